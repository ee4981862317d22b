"""Signs made here: their text, and what a click on them does.

A sign is made as 1.20.1 keeps it; ``sign_texts`` brings it to the form of other games.
"""

import json
from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockEntity
from world2minecraft.minecraft.nbt import Byte

SIGN = "minecraft:sign"
LINES = 4
LINE_LETTERS = 15  # Of about six pixels; a line has 90.


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
