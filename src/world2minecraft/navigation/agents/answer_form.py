"""The form of an answer: the letter of an option, and how it is read from what a model says.

``letter`` asks as supervised models were trained, ``think`` as models trained by reward were, and
``json`` holds any model to a schema. All are read alike: a JSON field, a tagged answer, an
``Answer:`` line, or a reply that is the letter or one option's words alone. A letter among prose
is no answer.
"""

import re
from collections.abc import Mapping
from typing import Any

from world2minecraft.external_models.structured_replies import Form, UnreadableError, json_of
from world2minecraft.navigation.prompts import LETTER_ALONE

STYLES = ("letter", "think", "json")
THINK = (
    "First think it through inside <think> </think>. Then give the letter of your choice, and "
    "nothing else, inside <answer> </answer>."
)
_TAGGED = re.compile(r"<answer>(.*?)</answer>", re.S | re.I)
_LINE = re.compile(r"^\W*(?:final\s+)?answer\W*(?:is\W*)?[:=](.*)$", re.M | re.I)
_LETTER = re.compile(r"^[\s\"'(*\[`]*([A-Ha-h])[\s\"')*\]`.:]*$")
_LETTERED = re.compile(r"^[\s(*]*([A-Ha-h])[).:]\s*(.+?)[\s.]*$", re.S)


def answer_form(options: Mapping[str, str], style: str) -> Form[str]:
    """Return the form of an answer.

    Args:
        options: the words of each option by its letter, empty where an option is a picture.
        style: one of ``STYLES``.
    """
    schema: dict[str, Any] = {
        "type": "object",
        "properties": {"answer": {"type": "string", "enum": list(options)}},
        "required": ["answer"],
        "additionalProperties": False,
    }

    def read(text: str) -> str:
        return read_answer(text, options)

    if style == "json":
        words = f'Reply with JSON alone: {{"answer": "{next(iter(options))}"}} with your letter.'
        return Form("answer", schema, words, read)
    words = THINK if style == "think" else LETTER_ALONE
    return Form("answer", schema, words, read, is_said=True, rung=2)


def ending(style: str) -> str:
    """Return what a question of a style ends with."""
    return {"think": THINK, "letter": LETTER_ALONE}.get(style, "")


def read_answer(text: str, options: Mapping[str, str]) -> str:
    """Return the letter that a reply says.

    Raises:
        UnreadableError: it says none, more than one, or one that is no option.

    Example:
        >>> told = {"A": "turn left", "B": "stop"}
        >>> [read_answer(text, told) for text in ("b.", "<answer>A</answer>", "Turn left")]
        ['B', 'A', 'A']
    """
    found = json_of(text)
    if found is not None and isinstance(found.get("answer"), str):
        return _option(found["answer"], options)
    tagged, lines = _TAGGED.findall(text), _LINE.findall(text)
    if tagged:
        return _option(_one(tagged, options), options)
    if lines:
        return _option(_one(lines, options), options)
    return _option(text, options)


def _one(said: list[str], options: Mapping[str, str]) -> str:
    """Return the last of several answers that agree."""
    if len({_option(one, options) for one in said}) > 1:
        raise UnreadableError("it gives several answers")
    return said[-1]


def _option(said: str, options: Mapping[str, str]) -> str:
    letter = _LETTER.match(said)
    if letter is None:
        same = [one for one, words in options.items() if words and _plain(words) == _plain(said)]
        if len(same) == 1:
            return same[0]
        letter = _lettered(said, options)
    if letter is None or letter[1].upper() not in options:
        raise UnreadableError(f"the answer is one letter of {', '.join(options)}")
    return letter[1].upper()


def _lettered(said: str, options: Mapping[str, str]) -> re.Match[str] | None:
    """Return the match of a letter that its own option's words follow."""
    found = _LETTERED.match(said)
    if found is None or _plain(options.get(found[1].upper(), "")) != _plain(found[2]):
        return None
    return found


def _plain(text: str) -> str:
    return " ".join(text.lower().strip(" .\"'`*\n").split())
