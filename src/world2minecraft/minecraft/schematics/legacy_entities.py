"""Block entities and entities as they were before 1.13, as those of today."""

import re
from collections.abc import Mapping
from typing import Any

from world2minecraft.core.types import BlockEntity, Entity
from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.rules.attached_entities import attached
from world2minecraft.minecraft.sign_texts import sign_of_today

Corner = tuple[int, int, int]
COLOURS = (
    *("white", "orange", "magenta", "light_blue", "yellow", "lime", "pink", "gray"),
    *("light_gray", "cyan", "purple", "blue", "brown", "green", "red", "black"),
)
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


def block_entity_of(nbt: Mapping[str, Any], corner: Corner) -> BlockEntity:
    """Return a block entity of today, at its place in the world; its id is empty if there is none.

    Raises:
        KeyError, TypeError, ValueError: it lacks its name or its place.
    """
    x, y, z = (int(nbt[axis]) + low for axis, low in zip("xyz", corner, strict=True))
    rest = {key: nbt[key] for key in nbt if key not in ("id", "x", "y", "z")}
    name = _name(str(nbt["id"]))
    if name == "minecraft:sign":
        rest = sign_of_today(rest)
    is_left_out = name.removeprefix("minecraft:") in WITHOUT_ENTITY
    return BlockEntity((x, y, z), "" if is_left_out else name, rest)


def entity_of(nbt: Mapping[str, Any], corner: Corner) -> Entity:
    """Return an entity of today, at its place in the world.

    Raises:
        KeyError, TypeError, ValueError: it lacks its name or its place.
    """
    x, y, z = (float(value) + low for value, low in zip(nbt["Pos"], corner, strict=True))
    rest = attached(nbt, (x, y, z), corner)
    rest = {key: rest[key] for key in rest if key not in ("id", "Pos")}
    return Entity((x, y, z), _name(str(nbt["id"])), rest)


def state_with(text: str, entity: BlockEntity) -> str:
    """Return a block's state with what its block entity said before 1.13.

    Example:
        >>> bed = BlockEntity((0, 0, 0), "minecraft:bed", {"color": 3})
        >>> state_with("minecraft:red_bed[part=foot]", bed)
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
    return COLOURS[_whole(value, default) % len(COLOURS)]


def _whole(value: Any, default: int) -> int:
    return int(value) if isinstance(value, int) else default


def _name(name: str) -> str:
    """Return the name of today: until 1.10 they were like ``EnderChest``."""
    if ":" in name:
        return name
    lowered = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
    return f"minecraft:{RENAMED.get(lowered, lowered)}"
