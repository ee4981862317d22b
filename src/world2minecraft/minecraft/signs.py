"""Signs: their text as each game keeps it.

Up to 1.19.4 a sign has four texts, from 1.20 on two sides of four lines each, as JSON, and from
1.21.5 on as NBT. Within the program a sign is kept as 1.20 keeps it.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from textwrap import wrap
from typing import Any

from world2minecraft.errors import UsageError
from world2minecraft.minecraft.nbt import Byte
from world2minecraft.minecraft.versions import GameVersion
from world2minecraft.types import BlockEntity, BlockVolume

SIGN = "minecraft:sign"
LINES = 4
LINE_LETTERS = 15  # Of about six pixels; a line has 90.
TWO_SIDES = 3463  # The data version of 1.20, from which on a sign has two sides,
TEXT_AS_NBT = 4325  # and of 1.21.5, from which on texts are NBT and no JSON.


def sign_entity(
    block_pos: tuple[int, int, int], lines: Sequence[str], command: str = ""
) -> BlockEntity:
    """Return the block entity of a sign, waxed, so that nobody rewrites it by a click.

    Args:
        block_pos: where it stands.
        lines: up to four lines of text.
        command: what a click on it does, such as ``/function w2m:human_size``; nothing if empty.

    Raises:
        UsageError: there are more than four lines.
    """
    if len(lines) > LINES:
        raise UsageError(f"a sign has {LINES} lines, not {len(lines)}")
    texts: list[dict[str, Any]] = [{"text": line} for line in lines]
    texts += [{"text": ""}] * (LINES - len(texts))
    if command:
        click = {"action": "run_command", "value": command}
        texts[0] = {**texts[0], "clickEvent": click}
    return BlockEntity(
        block_pos,
        SIGN,
        {
            "front_text": _side(texts),
            "back_text": _side([{"text": ""}] * LINES),
            "is_waxed": Byte(1),
        },
    )


def signs_for(volume: BlockVolume, version: GameVersion) -> BlockVolume:
    """Return a volume whose signs are written as a game keeps them."""
    if not any(entity.id == SIGN for entity in volume.block_entities):
        return volume
    kept = tuple(_for_game(entity, version) for entity in volume.block_entities)
    return replace(volume, block_entities=kept)


def wrapped(text: str, lines: int) -> list[str]:
    """Return a text in lines that a sign can show, cut off with dots where it is too long.

    Args:
        text: any printable text.
        lines: how many lines it may take.
    """
    return wrap(text, LINE_LETTERS, max_lines=lines, placeholder="..")


def _side(texts: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    messages = [json.dumps(text, ensure_ascii=False) for text in texts]
    return {"messages": messages, "color": "black", "has_glowing_text": Byte(0)}


def _for_game(entity: BlockEntity, version: GameVersion) -> BlockEntity:
    if entity.id != SIGN or "front_text" not in entity.nbt:
        return entity
    if version.data_version < TWO_SIDES:
        front = entity.nbt["front_text"]
        texts = {f"Text{i}": line for i, line in enumerate(front["messages"], 1)}
        return replace(entity, nbt={**texts, "Color": front["color"], "GlowingText": Byte(0)})
    if version.data_version < TEXT_AS_NBT:
        return entity
    sides = {key: _as_nbt(entity.nbt[key]) for key in ("front_text", "back_text")}
    return replace(entity, nbt={**entity.nbt, **sides})


def _as_nbt(side: Mapping[str, Any]) -> dict[str, Any]:
    return {**side, "messages": [_line_as_nbt(line) for line in side["messages"]]}


def _line_as_nbt(line: Any) -> Any:
    """A line as NBT; one that was read from a file of a newer game is so already."""
    if not isinstance(line, str):
        return line
    try:
        text = json.loads(line)
    except ValueError:
        return {"text": line}
    return _text_as_nbt(text) if isinstance(text, dict) else {"text": str(text)}


def _text_as_nbt(text: dict[str, Any]) -> dict[str, Any]:
    click = text.pop("clickEvent", None)
    if click is None:
        return text
    return {**text, "click_event": {"action": click["action"], "command": click["value"]}}
