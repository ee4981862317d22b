"""Reader of folders of photos without poses, optionally with depth.

Files that are not photos of the room are skipped with a reason: screenshots, thumbnails,
panoramas, duplicates, edits next to their originals, and files added by operating systems.
"""

import hashlib
import re
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.images import HEIF_SUFFIXES
from world2minecraft.capture.options import MIN_FRAMES, ScanOptions
from world2minecraft.capture.poster_detection import is_saved_poster
from world2minecraft.capture.readers.photo_exif import (
    PhotoMetadata,
    UprightPhoto,
    read_photo_metadata,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, InputError

PHOTO_SUFFIXES = (".jpg", ".jpeg", ".png", ".webp", *HEIF_SUFFIXES)
DEPTH_SUFFIXES = (".png", ".tif", ".tiff", ".npy")
COLOUR_FOLDERS = ("rgb", "color", "colour", "image", "images", "photos")
MOVIE_SUFFIXES = (".mov", ".mp4", ".m4v")
MAX_PHOTOS = 20_000
MIN_SIDE_PX = 240  # The longer side; less is a thumbnail.
THUMBNAIL_SHARE = 0.35  # Share of the median longer side; smaller images are thumbnails.
MAX_ASPECT = 2.4  # Wider is a panorama, which no one lens has taken.
_SCREENSHOT = re.compile(r"screen[ _-]?shot|bildschirmfoto|capture d.?.cran|screen recording", re.I)
_NOT_COLOUR = re.compile(r"[._-](depth|mask|labels?|conf(idence)?|normals?|pose)$", re.I)
_OF_AN_APP = re.compile(r"\.(depth|conf)$|[._-](depth|pose)\.[a-z]+$|^transforms.*\.json$", re.I)
_EDITED = re.compile(r"(IMG_)E(\d+)")


@dataclass(frozen=True)
class _PhotoFile:
    path: AnyPath
    facts: PhotoMetadata | None
    problem: str = ""


class PhotoFolderSource:
    """A reader of folders and zip archives of photos."""

    layout = (
        "a folder of photos (.jpg, .png, .heic, .webp), optionally with depth/NAME.png next to rgb/"
    )

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains photos and no files of a scanner app."""
        return bool(list_photos(folder))

    def read(self, folder: AnyPath) -> Capture:
        """Read all usable photos of a folder.

        Raises:
            CaptureError: If there are too few or too many photos.
        """
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Read the usable photos of a folder, at most ``options.frames``.

        Raises:
            CaptureError: If there are too few or too many photos.
        """
        colour_folder = _colour_folder(folder)
        paths = _photos(colour_folder)
        if len(paths) > MAX_PHOTOS:
            raise CaptureError(
                folder,
                f"contains {len(paths):,} photos, the limit is {MAX_PHOTOS:,}; use a part of them",
            )
        accepted, skipped = _select_photos(paths)
        if len(accepted) < MIN_FRAMES:
            why = f"; {skipped[0][0]} {skipped[0][1]}" if skipped else ""
            count = f"{len(accepted)} photo" + "s" * (len(accepted) != 1)
            reason = f"contains {count} that can be used{why}; take at least 30 photos of the room"
            raise CaptureError(folder, reason)
        accepted = evenly_thinned(accepted, options.frames)
        depths = _depth_files(folder, colour_folder)
        frames = _frames(accepted, depths)
        notes = [*_notes(colour_folder, paths), _lens_note(frames)]
        if depths:
            paired = sum(frame.depth_path is not None for frame in frames)
            notes.append(
                f"{paired} of {len(frames)} photos have depth; the capture contains no poses"
            )
        return Capture(
            folder, "photos", frames, notes=tuple(notes), lens="guess", scale="unknown",
            skipped=tuple(skipped),
        )  # fmt: skip


def _is_app_file(name: str) -> bool:
    """Return whether a file name belongs to an incomplete capture of another format."""
    return bool(_OF_AN_APP.search(name))


def plain_name(stem: str, used: Collection[str]) -> str:
    """Return a valid frame name for a file stem that differs from all names in use.

    Example:
        >>> plain_name("my room", ["my_room"])
        'my_room.2'
    """
    plain = re.sub(r"[^A-Za-z0-9_.-]+", "_", stem).lstrip(".-")[:80] or "photo"
    name, count = plain, 1
    while name in used:
        count += 1
        name = f"{plain}.{count}"
    return name


def list_photos(folder: AnyPath) -> list[AnyPath]:
    """Return the photo files of a folder or of its subfolder of colour images, by number.

    The result is empty if the path is not a folder, or contains files of a scanner app.
    """
    if not folder.is_dir() or any(_is_app_file(path.name) for path in folder.iterdir()):
        return []
    return _photos(_colour_folder(folder))


def natural_key(name: str) -> tuple[tuple[int, int, str], ...]:
    """Return a sort key that orders names by the numbers in them: IMG_2 before IMG_10."""
    parts = re.findall(r"[0-9]+|[^0-9]+", name.casefold())
    return tuple((0, int(part[:18]), part) if part[0].isdigit() else (1, 0, part) for part in parts)


def evenly_thinned(found: Sequence, wanted: int | None) -> list:
    """Return at most ``wanted`` elements, evenly spaced from the first to the last."""
    if wanted is None or len(found) <= wanted:
        return list(found)
    return [found[n] for n in np.linspace(0, len(found) - 1, wanted).round().astype(int)]


def _photos(folder: AnyPath) -> list[AnyPath]:
    """Return the photo files of a folder, sorted by number."""
    found = [
        path
        for path in folder.iterdir()
        if path.suffix.lower() in PHOTO_SUFFIXES
        and not path.name.startswith((".", "._"))
        and not _NOT_COLOUR.search(path.stem)
        and path.is_file()
        and not is_saved_poster(path)
    ]
    return sorted(found, key=lambda path: (natural_key(path.name), path.name))


def _colour_folder(folder: AnyPath) -> AnyPath:
    """Return the folder of the photos: this folder or a subfolder with a usual name."""
    if not _photos(folder):
        for name in COLOUR_FOLDERS:
            if (folder / name).is_dir() and _photos(folder / name):
                return folder / name
    return folder


def _select_photos(paths: list[AnyPath]) -> tuple[list[_PhotoFile], list[tuple[str, str]]]:
    """Return the usable photos, and the names of the others with the reasons."""
    found = [_inspect(path) for path in paths]
    sides = [max(item.facts.width_px, item.facts.height_px) for item in found if item.facts]
    usual = float(np.median(sides)) if sides else 0.0
    taken = [item.facts.by_camera for item in found if item.facts]
    by_phone = sum(taken) * 2 > len(taken)
    accepted: list[_PhotoFile] = []
    skipped: list[tuple[str, str]] = []
    seen: dict[str, str] = {}
    sizes = Counter(path.stat().st_size for path in paths)
    stems = {path.stem for path in paths}
    for item in found:
        reason = _reject_reason(item, usual, by_phone, stems) or _duplicate_reason(
            item, sizes, seen
        )
        if reason:
            skipped.append((item.path.name, reason))
        else:
            accepted.append(item)
    return accepted, skipped


def _inspect(path: AnyPath) -> _PhotoFile:
    try:
        return _PhotoFile(path, read_photo_metadata(path))
    except InputError as error:
        return _PhotoFile(path, None, error.reason)


def _reject_reason(item: _PhotoFile, usual_px: float, by_phone: bool, stems: set[str]) -> str:
    """Return why a file is not a photo of the room, or an empty string."""
    if item.facts is None:
        return item.problem
    sides = sorted((item.facts.width_px, item.facts.height_px))
    edited = _EDITED.fullmatch(item.path.stem)
    if edited and edited[1] + edited[2] in stems:
        return f"is an edited copy of {edited[1]}{edited[2]}, which is used instead"
    strange = item.path.suffix.lower() == ".png" and by_phone and not item.facts.by_camera
    if _SCREENSHOT.search(item.path.stem) or strange:
        return "is a screenshot"
    if sides[1] < max(MIN_SIDE_PX, THUMBNAIL_SHARE * usual_px):
        return f"is a thumbnail of {item.facts.width_px}x{item.facts.height_px} px"
    if sides[1] > MAX_ASPECT * sides[0]:
        return f"is a panorama of {item.facts.width_px}x{item.facts.height_px} px"
    return ""


def _duplicate_reason(item: _PhotoFile, sizes: Counter[int], seen: dict[str, str]) -> str:
    """Return why a photo is a duplicate, or an empty string; ``seen`` collects earlier photos."""
    keys = [f"stem {item.path.stem}"]
    if sizes[item.path.stat().st_size] > 1:  # Files of different sizes need not be read.
        keys.append(hashlib.sha256(item.path.read_bytes()).hexdigest())
    for key in keys:
        if key in seen:
            return f"is a duplicate of {seen[key]}"
    seen.update(dict.fromkeys(keys, item.path.name))
    return ""


def _depth_files(folder: AnyPath, colour_folder: AnyPath) -> dict[str, AnyPath]:
    """Return the depth images next to a folder of photos by the stem of the photo."""
    place = folder / "depth"
    if colour_folder == folder or not place.is_dir():
        return {}
    return {
        path.stem: path
        for path in sorted(place.iterdir(), key=lambda path: path.name)
        if path.suffix.lower() in DEPTH_SUFFIXES and not path.name.startswith(".")
    }


def _frames(accepted: Sequence[_PhotoFile], depths: dict[str, AnyPath]) -> tuple[FrameFiles, ...]:
    frames: list[FrameFiles] = []
    used: set[str] = set()
    for item in accepted:
        name = plain_name(item.path.stem, used)
        used.add(name)
        camera = item.facts.camera if item.facts else None
        frames.append(
            FrameFiles(
                name,
                None,
                UprightPhoto(item.path),
                camera,
                depths.get(item.path.stem),
                time_s=item.facts.time_s if item.facts else None,
            )
        )
    return tuple(frames)


def _lens_note(frames: tuple[FrameFiles, ...]) -> str:
    focals = [frame.colour_camera.fx_px for frame in frames if frame.colour_camera]
    if not focals:
        return (
            "the photos contain no lens data; the intrinsics are estimated together with the poses"
        )
    return (
        f"the initial lens parameters of {len(focals)} of {len(frames)} photos are "
        "estimated from EXIF data"
    )


def _notes(folder: AnyPath, photos: list[AnyPath]) -> list[str]:
    """Return notes about live-photo videos and raw files in the folder."""
    stems = {path.stem for path in photos}
    names = [path for path in folder.iterdir() if not path.name.startswith(".")]
    videos = [path for path in names if path.suffix.lower() in MOVIE_SUFFIXES]
    live = sum(path.stem in stems for path in videos)
    notes = [f"{live} live-photo videos are ignored"] if live else []
    if len(videos) > live:
        notes.append(f"{len(videos) - live} videos are ignored; to use a video, give its path")
    raw = sum(path.suffix.lower() in (".dng", ".cr2", ".cr3", ".nef", ".arw") for path in names)
    return [*notes, f"{raw} raw photos are ignored; export them as JPEG"] if raw else notes
