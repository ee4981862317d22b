"""An edit as bytes and back: an NBT tree, so that block data keep their tags."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import BlockEdit, BlockEntity, Blocks, Entity
from world2minecraft.minecraft.nbt import NbtLimits, read_nbt, write_nbt

EDIT_LIMITS = NbtLimits(depth=64, values=2_000_000, bytes=256 << 20)


def pack_edit(edit: BlockEdit) -> bytes:
    """Return an edit as NBT, not compressed; the same edit gives the same bytes."""
    return write_nbt(
        {
            "kind": edit.kind,
            "reason": edit.reason,
            "class_id": -1 if edit.class_id is None else edit.class_id,
            "instance": -1 if edit.instance is None else edit.instance,
            "palette": list(edit.palette),
            "cells": np.ascontiguousarray(edit.cells.ravel(), np.int32),
            "before": _packed(edit.before),
            "after": _packed(edit.after),
        }
    )


def unpack_edit(data: bytes, path: str | Path) -> BlockEdit:
    """Return the edit that ``pack_edit`` wrote.

    Args:
        data: the bytes.
        path: the file that errors name.

    Raises:
        DamagedFileError: the bytes are no edit. LimitError: they ask for too much.
    """
    _, root = read_nbt(data, path, EDIT_LIMITS)
    try:
        return BlockEdit(
            kind=root["kind"],
            cells=np.asarray(root["cells"], np.int32).reshape(-1, 3),
            palette=tuple(map(str, root["palette"])),
            before=_unpacked(root["before"]),
            after=_unpacked(root["after"]),
            reason=str(root["reason"]),
            class_id=_number(root["class_id"]),
            instance=_number(root["instance"]),
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise DamagedFileError(path, f"holds no edit of blocks ({error})") from error


def _packed(blocks: Blocks) -> dict[str, Any]:
    return {
        "states": blocks.states.astype(np.int32),
        "semantic": blocks.semantic.view(np.int8),
        "instance": blocks.instance.astype(np.int32),
        "data": [
            {"id": e.id, "pos": np.array(e.block_pos, np.int32), "nbt": dict(e.nbt)}
            for e in blocks.block_entities
        ],
        "entities": [
            {
                "id": e.id,
                "pos": [float(value) for value in e.position],
                "class_id": int(e.class_id),
                "instance": int(e.instance),
                "nbt": dict(e.nbt),
            }
            for e in blocks.entities
        ],
    }


def _unpacked(held: Mapping[str, Any]) -> Blocks:
    return Blocks(
        states=_small(held["states"]),
        semantic=np.asarray(held["semantic"], np.int8).view(np.uint8),
        instance=_small(held["instance"]),
        block_entities=tuple(
            BlockEntity(_three(e["pos"], int), str(e["id"]), dict(e["nbt"])) for e in held["data"]
        ),
        entities=tuple(
            Entity(
                _three(e["pos"], float),
                str(e["id"]),
                dict(e["nbt"]),
                int(e["class_id"]),
                int(e["instance"]),
            )
            for e in held["entities"]
        ),
    )


def _small(values: Any) -> np.ndarray:
    numbers = np.asarray(values, np.int32)
    if numbers.size and not 0 <= numbers.min() <= numbers.max() <= 0xFFFF:
        raise ValueError("a number of it is none of a palette or an object")
    return numbers.astype(np.uint16)


def _three(values: Any, kind: Any) -> tuple[Any, Any, Any]:
    x, y, z = (kind(value) for value in values)
    return x, y, z


def _number(value: int) -> int | None:
    return None if value < 0 else int(value)
