"""The options of ``w2m dataset build``, and the values that their words become."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from world2minecraft.core.errors import InputError, UsageError

if TYPE_CHECKING:
    from world2minecraft.core.types import Camera
    from world2minecraft.minecraftocc.plan import GivenViews, SceneSpec

IMAGES_A_SCENE = 50  # Where nobody says how many.


def _option(*names: str, text: str, metavar: str | None = None) -> Any:
    return typer.Option(*names, help=text, metavar=metavar)


Folder = Annotated[Path, typer.Argument(metavar="DIR", help="The data set's folder.")]
Houses = Annotated[
    int | None, _option("--houses", metavar="N", text="Generate so many furnished houses.")
]
Worlds = Annotated[
    Path | None,
    _option("--worlds", metavar="DIR", text="Every world or build in a folder, such as "
            "w2m rooms generate --houses makes."),
]  # fmt: skip
World = Annotated[
    list[Path] | None,
    _option("--world", "--schem", metavar="PLACE",
            text="A world, a run's folder or a schematic. May be given often."),
]  # fmt: skip
TourFile = Annotated[
    Path | None,
    _option("--tour", metavar="FILE", text="Poses of one --world, as a tour file has them."),
]
Screenshots = Annotated[
    Path | None,
    _option("--screenshots", metavar="DIR",
            text="The game's own pictures of one --world, with their poses."),
]  # fmt: skip
At = Annotated[
    str, _option("--at", metavar="feet|eye", text="What x, y, z of screenshots is; must be said.")
]
Images = Annotated[
    int | None,
    _option("--images", metavar="N", text=f"How many in all; {IMAGES_A_SCENE} a scene."),
]
Preset = Annotated[
    str, _option("--preset", text="8k, 50k or 100k: the paper's numbers of images, exactly.")
]
TestShare = Annotated[float, _option("--test-share", text="Of images, in scenes of their own.")]
CameraName = Annotated[
    str, _option("--camera", text="nyu: 640x480 as NYUv2 has it; paper: 1920x1129, 70 degrees.")
]
Size = Annotated[str, _option("--size", metavar="WxH", text="Pixels, instead of the camera's.")]
Fov = Annotated[
    float | None, _option("--fov", text="Vertical field of view, degrees, instead of its own.")
]
Voxel = Annotated[
    str, _option("--voxel", text="A cell's side in metres, or block: one cell a block.")
]
Region = Annotated[
    str, _option("--region", text="paper: along the axes or diagonals; free: turned with the view.")
]
LabelsOnly = Annotated[
    bool, _option("--labels-only", text="Labels and masks, no pictures and no depth.")
]
ImageFormat = Annotated[str, _option("--image-format", text="jpg, png or webp.")]
Quality = Annotated[int, _option("--quality", text="Of JPEG and WebP, 1 to 100.")]
PaperCompat = Annotated[
    bool, _option("--paper-compat", text="Also K and E as the paper prints them, slips and all.")
]
BlockMap = Annotated[
    str, _option("--block-map", text="Which class a block is: nyu, paper, or a YAML file.")
]
Scale = Annotated[
    float | None,
    _option("--blocks-per-metre", text="Of worlds that do not say it; 1 is true size."),
]
Hour = Annotated[
    float | None, _option("--hour", text="0 to 24: the light of all scenes, not each its own.")
]
Seed = Annotated[int, _option("--seed", text="The same seed, the same data set.")]
EngineName = Annotated[
    str, _option("--engine", text="pool: this machine; ray: all machines of a Ray cluster.")
]
Jobs = Annotated[int | None, _option("--jobs", text="How many processes; one a core.")]


def parse_camera(name: str, size: str, fov_deg: float | None) -> "Camera":
    """Return the camera that the options mean. Raises UsageError or UnknownNameError."""
    from world2minecraft.cli.render.options import camera_choice
    from world2minecraft.core.errors import UnknownNameError
    from world2minecraft.minecraftocc.tours import nyu_camera, paper_camera
    from world2minecraft.rendering.views import vertical_fov_deg_of

    cameras = {"nyu": nyu_camera, "paper": paper_camera}
    if name not in cameras:
        raise UnknownNameError("camera", name, cameras)
    camera = cameras[name]()
    if not size and fov_deg is None:
        return camera
    text = size or f"{camera.width_px}x{camera.height_px}"
    usual = vertical_fov_deg_of(camera)
    return camera_choice(text, usual if fov_deg is None else fov_deg, None).camera(usual)


def find_scenes(
    houses: int | None,
    worlds: Path | None,
    world: list[Path] | None,
    preset: str,
    blocks_per_metre: float | None,
    given: "GivenViews | None" = None,
) -> "list[SceneSpec]":
    """Return the scenes that the options mean, not yet split.

    Raises:
        UsageError: none, or two kinds of them. InputError: a place is not there.
    """
    from dataclasses import replace

    from world2minecraft.minecraftocc.plan import house_scenes, preset_named, source_scenes

    places = list(world or [])
    if worlds is not None:
        places += find_worlds(worlds)
    if places and houses is not None:
        raise UsageError("--houses are generated; give them alone, without --worlds and --world")
    if places:
        for place in places:
            if not place.exists():
                raise InputError(place, "is not there")
        if given is not None and len(places) > 1:
            raise UsageError("--tour and --screenshots are of one --world")
        found = source_scenes(places)
        return [replace(one, blocks_per_metre=blocks_per_metre, given=given) for one in found]
    if given is not None:
        raise UsageError("--tour and --screenshots are of one --world; name it")
    named = preset_named(preset) if preset else None
    count = named.houses if named is not None and houses is None else houses
    if count is not None and count < 1:
        raise UsageError(f"--houses is 1 or more, not {count}")
    return house_scenes(count or 0)


def read_given_poses(
    tour: Path | None, screenshots: Path | None, at: str, fov_deg: float | None
) -> "tuple[GivenViews | None, int]":
    """Return the views that were recorded, None where they are to be planned, and their number.

    Raises:
        UsageError: the words contradict each other. InputError: they cannot be read.
    """
    from world2minecraft.minecraftocc.plan import GivenViews

    if tour is not None and screenshots is not None:
        raise UsageError("--tour and --screenshots are two kinds of views; give one of them")
    if tour is not None:
        from world2minecraft.rendering.views import read_tour

        return GivenViews(str(tour)), len(read_tour(tour))
    if screenshots is not None:
        from world2minecraft.minecraftocc.building.recorded_views import load_screenshot_views

        words = {} if fov_deg is None else {"vertical_fov_deg": fov_deg}
        given = GivenViews(str(screenshots), True, parse_at(at), **words)  # type: ignore[arg-type]
        return given, len(load_screenshot_views(given))
    return None, 0


def parse_at(text: str) -> Literal["feet", "eye"]:
    """Return what x, y, z of screenshots is. Raises UsageError: it is not said."""
    if text == "feet" or text == "eye":
        return text
    raise UsageError(
        "say what x, y, z of the screenshots is: --at feet, as F3 and most mods tell, or --at eye; "
        "a slip of 1.62 blocks spoils every label"
    )


def find_worlds(folder: Path) -> list[Path]:
    """Return what can be a scene in a folder, sorted. Raises InputError where nothing can."""
    if not folder.is_dir():
        raise InputError(folder, "is no folder of worlds")
    kinds = (".schem", ".schematic", ".litematic", ".nbt")
    found = [
        path
        for path in sorted(folder.iterdir())
        if path.name[0] != "."
        and (
            path.suffix.lower() in kinds
            if path.is_file()
            else any(
                (path / part).exists() for part in ("level.dat", "scene.json", "build/scene.json")
            )
        )
    ]
    if not found:
        raise InputError(folder, "holds no world; w2m rooms generate --houses 4 --worlds DIR")
    return found


def check_seed(seed: int, hour: float | None = None) -> None:
    """Raise UsageError where a seed is none, or an hour, as ``check_hour``."""
    if seed < 0:
        raise UsageError(f"--seed must be 0 or more, not {seed}")
    check_hour(hour)


def check_hour(hour: float | None) -> None:
    """Raise UsageError where an hour is none of a day; None is each scene's own."""
    if hour is not None and not 0 <= hour <= 24:
        raise UsageError(f"--hour is 0 to 24, not {hour:g}")


def cells_of(voxel: str) -> float | None:
    """Return a cell's side in metres, None for one cell a block. Raises UsageError."""
    if voxel == "block":
        return None
    try:
        return float(voxel)
    except ValueError:
        raise UsageError(f"--voxel is metres, such as 0.08, or block; not {voxel!r}") from None
