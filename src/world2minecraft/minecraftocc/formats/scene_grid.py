"""The grid of a whole scene that the boxes of its frames lie in."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import cell_centers_m
from world2minecraft.core.errors import LimitError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.formats.boxes import LabelledBox, box_in_image
from world2minecraft.minecraftocc.formats.cameras import HALF_PX, HEIGHT_PX, WIDTH_PX
from world2minecraft.minecraftocc.formats.unpickling import read_pickle
from world2minecraft.minecraftocc.values import USUAL_SHAPE

MAX_CELLS = 100_000_000  # A hall of 64 x 64 x 12 m; its package would take 1.4 GB.


@dataclass(frozen=True, eq=False)
class SceneGrid:
    """Cells along the room's axes, in step with the first box; others lie to the nearest cell."""

    shape: tuple[int, int, int]
    origin_m: np.ndarray  # float64 [3]
    voxel_m: float

    @classmethod
    def around(cls, origins_m: Sequence[np.ndarray], voxel_m: float) -> "SceneGrid":
        """Return the smallest grid that holds usual boxes with these minimum corners.

        Raises:
            LimitError: it would be larger than any home.
        """
        steps = np.array([np.round((at - origins_m[0]) / voxel_m) for at in origins_m])
        low, high = steps.min(axis=0), steps.max(axis=0) + USUAL_SHAPE
        sides = (high - low).astype(np.int64)
        if np.prod(sides.astype(np.float64)) > MAX_CELLS:
            raise LimitError("scene", f"its frames span {sides.tolist()} cells; too far apart")
        shape = (int(sides[0]), int(sides[1]), int(sides[2]))
        return cls(shape, origins_m[0] + low * voxel_m, voxel_m)

    def slices(self, origin_m: np.ndarray) -> tuple[slice, ...]:
        """Return where the box with this minimum corner lies."""
        first = np.round((origin_m - self.origin_m) / self.voxel_m).astype(int)
        return tuple(slice(at, at + side) for at, side in zip(first, USUAL_SHAPE, strict=True))

    def centers_m(self) -> np.ndarray:
        """Return the centres of all cells in the room, float64 [X, Y, Z, 3]."""
        return cell_centers_m(
            np.moveaxis(np.indices(self.shape), 0, -1), self.origin_m, self.voxel_m
        )


@dataclass(frozen=True, eq=False)
class StoredFrame:
    """A frame of OccScanNet as scenes are made of it."""

    labels: np.ndarray  # uint8 [60, 60, 36] as x, y, z
    origin_m: np.ndarray
    in_image: np.ndarray  # bool [60, 60, 36]


def stored_frame(path: Path) -> StoredFrame:
    """Read the box of a frame that was written as 640x480. Raises what ``read_pickle`` raises."""
    found: dict[str, Any] = read_pickle(path)
    matrix = np.asarray(found["intrinsic"], np.float64)
    camera = Camera(
        WIDTH_PX,
        HEIGHT_PX,
        matrix[0, 0],
        matrix[1, 1],
        matrix[0, 2] + HALF_PX,
        matrix[1, 2] + HALF_PX,
    )
    labels = np.ascontiguousarray(found["target_1_4"].transpose(1, 0, 2))
    box = LabelledBox(labels, np.asarray(found["voxel_origin"]), np.asarray(found["cam_pose"]))
    return StoredFrame(labels, box.origin_m, box_in_image(box, camera))
