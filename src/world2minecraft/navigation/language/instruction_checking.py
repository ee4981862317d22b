"""Checks of a human-written instruction while it is being written.

An instruction is rejected if it is empty, too long, or does not clearly name the goal. A warning is
given for possible errors, such as turns that differ from those of the walk, or an unusual length.
"""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from world2minecraft.navigation.language.human_instructions import MAX_TEXT
from world2minecraft.navigation.language.instruction_parsing import parse_instruction
from world2minecraft.navigation.types import Instruction, Trajectory

PAPER_CHARACTERS = (15, 334)  # The shortest and the longest instruction of the paper's set.


class Finding(NamedTuple):
    """A remark about an instruction. ``is_wrong`` means that the instruction is rejected."""

    is_wrong: bool
    text: str


class Mention(NamedTuple):
    """A phrase in a text, and the names of the landmarks that it can refer to."""

    phrase: str
    names: tuple[str, ...]


def goal_name(trajectory: Trajectory) -> str:
    """Return the name of the landmark at the end of a walk, or "" if there is none."""
    for level in ("goal", "landmark"):
        for one in trajectory.instructions:
            if one.level == level and one.landmarks:
                return one.landmarks[-1]
    return ""


def landmark_names_of(trajectories: Iterable[Trajectory], scene_id: str) -> tuple[str, ...]:
    """Return the sorted landmark names in the instructions of a scene's walks."""
    own = [one for one in trajectories if one.scene_id == scene_id]
    names = {name for one in own for words in one.instructions for name in words.landmarks}
    return tuple(sorted(names))


def check_instruction(
    text: str, level: str, trajectory: Trajectory, names: Sequence[str]
) -> list[Finding]:
    """Check an instruction, and return remarks with errors first.

    Args:
        text: The instruction.
        level: "goal", "route" or "landmark".
        trajectory: The walk, with its existing instructions.
        names: The landmark names of the scene, as returned by ``landmark_names_of``.

    Raises:
        UsageError: If the level is unknown.
    """
    Instruction(text.strip() or "-", "human", level)  # Checks the level.
    plain = " ".join(text.split())
    if not plain:
        return [Finding(True, "the instruction is empty")]
    if len(plain) > MAX_TEXT:
        return [
            Finding(
                True, f"the instruction has {len(plain):,} characters, the limit is {MAX_TEXT:,}"
            )
        ]
    spoken = find_mentions(plain, names)
    found = [] if level == "route" else _of_goal(spoken, goal_name(trajectory))
    found += _of_things(spoken, goal_name(trajectory), level)
    found += [] if level == "goal" else _of_turns(plain, trajectory, names)
    return sorted([*found, *_of_length(plain)], key=lambda one: not one.is_wrong)


def find_mentions(text: str, names: Iterable[str]) -> list[Mention]:
    """Return the landmarks that a text mentions in order, preferring the longest phrase.

    A landmark can be mentioned by its name or by the last words of it: "piano" matches "upright
    piano".

    Example:
        >>> find_mentions("Pass the red chair, stop at the chair.", ["red chair", "blue chair"])
        [Mention(phrase='red chair', names=('red chair',)), \
Mention(phrase='chair', names=('blue chair', 'red chair'))]
    """
    meant: dict[str, set[str]] = {}
    for name in names:
        words = name.lower().split()
        own = words[: words.index("beside")] if "beside" in words else words
        for phrase in {" ".join(words), *(" ".join(own[n:]) for n in range(len(own)))}:
            meant.setdefault(phrase, set()).add(name)
    if not meant:
        return []
    longest_first = sorted(meant, key=lambda phrase: (-len(phrase), phrase))
    pattern = re.compile(rf"(?<!\w)({'|'.join(map(re.escape, longest_first))})(?!\w)")
    phrases = [match.group(1) for match in pattern.finditer(text.lower())]
    return [Mention(phrase, tuple(sorted(meant[phrase]))) for phrase in phrases]


def _of_goal(spoken: Sequence[Mention], goal: str) -> list[Finding]:
    if not goal or any(one.names == (goal,) for one in spoken):
        return []
    return [Finding(True, f"the instruction must name the goal: the {goal}")]


def _of_things(spoken: Sequence[Mention], goal: str, level: str) -> list[Finding]:
    found = []
    for one in dict.fromkeys(spoken):
        if len(one.names) > 1:
            some = ", ".join(one.names[:4])
            text = f"{one.phrase!r} matches {len(one.names)} landmarks; use one of {some}"
            found.append(Finding(False, text))
    others = [one for one in spoken if one.names != (goal,)]
    if level == "landmark" and not others:
        found.append(
            Finding(False, "the instruction names only the goal, but no landmark on the way")
        )
    if level == "route" and spoken:
        text = f"a route must use only turns and distances, but {spoken[0].phrase!r} is a landmark"
        found.append(Finding(False, text))
    return found


def _of_turns(text: str, trajectory: Trajectory, names: Sequence[str]) -> list[Finding]:
    routes = [one.text for one in trajectory.instructions if one.level == "route"]
    if not routes:
        return []
    walked, stated = parse_instruction(routes[0], names).turns, parse_instruction(text, names).turns
    if walked == stated:
        return []
    return [
        Finding(
            False,
            f"the walk turns {_turns_text(walked)}, but the instruction says {_turns_text(stated)}",
        )
    ]


def _of_length(text: str) -> list[Finding]:
    least, most = PAPER_CHARACTERS
    if least <= len(text) <= most:
        return []
    return [
        Finding(
            False,
            f"the instruction has {len(text)} characters, but those of the paper have {least} to "
            f"{most}",
        )
    ]


def _turns_text(turns: Sequence[str]) -> str:
    return ", ".join(turns) or "nowhere"
