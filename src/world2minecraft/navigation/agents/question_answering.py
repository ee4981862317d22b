"""Multiple-choice question answering on the items of a set: reply format, parser and model client.

The style ``letter`` asks as for supervised fine-tuned models, ``think`` as for models trained with
rewards, and ``json`` enforces a JSON schema. All replies are parsed alike: a JSON field, a tagged
answer, an ``Answer:`` line, or a reply that consists of a letter or the text of one option. A
letter within prose is not accepted as an answer.
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
    """Return the reply format of a multiple-choice answer.

    Args:
        options: The text of each option by its letter. Image options have an empty text.
        style: One of ``STYLES``.
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
    """Return the instruction that ends a question of the given style, or "" for ``json``."""
    return {"think": THINK, "letter": LETTER_ALONE}.get(style, "")


def read_answer(text: str, options: Mapping[str, str]) -> str:
    """Parse a model reply into the letter of one option.

    Raises:
        UnreadableError: If the reply contains no answer, several answers or an unknown option.

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
    """Return the last of several answers, or raise UnreadableError if they differ."""
    if len({_option_of(one, options) for one in reply_text}) > 1:
        raise UnreadableError("the reply contains several different answers")
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
        raise UnreadableError(f"the answer must be one of the letters {', '.join(options)}")
    return letter[1].upper()


def _lettered(reply_text: str, options: Mapping[str, str]) -> re.Match[str] | None:
    """Match a letter that is followed by the text of the option with that letter."""
    found = _LETTERED.match(reply_text)
    if found is None or _plain(options.get(found[1].upper(), "")) != _plain(found[2]):
        return None
    return found


def _plain(text: str) -> str:
    return " ".join(text.lower().strip(" .\"'`*\n").split())


@dataclass(frozen=True)
class Answer:
    """The answer to an item. ``letter`` is empty if ``outcome`` is "invalid" or "failed"."""

    letter: str
    outcome: str  # "answered", "invalid" or "failed"
    details: dict[str, Any]


class LetterAnswerer:
    """An answerer that returns precomputed letters, as the baselines do."""

    def __init__(self, name: str, letters: Mapping[str, str]):
        self.name, self.letters = name, letters

    def answer(self, item: Item) -> Answer:
        """Return the precomputed letter of an item, or an invalid answer if none is known."""
        letter = self.letters.get(item.item_id, "")
        return Answer(letter, "answered" if letter else "invalid", {})


class VlmAnswerer:
    """An answerer that queries a vision-language model with the prompts of the trainer exports.

    Args:
        model: The model to query.
        folder: The folder of the set. Images are read from it and checked against their SHA-256.
        style: One of ``STYLES``.
        max_px: The maximum number of pixels of an image. Larger images are downscaled.
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
            raise UnknownNameError("question style", style, STYLES)
        check_max_px(max_px)
        self.name, self.model, self.folder, self.style = model.name, model, Path(folder), style
        self.max_px = max_px

    def answer(self, item: Item) -> Answer:
        """Query the model for the answer to an item.

        Raises:
            InputError: If an image is missing or differs from the one recorded in the set.
            BudgetError: If the limit on calls or cost is reached.
            ServerError: If the model cannot be queried.
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
            raise DamagedFileError(path, "not a JPEG, PNG or WebP image")
        picture = Picture(data, kinds[0])
        if picture.sha256 != item.sha256.get(name):
            raise DamagedFileError(
                path,
                f"the image's SHA-256 does not match the one recorded for item {item.item_id}; "
                "build the set again",
            )
        try:
            return downscale_picture(picture, self.max_px)
        except ValueError as error:
            raise DamagedFileError(path, str(error)) from error
