"""Answer the items of a set: the reply format, its parser, and a model that answers.

``letter`` asks as supervised models were trained, ``think`` as models trained by reward were, and
``json`` holds any model to a schema. All are parsed alike: a JSON field, a tagged answer, an
``Answer:`` line, or a reply that is the letter or one option's words alone. A letter among prose
is no answer.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, UnknownNameError
from world2minecraft.core.files import read_bytes
from world2minecraft.external_models.chat_client import ChatModel
from world2minecraft.external_models.chat_messages import (
    MAX_PX,
    Picture,
    Turn,
    check_max_px,
    downscale_picture,
)
from world2minecraft.external_models.chat_transport import BusyServerError, RefusedQuestionError
from world2minecraft.external_models.structured_replies import (
    ReplyFormat,
    UnreadableError,
    ask_structured,
    extract_json_object,
)
from world2minecraft.navigation.agents.vlm_agent import describe_try
from world2minecraft.navigation.item_prompts import LETTER_ALONE, question_of
from world2minecraft.navigation.types import Item

STYLES = ("letter", "think", "json")
THINK = (
    "First think it through inside <think> </think>. Then give the letter of your choice, and "
    "nothing else, inside <answer> </answer>."
)
_TAGGED = re.compile(r"<answer>(.*?)</answer>", re.S | re.I)
_LINE = re.compile(r"^\W*(?:final\s+)?answer\W*(?:is\W*)?[:=](.*)$", re.M | re.I)
_LETTER = re.compile(r"^[\s\"'(*\[`]*([A-Ha-h])[\s\"')*\]`.:]*$")
_LETTERED = re.compile(r"^[\s(*]*([A-Ha-h])[).:]\s*(.+?)[\s.]*$", re.S)
MAX_IMAGE_BYTES = 20 << 20
_MAGIC = {b"\xff\xd8\xff": "image/jpeg", b"\x89PNG": "image/png", b"RIFF": "image/webp"}


def answer_form(options: Mapping[str, str], style: str) -> ReplyFormat[str]:
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
        return ReplyFormat("answer", schema, words, read)
    words = THINK if style == "think" else LETTER_ALONE
    return ReplyFormat("answer", schema, words, read, is_said=True, rung=2)


def answer_instruction(style: str) -> str:
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
    found = extract_json_object(text)
    if found is not None and isinstance(found.get("answer"), str):
        return _option_of(found["answer"], options)
    tagged, lines = _TAGGED.findall(text), _LINE.findall(text)
    if tagged:
        return _option_of(_agreed_answer(tagged, options), options)
    if lines:
        return _option_of(_agreed_answer(lines, options), options)
    return _option_of(text, options)


def _agreed_answer(reply_text: list[str], options: Mapping[str, str]) -> str:
    """Return the last of several answers that agree."""
    if len({_option_of(one, options) for one in reply_text}) > 1:
        raise UnreadableError("it gives several answers")
    return reply_text[-1]


def _option_of(reply_text: str, options: Mapping[str, str]) -> str:
    letter = _LETTER.match(reply_text)
    if letter is None:
        same = [
            one for one, words in options.items() if words and _plain(words) == _plain(reply_text)
        ]
        if len(same) == 1:
            return same[0]
        letter = _lettered(reply_text, options)
    if letter is None or letter[1].upper() not in options:
        raise UnreadableError(f"the answer is one letter of {', '.join(options)}")
    return letter[1].upper()


def _lettered(reply_text: str, options: Mapping[str, str]) -> re.Match[str] | None:
    """Return the match of a letter that its own option's words follow."""
    found = _LETTERED.match(reply_text)
    if found is None or _plain(options.get(found[1].upper(), "")) != _plain(found[2]):
        return None
    return found


def _plain(text: str) -> str:
    return " ".join(text.lower().strip(" .\"'`*\n").split())


@dataclass(frozen=True)
class Answer:
    """What was said to an item. ``letter`` is empty where ``outcome`` is invalid or failed."""

    letter: str
    outcome: str  # "answered", "invalid" or "failed"
    details: dict[str, Any]


class LetterAnswerer:
    """Gives the letters that were found for items before, as baselines do."""

    def __init__(self, name: str, letters: Mapping[str, str]):
        self.name, self.letters = name, letters

    def answer(self, item: Item) -> Answer:
        """Return the letter of an item, none where there is none."""
        letter = self.letters.get(item.item_id, "")
        return Answer(letter, "answered" if letter else "invalid", {})


class VlmAnswerer:
    """Asks a model each item by the words that exports for trainers use.

    Args:
        model: whom to ask.
        folder: of the set; images are read from it and held against their sums.
        style: one of ``STYLES``.
        max_px: pixels of a picture that it is shown; larger ones are made smaller.
    """

    def __init__(
        self,
        model: ChatModel,
        folder: str | Path,
        style: str = "letter",
        *,
        max_px: int = MAX_PX,
    ):
        if style not in STYLES:
            raise UnknownNameError("style of question", style, STYLES)
        check_max_px(max_px)
        self.name, self.model, self.folder, self.style = model.name, model, Path(folder), style
        self.max_px = max_px

    def answer(self, item: Item) -> Answer:
        """Ask an item.

        Raises:
            InputError: an image is missing or not the one of the set. BudgetError, ServerError:
            the model cannot be asked at all.
        """
        question = question_of(item)
        parts: list[str | Picture] = [
            self._picture(part, item) if kind == "image" else part for kind, part in question.parts
        ]
        if last := answer_instruction(self.style):
            parts.append(f"\n{last}")
        options = {option.label: option.text for option in item.options}
        try:
            turns = (Turn("user", tuple(parts)),)
            formed = ask_structured(self.model, turns, answer_form(options, self.style))
        except (BusyServerError, RefusedQuestionError) as error:
            return Answer("", "failed", {"problem": str(error)})
        details = {"raw": formed.raw, "tries": [describe_try(one) for one in formed.tries]}
        if formed.value is None:
            return Answer("", "invalid", {**details, "problem": formed.problem})
        return Answer(formed.value, "answered", details)

    def _picture(self, name: str, item: Item) -> Picture:
        path = self.folder / name
        data = read_bytes(path, MAX_IMAGE_BYTES)
        kinds = [kind for magic, kind in _MAGIC.items() if data.startswith(magic)]
        if not kinds:
            raise DamagedFileError(path, "is no JPEG, PNG or WebP")
        picture = Picture(data, kinds[0])
        if picture.sha256 != item.sha256.get(name):
            raise DamagedFileError(path, f"is not the image that item {item.item_id} was made of")
        try:
            return downscale_picture(picture, self.max_px)
        except ValueError as error:
            raise DamagedFileError(path, str(error)) from error
