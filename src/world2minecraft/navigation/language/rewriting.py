"""Paraphrasing of instructions by a language model, with a check that the meaning is unchanged.

The model is any function from a prompt to a reply. The turns, the landmarks and their order are
parsed from the reply, and a text in which they differ is rejected.
"""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from world2minecraft.navigation.item_prompts import find_reserved_token
from world2minecraft.navigation.language.instruction_parsing import parse_instruction
from world2minecraft.navigation.types import Instruction

Ask = Callable[[str], str]
"""A language model as a function from a prompt to a reply."""

MAX_CHARACTERS = 600
PROMPT = """\
Say this walking instruction again in natural English, as a person would say it to a guest.
Keep every turn and every thing, by exactly these names and in this order, and add none.
Turns: {turns}. Things: {things}.
Reply with the instruction alone, in one line.

{text}
"""


@dataclass(frozen=True)
class Rewriting:
    """The result of a rewrite: the new instruction, or the reason why the reply was rejected."""

    instruction: Instruction | None
    refusal: str = ""


def rewrite(
    instruction: Instruction, names: Iterable[str], ask: Ask, annotator: str = "model"
) -> Rewriting:
    """Ask a model to paraphrase an instruction.

    Args:
        instruction: The generated instruction.
        names: All landmark names of the scene.
        ask: The model. Its exceptions are propagated.
        annotator: The name of the model, which is stored with the instruction.

    Example:
        >>> told = Instruction("Turn left at the sofa and stop.", landmarks=("sofa",))
        >>> rewrite(told, ["sofa"], lambda _: "At the sofa go left, then stop.").refusal
        ''
        >>> rewrite(told, ["sofa"], lambda _: "Go right at the sofa.").refusal
        'other turns'
    """
    known = list(names)
    expected = parse_instruction(instruction.text, known)
    prompt = PROMPT.format(
        turns=", ".join(expected.turns) or "none",
        things=", ".join(expected.landmarks) or "none",
        text=instruction.text,
    )
    text = _plain(ask(prompt))
    if not text or len(text) > MAX_CHARACTERS:
        return Rewriting(None, "empty" if not text else "too long")
    if not text.isprintable() or find_reserved_token(text):
        return Rewriting(None, "invalid characters")
    found = parse_instruction(text, known)
    if found.turns != expected.turns:
        return Rewriting(None, "other turns")
    if found.landmarks != expected.landmarks:
        return Rewriting(None, "other landmarks")
    return Rewriting(replace(instruction, text=text, source="llm", annotator=annotator))


def _plain(reply: str) -> str:
    """Return a reply as one line, without enclosing quotes."""
    text = reply[: 4 * MAX_CHARACTERS].strip()
    if text.startswith('"'):
        try:
            text = str(json.loads(text))
        except ValueError:
            text = text.strip('"')
    return " ".join(text.split())
