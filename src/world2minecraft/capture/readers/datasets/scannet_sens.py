"""Reader of ScanNet's ``.sens`` files, which contain the cameras and all frames of a scan.

The layout of version 4, little-endian, is::

    uint32 4; uint64 n; n bytes of the sensor's name
    four float32 [4, 4]: colour intrinsics and extrinsics, depth intrinsics and extrinsics
    int32 colour compression (0 none, 1 PNG, 2 JPEG), int32 depth compression (0 none, 1 zlib)
    uint32 colour width, height, depth width, height; float32 depth units per metre
    uint64 number of frames; each: float32 [4, 4] camera to world, uint64 time of colour and of
    depth in microseconds, uint64 bytes of colour and of depth, then those bytes

Only headers are read here. Frames with lost tracking have poses of -inf.
"""

import struct
from dataclasses import dataclass
from typing import IO

import numpy as np

from world2minecraft.capture.images import ImageSource
from world2minecraft.capture.readers.datasets.embedded_images import (
    EncodedImage,
    RawImage,
    open_seekable,
)
from world2minecraft.capture.readers.datasets.intrinsics import matrix_camera, stated_camera
from world2minecraft.capture.readers.datasets.scannet_metadata import (
    find_labels,
    read_scene_info,
    stated_lens,
    up_vector,
)
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Camera
from world2minecraft.core.types.capture import MAX_SIDE_PX

VERSION = 4
MAX_NAME_BYTES = 4096
MAX_FRAMES = 300_000  # Nearly three hours at 30 frames a second.
_CALIBRATION = struct.Struct("<64f2i4IfQ")
_FRAME = struct.Struct("<16f4Q")
_COLOURS = {0: "plain", 1: "PNG", 2: "JPEG"}
_DEPTHS = {0: "plain", 1: "zlib"}


@dataclass(frozen=True, eq=False)
class SensHeader:
    """The header of a ``.sens`` file; matrices are float64 [4, 4]."""

    colour_intrinsics: np.ndarray
    colour_to_base: np.ndarray
    depth_intrinsics: np.ndarray
    depth_to_base: np.ndarray
    colour_packing: int
    depth_packing: int
    colour_size: tuple[int, int]
    depth_size: tuple[int, int]
    units_a_metre: float
    frames: int


class ScanNetSensSource:
    """A reader of ScanNet ``.sens`` files, and of folders that contain a ``.sens`` file."""

    layout = "scene0000_00.sens (ScanNet)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the path is a ``.sens`` file or a folder with exactly one such file."""
        return _sens_file(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of a ``.sens`` file.

        Raises:
            CaptureError: If the metadata of the scene is not valid.
            DamagedFileError: If the file is damaged.
        """
        path = _sens_file(folder)
        if path is None:
            raise DamagedFileError(folder, "does not contain a .sens file")
        size = int(path.stat().st_size)
        with open_seekable(path) as stream:
            header = read_sens_header(path, stream)
            places, notes = _read_frame_records(path, stream, size, header.frames)
        facts_path = path.parent / f"{path.stem}.txt"
        facts = read_scene_info(facts_path)
        cameras = _cameras(path, header, facts)
        labels, label_notes = find_labels(path.parent, path.stem)
        frames = tuple(
            _frame(path, header, cameras, place, labels.get(place.number)) for place in places
        )
        return Capture(
            folder,
            "scannet_sens",
            frames,
            depth_unit=_unit(header.units_a_metre),
            notes=(*notes, *label_notes),
            world_up=up_vector(facts_path, facts),
        )


def _sens_file(place: AnyPath) -> AnyPath | None:
    if place.suffix.lower() == ".sens" and place.is_file():
        return place
    found = [path for path in place.glob("*.sens") if path.is_file()] if place.is_dir() else []
    return found[0] if len(found) == 1 else None


def read_sens_header(path: AnyPath, stream: IO[bytes]) -> SensHeader:
    """Read the header of a ``.sens`` file and check all sizes in it.

    Raises:
        DamagedFileError: If the file is truncated or is not a ``.sens`` file of version 4.
    """
    start = stream.read(12)
    version, length = struct.unpack("<IQ", start) if len(start) == 12 else (0, 0)
    if version != VERSION or length > MAX_NAME_BYTES:
        raise DamagedFileError(
            path, f"is not a .sens file of version {VERSION} (version field: {version})"
        )
    stream.seek(length, 1)
    data = stream.read(_CALIBRATION.size)
    if len(data) != _CALIBRATION.size:
        raise DamagedFileError(path, "is truncated in its header; copy the file again")
    values = _CALIBRATION.unpack(data)
    matrices = np.array(values[:64], np.float64).reshape(4, 4, 4)
    colour_packing, depth_packing, *sizes = values[64:70]
    units, frames = values[70:]
    if colour_packing not in _COLOURS or depth_packing not in _DEPTHS:
        raise DamagedFileError(
            path,
            f"has the unsupported compression {colour_packing} for colour or {depth_packing} "
            "for depth; supported: colour 0 (none), 1 (PNG), 2 (JPEG) and depth 0 (none), 1 "
            "(zlib)",
        )
    if not all(size <= MAX_SIDE_PX for size in sizes) or not 0 < units < 1e7:
        raise DamagedFileError(
            path, f"has an invalid image size or depth unit: {sizes} px, {units} units per metre"
        )
    if not 0 < frames <= MAX_FRAMES:
        raise DamagedFileError(path, f"contains {frames:,} frames; expected 1 to {MAX_FRAMES:,}")
    width, height, depth_width, depth_height = sizes
    return SensHeader(
        matrices[0],
        matrices[1],
        matrices[2],
        matrices[3],
        colour_packing,
        depth_packing,
        (width, height),
        (depth_width, depth_height),
        units,
        frames,
    )


@dataclass(frozen=True, eq=False)
class _FrameRecord:
    """The byte offsets, sizes and metadata of one frame's images."""

    number: int
    pose: np.ndarray
    time_s: float
    colour: tuple[int, int]
    depth: tuple[int, int]


def _read_frame_records(
    path: AnyPath, stream: IO[bytes], size: int, count: int
) -> tuple[list[_FrameRecord], tuple[str, ...]]:
    """Read the frame headers one after the other; in a truncated file, keep the complete frames."""
    places: list[_FrameRecord] = []
    position = stream.tell()
    for number in range(count):
        data = stream.read(_FRAME.size)
        if len(data) != _FRAME.size:
            break
        *pose, colour_us, depth_us, colour_bytes, depth_bytes = _FRAME.unpack(data)
        position += _FRAME.size
        if colour_bytes + depth_bytes > size - position:
            break
        places.append(
            _FrameRecord(
                number,
                np.array(pose, np.float64).reshape(4, 4),
                (colour_us or depth_us) / 1e6,
                (position, colour_bytes),
                (position + colour_bytes, depth_bytes),
            )
        )
        position += colour_bytes + depth_bytes
        stream.seek(position)
    if not places:
        raise DamagedFileError(
            path, "is truncated and contains no complete frame; copy the file again"
        )
    if len(places) == count:
        return places, ()
    return places, (f"{path.name} is truncated; {len(places):,} of {count:,} frames are complete",)


def _cameras(
    path: AnyPath, header: SensHeader, facts: dict[str, np.ndarray]
) -> tuple[Camera | None, Camera | None]:
    """Return the colour and depth cameras; ``SCENE.txt`` provides values missing in the header."""
    cameras: list[Camera | None] = []
    for kind, size, matrix in (
        ("color", header.colour_size, header.colour_intrinsics),
        ("depth", header.depth_size, header.depth_intrinsics),
    ):
        lens = stated_lens(facts, kind)
        if 0 in size:
            cameras.append(None)
        elif matrix[0, 0] <= 1 and lens is not None:
            cameras.append(stated_camera(path, size, lens))
        else:
            cameras.append(matrix_camera(path, size, matrix))
    return cameras[0], cameras[1]


def _frame(
    path: AnyPath,
    header: SensHeader,
    cameras: tuple[Camera | None, Camera | None],
    place: _FrameRecord,
    labels: ImageSource | None,
) -> FrameFiles:
    name = f"{place.number:06d}"
    colour = _colour(path, header, place, name) if place.colour[1] and cameras[0] else None
    depth = None
    if place.depth[1] and cameras[1]:
        packed = header.depth_packing == 1
        depth = RawImage(path, *place.depth, f"{name} depth", *header.depth_size, "I;16", packed)
    to_base = header.colour_to_base if colour else header.depth_to_base
    depth_to_colour = np.eye(4)
    if not np.array_equal(header.colour_to_base, header.depth_to_base):
        depth_to_colour = invert_rigid(header.colour_to_base) @ header.depth_to_base
    identity = np.array_equal(to_base, np.eye(4)) or not np.isfinite(place.pose).all()
    return FrameFiles(
        name,
        place.pose if identity else place.pose @ to_base,
        colour,
        cameras[0] if colour else None,
        depth,
        cameras[1] if depth else None,
        depth_to_colour,
        labels if colour else None,
        "" if colour or depth else "has no images",
        time_s=place.time_s,
    )


def _colour(path: AnyPath, header: SensHeader, place: _FrameRecord, name: str) -> ImageSource:
    named = f"{name} colour"
    if header.colour_packing == 0:
        return RawImage(path, *place.colour, named, *header.colour_size, "RGB")
    return EncodedImage(path, *place.colour, named)


def _unit(units_a_metre: float) -> str:
    return "mm" if units_a_metre == 1000 else repr(1 / float(np.float32(units_a_metre)))
