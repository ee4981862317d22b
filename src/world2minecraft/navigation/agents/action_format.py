"""The reply format of one navigation step, and its parser.

Servers with structured output return a JSON object with exactly four fields. In plain text, the
parser accepts an ``Actions:`` line, a tagged answer, or a reply that consists of actions only. It
never extracts action words from prose, so "do not go forward" does not count as a forward step.
"""

import re
from dataclasses import dataclass
from typing import Any

from world2minecraft.external_models.structured_replies import (
    ReplyFormat,
    UnreadableError,
    extract_json_object,
)
from world2minecraft.navigation.types import Move

MAX_MOVES = 4
MAX_THOUGHT_CHARACTERS = 2000
NAMES = {
    "FORWARD": Move.FORWARD,
    "LEFT": Move.LEFT,
    "RIGHT": Move.RIGHT,
    "STOP": Move.STOP,
}
# Names used by papers and fine-tuned models, such as NaVid, StreamVLN and Uni-NaVid.
OTHER_NAMES = {
    "MOVE_FORWARD": Move.FORWARD,
    "GO_FORWARD": Move.FORWARD,
    "MOVE_AHEAD": Move.FORWARD,
    "TURN_LEFT": Move.LEFT,
    "TURN_RIGHT": Move.RIGHT,
    "↑": Move.FORWARD,
    "←": Move.LEFT,
    "→": Move.RIGHT,
}
_ALL = NAMES | OTHER_NAMES
_TAGGED = re.compile(r"<(?:answer|actions?)>(.*?)</(?:answer|actions?)>", re.S | re.I)
_LINE = re.compile(r"^\W*(?:actions?|answer)\W*[:=](.*)$", re.M | re.I)
_THOUGHT = re.compile(r"^\W*thoughts?\W*[:=](.*)$", re.M | re.I)
FIELDS = ("thought", "progress", "actions", "done")

SCHEMA: dict[str, Any] = {
    "type": "object",
    "properties": {
        "thought": {"type": "string", "description": "What you see and why you move so; short."},
        "progress": {"type": "string", "description": "What of the instruction is done so far."},
        "actions": {
            "type": "array",
            "items": {"type": "string", "enum": list(NAMES)},
            "description": "The next moves, in turn. STOP only as the last one, at the goal.",
        },
        "done": {"type": "boolean", "description": "true with STOP, else false."},
    },
    "required": list(FIELDS),
    "additionalProperties": False,
}


@dataclass(frozen=True)
class Step:
    """The moves parsed from a model reply, with the model's reasoning and progress notes."""

    moves: tuple[Move, ...]
    thought: str = ""
    progress: str = ""


def step_form(max_moves: int = MAX_MOVES) -> ReplyFormat[Step]:
    """Return the reply format of a step with at most ``max_moves`` moves."""
    count = "one action" if max_moves == 1 else f"1 to {max_moves} actions"
    words = (
        'Reply with one JSON object: {"thought": "...", "progress": "...", "actions": '
        f'["FORWARD"], "done": false}}, with {count} of {", ".join(NAMES)} and nothing around it. '
        "STOP comes last, alone with done true. If you cannot write JSON, end with one line: "
        "Actions: FORWARD, LEFT"
    )
    return ReplyFormat("step", SCHEMA, words, lambda text: parse_step(text, max_moves))


def parse_step(text: str, max_moves: int = MAX_MOVES) -> Step:
    r"""Parse a model reply into a navigation step.

    Raises:
        UnreadableError: If the reply contains no valid actions, or contradicts itself.

    Example:
        >>> parse_step("Thought: the door is left.\nActions: turn left, move forward").moves
        (<Move.LEFT: 2>, <Move.FORWARD: 1>)
    """
    found = extract_json_object(text)
    if found is not None:
        return _of_json(found, max_moves)
    tagged, lines = _TAGGED.findall(text), _LINE.findall(text)
    for found_texts in (tagged[-1:], lines[-1:], [text]):
        if found_texts:
            moves = tuple(_move(word) for word in _words(found_texts[0]))
            thought = (_THOUGHT.findall(text) or [""])[0].strip()
            return Step(_validate(moves, None, max_moves), thought[:MAX_THOUGHT_CHARACTERS])
    raise UnreadableError("the reply is empty")


def _of_json(found: dict[str, Any], max_moves: int) -> Step:
    actions, done = found.get("actions"), found.get("done")
    if isinstance(actions, str):
        actions = _words(actions)
    if not isinstance(actions, list) or not all(isinstance(one, str) for one in actions):
        raise UnreadableError("actions must be a list of action names")
    if done is not None and not isinstance(done, bool):
        raise UnreadableError("done must be true or false")
    moves = _validate(tuple(_move(one) for one in actions), done, max_moves)
    texts = [found.get(name) for name in ("thought", "progress")]
    thought, progress = (
        one[:MAX_THOUGHT_CHARACTERS] if isinstance(one, str) else "" for one in texts
    )
    return Step(moves, thought, progress)


def _words(text: str) -> list[str]:
    """Split a plain-text action list at commas, line breaks, 'then', 'and' or spaces."""
    plain = text.strip().strip("[]().\"'`* ")
    parts = re.split(r"[,;|\n]+|\bthen\b|\band\b", plain, flags=re.I)
    whole = [part.strip(" \t\"'`*.[]") for part in parts]
    whole = [part for part in whole if part]
    if len(whole) == 1 and _name(whole[0]) not in _ALL:
        return whole[0].split()  # FORWARD FORWARD LEFT
    return whole


def _name(word: str) -> str:
    return re.sub(r"[\s_-]+", "_", word.strip().upper())


def _move(word: str) -> Move:
    name = _name(word)
    if name not in _ALL:
        known = ", ".join(NAMES)
        raise UnreadableError(f"{word[:40]!r} is not a valid action; expected one of {known}")
    return _ALL[name]


def _validate(moves: tuple[Move, ...], done: bool | None, max_moves: int) -> tuple[Move, ...]:
    if not 1 <= len(moves) <= max_moves:
        raise UnreadableError(f"the reply contains {len(moves)} actions; expected 1 to {max_moves}")
    if Move.STOP in moves[:-1]:
        raise UnreadableError("STOP ends the walk, so it must be the last action")
    if done is True and moves[-1] != Move.STOP:
        raise UnreadableError("done is true but the last action is not STOP")
    return moves
