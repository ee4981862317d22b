"""Rotation and mirroring of block states and volumes.

A quarter turn is counter-clockwise seen from above: east becomes north, north becomes west, west
becomes south. Block axes are x east, y up, z south. The rules depend on properties and not on block
names, so they also apply to mods that use the game's property names.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any, Literal

import numpy as np

from world2minecraft.core.types import BlockEntity, BlockVolume, Entity
from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.nbt import Byte, Float
from world2minecraft.minecraft.rules.attached_entities import name_attached_block, named_block

Properties = dict[str, str]
SIDES = ("east", "north", "west", "south")  # Counter-clockwise.
_LEFT_RIGHT = {
    "left": "right",
    "right": "left",
    "inner_left": "inner_right",
    "inner_right": "inner_left",
    "outer_left": "outer_right",
    "outer_right": "outer_left",
}
# The game numbers the six sides from below: 2 north, 3 south, 4 west, 5 east. Paintings count four,
# clockwise from the south.
_TURNED_SIDES = {5: 2, 2: 4, 4: 3, 3: 5}
_SLOTS = {"slot_0": "slot_2", "slot_2": "slot_0", "slot_3": "slot_5", "slot_5": "slot_3"}


@lru_cache(maxsize=1 << 16)
def turn_state(state: str, quarter_turns: int) -> str:
    """Rotate a block state by quarter turns counter-clockwise seen from above.

    Args:
        state: Text of the block state. Mod blocks follow the same rules.
        quarter_turns: Number of quarter turns. Negative turns are clockwise.

    Raises:
        UsageError: If the text is not a valid block state.

    Example:
        >>> turn_state("minecraft:oak_stairs[facing=east,half=bottom]", 1)
        'minecraft:oak_stairs[facing=north,half=bottom]'
    """
    turns = quarter_turns % 4
    sides = {side: SIDES[(index + turns) % 4] for index, side in enumerate(SIDES)}
    parsed = parse_state(state)
    moved = _move_sides(dict(parsed.properties), sides)
    if turns % 2 and moved.get("axis") in ("x", "z"):
        moved["axis"] = "z" if moved["axis"] == "x" else "x"
    _change_rotation(moved, lambda sixteenths: sixteenths - 4 * turns)
    return str(BlockState(parsed.name, moved))


@lru_cache(maxsize=1 << 16)
def mirror_state(state: str, axis: Literal["x", "z"]) -> str:
    """Mirror a block state along one block axis. The axis x swaps east and west.

    Raises:
        UsageError: If the text is not a valid block state.

    Example:
        >>> mirror_state("minecraft:oak_door[facing=east,hinge=left]", "x")
        'minecraft:oak_door[facing=west,hinge=right]'
    """
    swap = {"x": ("east", "west"), "z": ("north", "south")}[axis]
    sides = {side: side for side in SIDES} | {swap[0]: swap[1], swap[1]: swap[0]}
    parsed = parse_state(state)
    moved = _move_sides(dict(parsed.properties), sides)
    for key in ("hinge", "type", "shape"):
        if key in moved:
            moved[key] = _LEFT_RIGHT.get(moved[key], moved[key])
    moved = {_mirror_slot(key): value for key, value in moved.items()}
    half = 16 if axis == "x" else 8
    _change_rotation(moved, lambda sixteenths: half - sixteenths)
    return str(BlockState(parsed.name, moved))


def turn_volume(volume: BlockVolume, quarter_turns: int) -> BlockVolume:
    """Rotate a volume by quarter turns counter-clockwise, keeping its minimum corner.

    Block entities, entities and ``block_to_room`` are rotated too, so that every block keeps its
    position in the room.
    """
    turned = volume
    for _ in range(quarter_turns % 4):
        turned = _turn_once(turned)
    return turned


def _move_sides(properties: Properties, sides: dict[str, str]) -> Properties:
    """Rename sides in property keys, values and parts of values."""
    moved = {sides.get(key, key): value for key, value in properties.items()}
    for key in ("facing", "orientation", "shape"):
        if key in moved:
            words = [sides.get(word, word) for word in moved[key].split("_")]
            moved[key] = "_".join(_rail_order(words) if key == "shape" else words)
    return moved


def _rail_order(words: list[str]) -> list[str]:
    """Sort the two ends of a rail: north or south first, or east first if it is straight."""
    if len(words) != 2 or not set(words) <= set(SIDES):
        return words
    order = ("north", "south", "east", "west")
    return sorted(words, key=order.index)


def _mirror_slot(key: str) -> str:
    """Mirror a slot name of a chiseled bookshelf, which has two rows of three slots."""
    return key.replace(key[:6], _SLOTS.get(key[:6], key[:6]), 1)


def _change_rotation(properties: Properties, change: Callable[[int], int]) -> None:
    """Change the rotation of a standing sign, which is in sixteenths clockwise from south."""
    value = properties.get("rotation", "")
    if value.isdecimal():
        properties["rotation"] = str(change(int(value)) % 16)


def _turn_once(volume: BlockVolume) -> BlockVolume:
    old_to_new = _quarter_turn(volume)
    corner = np.array(volume.corner)

    def turned_grid(values: np.ndarray) -> np.ndarray:
        return np.ascontiguousarray(np.rot90(values, 1, axes=(2, 0)))

    def cell_of(block_pos: tuple[int, int, int]) -> tuple[int, int, int]:
        center = old_to_new @ [*(np.array(block_pos) + 0.5), 1.0]
        x, y, z = np.floor(center[:3]).astype(int).tolist()
        return x, y, z

    def turned_block(entity: BlockEntity) -> BlockEntity:
        return replace(entity, block_pos=cell_of(entity.block_pos))

    def turned_entity(entity: Entity) -> Entity:
        """Return an entity at its new position, with its NBT turned and its block moved."""
        x, y, z = (old_to_new @ [*entity.position, 1.0])[:3].tolist()
        nbt = _turn_nbt(dict(entity.nbt), entity.id)
        held = named_block(nbt)
        return replace(
            entity,
            position=(x, y, z),
            nbt=nbt if held is None else name_attached_block(nbt, cell_of(held)),
        )

    return replace(
        volume,
        states=turned_grid(volume.states),
        palette=tuple(turn_state(state, 1) for state in volume.palette),
        semantic=turned_grid(volume.semantic),
        instance=turned_grid(volume.instance),
        corner=tuple(corner.tolist()),
        block_to_room=volume.block_to_room @ np.linalg.inv(old_to_new),
        block_entities=tuple(map(turned_block, volume.block_entities)),
        entities=tuple(map(turned_entity, volume.entities)),
    )


def _quarter_turn(volume: BlockVolume) -> np.ndarray:
    """Return the 4x4 transform from old to new block coordinates, x' = z and z' = X - x."""
    x, _, z = volume.corner
    transform = np.eye(4)
    transform[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    transform[:3, 3] = [x - z, 0, z + x + volume.states.shape[0]]
    return transform


def _turn_nbt(nbt: dict[str, Any], kind: str) -> dict[str, Any]:
    """Rotate the yaw and the facing in an entity's NBT by a quarter turn."""
    rotation = nbt.get("Rotation", [Float(0), Float(0)])  # Without one it looks south.
    if isinstance(rotation, list) and len(rotation) == 2:
        yaw = type(rotation[0])((float(rotation[0]) - 90.0 + 180.0) % 360.0 - 180.0)
        nbt["Rotation"] = [yaw, rotation[1]]
    for key in ("Facing", "facing"):
        side = nbt.get(key)
        if isinstance(side, int):
            flat = kind.endswith("painting")
            turned = (side - 1) % 4 if flat else _TURNED_SIDES.get(int(side), int(side))
            nbt[key] = Byte(turned)
    return nbt
