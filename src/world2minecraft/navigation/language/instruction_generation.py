"""Generation of instructions from route events on three levels: goal, route and landmark.

Examples of the levels::

    goal      Go to the piano.
    route     Turn left and walk about three metres. Turn right, take a few steps and stop.
    landmark  Turn left and walk past the table on your right. Turn right at the sofa, walk to the
              piano and stop in front of it.

A random generator varies the wording. ``instruction_parsing`` recovers the same turns and landmarks
from the text.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.navigation.language.route_events import (
    TURN_DEG,
    Route,
    RouteSegment,
    side_of_turn,
)
from world2minecraft.navigation.types import LEVELS, Instruction

_NUMBERS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
SLIGHT_DEG, SHARP_DEG = 55.0, 125.0
STEPS_M = (0.9, 2.3)  # Lengths up to "a step" and "a few steps"; longer ones are in metres.
MAX_PASSED = 2


def generate_instructions(way: Route, rng: np.random.Generator) -> list[Instruction]:
    """Return the instructions of a route. Levels that require landmarks are omitted without them.

    Args:
        way: The route.
        rng: The random generator for the wording.
    """
    made = [goal_text(way, rng), route_text(way, rng), landmark_text(way, rng)]
    return [
        Instruction(text, level=level, landmarks=names)
        for level, (text, names) in zip(LEVELS, made, strict=True)
        if text
    ]


TextAndLandmarks = tuple[str, tuple[str, ...]]
"""A text and the landmarks that it names in order."""


def goal_text(way: Route, rng: np.random.Generator) -> TextAndLandmarks:
    """Return an instruction that names only the goal, or "" if there is no landmark at the end."""
    if not way.stop:
        return "", ()
    choices = [f"Go to the {way.stop}.", f"Walk to the {way.stop}."]
    if way.stop_side == "front":
        choices.append(f"Find the {way.stop} and stop in front of it.")
    return choices[rng.integers(len(choices))], (way.stop,)


def route_text(way: Route, rng: np.random.Generator) -> TextAndLandmarks:
    """Return an instruction with turns and distances only."""
    parts = [[*_turn(one.turn_deg), _distance(one.length_m, rng)] for one in way.stretches]
    parts[-1] += [*_turn(way.last_turn_deg), "stop"]
    return _sentences(parts, rng), ()


def landmark_text(way: Route, rng: np.random.Generator) -> TextAndLandmarks:
    """Return a route description based on landmarks, or "" if it mentions none."""
    parts, names = [], []
    for number, one in enumerate(way.stretches):
        is_last = number == len(way.stretches) - 1
        words, named_landmarks = _stretch(
            one, way.stop if is_last and way.stop_side == "front" else "", rng
        )
        parts.append(words)
        names += named_landmarks
    named = parts[-1][-1].endswith(f" to the {way.stop}") if way.stop else False
    stop = _stop(way, named)
    parts[-1] += stop
    names += [way.stop] if way.stop else []
    once = tuple(name for n, name in enumerate(names) if n == 0 or name != names[n - 1])
    return (_sentences(parts, rng), once) if once else ("", ())


def _turn(turn_deg: float, at: str = "") -> list[str]:
    """Return the phrase for a turn, or an empty list for an insignificant turn."""
    if abs(turn_deg) < TURN_DEG:
        return []
    side = side_of_turn(turn_deg)
    how = "slightly " if abs(turn_deg) < SLIGHT_DEG else "sharply " if _is_sharp(turn_deg) else ""
    words = f"turn {how}{side}" if side != "around" else "turn around"
    return [f"{words} at the {at}" if at else words]


def _is_sharp(turn_deg: float) -> bool:
    return abs(turn_deg) > SHARP_DEG


def _distance(length_m: float, rng: np.random.Generator) -> str:
    if length_m < STEPS_M[0]:
        return "take a step forward"
    if length_m < STEPS_M[1]:
        return ("take a few steps forward", "walk a few steps")[rng.integers(2)]
    metres = round(length_m)
    word = _NUMBERS[metres] if metres < len(_NUMBERS) else str(metres)
    verb = ("walk", "walk forward", "walk straight on for", "go forward")[rng.integers(4)]
    return f"{verb} about {word} metres"


def _stretch(one: RouteSegment, stop: str, rng: np.random.Generator) -> tuple[list[str], list[str]]:
    """Return the clauses of a route segment, and the landmarks that they name."""
    turn = _turn(one.turn_deg, one.at)
    names = [one.at] if one.at and turn else []
    passing = one.passing[:MAX_PASSED]
    into = _room(one.into)
    if passing:
        walk = f"{('walk', 'go')[rng.integers(2)]} past {_sides(passing)}"
        names += [name for name, _ in passing]
        walk += f" {into}" if into else ""
        return [*turn, walk], names
    if one.towards and one.towards == stop and not into:
        return [*turn, f"{('walk', 'go')[rng.integers(2)]} to the {stop}"], [*names, stop]
    if into:
        return [*turn, f"{('go', 'walk')[rng.integers(2)]} {into}"], names
    if one.towards:
        verb = ("walk towards", "head for")[rng.integers(2)]
        return [*turn, f"{verb} the {one.towards}"], [*names, one.towards]
    return [*turn, _distance(one.length_m, rng)], names


def _sides(passing: Sequence[tuple[str, str]]) -> str:
    things = [f"the {name}" for name, _ in passing]
    sides = [f" on your {side}" for _, side in passing]
    if len(set(sides)) == 1:
        return f"{' and '.join(things)}{sides[0]}"
    return " and ".join(f"{thing}{side}" for thing, side in zip(things, sides, strict=True))


def _room(name: str) -> str:
    """Return the phrase for entering a room. Numbered rooms become "the next room"."""
    if not name:
        return ""
    plain = not name[-1].isdigit() and name != "room"
    return f"into the {name}" if plain else "into the next room"


def _stop(way: Route, named: bool) -> list[str]:
    """Return the final clauses. With ``named``, the previous clause names the final landmark."""
    turn = _turn(way.last_turn_deg)
    thing = "it" if named else f"the {way.stop}"
    if not way.stop:
        return [*turn, "stop"]
    if way.stop_side == "front":
        return [f"{turn[0]} to face {thing}", "stop"] if turn else [f"stop in front of {thing}"]
    return [*turn, f"stop with {thing} on your {way.stop_side}"]


def _sentences(parts: Sequence[Sequence[str]], rng: np.random.Generator) -> str:
    """Join clauses into sentences, combining short segments."""
    sentences, begun = [], []
    for number, part in enumerate(parts):
        begun += part
        if len(begun) >= 3 or number == len(parts) - 1:
            sentences.append(_joined(begun))
            begun = []
    first, *rest = sentences
    following = [f"Then {one}" if rng.random() < 0.4 else one[0].upper() + one[1:] for one in rest]
    return " ".join(f"{one}." for one in [first[0].upper() + first[1:], *following])


def _joined(clauses: Sequence[str]) -> str:
    if len(clauses) == 1:
        return clauses[0]
    return f"{', '.join(clauses[:-1])} and {clauses[-1]}"
