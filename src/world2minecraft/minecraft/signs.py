"""Signs: creation, and conversion between the text formats of game versions.

Signs store four tags until 1.19, two sides of four JSON lines since 1.20, and NBT lines since
1.21.5, which displays JSON as plain text. The game upgrades an older block entity only if the data
version of its chunk is older. Volumes store signs in the form of 1.20.1: readers convert to this
form, and writers convert to the form of the target game.
"""

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from textwrap import wrap
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockEntity
from world2minecraft.minecraft.nbt import Byte

FIRST_TWO_SIDES = 3463  # 1.20.
FIRST_NBT_LINES = 4325  # 1.21.5.
SIGNS = ("minecraft:sign", "minecraft:hanging_sign")
LEGACY_TEXT_KEYS = ("Text1", "Text2", "Text3", "Text4")
SIDES = ("front_text", "back_text")
EMPTY = '{"text":""}'
MAX_DEPTH = 20  # Of a text in a text; what lies deeper is left out.
_PARTS = ("extra", "with")  # Lists of texts in a text.
_FLAGS = ("bold", "italic", "underlined", "strikethrough", "obfuscated", "interpret")
# What a click's value is called since 1.21.5, by its action.
_CLICKS = {
    "open_url": "url",
    "run_command": "command",
    "suggest_command": "command",
    "change_page": "page",
}
SIGN = "minecraft:sign"
LINE_COUNT = 4
LINE_LETTERS = 15  # Of about six pixels; a line has 90.


def upgrade_signs(held: Iterable[BlockEntity], data_version: int) -> tuple[BlockEntity, ...]:
    """Convert the signs among block entities to the form of 1.20.1.

    Args:
        held: The block entities of a file.
        data_version: The data version of the game that wrote the file.
    """
    if data_version < FIRST_TWO_SIDES:
        return _map_signs(held, upgrade_sign)
    if data_version < FIRST_NBT_LINES:
        return tuple(held)
    return _map_signs(held, lambda nbt: _with_lines(nbt, _json_of_line))


def upgrade_command_signs(held: Iterable[BlockEntity]) -> tuple[BlockEntity, ...]:
    """Convert the signs set by commands of any game version to the form of 1.20.1.

    A line given as a string is taken as JSON, because only an NBT line identifies its game version.
    """
    return _map_signs(
        held,
        lambda nbt: _with_lines(
            nbt, lambda line: _json_of_line(line) if isinstance(line, dict) else line
        ),
    )


def convert_sign(entity: BlockEntity, data_version: int) -> BlockEntity:
    """Convert the sign of a volume to the form of a game version.

    Block entities that are not signs are returned unchanged. Before 1.20, only the front is kept.
    """
    if entity.id not in SIGNS or FIRST_TWO_SIDES <= data_version < FIRST_NBT_LINES:
        return entity
    if data_version < FIRST_TWO_SIDES:
        return replace(entity, nbt=_downgrade_sign(entity.nbt))
    return replace(entity, nbt=_with_lines(entity.nbt, _nbt_of_line))


def upgrade_sign(nbt: Mapping[str, Any]) -> dict[str, Any]:
    """Convert the NBT of a sign to the form with two sides.

    Example:
        >>> upgrade_sign({"Text1": "Exit"})["front_text"]["messages"][0]
        '{"text": "Exit"}'
    """
    rest = {key: nbt[key] for key in nbt if key not in (*LEGACY_TEXT_KEYS, "Color", "GlowingText")}
    if "front_text" in nbt:
        return rest
    front = {
        "has_glowing_text": Byte(bool(nbt.get("GlowingText", 0))),
        "color": str(nbt.get("Color", "black")),
        "messages": [_component(nbt.get(line, EMPTY)) for line in LEGACY_TEXT_KEYS],
    }
    back = {"has_glowing_text": Byte(0), "color": "black", "messages": [EMPTY] * 4}
    return {**rest, "is_waxed": Byte(0), "front_text": front, "back_text": back}


def _map_signs(
    held: Iterable[BlockEntity], change: Callable[[Mapping[str, Any]], dict[str, Any]]
) -> tuple[BlockEntity, ...]:
    return tuple(replace(e, nbt=change(e.nbt)) if e.id in SIGNS else e for e in held)


def _component(text: Any) -> str:
    """Return a line as JSON. Lines before 1.8 are plain text."""
    line = str(text)
    try:
        json.loads(line)
    except (ValueError, RecursionError):
        return json.dumps({"text": line})
    return line


def _downgrade_sign(nbt: Mapping[str, Any]) -> dict[str, Any]:
    front = nbt.get("front_text")
    if not isinstance(front, Mapping):
        return dict(nbt)
    rest = {key: nbt[key] for key in nbt if key not in (*SIDES, "is_waxed")}
    lines = [str(line) for line in front.get("messages", ())][:4]
    texts = dict(zip(LEGACY_TEXT_KEYS, lines + [EMPTY] * (4 - len(lines)), strict=True))
    glows = Byte(bool(front.get("has_glowing_text", 0)))
    return {**rest, **texts, "Color": str(front.get("color", "black")), "GlowingText": glows}


def _with_lines(nbt: Mapping[str, Any], change: Callable[[Any], Any]) -> dict[str, Any]:
    """Apply a function to each line on both sides of a sign."""
    result = dict(nbt)
    for side in SIDES:
        held = nbt.get(side)
        for key in ("messages", "filtered_messages"):
            if isinstance(held, Mapping) and isinstance(held.get(key), list):
                held = {**held, key: [change(line) for line in held[key]]}
        if side in nbt:
            result[side] = held
    return result


def _nbt_of_line(line: Any) -> dict[str, Any]:
    """Convert a JSON line to NBT. An NBT line is returned unchanged."""
    if isinstance(line, Mapping):
        return dict(line)
    try:
        return _nbt_of(json.loads(str(line)), 0)
    except (ValueError, RecursionError):
        return {"text": str(line)}


def _nbt_of(text: Any, depth: int) -> dict[str, Any]:
    """Convert a JSON text to a compound, so that lists of texts have a single type."""
    if text is None or depth > MAX_DEPTH:
        return {"text": ""}
    if isinstance(text, list):
        first, *rest = [_nbt_of(part, depth + 1) for part in text] or [{"text": ""}]
        return {**first, "extra": [*first.get("extra", []), *rest]} if rest else first
    if not isinstance(text, dict):
        return {"text": str(text).lower() if isinstance(text, bool) else str(text)}
    found: dict[str, Any] = {}
    for key, value in text.items():
        if key in _PARTS and isinstance(value, list) and value:
            found[key] = [_nbt_of(part, depth + 1) for part in value]
        elif key == "clickEvent" and isinstance(value, dict):
            found["click_event"] = _click_of_1_21_5(value)
        elif isinstance(value, bool):
            found[key] = Byte(value)
        elif isinstance(value, str) or (isinstance(value, int) and abs(value) < 1 << 31):
            found[key] = value
    return found or {"text": ""}


def _click_of_1_21_5(click: Mapping[str, Any]) -> dict[str, Any]:
    action, value = str(click.get("action", "")), str(click.get("value", ""))
    if action == "change_page":
        return {"action": action, "page": int(value) if value.isdecimal() else 1}
    return {"action": action, _CLICKS.get(action, "value"): value}


def _json_of_line(line: Any) -> str:
    """Convert an NBT line to JSON."""
    text = {"text": line} if isinstance(line, str) else _json_of(line, 0)
    return json.dumps(text, ensure_ascii=False, separators=(",", ":"), allow_nan=False)


def _json_of(text: Any, depth: int) -> Any:
    if depth > MAX_DEPTH:
        return ""
    if isinstance(text, list):
        return [_json_of(part, depth + 1) for part in text] or ""
    if not isinstance(text, dict):
        return text if isinstance(text, str) else str(text)
    if list(text) == [""]:  # What NBT puts around a text in a list of other types.
        return _json_of(text[""], depth + 1)
    found: dict[str, Any] = {}
    for key, value in text.items():
        if key in _PARTS and isinstance(value, list) and value:
            found[key] = [_json_of(part, depth + 1) for part in value]
        elif key == "click_event" and isinstance(value, dict):
            action = str(value.get("action", ""))
            target = value.get(_CLICKS.get(action, "value"), "")
            found["clickEvent"] = {"action": action, "value": str(target)}
        elif isinstance(value, str):
            found[key] = value
        elif isinstance(value, int):
            found[key] = bool(value) if key in _FLAGS else int(value)
    return found or {"text": ""}


def sign_entity(
    block_pos: tuple[int, int, int], lines: Sequence[str], command: str = ""
) -> BlockEntity:
    """Create the block entity of a sign, waxed so that players cannot edit it.

    Args:
        block_pos: The block position of the sign.
        lines: Up to four lines of text.
        command: The command that a click runs, such as ``/function w2m:human_size``. Empty for
            none.

    Raises:
        UsageError: If there are more than four lines.
    """
    if len(lines) > LINE_COUNT:
        raise UsageError(f"a sign must have at most {LINE_COUNT} lines of text, got {len(lines)}")
    texts: list[dict[str, Any]] = [{"text": line} for line in lines]
    texts += [{"text": ""}] * (LINE_COUNT - len(texts))
    if command:
        click = {"action": "run_command", "value": command}
        texts[0] = {**texts[0], "clickEvent": click}
    return BlockEntity(
        block_pos,
        SIGN,
        {
            "front_text": _side(texts),
            "back_text": _side([{"text": ""}] * LINE_COUNT),
            "is_waxed": Byte(1),
        },
    )


def wrap_sign_text(text: str, lines: int) -> list[str]:
    """Wrap a text into lines that fit on a sign, and shorten it with dots if it is too long.

    Args:
        text: The text to wrap.
        lines: Maximum number of lines.
    """
    return wrap(text, LINE_LETTERS, max_lines=lines, placeholder="..")


def _side(texts: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    messages = [json.dumps(text, ensure_ascii=False) for text in texts]
    return {"messages": messages, "color": "black", "has_glowing_text": Byte(0)}
