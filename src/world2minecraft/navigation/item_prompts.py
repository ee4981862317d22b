"""Conversion of items to questions: a text with a placeholder for each image, and the answer.

Trainer exports and question-answering agents use the same texts, so a model is evaluated on the
prompts it was trained on.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.types import Item

IMAGE = "<image>"  # The placeholder of LLaMA-Factory and EasyR1.
LETTER_ALONE = "Answer with its letter alone."  # Ends questions without a format prompt.
TASK_WORDS = {
    "next_view": "Which of these views do you see next?",
    "next_action": "Which action do you take next?",
}
_ROLE = "You walk through a Minecraft world and follow an instruction."
# Trainers interpret these as images and tokenizers as the end of a turn, wherever they occur.
_MARK = re.compile(r"<(?:image|video|audio)>|<\|[^<>|]{1,40}\|>", re.IGNORECASE)


@dataclass(frozen=True)
class Question:
    """The question of an item, with one ``IMAGE`` placeholder in ``text`` per image."""

    text: str
    images: tuple[str, ...]
    answer: str  # a letter

    @property
    def parts(self) -> Iterator[tuple[Literal["text", "image"], str]]:
        """The text segments and image names in reading order."""
        images = iter(self.images)
        for number, text in enumerate(self.text.split(IMAGE)):
            if number:
                yield "image", next(images)
            if text:
                yield "text", text


def find_reserved_token(text: str) -> str:
    """Return the first substring that trainers or models treat as a special token, or "".

    Example:
        >>> find_reserved_token("Go to the <image>.")
        '<image>'
    """
    found = _MARK.search(text)
    return found[0] if found else ""


def question_of(item: Item) -> Question:
    """Return the question of an item.

    Raises:
        UsageError: If a text contains a special token of trainers or models.

    Example:
        >>> from world2minecraft.navigation.types import Instruction, Option
        >>> choices = (Option("A", "action", "turn left"), Option("B", "positive", "stop"))
        >>> item = Item("i", "next_action", "s", "t", 3, Instruction("Go to the piano."), (),
        ...     "3.jpg", choices, "B", "train", "base", 0.25, "", {}, {})
        >>> print(question_of(item).text)
        You walk through a Minecraft world and follow an instruction.
        Instruction: Go to the piano.
        You see now: <image>
        Which action do you take next?
        A. turn left
        B. stop
    """
    words = [item.instruction.text, *(option.text for option in item.options)]
    for text in words:
        if found := find_reserved_token(text):
            raise UsageError(
                f"item {item.item_id}: the text contains {found!r}, which trainers and "
                "models interpret as an image or the end of a turn; reword it"
            )
    lines = [_ROLE, f"Instruction: {' '.join(item.instruction.text.split())}"]
    if item.history:
        lines.append(f"You saw before, oldest first: {IMAGE * len(item.history)}")
    lines += [f"You see now: {IMAGE}", TASK_WORDS[item.task]]
    lines += [f"{option.label}. {option.text or IMAGE}" for option in item.options]
    return Question("\n".join(lines), item.images, item.answer)
