"""Binary messages with one array of a scene for the page, ``W2MV``.

``W2MV``: magic, u16 version, u8 dtype (0 u8, 1 u16), u8 flags, 3 x u32 cells along x, y, z, f32
cell size in metres, 3 x f32 minimum corner in metres, u32 number of labels; then the values in C
order, all little-endian. Flag 1 means that each cell has three bytes, its colour.
"""

import struct
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.editing.scene import SceneDraft

MAGIC, VERSION = b"W2MV", 1
HEADER = struct.Struct("<4sHBB3If3fI")
DTYPE_U8, DTYPE_U16 = 0, 1
FLAG_RGB = 1
VOLUMES = ("labels", "instance", "confidence", "colour")


@dataclass(frozen=True, eq=False)
class Volume:
    """A copy of one array of a scene, with the fields of its ``W2MV`` header."""

    values: np.ndarray  # [X, Y, Z], or [X, Y, Z, 3] of a colour
    voxel_m: float
    origin_m: np.ndarray  # float64 [3]

    def as_bytes(self) -> bytes:
        """Return the array as a ``W2MV`` message, with confidence scaled to 0 to 255."""
        is_share = self.values.dtype == np.float16
        values = confidence_bytes(self.values) if is_share else self.values
        kind = DTYPE_U16 if values.dtype == np.uint16 else DTYPE_U8
        flags = FLAG_RGB if values.ndim == 4 else 0
        place = (*values.shape[:3], self.voxel_m, *map(float, self.origin_m))
        head = HEADER.pack(MAGIC, VERSION, kind, flags, *place, CLASS_COUNT)
        return head + values.astype(values.dtype.newbyteorder("<"), copy=False).tobytes()


def copy_volume(draft: SceneDraft, what: str) -> Volume:
    """Return a copy of the array named ``what``: labels, instance, confidence or colour.

    Raises:
        UnknownNameError: If the scene has no array of this name.
    """
    if what not in VOLUMES:
        raise UnknownNameError("volume", what, VOLUMES)
    return Volume(getattr(draft, what).copy(), draft.voxel_m, draft.origin_m)


def labels_bytes(draft: SceneDraft, labels: np.ndarray) -> bytes:
    """Return labels uint8 [X, Y, Z] in a scene's cells as a ``W2MV`` message."""
    return Volume(labels, draft.voxel_m, draft.origin_m).as_bytes()


def confidence_bytes(confidence: np.ndarray) -> np.ndarray:
    """Return confidence values 0 to 1 as uint8 0 to 255 of the same shape."""
    return np.round(confidence.astype(np.float32) * 255).astype(np.uint8)
