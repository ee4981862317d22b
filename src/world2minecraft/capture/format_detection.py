"""Detection of the format of a capture.

To add a format, write a module with a ``Source``, add it to ``SOURCES`` and add a test. Other
packages register formats through the entry point group ``world2minecraft.source``.
"""

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.pose_validation import move_near_origin
from world2minecraft.capture.source_types import Capture, ConfigurableSource, Source
from world2minecraft.core.archives import AnyPath, ArchivePath, is_zip
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.registry import Registry
from world2minecraft.core.whole_reads import read_whole, unchanged

SOURCES = Registry(
    "source",
    {
        "plain": "world2minecraft.capture.readers.capture_json:PlainSource",
        "record3d": "world2minecraft.capture.readers.apps.record3d:Record3DSource",
        "polycam": "world2minecraft.capture.readers.apps.polycam:PolycamSource",
        "stray": "world2minecraft.capture.readers.apps.stray:StraySource",
        "arkitscenes": "world2minecraft.capture.readers.apps.arkitscenes:ARKitScenesSource",
        "scanner_app": "world2minecraft.capture.readers.apps.scanner_app:ScannerAppSource",
        "scannet_sens": "world2minecraft.capture.readers.datasets.scannet_sens:ScanNetSensSource",
        "scannet_folder": (
            "world2minecraft.capture.readers.datasets.scannet_folder:ScanNetFolderSource"
        ),
        "scannetpp": "world2minecraft.capture.readers.datasets.scannetpp:ScanNetPpSource",
        "tum": "world2minecraft.capture.readers.datasets.tum:TumSource",
        "replica": "world2minecraft.capture.readers.datasets.replica:ReplicaSource",
        "sun": "world2minecraft.capture.readers.datasets.sun_rgbd:SunSource",
        "nyu_raw": "world2minecraft.capture.readers.datasets.nyu_raw:NyuRawSource",
        "realsense": "world2minecraft.capture.readers.datasets.realsense:RealSenseSource",
        "open3d": "world2minecraft.capture.readers.datasets.open3d:Open3dSource",
        "colmap": "world2minecraft.capture.readers.datasets.colmap:ColmapSource",
        "nerfstudio": "world2minecraft.capture.readers.datasets.nerfstudio:NerfstudioSource",
        "seven_scenes": "world2minecraft.capture.readers.datasets.seven_scenes:SevenScenesSource",
        "solid": "world2minecraft.capture.readers.meshes.mesh_source:MeshSource",
        "video": "world2minecraft.capture.readers.video:VideoSource",
        "panoramas": "world2minecraft.capture.readers.panoramas:PanoramaSource",
        "photos": "world2minecraft.capture.readers.photo_folder:PhotoFolderSource",
        "photo": "world2minecraft.capture.readers.single_photo:SinglePhotoSource",
    },
)
# Asked last, after those of other packages too.
FALLBACK_SOURCES = ("panoramas", "photos", "photo")
MAX_WRAPPINGS = 3  # Folders that hold nothing but a folder, as zips often do.
MAX_HINT_FOLDERS = 50  # Folders of a wrong folder that are tried, for a hint.
INDEX_FILES = ("capture.json", "transforms.json")
UNREAD_ARCHIVE_SUFFIXES = (".tar", ".tgz", ".gz", ".bz2", ".xz", ".zst", ".7z", ".rar")


def find_capture(path: str | Path, options: ScanOptions | None = None) -> Capture:
    """Detect the format of the capture at a path and list its frames.

    Args:
        path: A folder, one of its ``INDEX_FILES``, a zip archive of a capture, or a file of a
            supported format.
        options: User options, passed to sources that implement ``ConfigurableSource``.

    Raises:
        CaptureError: If the capture is missing, empty, inconsistent or of an unknown format.
        ConflictError: If another process is changing the folder.
    """
    place = Path(path)
    try:
        if place.is_file() and place.name in INDEX_FILES:
            place = place.parent
        if not place.exists():
            raise CaptureError(place, "not found")
        empty = place.is_dir() and next(place.iterdir(), None) is None
    except OSError as error:
        raise CaptureError(place, f"cannot be read: {error.strerror or error}") from error
    if place.is_file() and place.suffix.lower() in UNREAD_ARCHIVE_SUFFIXES:
        reason = f"is a {place.suffix} archive; only zip archives can be read directly: unpack it"
        raise CaptureError(place, f"{reason} and use the unpacked folder")
    return read_whole(place, lambda: _detect(place, empty, options))


def _detect(place: Path, empty: bool, options: ScanOptions | None) -> Capture:
    names = sorted(SOURCES.names(), key=lambda name: name in FALLBACK_SOURCES)
    sources: list[Source] = [SOURCES.load(name)() for name in names]
    choosy = sources[: -len(FALLBACK_SOURCES)]
    for inner in _candidate_places(place):
        for source in sources:
            if source.recognise(inner):
                is_inside = inner != place
                with unchanged(inner) if is_inside and isinstance(inner, Path) else nullcontext():
                    found = replace(_read_source(source, inner, options), folder=place)
                return move_near_origin(found)
    kind = (
        "is empty"
        if empty
        else f"is a {_describe_kind(place)} of an unknown format{_describe_contents(place)}"
    )
    within = _capture_one_level_down(place, choosy)
    if within is not None:
        raise CaptureError(place, f"{kind}; there is a capture one folder deeper, use {within}")
    known = ", ".join(_layout_name(source.layout) for source in sources)
    raise CaptureError(
        place,
        f"{kind}; supported formats: {known}; their files: docs/reference/capture-formats.md",
    )


def _read_source(source: Source, place: AnyPath, options: ScanOptions | None) -> Capture:
    if isinstance(source, ConfigurableSource):
        return source.read_with(place, options or ScanOptions())
    return source.read(place)


def _candidate_places(place: Path) -> Iterator[AnyPath]:
    """Yield the places to search: the path, the inside of its zip, and lone subfolders."""
    yield place
    inner: AnyPath = ArchivePath(place) if place.is_file() and is_zip(place) else place
    for _ in range(MAX_WRAPPINGS):
        if inner is not place:
            yield inner
        if not inner.is_dir():
            return
        held = [entry for entry in inner.iterdir() if not entry.name.startswith((".", "__MACOSX"))]
        if len(held) != 1 or not held[0].is_dir():
            return
        inner = held[0]


def _describe_kind(place: Path) -> str:
    if place.is_dir():
        return "folder"
    return "zip" if is_zip(place) else f"file ({place.suffix or 'no suffix'})"


def _describe_contents(place: Path) -> str:
    """Return a summary of a folder's entries, which helps to find missing parts of an export."""
    if not place.is_dir():
        return ""
    entries = list(place.iterdir())
    kinds = Counter(
        "folder" if entry.is_dir() else entry.suffix.lower() or "file without suffix"
        for entry in entries
    )
    most = sorted(kinds.items(), key=lambda item: (-item[1], item[0]))[:4]
    return ", which contains " + ", ".join(_count_phrase(count, kind) for kind, count in most)


def _count_phrase(count: int, kind: str) -> str:
    """Return a count with its noun.

    Example:
        >>> [_count_phrase(count, "file without suffix") for count in (1, 2)]
        ['1 file without suffix', '2 files without suffix']
        >>> _count_phrase(2, ".png")
        '2 .png'
    """
    first, *rest = kind.split()
    return " ".join([str(count), first + "s" * (count > 1 and not first.startswith(".")), *rest])


def _capture_one_level_down(place: Path, sources: Sequence[Source]) -> Path | None:
    """Return the only subfolder that is a capture; None if there is none or more than one."""
    if not place.is_dir():
        return None
    folders = sorted(entry for entry in place.iterdir() if entry.is_dir())[:MAX_HINT_FOLDERS]
    known = [one for one in folders if any(source.recognise(one) for source in sources)]
    return known[0] if len(known) == 1 else None


def _layout_name(layout: str) -> str:
    """Return the name of a layout, which is in brackets at its end, or else the whole text.

    Example:
        >>> _layout_name("rgb.txt, depth.txt and groundtruth.txt (TUM RGB-D)")
        'TUM RGB-D'
    """
    front, _, name = layout.partition(" (")
    if name.startswith("."):
        return front  # What stands in brackets are suffixes.
    return name.removesuffix(")") if layout.endswith(")") else layout
