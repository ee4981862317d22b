"""A vision-language model answers items: the views and choices it is shown, the letter it gives."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, UnknownNameError
from world2minecraft.core.files import read_bytes
from world2minecraft.external_models.chat_client import ChatModel
from world2minecraft.external_models.chat_messages import Picture, Turn
from world2minecraft.external_models.chat_pictures import MOST_PX, capped, check_most_px
from world2minecraft.external_models.chat_wire import BusyServerError, RefusedQuestionError
from world2minecraft.external_models.structured_replies import ask_form
from world2minecraft.navigation.agents.answer_form import STYLES, answer_form, ending
from world2minecraft.navigation.agents.model import told_of
from world2minecraft.navigation.prompts import question_of
from world2minecraft.navigation.values import Item

MAX_IMAGE_BYTES = 20 << 20
_MAGIC = {b"\xff\xd8\xff": "image/jpeg", b"\x89PNG": "image/png", b"RIFF": "image/webp"}


@dataclass(frozen=True)
class Answer:
    """What was said to an item. ``letter`` is empty where ``outcome`` is invalid or failed."""

    letter: str
    outcome: str  # "answered", "invalid" or "failed"
    told: dict[str, Any]


class LetterAnswerer:
    """Gives the letters that were found for items before, as baselines do."""

    def __init__(self, name: str, letters: Mapping[str, str]):
        self.name, self.letters = name, letters

    def answer(self, item: Item) -> Answer:
        """Return the letter of an item, none where there is none."""
        letter = self.letters.get(item.item_id, "")
        return Answer(letter, "answered" if letter else "invalid", {})


class ModelAnswerer:
    """Asks a model each item by the words that exports for trainers use.

    Args:
        model: whom to ask.
        folder: of the set; images are read from it and held against their sums.
        style: one of ``STYLES``.
        most_px: pixels of a picture that it is shown; larger ones are made smaller.
    """

    def __init__(
        self,
        model: ChatModel,
        folder: str | Path,
        style: str = "letter",
        *,
        most_px: int = MOST_PX,
    ):
        if style not in STYLES:
            raise UnknownNameError("style of question", style, STYLES)
        check_most_px(most_px)
        self.name, self.model, self.folder, self.style = model.name, model, Path(folder), style
        self.most_px = most_px

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
        if last := ending(self.style):
            parts.append(f"\n{last}")
        options = {option.label: option.text for option in item.options}
        try:
            turns = (Turn("user", tuple(parts)),)
            formed = ask_form(self.model, turns, answer_form(options, self.style))
        except (BusyServerError, RefusedQuestionError) as error:
            return Answer("", "failed", {"problem": str(error)})
        told = {"raw": formed.raw, "tries": [told_of(one) for one in formed.tries]}
        if formed.value is None:
            return Answer("", "invalid", {**told, "problem": formed.problem})
        return Answer(formed.value, "answered", told)

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
            return capped(picture, self.most_px)
        except ValueError as error:
            raise DamagedFileError(path, str(error)) from error
