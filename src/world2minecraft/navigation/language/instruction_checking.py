"""Is an instruction that a person wrote one that another could follow? Told while it is written.

What is certainly wrong refuses it: it is empty, too long, or does not name the goal, or names it by
words that mean another thing too. What may be wrong is a hint: other turns than the walk makes, a
length that no instruction of the paper has.
"""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from world2minecraft.navigation.language.human_instructions import MAX_TEXT
from world2minecraft.navigation.language.instruction_parsing import parse_instruction
from world2minecraft.navigation.types import Instruction, Trajectory

PAPER_CHARACTERS = (15, 334)  # The shortest and the longest instruction of the paper's set.


class Finding(NamedTuple):
    """What is to be said of an instruction; ``is_wrong`` refuses it."""

    is_wrong: bool
    text: str


class Mention(NamedTuple):
    """What words of a text mean: one name, or the names of several things."""

    phrase: str
    names: tuple[str, ...]


def goal_name(trajectory: Trajectory) -> str:
    """Return the name of what a walk ends at, as its instructions have it; empty for none."""
    for level in ("goal", "landmark"):
        for one in trajectory.instructions:
            if one.level == level and one.landmarks:
                return one.landmarks[-1]
    return ""


def landmark_names_of(trajectories: Iterable[Trajectory], scene_id: str) -> tuple[str, ...]:
    """Return what things of a scene are called in the instructions of its walks, sorted."""
    own = [one for one in trajectories if one.scene_id == scene_id]
    names = {name for one in own for words in one.instructions for name in words.landmarks}
    return tuple(sorted(names))


def check_instruction(
    text: str, level: str, trajectory: Trajectory, names: Sequence[str]
) -> list[Finding]:
    """Return what is to be said of an instruction, what is wrong first.

    Args:
        text: what was written.
        level: goal, route or landmark.
        trajectory: the walk, with what is told of it already.
        names: what things of its scene are called, see ``landmark_names_of``.

    Raises:
        UsageError: there is no such level.
    """
    Instruction(text.strip() or "-", "human", level)  # Checks the level.
    plain = " ".join(text.split())
    if not plain:
        return [Finding(True, "write something: an instruction has words")]
    if len(plain) > MAX_TEXT:
        return [Finding(True, f"{len(plain):,} characters; at most {MAX_TEXT:,} are kept")]
    spoken = find_mentions(plain, names)
    found = [] if level == "route" else _of_goal(spoken, goal_name(trajectory))
    found += _of_things(spoken, goal_name(trajectory), level)
    found += [] if level == "goal" else _of_turns(plain, trajectory, names)
    return sorted([*found, *_of_length(plain)], key=lambda one: not one.is_wrong)


def find_mentions(text: str, names: Iterable[str]) -> list[Mention]:
    """Return the things that a text speaks of, in its order; the longest phrase counts.

    A thing may be called by its name or by the end of it: "piano" is an upright piano.

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
    return [Finding(True, f"it does not name where the walk ends: the {goal}")]


def _of_things(spoken: Sequence[Mention], goal: str, level: str) -> list[Finding]:
    found = []
    for one in dict.fromkeys(spoken):
        if len(one.names) > 1:
            some = ", ".join(one.names[:4])
            text = f"{len(one.names)} things are called {one.phrase!r} here: say one of {some}"
            found.append(Finding(False, text))
    others = [one for one in spoken if one.names != (goal,)]
    if level == "landmark" and not others:
        found.append(Finding(False, "it names no thing on the way, only where it ends"))
    if level == "route" and spoken:
        found.append(Finding(False, f"a route is told by turns and distances; {spoken[0].phrase!r} "
                             "is a thing"))  # fmt: skip
    return found


def _of_turns(text: str, trajectory: Trajectory, names: Sequence[str]) -> list[Finding]:
    routes = [one.text for one in trajectory.instructions if one.level == "route"]
    if not routes:
        return []
    walked, stated = parse_instruction(routes[0], names).turns, parse_instruction(text, names).turns
    if walked == stated:
        return []
    return [
        Finding(False, f"the walk turns {_turns_text(walked)}; this says {_turns_text(stated)}")
    ]


def _of_length(text: str) -> list[Finding]:
    least, most = PAPER_CHARACTERS
    if least <= len(text) <= most:
        return []
    return [Finding(False, f"{len(text)} characters; the paper's have {least} to {most}")]


def _turns_text(turns: Sequence[str]) -> str:
    return ", ".join(turns) or "nowhere"
