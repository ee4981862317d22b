"""Conversion of block entity and entity data between game versions.

Sign texts, item stacks, and the block that a painting or item frame hangs on are converted.

Up to 1.20.4 an item stack is ``{id, Count, tag}``, and since 1.20.5 ``{id, count, components}``. A
game that reads the other form loses the stack or its count. A volume keeps item stacks in the form
of their file, and writers convert them to the form of the target game. ``tag`` and ``components``
(names, enchantments, wear) cannot be converted in general, so they are dropped and counted as
losses.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.nbt import Byte
from world2minecraft.minecraft.rules.attached_entities import (
    TILE,
    name_attached_block,
    named_block,
)
from world2minecraft.minecraft.signs import convert_sign

FIRST_COMPONENTS = 3837  # 1.20.5.
OLD, NEW = ("Count", "tag"), ("count", "components")
FIRST_BLOCK_POS = 4325  # 1.21.5, since which ``block_pos`` holds what ``TileX`` to ``TileZ`` held.
MAX_OLD_COUNT = 127  # The maximum of a signed byte.


def convert_volume(volume: BlockVolume, data_version: int) -> BlockVolume:
    """Convert the block entities and entities of a volume to the form of a game version."""
    if not (volume.block_entities or volume.entities):
        return volume
    blocks = tuple(convert_block_entity(entity, data_version) for entity in volume.block_entities)
    entities = tuple(convert_entity(entity, data_version) for entity in volume.entities)
    pairs = zip((*blocks, *entities), (*volume.block_entities, *volume.entities), strict=True)
    if all(ours is theirs for ours, theirs in pairs):
        return volume
    return replace(volume, block_entities=blocks, entities=entities)


def convert_block_entity(entity: BlockEntity, data_version: int) -> BlockEntity:
    """Convert the data of a block entity to the form of a game version."""
    entity = convert_sign(entity, data_version)
    if not any(_item_stacks(entity.nbt, data_version)):
        return entity
    return replace(entity, nbt=_convert(entity.nbt, data_version))


def convert_entity(entity: Entity, data_version: int) -> Entity:
    """Convert the data of an entity to the form of a game version."""
    if any(_item_stacks(entity.nbt, data_version)):
        entity = replace(entity, nbt=_convert(entity.nbt, data_version))
    block = named_block(entity.nbt)
    if block is None or ("block_pos" in entity.nbt) == (data_version >= FIRST_BLOCK_POS):
        return entity
    kept = {key: held for key, held in entity.nbt.items() if key not in (*TILE, "block_pos")}
    form = {"block_pos": ()} if data_version >= FIRST_BLOCK_POS else {}
    return replace(entity, nbt=name_attached_block({**kept, **form}, block))


def count_lost_data(volume: BlockVolume, data_version: int, losses: Losses) -> None:
    """Count the item stacks that keep only their kind and count in the form of a game version."""
    _, extra = OLD if data_version >= FIRST_COMPONENTS else NEW
    for entity in (*volume.block_entities, *volume.entities):
        lost = sum(bool(stack.get(extra)) for stack in _item_stacks(entity.nbt, data_version))
        losses.add("names, enchantments and other data of item stacks", lost)


def _item_stacks(value: Any, data_version: int) -> Iterator[Mapping[str, Any]]:
    """Yield the item stacks that are not in the form of a game version."""
    if isinstance(value, Mapping):
        if _is_other(value, data_version):
            yield value
            return
        value = list(value.values())
    for held in value if isinstance(value, list) else ():
        if isinstance(held, list | Mapping):
            yield from _item_stacks(held, data_version)


def _is_other(value: Mapping[str, Any], data_version: int) -> bool:
    theirs, ours = (OLD[0], NEW[0]) if data_version >= FIRST_COMPONENTS else (NEW[0], OLD[0])
    is_stack = isinstance(value.get("id"), str) and isinstance(value.get(theirs), int)
    return is_stack and ours not in value


def _convert(value: Any, data_version: int) -> Any:
    if isinstance(value, list):
        return [_convert(held, data_version) for held in value]
    if not isinstance(value, Mapping):
        return value
    if not _is_other(value, data_version):
        return {key: _convert(held, data_version) for key, held in value.items()}
    if data_version >= FIRST_COMPONENTS:
        plain = {key: held for key, held in value.items() if key not in OLD}
        return {**plain, NEW[0]: int(value[OLD[0]])}
    plain = {key: held for key, held in value.items() if key not in NEW}
    return {**plain, OLD[0]: Byte(max(0, min(value[NEW[0]], MAX_OLD_COUNT)))}
