"""Parsing of instructions into turns and landmarks.

The parser supports the texts of ``instruction_generation`` and plain English by people and models:
"take a left" is a turn, "on your left" is not. Doubtful phrases count as turns, so that an unclear
text is rejected rather than a wrong one accepted.
"""

import re
from collections.abc import Iterable
from typing import NamedTuple

# The side of an object, or a "right" that is not a direction.
_NO_TURN = re.compile(
    r"\b(?:on|to|at|along|by)\s+(?:your|the|its|his|her)\s+(?:immediate\s+|far\s+)?(?:left|right)\b"
    r"(?:[\s-]+(?:hand[\s-]+)?side)?|\bright\s+(?:away|now|before|after|in\s+front|next|there|up)\b"
    r"|\b(?:left|right)[\s-]hand\s+side\b",
    re.IGNORECASE,
)
_TURN = re.compile(r"\b(left|right|u-turn)\b", re.IGNORECASE)
_AROUND = re.compile(
    r"\b(?:turn|turning|spin|swing|face)\s+(?:right\s+|all\s+the\s+way\s+|fully\s+)?(?:around|round|"
    r"back)\b|\bu-turn\b|\babout[\s-]face\b",
    re.IGNORECASE,
)


class ParsedInstruction(NamedTuple):
    """The turns and landmarks of an instruction, in order.

    Attributes:
        turns: Any of "left", "right" and "around".
        landmarks: The landmark names, without immediate repetitions.
    """

    turns: tuple[str, ...]
    landmarks: tuple[str, ...]


def parse_instruction(text: str, names: Iterable[str]) -> ParsedInstruction:
    """Return the turns and landmarks of an instruction.

    Args:
        text: The instruction.
        names: All landmark names of the scene. Longer names are matched first.

    Example:
        >>> parse_instruction("Take a left at the sofa, the bed is on your right.", ["bed", "sofa"])
        ParsedInstruction(turns=('left',), landmarks=('sofa', 'bed'))
    """
    landmarks, rest = _landmarks(text, names)
    return ParsedInstruction(_turns(rest), landmarks)


def _landmarks(text: str, names: Iterable[str]) -> tuple[tuple[str, ...], str]:
    """Return the landmarks and the text without them, because names may contain "left"."""
    ordered = sorted(set(names), key=lambda name: (-len(name), name))
    if not ordered:
        return (), text
    pattern = re.compile(
        r"\b(" + "|".join(re.escape(name) for name in ordered) + r")\b", re.IGNORECASE
    )
    by_lower = {name.lower(): name for name in ordered}
    found = [by_lower[match.group(1).lower()] for match in pattern.finditer(text)]
    once = [name for n, name in enumerate(found) if n == 0 or name != found[n - 1]]
    return tuple(once), pattern.sub("thing", text)


def _turns(text: str) -> tuple[str, ...]:
    plain = _NO_TURN.sub(" ", _AROUND.sub(" u-turn ", text))
    words = [match.group(1).lower() for match in _TURN.finditer(plain)]
    return tuple("around" if word == "u-turn" else word for word in words)
