"""Crop volumes to the blocks in a box, or remove the air around the blocks."""

from dataclasses import replace

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume

Box = tuple[int, int, int, int, int, int]


def crop_volume(volume: BlockVolume, box: Box) -> BlockVolume:
    """Return the blocks and entities of a volume inside a box of world coordinates.

    Args:
        volume: Blocks to crop.
        box: Box x0 y0 z0 x1 y1 z1 in blocks, with exclusive upper bounds.

    Raises:
        UsageError: If the box does not overlap the volume.
    """
    corner = np.array(volume.corner)
    low = np.clip(np.array(box[:3]) - corner, 0, volume.states.shape)
    high = np.maximum(np.clip(np.array(box[3:]) - corner, 0, volume.states.shape), low)
    if (high == low).any():
        size = " x ".join(str(side) for side in volume.states.shape)
        at = ",".join(str(value) for value in volume.corner)
        raise UsageError(f"the box does not overlap the build, which is {size} blocks from {at}")
    cut = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    x, y, z = (int(value) for value in corner + low)
    first, last = corner + low, corner + high
    return replace(
        volume,
        states=volume.states[cut],
        semantic=volume.semantic[cut],
        instance=volume.instance[cut],
        corner=(x, y, z),
        block_entities=tuple(
            one
            for one in volume.block_entities
            if (first <= one.block_pos).all() and (one.block_pos < last).all()
        ),
        entities=tuple(
            one
            for one in volume.entities
            if (first <= one.position).all() and (one.position < last).all()
        ),
    )


def trim_air(volume: BlockVolume) -> BlockVolume:
    """Return the volume without the layers of air around its blocks, keeping all entities."""
    filled = volume.states != 0
    if not filled.any():
        return volume
    cuts = []
    for axis in range(3):
        used = np.flatnonzero(filled.any(axis=tuple({0, 1, 2} - {axis})))
        cuts.append(slice(int(used[0]), int(used[-1]) + 1))
    cut = tuple(cuts)
    x, y, z = (low + part.start for low, part in zip(volume.corner, cut, strict=True))
    return replace(
        volume,
        states=np.ascontiguousarray(volume.states[cut]),
        semantic=np.ascontiguousarray(volume.semantic[cut]),
        instance=np.ascontiguousarray(volume.instance[cut]),
        corner=(x, y, z),
    )
