"""A whole volume as bytes: what files that are no format of the game carry of it.

One NBT tree, packed by gzip: sides, corner, ``block_to_room``, palette, states, labels, block
entities and entities. It is read within the same bounds as every NBT file.
"""

from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, LimitError, UsageError
from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.nbt import NbtLimits, pack_gzip, read_nbt, unpack, write_nbt

MAX_CELLS = 32 << 20  # 320 blocks a side; with its labels such a volume takes 160 MB.
LIMITS = NbtLimits(bytes=6 * MAX_CELLS)
_ARRAYS = (("states", np.uint16), ("semantic", np.uint8), ("instance", np.uint16))


def pack_volume(volume: BlockVolume) -> bytes:
    """Return the bytes of a volume; the same volume gives the same bytes.

    Raises:
        UsageError: it is larger than is read back.
    """
    if volume.states.size > MAX_CELLS:
        raise UsageError(f"a .glb holds at most {MAX_CELLS:,} blocks, not {volume.states.size:,}")
    tree: dict[str, Any] = {
        "format": 1,
        "size": np.array(volume.states.shape, np.int32),
        "corner": np.array(volume.corner, np.int32),
        "block_to_room": volume.block_to_room.ravel().tolist(),
        "palette": list(volume.palette),
        "block_entities": [
            {"pos": np.array(e.block_pos, np.int32), "id": e.id, "nbt": dict(e.nbt)}
            for e in volume.block_entities
        ],
        "entities": [
            {
                "pos": [float(value) for value in e.position],
                "id": e.id,
                "nbt": dict(e.nbt),
                "class": e.class_id,
                "instance": e.instance,
            }
            for e in volume.entities
        ],
    }
    for name, kind in _ARRAYS:
        values = np.ascontiguousarray(getattr(volume, name)).astype(
            np.dtype(kind).newbyteorder("<")
        )
        tree[name] = np.frombuffer(values.tobytes(), np.int8)
    return pack_gzip(write_nbt(tree))


def unpack_volume(data: bytes, path: str | Path) -> BlockVolume:
    """Return the volume of ``pack_volume``'s bytes.

    Raises:
        DamagedFileError: they are no volume. LimitError: they ask for too much.
    """
    _, tree = read_nbt(unpack(data, path, LIMITS.bytes), path, LIMITS)
    try:
        if tree["format"] != 1:
            raise ValueError(f"its blocks are of format {tree['format']}, not 1")
        x, y, z = (int(side) for side in tree["size"])
        if min(x, y, z) < 0 or x * y * z > MAX_CELLS:
            raise LimitError(path, f"says {x} x {y} x {z} blocks; at most {MAX_CELLS:,} are read")
        east, up, south = (int(value) for value in tree["corner"])
        return BlockVolume(
            **{name: _array(tree[name], kind, (x, y, z)) for name, kind in _ARRAYS},
            palette=tuple(str(state) for state in tree["palette"]),
            corner=(east, up, south),
            block_to_room=np.array(tree["block_to_room"], np.float64).reshape(4, 4),
            block_entities=tuple(map(_block_entity, tree["block_entities"])),
            entities=tuple(map(_entity, tree["entities"])),
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise DamagedFileError(path, f"holds no volume of blocks ({error})") from error


def _array(raw: np.ndarray, kind: type, shape: tuple[int, int, int]) -> np.ndarray:
    return raw.view(np.dtype(kind).newbyteorder("<")).reshape(shape).astype(kind, copy=False)


def _block_entity(row: dict[str, Any]) -> BlockEntity:
    x, y, z = (int(value) for value in row["pos"])
    return BlockEntity((x, y, z), str(row["id"]), dict(row["nbt"]))


def _entity(row: dict[str, Any]) -> Entity:
    x, y, z = (float(value) for value in row["pos"])
    return Entity(
        (x, y, z), str(row["id"]), dict(row["nbt"]), int(row["class"]), int(row["instance"])
    )
