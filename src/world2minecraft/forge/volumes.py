"""One array of a scene as bytes for the page: ``W2MV``.

Magic, u16 version, u8 dtype (0 u8, 1 u16), u8 flags, 3 x u32 cells along x, y, z, f32 cell size
in metres, 3 x f32 minimum corner in metres, u32 number of labels; then the values in C order, all
little-endian. Flag 1 says that each cell has three bytes, its colour.
"""

import struct

import numpy as np

from world2minecraft.classes import CLASS_COUNT
from world2minecraft.edit.scene import SceneDraft
from world2minecraft.errors import UnknownNameError

MAGIC, VERSION = b"W2MV", 1
HEADER = struct.Struct("<4sHBB3If3fI")
U8, U16 = 0, 1
THREE_A_CELL = 1
VOLUMES = ("labels", "instance", "confidence", "colour")


def volume_bytes(draft: SceneDraft, what: str) -> bytes:
    """Return the array named ``what``: labels, instance, confidence (0 to 255) or colour.

    Raises:
        UnknownNameError: there is no array of that name.
    """
    if what not in VOLUMES:
        raise UnknownNameError("volume", what, VOLUMES)
    values = as_bytes(draft.confidence) if what == "confidence" else getattr(draft, what)
    return _packed(draft, values, THREE_A_CELL if what == "colour" else 0)


def labels_bytes(draft: SceneDraft, labels: np.ndarray) -> bytes:
    """Return labels uint8 [X, Y, Z] that lie on a scene's cells."""
    return _packed(draft, labels, 0)


def _packed(draft: SceneDraft, values: np.ndarray, flags: int) -> bytes:
    kind = U16 if values.dtype == np.uint16 else U8
    corner = (float(value) for value in draft.origin_m)
    head = (MAGIC, VERSION, kind, flags, *draft.shape, draft.voxel_m, *corner, CLASS_COUNT)
    return HEADER.pack(*head) + values.astype(values.dtype.newbyteorder("<"), copy=False).tobytes()


def as_bytes(confidence: np.ndarray) -> np.ndarray:
    """Return confidence, 0 to 1, as uint8 of the same shape, 0 to 255."""
    return np.round(confidence.astype(np.float32) * 255).astype(np.uint8)
