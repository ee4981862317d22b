"""Reader of LAS, LAZ and E57 point clouds, which are in metres with z up by specification."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.capture.readers.meshes.colours_and_classes import colours_or_black
from world2minecraft.capture.readers.meshes.mesh_and_cloud import MAX_POINTS, LoadedGeometry
from world2minecraft.capture.readers.meshes.optional_libraries import import_optional
from world2minecraft.capture.readers.meshes.voxel_downsampling import VoxelDownsampler
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, LimitError, reason_of

CHUNK = 1_000_000
RECORD_BYTES = 54  # The head of a variable length record of LAS.
MAX_SCAN_POINTS = 80_000_000  # An E57 scan is read whole, with 27 bytes per point.


def load_las(place: AnyPath) -> LoadedGeometry:
    """Read a LAS or LAZ file in chunks.

    Raises:
        DamagedFileError: If the file cannot be read.
        LimitError: If the file has too many points.
        MissingExtraError: If laspy is not installed.
    """
    laspy = import_optional("laspy", "reading LAS clouds")
    thinner = VoxelDownsampler(unit_m=1.0)
    try:
        _check_records(place)
        with laspy.open(place.open("rb"), read_evlrs=False) as reader:
            _check_count(place, reader.header.point_count)
            if reader.header.are_points_compressed:
                _check_chunks(place, reader.header)
            for chunk in reader.chunk_iterator(CHUNK):
                points = np.stack([np.asarray(chunk[axis]) for axis in "xyz"], axis=1)
                thinner.add(points.astype(np.float64), _las_colour(chunk))
            if thinner.read < reader.header.point_count:
                raise DamagedFileError(
                    place,
                    f"is truncated: expected {reader.header.point_count:,} points, found "
                    f"{thinner.read:,}; copy the file again",
                )
    except (DamagedFileError, LimitError):
        raise
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # laspy and lazrs share no root; lazrs even panics.
        raise DamagedFileError(
            place, f"cannot be read as LAS ({reason_of(error)}); export the file again"
        ) from error
    return _to_geometry(thinner, "LAS")


def _check_records(place: AnyPath) -> None:
    """Check the number of records in the header of a LAS file, which laspy reads one by one."""
    with place.open("rb") as stream:
        head = stream.read(104)
    points_at, records = (
        int.from_bytes(head[96:100], "little"),
        int.from_bytes(head[100:], "little"),
    )
    if RECORD_BYTES * records > points_at or points_at > place.stat().st_size:
        raise DamagedFileError(
            place,
            f"is damaged: its header declares {records:,} records, more than the file contains; "
            "copy the file again",
        )


def _check_chunks(place: AnyPath, header: Any) -> None:
    """Check the chunk table of a LAZ file against the file size; lazrs crashes on bad tables.

    The point data starts with the offset of the table; the table starts with a version and its
    length.
    """
    size, start = place.stat().st_size, int(header.offset_to_point_data)
    with place.open("rb") as stream:
        stream.seek(min(start, size))
        at = int.from_bytes(stream.read(8), "little", signed=True)
        if at == -1 and size >= 8:  # Written as it came: the place stands at the end.
            stream.seek(size - 8)
            at = int.from_bytes(stream.read(8), "little", signed=True)
        if not start + 8 <= at <= size - 8:
            raise DamagedFileError(
                place, "is truncated: the LAZ chunk table is missing; copy the file again"
            )
        stream.seek(at + 4)
        chunks = int.from_bytes(stream.read(4), "little")
    if chunks > min(header.point_count, 8 * (size - at)):
        raise DamagedFileError(
            place,
            f"is damaged: its header declares {chunks:,} chunks, more than the file "
            "contains; copy the file again",
        )


def _las_colour(chunk: Any) -> np.ndarray | None:
    if not {"red", "green", "blue"} <= set(chunk.point_format.dimension_names):
        return None
    values = np.stack([np.asarray(chunk[name]) for name in ("red", "green", "blue")], axis=1)
    return colours_or_black(values)  # The format asks for 16 bits; some writers use 8.


def load_e57(place: AnyPath) -> LoadedGeometry:
    """Read an E57 file scan by scan, applying the pose of each scan.

    Raises:
        DamagedFileError: If the file cannot be read.
        LimitError: If the file or one of its scans has too many points.
        MissingExtraError: If pye57 is not installed.
    """
    pye57 = import_optional("pye57", "reading E57 clouds")
    thinner = VoxelDownsampler(unit_m=1.0)
    try:
        with file_on_disk(place) as path, pye57.E57(str(path)) as file:
            counts = [file.get_header(scan).point_count for scan in range(file.scan_count)]
            _check_count(place, sum(counts))
            if max(counts, default=0) > MAX_SCAN_POINTS:
                raise LimitError(
                    place,
                    f"contains a scan of {max(counts):,} points, the limit is "
                    f"{MAX_SCAN_POINTS:,}; export fewer points",
                )
            if sum(counts) > 8 * path.stat().st_size:  # A point takes a bit at least.
                raise DamagedFileError(
                    place, f"is too short for {sum(counts):,} points; copy the file again"
                )
            for scan in range(file.scan_count):
                _add_scan(thinner, file, scan)
    except (DamagedFileError, LimitError):
        raise
    except Exception as error:  # What the library's C++ raises has no root.
        raise DamagedFileError(
            place, f"cannot be read as E57 ({reason_of(error)}); export the file again"
        ) from error
    return _to_geometry(thinner, "E57")


def _add_scan(thinner: VoxelDownsampler, file: Any, scan: int) -> None:
    fields = set(file.get_header(scan).point_fields)
    coloured = {"colorRed", "colorGreen", "colorBlue"} <= fields
    read = file.read_scan(scan, colors=coloured, ignore_missing_fields=True)
    points = np.stack([read[f"cartesian{axis}"] for axis in "XYZ"], axis=1)
    colour = None
    if coloured:
        values = np.stack([read[f"color{name}"] for name in ("Red", "Green", "Blue")], axis=1)
        colour = colours_or_black(values)
    for start in range(0, len(points), CHUNK):
        part = slice(start, start + CHUNK)
        thinner.add(points[part], None if colour is None else colour[part])


@contextmanager
def file_on_disk(place: AnyPath) -> Iterator[Path]:
    """Yield the path of a file on disk; files in a zip archive are extracted temporarily."""
    if isinstance(place, Path):
        yield place
        return
    with tempfile.TemporaryDirectory(prefix="world2minecraft-") as folder:
        path = Path(folder) / f"file{place.suffix}"
        path.write_bytes(place.read_bytes())
        yield path


def _check_count(place: AnyPath, count: int) -> None:
    if count > MAX_POINTS:
        raise LimitError(
            place,
            f"contains {count:,} points, the limit is {MAX_POINTS:,}; reduce the number of points",
        )


def _to_geometry(thinner: VoxelDownsampler, kind: str) -> LoadedGeometry:
    offset = np.zeros(3) if thinner.offset is None else thinner.offset
    return LoadedGeometry(
        thinner.cloud(), kind, offset, 1.0, "z", up_stated=True, read=thinner.read
    )
