"""Route events of a walk as a person would describe them: turns, segments, passed objects, the end.

Small corrections do not count as turns, and objects that were not visible are not mentioned.
Positions are in metres of the room frame. Turn angles are clockwise from above, positive to the
right.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from world2minecraft.navigation.landmarks import Landmark
from world2minecraft.navigation.walk_discretization import simplify_path
from world2minecraft.navigation.walk_stream import wrap_deg

CORNER_M = 0.3  # Maximum distance of a straight path from a line.
SHORT_M = 0.7  # Shorter segments between two turns are merged with the next.
TURN_DEG = 35.0  # Minimum angle of a turn that is mentioned.
CORNER_AT_M = 0.6  # Maximum distance between a turn of the moves and a turn of the route.
AHEAD_DEG = 15.0  # Maximum angle between the heading and a landmark ahead.
FAR_M = 7.0  # Maximum distance of a landmark ahead.
SIDE_M = (0.1, 1.8)  # Distances of passed landmarks from the path.
AT_M = 1.0  # Maximum distance of the landmark at a turn.
STOP_M = 1.3  # Maximum distance of the landmark at the end.
FRONT_DEG = 35.0  # Maximum angle of a landmark in front of the walker at the end.


@dataclass(frozen=True)
class RouteSegment:
    """A turn on the spot followed by a straight path. Landmark names are "" if there is none.

    Attributes:
        turn_deg: The turn angle in degrees, positive to the right.
        length_m: The length of the straight path in metres.
        at: The landmark at the turn.
        towards: The landmark ahead.
        passing: The passed landmarks in order, each with its side.
        into: The name of the room that is entered.
    """

    turn_deg: float
    length_m: float
    at: str = ""
    towards: str = ""
    passing: tuple[tuple[str, str], ...] = ()
    into: str = ""


@dataclass(frozen=True)
class Route:
    """The segments of a walk, the last turn, and the landmark at its end.

    Attributes:
        stretches: The segments in order.
        last_turn_deg: The angle of the turn at the end, positive to the right.
        stop: The landmark at the end.
        stop_side: The side of that landmark, "front", "left" or "right".
        corners_m: The position of each turn, including the last one.
    """

    stretches: tuple[RouteSegment, ...]
    last_turn_deg: float
    stop: str = ""
    stop_side: str = ""
    corners_m: tuple[tuple[float, float], ...] = ()

    def tells_turn(self, place_m: np.ndarray, side: str) -> bool:
        """Return whether the route describes a turn to a side at a position [2] of the room."""
        every = [one.turn_deg for one in self.stretches] + [self.last_turn_deg]
        return any(
            abs(turn) >= TURN_DEG
            and side_of_turn(turn) == side
            and float(np.hypot(corner[0] - place_m[0], corner[1] - place_m[1])) <= CORNER_AT_M
            for turn, corner in zip(every, self.corners_m, strict=True)
        )

    @property
    def turns(self) -> tuple[str, ...]:
        """The mentioned turns: left, right or around."""
        every = [one.turn_deg for one in self.stretches] + [self.last_turn_deg]
        return tuple(side_of_turn(turn) for turn in every if abs(turn) >= TURN_DEG)

    @property
    def length_m(self) -> float:
        """The total length of the segments in metres."""
        return sum(one.length_m for one in self.stretches)


@dataclass(frozen=True, eq=False)
class ObservedWalk:
    """A walk of N stances with the landmarks visible at some of them.

    Attributes:
        places_m: The positions in metres of the room as float64 [N, 2].
        yaws_deg: The game's yaws in degrees as float64 [N].
        looks: The IDs of the visible landmarks, by the index of the stance.
        rooms: The name of the room at each stance, or "" if unknown.
    """

    places_m: np.ndarray
    yaws_deg: np.ndarray
    looks: dict[int, frozenset[int]]
    rooms: Sequence[str] = field(default_factory=tuple)


def describe_route(walk: ObservedWalk, landmarks: Sequence[Landmark], target: str = "") -> Route:
    """Return the route events of a walk.

    Args:
        walk: The stances and the visible landmarks.
        landmarks: The landmarks to mention, which should have unambiguous names.
        target: The intended landmark, if known. It becomes the end if the walk stops in front of
            it. Otherwise the nearest visible landmark does.
    """
    corners = _merge_corners(walk.places_m, list(simplify_path(walk.places_m, CORNER_M)))
    yaws = np.unwrap(walk.yaws_deg, period=360.0)  # A left turn of 190 degrees remains a left turn.
    stretches, before, used = [], float(yaws[0]), set[str]()
    for first, last in _pairs(corners):
        heading = _heading(walk.places_m[first], walk.places_m[last])
        walked = float(yaws[(first + last + 1) // 2])
        heading = walked + float(wrap_deg(heading - walked))
        turn = heading - before
        stretch = _stretch(walk, landmarks, first, last, turn, used, target)
        used |= {stretch.at, stretch.towards, *(name for name, _ in stretch.passing)} - {""}
        stretches.append(stretch)
        before = heading
    last_turn = float(yaws[-1]) - before
    stop, side = _stop(walk, landmarks, target)
    places = [walk.places_m[n] for n in corners]
    where = tuple((float(x), float(y)) for x, y in places)
    return Route(tuple(stretches), last_turn, stop, side, where)


def side_of_turn(turn_deg: float) -> str:
    """Return the word for a turn angle.

    Example:
        >>> [side_of_turn(turn) for turn in (-90, 40, 170)]
        ['left', 'right', 'around']
    """
    if abs(turn_deg) > 150:
        return "around"
    return "right" if turn_deg > 0 else "left"


def _pairs(corners: Sequence[int]) -> list[tuple[int, int]]:
    return list(pairwise(corners))


def _merge_corners(places: np.ndarray, corners: list[int]) -> list[int]:
    """Remove corners with small turns, and corners of very short segments."""
    while len(corners) > 2:
        lengths = [float(np.linalg.norm(places[b] - places[a])) for a, b in _pairs(corners)]
        headings = [_heading(places[a], places[b]) for a, b in _pairs(corners)]
        turns = np.abs(wrap_deg(np.diff(headings)))
        if turns.min() < TURN_DEG:
            del corners[1 + int(turns.argmin())]
        elif min(lengths) < SHORT_M:
            shortest = int(np.argmin(lengths))
            del corners[max(1, min(shortest, len(corners) - 2))]
        else:
            break
    return corners


def _heading(begin: np.ndarray, end: np.ndarray) -> float:
    """Return the game's yaw of a direction in the room: yaw 0 looks along -y, 90 along -x."""
    x, y = end - begin
    return float(np.degrees(np.arctan2(-x, -y)))


def _stretch(
    walk: ObservedWalk,
    landmarks: Sequence[Landmark],
    first: int,
    last: int,
    turn_deg: float,
    used: set[str],
    target: str,
) -> RouteSegment:
    begin, end = walk.places_m[first], walk.places_m[last]
    length = float(np.linalg.norm(end - begin))
    before = _seen_between(walk, 0, first)
    during = _seen_between(walk, first, last)
    at = _turn_at(begin, [one for one in landmarks if one.number in before], used)
    fresh = [one for one in landmarks if one.name != at and one.number in during]
    ahead = _ahead(begin, end, [one for one in fresh if one.name not in used - {target}])
    passing = [] if length < SHORT_M else _passed(begin, end, fresh, {ahead, *used})
    into = ""
    if walk.rooms and walk.rooms[last] != walk.rooms[first]:
        into = walk.rooms[last]
    return RouteSegment(
        turn_deg, length, at if first and abs(turn_deg) >= TURN_DEG else "", ahead,
        tuple(passing), into,
    )  # fmt: skip


def _seen_between(walk: ObservedWalk, first: int, last: int) -> frozenset[int]:
    """Return the landmarks visible at stances from ``first`` up to, but excluding, ``last``."""
    seen = [look for at, look in walk.looks.items() if first <= at < max(last, first + 1)]
    return frozenset().union(*seen)


def _turn_at(place: np.ndarray, seen: Sequence[Landmark], used: set[str]) -> str:
    near = [(gap_m(place, one), one.name) for one in seen if one.name not in used]
    return min(near)[1] if near and min(near)[0] <= AT_M else ""


def _ahead(begin: np.ndarray, end: np.ndarray, seen: Sequence[Landmark]) -> str:
    """Return the landmark straight ahead that is not reached before the segment ends, or ""."""
    found = []
    length = np.linalg.norm(end - begin)
    for one in seen:
        away = float(np.linalg.norm(one.center_m[:2] - begin))
        off = abs(wrap_deg(_heading(begin, one.center_m[:2]) - _heading(begin, end)))
        if length - 0.2 <= away <= FAR_M and off <= AHEAD_DEG:
            found.append((away, one.name))
    return min(found)[1] if found else ""


def _passed(
    begin: np.ndarray, end: np.ndarray, seen: Sequence[Landmark], left_out: set[str]
) -> list[tuple[str, str]]:
    """Return the landmarks beside the middle part of a segment, each with its side."""
    along = (end - begin) / np.linalg.norm(end - begin)
    left = np.array([-along[1], along[0]])
    found = []
    for one in seen:
        low, high = one.low_m[:2] - begin, one.high_m[:2] - begin
        box = np.array([[x, y] for x in (low[0], high[0]) for y in (low[1], high[1])])
        far, aside = box @ along, box @ left
        middle = float(far.mean()) / float(np.linalg.norm(end - begin))
        near = float(np.abs(aside).min())
        crosses = aside.min() < 0 < aside.max()
        if one.name in left_out or crosses or not 0.2 <= middle <= 0.85:
            continue
        if SIDE_M[0] <= near <= SIDE_M[1]:
            found.append((middle, one.name, "left" if aside.mean() > 0 else "right"))
    return [(name, side) for _, name, side in sorted(found)]


def _stop(walk: ObservedWalk, landmarks: Sequence[Landmark], target: str) -> tuple[str, str]:
    place, yaw = walk.places_m[-1], float(walk.yaws_deg[-1])
    seen = walk.looks.get(len(walk.places_m) - 1, frozenset())
    found = []
    for one in landmarks:
        gap, off = gap_m(place, one), _off_deg(place, yaw, one)
        if gap <= STOP_M and one.number in seen:
            found.append((one.name != target, abs(off) > FRONT_DEG, gap, one.name, off))
    if not found:
        return "", ""
    _, aside, _, name, off = min(found)
    return name, ("right" if off > 0 else "left") if aside else "front"


def gap_m(place: np.ndarray, landmark: Landmark) -> float:
    """Return the horizontal distance in metres from a position [2] to a landmark's box."""
    low, high = landmark.low_m[:2], landmark.high_m[:2]
    return float(np.linalg.norm(np.maximum(0.0, np.maximum(low - place, place - high))))


def _off_deg(place: np.ndarray, yaw_deg: float, landmark: Landmark) -> float:
    """Return the angle from straight ahead to a landmark in degrees, positive to the right."""
    near = np.clip(place, landmark.low_m[:2], landmark.high_m[:2])
    point = (near + landmark.center_m[:2]) / 2
    return float(wrap_deg(_heading(place, point) - yaw_deg))
