"""Conversion of a recorded walk into discrete moves that end where the walk ended.

The path is simplified to its corners (Ramer-Douglas-Peucker), which are approached one after the
other from the position reached so far, so that errors are corrected by later moves instead of
accumulating. Each move is simulated with the world's physics (``StepFunction``). A walk that
collides, or that ends elsewhere, is rejected.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.navigation.types import Move, MoveSet, Stance
from world2minecraft.navigation.walk_stream import StreamFrame, feet_m, wrap_deg

EPSILON_M = 0.25  # The length of a move; smaller deviations cannot be walked.
DISCRETIZATION_VERSION = "corners-1"  # Recorded with the moves.
SLACK_M = 0.1  # Of the end, in addition to half a step.
CLOSENESS_M = (EPSILON_M, 0.1)  # Distance within which a corner is passed without a turn.
MEETING_M = 0.15  # Distance within which the end is reached without a turn.
MAX_MOVES = 500


def simplify_path(path: np.ndarray, epsilon: float = EPSILON_M) -> np.ndarray:
    """Return the ascending indices of the points that approximate a path to within ``epsilon``.

    Args:
        path: The path as float64 [N, 2] with N at least 1.
        epsilon: The maximum distance of an omitted point from the simplified path.

    Example:
        >>> simplify_path(np.array([[0, 0], [1, 0.01], [2, 0], [2, 3]]), 0.25).tolist()
        [0, 2, 3]
    """
    retained = np.zeros(len(path), bool)
    retained[[0, -1]] = True
    open_spans = [(0, len(path) - 1)]
    while open_spans:
        first, last = open_spans.pop()
        if last - first < 2:
            continue
        away = _distances_from_segment(path[first + 1 : last], path[first], path[last])
        farthest = int(away.argmax())
        if away[farthest] > epsilon:
            middle = first + 1 + farthest
            retained[middle] = True
            open_spans += [(first, middle), (middle, last)]
    return np.flatnonzero(retained)


def _distances_from_segment(points: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the distance of each point to a line segment."""
    along = end - begin
    length2 = float(along @ along)
    if length2 == 0:
        return np.linalg.norm(points - begin, axis=1)
    share = np.clip((points - begin) @ along / length2, 0, 1)
    return np.linalg.norm(points - begin - share[:, None] * along, axis=1)


StepFunction = Callable[[Stance, Move], tuple[Stance, bool]]
"""Return the stance after a move, and whether the move collided."""

PathPlanner = Callable[[Stance, tuple[float, float, float]], Sequence[Move]]
"""Return the moves from a stance to a position in world blocks, or no moves without a path."""


@dataclass(frozen=True)
class DiscreteWalk:
    """The moves of a walk and the stances between them, or the reason why it was rejected."""

    moves: tuple[Move, ...] = ()
    stances: tuple[Stance, ...] = ()
    refusal: str = ""


def discretize_walk(
    segment: Sequence[StreamFrame],
    move_set: MoveSet,
    blocks_per_metre: float,
    walker: StepFunction,
    guide: PathPlanner | None = None,
) -> DiscreteWalk:
    """Convert a walk segment to moves with STOP at the end, or to a rejected walk with a reason.

    The result ends within half a step plus 0.1 m of the recorded end, and within half a turn of its
    heading. If moves along the corners collide, the corners are followed more closely. If that also
    fails, the moves of ``guide`` to the same end are tried.

    Args:
        segment: A walk from ``split_into_walks``.
        move_set: The move set. If its ``forward_m`` is 0, a step is one block.
        blocks_per_metre: The scale of the world.
        walker: The physics of the world.
        guide: A planner of moves from a stance to a position.
    """
    path = feet_m(segment, blocks_per_metre)[:, [0, 2]]
    refusal = ""
    for closeness_m in CLOSENESS_M:
        follower = _CornerFollower(segment[0].stance, move_set, blocks_per_metre, walker)
        corners = path[simplify_path(path, closeness_m)]
        for number, corner in enumerate(corners[1:], 2):
            is_last = number == len(corners)
            follower.go_to(corner, min(closeness_m, MEETING_M) if is_last else closeness_m, is_last)
        walk = _finished(follower, segment, path[-1])
        if not walk.refusal:
            return walk
        refusal = refusal or walk.refusal
    if guide is None:
        return DiscreteWalk(refusal=refusal)
    follower = _CornerFollower(segment[0].stance, move_set, blocks_per_metre, walker)
    follower.make(guide(follower.stance, segment[-1].stance.feet))
    walk = _finished(follower, segment, path[-1])
    return walk if not walk.refusal else DiscreteWalk(refusal=refusal)


def _finished(
    follower: "_CornerFollower", segment: Sequence[StreamFrame], end_m: np.ndarray
) -> DiscreteWalk:
    yaw_deg = segment[-1].stance.yaw_deg
    follower.face(yaw_deg)
    refusal = follower.refusal or _end_mismatch(follower, end_m, yaw_deg)
    if refusal:
        return DiscreteWalk(refusal=refusal)
    return DiscreteWalk((*follower.moves, Move.STOP), tuple(follower.stances))


def _end_mismatch(follower: "_CornerFollower", end_m: np.ndarray, yaw_deg: float) -> str:
    """Return how the end differs from the recorded one, or ""."""
    away_m = float(np.linalg.norm(follower.place_m - end_m))
    turn_deg = abs(float(wrap_deg(yaw_deg - follower.stance.yaw_deg)))
    if away_m > follower.step_m / 2 + SLACK_M:
        return "ends at another position"
    return "ends with another heading" if turn_deg > follower.turn_deg / 2 + 1e-6 else ""


class _CornerFollower:
    """A walker that follows corners with discrete moves."""

    def __init__(
        self,
        start: Stance,
        move_set: MoveSet,
        blocks_per_metre: float,
        walker: StepFunction,
    ):
        level = Stance(start.x, start.y, start.z, start.yaw_deg)
        self.stances, self.moves, self.refusal = [level], [], ""
        self.step_m = move_set.forward_m or 1 / blocks_per_metre
        self.turn_deg = move_set.turn_deg
        self._blocks_per_metre, self._walker = blocks_per_metre, walker

    @property
    def stance(self) -> Stance:
        return self.stances[-1]

    @property
    def place_m(self) -> np.ndarray:
        return np.array([self.stance.x, self.stance.z]) / self._blocks_per_metre

    def go_to(self, corner_m: np.ndarray, passing_m: float, is_last: bool) -> None:
        """Walk to a corner until no further step would get closer."""
        near_m = self.step_m * (0.5 if is_last else 1.0)
        while not self.refusal:
            ahead = corner_m - self.place_m
            if np.linalg.norm(ahead) <= near_m:
                return
            self._aim(ahead, passing_m)
            yaw = np.radians(self.stance.yaw_deg)
            forward = self.step_m * np.array([-np.sin(yaw), np.cos(yaw)])
            if np.linalg.norm(ahead - forward) >= np.linalg.norm(ahead):
                return
            self._make(Move.FORWARD)

    def make(self, moves: Sequence[Move]) -> None:
        """Make the given moves except STOP."""
        for move in moves:
            if move != Move.STOP:
                self._make(move)

    def _aim(self, ahead_m: np.ndarray, passing_m: float) -> None:
        """Turn to a target, unless the current heading already passes it closely enough."""
        yaw_deg = float(np.degrees(np.arctan2(-ahead_m[0], ahead_m[1])))
        off = np.radians(float(wrap_deg(yaw_deg - self.stance.yaw_deg)))
        if np.cos(off) < 0 or abs(np.sin(off)) * np.linalg.norm(ahead_m) > passing_m:
            self.face(yaw_deg)

    def face(self, yaw_deg: float) -> None:
        """Turn to the closest heading that whole turns can reach."""
        off_deg = float(wrap_deg(yaw_deg - self.stance.yaw_deg))
        turns = int(np.floor(abs(off_deg) / self.turn_deg + 0.5 - 1e-9))
        for _ in range(turns):
            self._make(Move.RIGHT if off_deg > 0 else Move.LEFT)

    def _make(self, move: Move) -> None:
        if self.refusal or len(self.moves) >= MAX_MOVES:
            self.refusal = self.refusal or f"more than {MAX_MOVES} moves"
            return
        stance, collided = self._walker(self.stance, move)
        if collided:
            self.refusal = "collision"
        self.moves.append(move)
        self.stances.append(stance)
