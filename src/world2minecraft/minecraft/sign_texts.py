"""The texts of signs: four tags until 1.19, two sides of four lines since 1.20.

The game brings an older block entity up to date only where the chunk says that it is older. A
volume keeps signs as 1.20.1 has them, and writers for older games turn them back.
"""

import json
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from world2minecraft.minecraft.nbt import Byte
from world2minecraft.types import BlockEntity, BlockVolume

FIRST_TWO_SIDES = 3463  # 1.20.
SIGNS = ("minecraft:sign", "minecraft:hanging_sign")
LINES = ("Text1", "Text2", "Text3", "Text4")
EMPTY = '{"text":""}'


def signs_of_today(held: Iterable[BlockEntity], data_version: int) -> tuple[BlockEntity, ...]:
    """Return block entities with their signs as 1.20.1 has them.

    Args:
        held: block entities of a file.
        data_version: that of the game that wrote it.
    """
    if data_version >= FIRST_TWO_SIDES:
        return tuple(held)
    return tuple(replace(e, nbt=sign_of_today(e.nbt)) if e.id in SIGNS else e for e in held)


def signs_for(volume: BlockVolume, data_version: int) -> BlockVolume:
    """Return a volume with its signs as a game has them: before 1.20 with their front alone."""
    if data_version >= FIRST_TWO_SIDES:
        return volume
    held = (replace(e, nbt=_before(e.nbt)) if e.id in SIGNS else e for e in volume.block_entities)
    return replace(volume, block_entities=tuple(held))


def sign_of_today(nbt: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tags of a sign with two sides.

    Example:
        >>> sign_of_today({"Text1": "Exit"})["front_text"]["messages"][0]
        '{"text": "Exit"}'
    """
    rest = {key: nbt[key] for key in nbt if key not in (*LINES, "Color", "GlowingText")}
    if "front_text" in nbt:
        return rest
    front = {
        "has_glowing_text": Byte(bool(nbt.get("GlowingText", 0))),
        "color": str(nbt.get("Color", "black")),
        "messages": [_component(nbt.get(line, EMPTY)) for line in LINES],
    }
    back = {"has_glowing_text": Byte(0), "color": "black", "messages": [EMPTY] * 4}
    return {**rest, "is_waxed": Byte(0), "front_text": front, "back_text": back}


def _component(text: Any) -> str:
    """Return a line as JSON; before 1.8 it was plain text."""
    line = str(text)
    try:
        json.loads(line)
    except (ValueError, RecursionError):
        return json.dumps({"text": line})
    return line


def _before(nbt: Mapping[str, Any]) -> dict[str, Any]:
    front = nbt.get("front_text")
    if not isinstance(front, Mapping):
        return dict(nbt)
    rest = {key: nbt[key] for key in nbt if key not in ("front_text", "back_text", "is_waxed")}
    lines = [str(line) for line in front.get("messages", ())][:4]
    texts = dict(zip(LINES, lines + [EMPTY] * (4 - len(lines)), strict=True))
    glows = Byte(bool(front.get("has_glowing_text", 0)))
    return {**rest, **texts, "Color": str(front.get("color", "black")), "GlowingText": glows}
