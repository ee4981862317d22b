"""Reader and writer for SSCNet ``.bin`` files: run-length encoded 2 cm voxels of an NYU frame.

A file contains 3 float32 (the minimum corner of voxel (0, 0, 0) in the world), 16 float32 (the
camera pose in the world, row by row), and uint32 pairs of value and count for 240 x 144 x 240
voxels in C order with the axes (x, z up, y). The values are 0 to 36 or 255. Like MonoScene's
preprocessing, this module downsamples the voxels to grids of 8 and 32 cm, but for all cells at
once.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.jit import njit
from world2minecraft.core.types import checks

NYU_SIZE_PX, NYU_FOCAL_PX = (640, 480), 518.8579  # The camera that loaders of NYUv2 assume.
FINE_SHAPE = (240, 144, 240)  # x, z up, y
FINE_PER_CELL = 4
HEADER_BYTES = 4 * (3 + 16)
MAX_BYTES = 80 << 20  # Every voxel a run of its own takes 66 MB.
MAX_SKEW = 1e-3  # Poses of float32, and of a few printed digits, are rigid within this.
EMPTY_SHARE = 0.95  # A cell is empty where more of its voxels than this are empty or unknown.

# SSCNet's 36 classes and its empty, as the 12; the list stands in every loader of the format.
CLASS_OF_CODE = np.array(
    [
        *(0, 1, 2, 3, 4, 11, 5, 6, 7, 8, 8, 10, 10, 10, 11, 11, 9, 8, 11),
        *(11, 11, 11, 11, 11, 11, 11, 11, 10, 10, 11, 8, 10, 11, 9, 11, 11, 11),
    ],
    np.uint8,
)
# The first code of each class, but for objs, whose first is SSCNet's door.
CODE_OF_CLASS = np.array([0, 1, 2, 3, 4, 6, 7, 8, 9, 16, 11, 14], np.uint8)


@dataclass(frozen=True, eq=False)
class SscnetFrame:
    """The content of a ``.bin`` file, with its codes converted to the 12 classes.

    Attributes:
        labels: Class of each voxel (0 to 11 or 255), uint8 [240, 144, 240], with axes x, z (up) and
            y.
        origin_m: Minimum corner of voxel (0, 0, 0) in the world in metres, float32 [3].
        camera_to_world: Camera pose in the world, float32 [4, 4].
    """

    labels: np.ndarray  # uint8 [240, 144, 240] as x, z up, y; 0 to 11 or 255
    origin_m: np.ndarray  # float32 [3], minimum corner of voxel (0, 0, 0) in the world
    camera_to_world: np.ndarray  # float32 [4, 4]


def read_bin(path: str | Path) -> SscnetFrame:
    """Read a ``.bin`` file.

    Raises:
        InputError: If the file does not exist.
        LimitError: If the file is too large.
        DamagedFileError: If the file is not a valid SSCNet ``.bin``.
    """
    data = read_bytes(path, MAX_BYTES)
    if len(data) < HEADER_BYTES or (len(data) - HEADER_BYTES) % 8:
        raise DamagedFileError(
            path, f"not a valid SSCNet .bin: {len(data):,} bytes is not a possible file size"
        )
    head = np.frombuffer(data, "<f4", 19)
    pairs = np.frombuffer(data, "<u4", offset=HEADER_BYTES).reshape(-1, 2)
    try:
        codes = _expand_runs(pairs)
        origin_m = checks.coordinates("voxel origin", head[:3], (3,)).astype(np.float32)
        pose = checks.transform("camera pose", head[3:].reshape(4, 4), MAX_SKEW)
    except ValueError as error:
        raise DamagedFileError(path, f"not a valid SSCNet .bin: {error}") from error
    table = np.zeros(256, np.uint8)
    table[: len(CLASS_OF_CODE)], table[UNKNOWN] = CLASS_OF_CODE, UNKNOWN
    return SscnetFrame(table[codes].reshape(FINE_SHAPE), origin_m, pose.astype(np.float32))


def _expand_runs(pairs: np.ndarray) -> np.ndarray:
    """Expand runs to codes, uint8 [8294400], after checking their total length."""
    voxels, total = int(np.prod(FINE_SHAPE)), int(pairs[:, 1].sum(dtype=np.uint64))
    if total != voxels:
        raise ValueError(f"contains {total:,} voxels, expected {voxels:,}")
    values = pairs[:, 0]
    if np.any((values >= len(CLASS_OF_CODE)) & (values != UNKNOWN)):
        raise ValueError(f"contains the unknown class code {int(values[values != UNKNOWN].max())}")
    return np.repeat(values.astype(np.uint8), pairs[:, 1])


def encode_bin(labels: np.ndarray, origin_m: np.ndarray, camera_to_world: np.ndarray) -> bytes:
    """Encode an 8 cm grid as a ``.bin`` file, with 4 x 4 x 4 equal voxels for each cell.

    ``downsample_labels(read_bin(...).labels, 4)`` restores the grid exactly.

    Args:
        labels: Class of each cell (0 to 11 or 255), uint8 [60, 36, 60], with axes x, z (up) and y.
        origin_m: Minimum corner of cell (0, 0, 0) in metres [3].
        camera_to_world: Camera pose in the world [4, 4].
    """
    table = np.full(256, UNKNOWN, np.uint8)
    table[:CLASS_COUNT] = CODE_OF_CLASS
    codes = table[labels]
    for axis in (2, 1, 0):
        codes = np.repeat(codes, FINE_PER_CELL, axis=axis)
    flat = codes.reshape(-1)
    starts = np.concatenate([[0], np.flatnonzero(flat[1:] != flat[:-1]) + 1])
    counts = np.diff(np.append(starts, flat.size))
    runs = np.stack([flat[starts], counts], axis=1).astype("<u4")
    head = np.concatenate([np.ravel(origin_m), np.ravel(camera_to_world)]).astype("<f4")
    return head.tobytes() + runs.tobytes()


def downsample_labels(labels: np.ndarray, factor: int) -> np.ndarray:
    """Downsample a label grid with the rule of SSCNet's loaders.

    If more than 95 % of a cell is empty or unknown, the cell gets the more frequent of these two
    labels (unknown in case of a tie). Any other cell gets its most frequent class, or the lowest id
    in case of a tie.

    Args:
        labels: Class of each cell (0 to 11 or 255), uint8 [X, Y, Z]. The sides must be multiples of
            ``factor``.
        factor: Ratio of the cell sizes, such as 4 to make 8 cm cells from 2 cm voxels.

    Example:
        >>> fine = np.zeros((4, 4, 4), np.uint8)
        >>> fine[0, 0, :4] = 2
        >>> int(downsample_labels(fine, 4)[0, 0, 0])
        2
    """
    sides = tuple(side // factor for side in labels.shape)
    result = np.empty(sides, np.uint8)
    _count_blocks(np.ascontiguousarray(labels), factor, EMPTY_SHARE * factor**3, result)
    return result


@njit
def _count_blocks(labels, factor, sparse, result):
    counts = np.zeros(256, np.int32)
    for i, j, k in np.ndindex(result.shape):
        counts[:] = 0
        for x in range(i * factor, (i + 1) * factor):
            for y in range(j * factor, (j + 1) * factor):
                for z in range(k * factor, (k + 1) * factor):
                    counts[labels[x, y, z]] += 1
        if counts[0] + counts[255] > sparse:
            result[i, j, k] = 0 if counts[0] > counts[255] else 255
        else:
            result[i, j, k] = 1 + np.argmax(counts[1:255])
