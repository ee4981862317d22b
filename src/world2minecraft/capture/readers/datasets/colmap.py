"""A COLMAP project: photos whose places and lenses are known, without depth and without a scale.

The model lies in ``sparse/0`` (or ``sparse``, or here), the photos in ``images/`` beside it.
"""

from collections import Counter
from pathlib import PurePosixPath

from world2minecraft.capture.frames import Capture, FrameFiles
from world2minecraft.capture.readers.datasets.colmap_model import ModelImage, read_model
from world2minecraft.capture.readers.datasets.text_tables import checked_inside
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError

IMAGE_FOLDERS = ("images", "rgb", "image", ".")
_SAMPLED = 20  # Names that are looked for to tell which folder the photos lie in.


class ColmapSource:
    """Reads a COLMAP model with its photos."""

    layout = "sparse/0/cameras and images (.bin or .txt) with images/*.jpg (COLMAP)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether there is a model; where there are transforms.json too, those are read."""
        return bool(_models(folder)) and not (folder / "transforms.json").is_file()

    def read(self, folder: AnyPath) -> Capture:
        """List the photos. Raises CaptureError as ``Source.read`` says."""
        chosen, *others = _models(folder)
        images = read_model(chosen)
        if not images:
            raise CaptureError(chosen, "holds no photo; run colmap mapper again")
        files = [checked_inside(chosen, image.name) for image in images]
        place = _image_folder(folder, chosen, files)
        size = _usual_size(images)
        frames = tuple(
            FrameFiles(
                name,
                image.camera_to_world,
                place / str(file),
                image.camera,
                problem=_other_size(image, size),
            )
            for name, file, image in zip(_names(files), files, images, strict=True)
        )
        notes = ()
        if others:
            notes = (f"of {1 + len(others)} models the largest is read, {chosen.name}",)
        return Capture(folder, "colmap", frames, notes=notes, scale="unknown")


def _models(folder: AnyPath) -> list[AnyPath]:
    """Return the folders with a model, the one of most photos first."""
    sparse = [folder / "sparse", folder / "colmap" / "sparse"]
    places = [folder, *sparse]
    for place in sparse:
        if place.is_dir():
            places += sorted((path for path in place.iterdir() if path.is_dir()), key=str)
    found = [place for place in places if _has_model(place)]
    return sorted(found, key=lambda place: -_weight(place))


def _has_model(place: AnyPath) -> bool:
    return any(
        all((place / f"{kind}{suffix}").is_file() for kind in ("cameras", "images"))
        for suffix in (".bin", ".txt")
    )


def _weight(place: AnyPath) -> int:
    binary = place / "images.bin"
    return int((binary if binary.is_file() else place / "images.txt").stat().st_size)


def _image_folder(folder: AnyPath, model: AnyPath, files: list[PurePosixPath]) -> AnyPath:
    """Return the folder in which most of some named photos lie."""
    tops = list(dict.fromkeys([folder, model.parent, model.parent.parent]))
    places = [top if name == "." else top / name for top in tops for name in IMAGE_FOLDERS]
    sampled = files[:: max(1, len(files) // _SAMPLED)]

    def there(place: AnyPath) -> int:
        return sum((place / str(file)).is_file() for file in sampled)

    best = max(places, key=there)
    if not there(best):
        raise CaptureError(
            folder,
            f"has a model but none of its photos, such as images/{str(files[0])[:80]}: put them "
            "beside it",
        )
    return best


def _names(files: list[PurePosixPath]) -> list[str]:
    """Return a name of its own for each photo, folders told by dots."""
    names: list[str] = []
    seen: dict[str, int] = {}
    for file in files:
        name = ".".join([*file.parent.parts, file.stem])[-150:]
        count = seen[name] = seen.get(name, 0) + 1
        names.append(name if count == 1 else f"{name}.{count}")
    return names


def _usual_size(images: tuple[ModelImage, ...]) -> tuple[int, int]:
    """Return the size in pixels that most photos have, the first of equals."""
    counts = Counter((image.camera.width_px, image.camera.height_px) for image in images)
    return counts.most_common(1)[0][0]


def _other_size(image: ModelImage, size: tuple[int, int]) -> str:
    """Return why a photo is left out: all that go into one reconstruction have one size."""
    width, height = image.camera.width_px, image.camera.height_px
    return "" if (width, height) == size else f"is {width}x{height}; most are {size[0]}x{size[1]}"
