"""Upgrades of blocks, block entities and entities from before 1.13 ("the flattening").

Blocks had numeric IDs and data values, and block entities stored some properties that are now in
the block state. In blocks of two parts, each part stored only some properties: the lower half of a
door stored its direction and whether it is open, and the upper half stored its hinge. Only the
lower half of a tall plant stored its kind. Two adjacent chests formed a double chest.
"""

import re
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from world2minecraft.core.types import BlockEntity, Entity
from world2minecraft.minecraft.block_colours import DYES
from world2minecraft.minecraft.block_renames import read_state
from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.data_files import read_data
from world2minecraft.minecraft.rules.attached_entities import move_attachment
from world2minecraft.minecraft.signs import upgrade_sign

HEADS = ("skeleton", "wither_skeleton", "zombie", "player", "creeper", "dragon")
FLOWERS = (
    *("poppy", "blue_orchid", "allium", "azure_bluet", "red_tulip", "orange_tulip"),
    *("white_tulip", "pink_tulip", "oxeye_daisy"),
)
SAPLINGS = ("oak", "spruce", "birch", "jungle", "acacia", "dark_oak")
# What stood in a flower pot, by its item's name or number; by data value where it had several.
POTTED: dict[str, tuple[str, ...]] = {
    "red_flower": FLOWERS,
    "yellow_flower": ("dandelion",),
    "sapling": tuple(f"{wood}_sapling" for wood in SAPLINGS),
    "red_mushroom": ("red_mushroom",),
    "brown_mushroom": ("brown_mushroom",),
    "cactus": ("cactus",),
    "deadbush": ("dead_bush",),
    "tallgrass": ("dead_bush", "fern", "fern"),
}
POTTED_NUMBERS = {
    **{37: "yellow_flower", 38: "red_flower", 6: "sapling", 39: "brown_mushroom"},
    **{40: "red_mushroom", 81: "cactus", 31: "tallgrass", 32: "deadbush"},
}
# Names of block entities until 1.10 that are not the block's own name in other letters.
RENAMED = {
    "record_player": "jukebox",
    "trap": "dispenser",
    "enchant_table": "enchanting_table",
    "cauldron": "brewing_stand",
    "airportal": "end_portal",
    "control": "command_block",
    "dldetector": "daylight_detector",
    "structure": "structure_block",
}
WITHOUT_ENTITY = ("flower_pot", "music", "noteblock")  # Since 1.13 their state says it all.
_PLANTS = ("sunflower", "lilac", "tall_grass", "large_fern", "rose_bush", "peony")
PLANTS = tuple(f"minecraft:{name}" for name in _PLANTS)
CHESTS = ("minecraft:chest", "minecraft:trapped_chest")
# Where the right half of a chest stands, seen from its left half: steps along x and z.
RIGHT_HALF = {"north": (1, 0), "east": (0, 1), "south": (-1, 0), "west": (0, -1)}
FLATTENING = 1519  # 1.13: the table's states are named as that game names them.
_MOD_NAME = re.compile(r"[a-z0-9_.-]+:[a-z0-9_./-]+")


Corner = tuple[int, int, int]


def upgrade_block_entity(nbt: Mapping[str, Any], corner: Corner) -> BlockEntity:
    """Convert a legacy block entity to the current form, at its world position.

    The ID is empty if the block no longer has a block entity.

    Raises:
        KeyError, TypeError, ValueError: If the name or position is missing or invalid.
    """
    x, y, z = (int(nbt[axis]) + low for axis, low in zip("xyz", corner, strict=True))
    rest = {key: nbt[key] for key in nbt if key not in ("id", "x", "y", "z")}
    name = _name(str(nbt["id"]))
    if name == "minecraft:sign":
        rest = upgrade_sign(rest)
    is_left_out = name.removeprefix("minecraft:") in WITHOUT_ENTITY
    return BlockEntity((x, y, z), "" if is_left_out else name, rest)


def upgrade_entity(nbt: Mapping[str, Any], corner: Corner) -> Entity:
    """Convert a legacy entity to the current form, at its world position.

    Raises:
        KeyError, TypeError, ValueError: If the name or position is missing or invalid.
    """
    x, y, z = (float(value) + low for value, low in zip(nbt["Pos"], corner, strict=True))
    rest = move_attachment(nbt, (x, y, z), corner)
    rest = {key: rest[key] for key in rest if key not in ("id", "Pos")}
    return Entity((x, y, z), _name(str(nbt["id"])), rest)


def apply_block_entity(text: str, entity: BlockEntity) -> str:
    """Add the properties that a legacy block entity stored to a block state.

    Example:
        >>> bed = BlockEntity((0, 0, 0), "minecraft:bed", {"color": 3})
        >>> apply_block_entity("minecraft:red_bed[part=foot]", bed)
        'minecraft:light_blue_bed[part=foot]'
    """
    state, nbt = parse_state(text), entity.nbt
    kind = state.name.removeprefix("minecraft:")
    if kind.endswith("_bed"):
        return _named(state, f"{_colour(nbt.get('color'), 14)}_bed")
    if kind.endswith("_banner"):
        end = "wall_banner" if "wall" in kind else "banner"
        return _named(state, f"{_colour(15 - _whole(nbt.get('Base'), 15), 0)}_{end}")
    if kind.startswith(("skeleton_skull", "skeleton_wall_skull")):
        return _head(state, nbt)
    if kind == "flower_pot":
        return _named(state, _pot(nbt))
    return text


def _head(state: BlockState, nbt: Mapping[str, Any]) -> str:
    kind = HEADS[_whole(nbt.get("SkullType"), 0) % len(HEADS)]
    end = "skull" if kind.endswith("skeleton") else "head"
    if state.get("facing"):
        return _named(state, f"{kind}_wall_{end}")
    return _named(state.having(rotation=str(_whole(nbt.get("Rot"), 0) % 16)), f"{kind}_{end}")


def _pot(nbt: Mapping[str, Any]) -> str:
    item = nbt.get("Item", 0)
    name = POTTED_NUMBERS.get(item) if isinstance(item, int) else str(item).split(":")[-1]
    plants = POTTED.get(name or "", ())
    value = _whole(nbt.get("Data"), 0)
    return f"potted_{plants[min(max(value, 0), len(plants) - 1)]}" if plants else "flower_pot"


def _named(state: BlockState, name: str) -> str:
    return str(BlockState(f"minecraft:{name}", state.properties))


def _colour(value: Any, default: int) -> str:
    return DYES[_whole(value, default) % len(DYES)]


def _whole(value: Any, default: int) -> int:
    return int(value) if isinstance(value, int) else default


def _name(name: str) -> str:
    """Return the current name of a block entity. Until 1.10, names were like ``EnderChest``."""
    if ":" in name:
        return name
    lowered = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
    return f"minecraft:{RENAMED.get(lowered, lowered)}"


Palette = tuple[str, ...]
Pair = tuple[BlockState, BlockState]


def join_halves(states: np.ndarray, palette: Palette) -> tuple[np.ndarray, Palette]:
    """Complete the properties of doors, tall plants and double chests from their other halves.

    Args:
        states: Palette indices, uint16 [X, Y, Z] in block axes, modified in place.
        palette: The block states of the palette.

    Returns:
        The states and the extended palette.
    """
    growing = list(palette)
    parsed = [parse_state(text) for text in palette]
    _join(states, growing, _are(parsed, _is_door, "lower"), _are(parsed, _is_door, "upper"), _door)
    _join(
        states, growing, _are(parsed, _is_plant, "lower"), _are(parsed, _is_plant, "upper"), _plant
    )
    _join_chests(states, growing, parsed)
    return states, tuple(growing)


def _is_door(state: BlockState) -> bool:
    return state.name.endswith("_door")


def _is_plant(state: BlockState) -> bool:
    return state.name in PLANTS


def _are(parsed: list[BlockState], kind: Callable[[BlockState], bool], half: str) -> np.ndarray:
    return np.array([kind(state) and state.get("half") == half for state in parsed])


def _door(lower: BlockState, upper: BlockState) -> Pair:
    own = {"hinge": upper.get("hinge"), "powered": upper.get("powered")}
    lower = lower.having(**own)
    return lower, lower.having(half="upper")


def _plant(lower: BlockState, upper: BlockState) -> Pair:
    return lower, lower.having(half="upper")


def _join(
    states: np.ndarray,
    palette: list[str],
    is_lower: np.ndarray,
    is_upper: np.ndarray,
    join: Callable[[BlockState, BlockState], Pair],
) -> None:
    """Replace each lower half below an upper half, and the upper half."""
    if not (is_lower.any() and is_upper.any()):
        return
    known = len(is_lower)  # States that were added since are finished.
    numbers = np.minimum(states, known - 1)
    is_pair = (is_lower[numbers] & (states < known))[:, :-1] & is_upper[numbers][:, 1:]
    x, y, z = np.nonzero(is_pair)
    if not len(x):
        return
    both = states[x, y, z].astype(np.int64) << 16 | states[x, y + 1, z]
    kinds, which = np.unique(both, return_inverse=True)
    found = []
    for kind in kinds.tolist():
        parts = join(parse_state(palette[kind >> 16]), parse_state(palette[kind & 0xFFFF]))
        found.append([_number(palette, str(part)) for part in parts])
    new = np.array(found, np.uint16)[which.ravel()]
    states[x, y, z], states[x, y + 1, z] = new[:, 0], new[:, 1]


def _join_chests(states: np.ndarray, palette: list[str], parsed: list[BlockState]) -> None:
    for number, state in enumerate(parsed):
        if state.name not in CHESTS or state.get("type") != "single":
            continue
        step_x, step_z = RIGHT_HALF[state.get("facing")]
        right = _number(palette, str(state.having(type="right")))
        left = _number(palette, str(state.having(type="left")))
        cells = {tuple(cell) for cell in np.argwhere(states == number).tolist()}
        for x, y, z in sorted(cells):
            other = (x + step_x, y, z + step_z)
            if (x, y, z) in cells and other in cells:
                states[x, y, z], states[other] = left, right
                cells -= {(x, y, z), other}


def _number(palette: list[str], text: str) -> int:
    if text not in palette:
        palette.append(text)
    return palette.index(text)


def legacy_state(number: int, value: int, names: Mapping[int, str]) -> tuple[str, bool]:
    """Return the state of a legacy block, and whether vanilla games had the block.

    Args:
        number: The block ID, 0 to 4095.
        value: The data value, 0 to 15. A value that the block did not use gives its first state.
        names: The names that the file defines for IDs. IDs of mod blocks vary between files.

    Example:
        >>> legacy_state(5, 1, {})
        ('minecraft:spruce_planks', True)
        >>> legacy_state(900, 2, {900: "Shop:Shelf"}), legacy_state(901, 0, {})
        (('shop:shelf[data=2]', False), ('legacy:901_0', False))
    """
    states = _table().get(number)
    if states is not None:
        return states[value], True
    name = names.get(number, "").lower()
    if not _MOD_NAME.fullmatch(name) or name.startswith("minecraft:"):
        return f"legacy:{number}_{value}", False
    return (f"{name}[data={value}]" if value else name), False


@cache
def _table() -> dict[int, tuple[str, ...]]:
    blocks = read_data("legacy_blocks.json")["blocks"]
    return {int(key): _states_by_value(states) for key, states in blocks.items()}


def _states_by_value(states: list[str | None]) -> tuple[str, ...]:
    first = next(state for state in states if state is not None)
    every = [state or first for state in states] + [first] * (16 - len(states))
    return tuple(_modern_state(f"minecraft:{state}") for state in every)


def _modern_state(text: str) -> str:
    state = parse_state(read_state(str(parse_state(text)), FLATTENING))
    if state.name.endswith("_stairs"):  # The table has the last of the shapes, not the first.
        state = state.having(shape="straight")
    if state.name.endswith("_trapdoor"):  # It has open ones as powered, which their value is not.
        state = state.having(powered="false")
    return str(complete(state))
