"""Conversion of block entities between Bedrock Edition and Java Edition.

Java Edition encodes the colour of a bed or banner, the plant in a pot and the kind of a head in the
block name; Bedrock Edition stores them in block entities. Java Edition stores sign text as JSON
lines, Bedrock Edition as a single string.
"""

import json
from collections.abc import Mapping
from typing import Any

from world2minecraft.minecraft.bedrock.states import bedrock_table, bedrock_to_java, java_to_bedrock
from world2minecraft.minecraft.block_colours import DYES
from world2minecraft.minecraft.block_states import BlockState, known_blocks, parse_state
from world2minecraft.minecraft.nbt import Byte, Float

HEADS = ("skeleton", "wither_skeleton", "zombie", "player", "creeper", "dragon", "piglin")
POTTED = {"azalea_bush": "azalea", "flowering_azalea_bush": "flowering_azalea"}
SIGNS = {"minecraft:sign": "Sign", "minecraft:hanging_sign": "HangingSign"}
FACES = ("down", "up", "north", "south", "west", "east")
CLOCKWISE = ("north", "east", "south", "west")  # Seen from above.
STEPS = {"north": (0, -1), "east": (1, 0), "south": (0, 1), "west": (-1, 0)}  # Along x and z.
CHESTS = ("chest", "trapped_chest")
Place = tuple[int, int, int]
KINDS = ("Bed", "Banner", "Skull", "FlowerPot", "ShulkerBox", "Chest", *SIGNS.values())
SIDES = (("front_text", "FrontText"), ("back_text", "BackText"))
MAX_LINES = 4


def bedrock_data(
    state: str, java: tuple[str, Mapping[str, Any]] | None = None, place: Place = (0, 0, 0)
) -> dict[str, Any] | None:
    """Return the Bedrock block entity of a Java block, or None if Bedrock stores none for it.

    Args:
        state: The Java block state.
        java: The ID and NBT data of the Java block entity, or None if the block has none.
        place: The block position in the world as (x, y, z).
    """
    parsed = parse_state(state)
    data = _data_from_state(parsed, java[1] if java else {}, place)
    if data is None and java is not None and java[0] in SIGNS:
        texts = {theirs: _sign_side(java[1], ours) for ours, theirs in SIDES}
        data = {"id": SIGNS[java[0]], **texts, "IsWaxed": Byte(bool(java[1].get("is_waxed", 0)))}
    return None if data is None else {**data, "x": place[0], "y": place[1], "z": place[2]}


def _data_from_state(
    state: BlockState, java: Mapping[str, Any], place: Place
) -> dict[str, Any] | None:
    """Return the block entity data that Java Edition stores in a block state."""
    name = state.name.partition(":")[2]
    stem, _, kind = name.rpartition("_")
    if kind == "bed" and stem in DYES:
        return {"id": "Bed", "color": Byte(DYES.index(stem)), "isMovable": Byte(1)}
    if kind == "banner" and stem.removesuffix("_wall") in DYES:
        # Bedrock counts the colours of banners from black.
        base = 15 - DYES.index(stem.removesuffix("_wall"))
        return {"id": "Banner", "Base": base, "Patterns": _patterns(java), "Type": 0}
    if kind in ("head", "skull") and stem.removesuffix("_wall") in HEADS:
        turn = 22.5 * int(state.get("rotation", "0"))
        number = HEADS.index(stem.removesuffix("_wall"))
        return {"id": "Skull", "SkullType": Byte(number), "Rotation": Float(turn)}
    if name.startswith("potted_"):
        plant = java_to_bedrock(f"minecraft:{POTTED.get(name[7:], name[7:])}")
        held = {} if plant is None else {"PlantBlock": palette_entry(*plant)}
        return {"id": "FlowerPot", **held}
    if name.endswith("shulker_box"):
        return {"id": "ShulkerBox", "facing": Byte(FACES.index(state.get("facing", "up")))}
    if name in CHESTS and state.get("type", "single") != "single":
        east, south = STEPS[_partner_side(state)]
        return {"id": "Chest", "pairx": place[0] + east, "pairz": place[2] + south}
    return None


def _partner_side(state: BlockState) -> str:
    """Return the direction of the other half of a double chest.

    The other half is clockwise of the front for a left half.
    """
    step = 1 if state.get("type") == "left" else -1
    return CLOCKWISE[(CLOCKWISE.index(state.get("facing", "north")) + step) % 4]


def java_state(state: str, data: Mapping[str, Any]) -> str:
    """Refine the Java state of a Bedrock block with the data of its block entity."""
    parsed = parse_state(state)
    name, kind = parsed.name.partition(":")[2], data.get("id")
    if kind == "Bed" and name.endswith("_bed"):
        return _renamed_state(parsed, f"{_dye(data.get('color', 0))}_bed")
    if kind == "Banner" and name.endswith("_banner"):
        wall = "_wall" if name.endswith("_wall_banner") else ""
        return _renamed_state(parsed, f"{_dye(15 - _number(data.get('Base', 15)))}{wall}_banner")
    if kind == "Skull" and name.endswith(("_skull", "_head")):
        return _head(parsed, data)
    if kind == "ShulkerBox" and name.endswith("shulker_box"):
        return str(parsed.having(facing=FACES[_number(data.get("facing", 1)) % len(FACES)]))
    if kind == "Chest" and name in CHESTS and "pairx" in data:
        step = tuple(_number(data.get(f"pair{axis}")) - _number(data.get(axis)) for axis in "xz")
        for side in ("left", "right"):
            half = parsed.having(type=side)
            if STEPS[_partner_side(half)] == step:
                return str(half)
    if kind == "FlowerPot" and name == "flower_pot" and isinstance(data.get("PlantBlock"), Mapping):
        plant = java_from_entry(data["PlantBlock"])
        bare = parse_state(plant).name.partition(":")[2] if plant else ""
        back = {plain: potted for potted, plain in POTTED.items()}
        potted = f"potted_{back.get(bare, bare)}"
        return f"minecraft:{potted}" if f"minecraft:{potted}" in known_blocks() else state
    return state


def java_data(data: Mapping[str, Any]) -> tuple[str, dict[str, Any]] | None:
    """Return the ID and NBT data of the Java block entity for a Bedrock sign or banner.

    Other block entities return None.
    """
    kind = data.get("id")
    if kind in SIGNS.values():
        java = next(ours for ours, theirs in SIGNS.items() if theirs == kind)
        sides = {ours: _java_side(data.get(theirs)) for ours, theirs in SIDES}
        return java, {**sides, "is_waxed": Byte(bool(data.get("IsWaxed", 0)))}
    if kind == "Banner":
        patterns = _patterns(data)
        return "minecraft:banner", {"Patterns": patterns} if patterns else {}
    return None


def is_in_state(data: Mapping[str, Any]) -> bool:
    """Return whether the Java block keeps all data of a Bedrock block entity.

    Items in a container are not kept.
    """
    return data.get("id") in KINDS and not _list(data.get("Items"))


def palette_entry(name: str, states: Mapping[str, Any]) -> dict[str, Any]:
    """Return a block in the form that Bedrock uses in palettes and flower pots."""
    return {"name": name, "states": dict(states), "version": bedrock_table().version}


def java_from_entry(entry: Mapping[str, Any]) -> str | None:
    """Return the Java state of a Bedrock palette entry, or None if the table does not have it."""
    states = entry.get("states", {})
    return bedrock_to_java(str(entry["name"]), states if isinstance(states, Mapping) else {})


def _renamed_state(state: BlockState, name: str) -> str:
    return str(BlockState(name, state.properties))


def _head(state: BlockState, data: Mapping[str, Any]) -> str:
    kind = HEADS[min(max(_number(data.get("SkullType", 0)), 0), len(HEADS) - 1)]
    ending = "skull" if kind in ("skeleton", "wither_skeleton") else "head"
    if state.name.endswith(("_wall_skull", "_wall_head")):
        return _renamed_state(state, f"{kind}_wall_{ending}")
    turn = data.get("Rotation", 0.0)
    turn = float(turn) if isinstance(turn, int | float) and abs(turn) < 1e6 else 0.0
    return _renamed_state(state.having(rotation=str(round(turn / 22.5) % 16)), f"{kind}_{ending}")


def _patterns(data: Mapping[str, Any]) -> list[dict[str, Any]]:
    rows = [row for row in _list(data.get("Patterns")) if isinstance(row, Mapping)]
    return [
        {"Pattern": str(row.get("Pattern", "")), "Color": 15 - _number(row.get("Color", 0)) % 16}
        for row in rows
    ]


def _sign_side(data: Mapping[str, Any], side: str) -> dict[str, Any]:
    """Return one side of a sign. Before 1.20, Java signs had a single side in four tags."""
    held = data.get(side)
    if isinstance(held, Mapping):
        lines, glows = _list(held.get("messages")), held.get("has_glowing_text", 0)
    elif side == "front_text":
        lines = [data[key] for key in ("Text1", "Text2", "Text3", "Text4") if key in data]
        glows = data.get("GlowingText", 0)
    else:
        lines, glows = [], 0
    text = "\n".join(plain_text(line) for line in lines[:MAX_LINES]).rstrip("\n")
    return {"Text": text, "IgnoreLighting": Byte(bool(glows)), "SignTextColor": -(1 << 24)}


def plain_text(line: Any) -> str:
    r"""Return the plain text of one sign line, which may be JSON, NBT or plain text.

    Example:
        >>> plain_text('{"text":"my ","extra":["room"]}')
        'my room'
    """
    if isinstance(line, str):
        try:
            return _letters(json.loads(line), 0)
        except (ValueError, RecursionError):
            return line
    return _letters(line, 0)


def _letters(part: Any, depth: int) -> str:
    if isinstance(part, list | tuple) and depth < 20:
        return "".join(_letters(one, depth + 1) for one in part)
    if isinstance(part, Mapping):
        rest = _letters(part.get("extra", []), depth + 1)
        return str(part.get("text", part.get("", ""))) + rest
    return str(part) if isinstance(part, str | int | float) and not isinstance(part, bool) else ""


def _java_side(side: Any) -> dict[str, Any]:
    held = side if isinstance(side, Mapping) else {}
    lines = str(held.get("Text", "")).split("\n")[:MAX_LINES]
    messages = [json.dumps({"text": line}, ensure_ascii=False) for line in lines]
    messages += ['{"text": ""}'] * (MAX_LINES - len(messages))
    return {
        "messages": messages,
        "color": "black",
        "has_glowing_text": Byte(bool(held.get("IgnoreLighting", 0))),
    }


def _list(value: Any) -> list[Any]:
    return list(value) if isinstance(value, list | tuple) else []


def _number(value: Any) -> int:
    return int(value) if isinstance(value, int) else 0


def _dye(value: Any) -> str:
    return DYES[_number(value) % len(DYES)]
