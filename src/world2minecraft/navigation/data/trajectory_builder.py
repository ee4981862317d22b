"""Conversion of pose streams into trajectories with moves, keyframes and instructions."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.navigation.data.keyframes import (
    NO_MOVEMENT,
    KeyframeMark,
    find_keyframes,
    is_turn_around,
    path_fault,
    path_length_m,
)
from world2minecraft.navigation.data.picture_store import vln_camera
from world2minecraft.navigation.data.planned_walks import floor_landmarks
from world2minecraft.navigation.data.stream_segmentation import split_into_walks
from world2minecraft.navigation.language.instruction_generation import generate_instructions
from world2minecraft.navigation.language.route_events import ObservedWalk, Route, describe_route
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import Instruction, Move, MoveSet, Stance
from world2minecraft.navigation.walk_discretization import (
    DiscreteWalk,
    PathPlanner,
    StepFunction,
    discretize_walk,
)
from world2minecraft.navigation.walk_stream import StreamFrame

PREVIEW_PX = (96, 54)  # Of images in which visible landmarks are counted.
MIN_SHARE = 0.006  # Minimum share of the image of a visible landmark.
MIN_TURN_DEG = 30.0  # Smaller turns are corrections that the images do not reveal.
MAX_TARGET_M = 1.0  # Maximum walking distance from the end to the landmark named there.


@dataclass(frozen=True, eq=False)
class Candidate:
    """A candidate for a trajectory, before its images are rendered."""

    trajectory_id: str
    tour_id: str
    walk: DiscreteWalk
    marks: tuple[KeyframeMark, ...]
    way: Route
    instructions: tuple[Instruction, ...]
    path_length_m: float
    clear: tuple[int, ...]  # keyframes whose next action follows from the instruction


class TrajectoryBuilder:
    """A builder of candidate trajectories from the streams of one scene."""

    def __init__(
        self,
        scene: VlnScene,
        move_set: MoveSet,
        walker: StepFunction,
        guide: PathPlanner | None = None,
        seed: int = 0,
    ):
        self._scene, self._move_set, self._seed = scene, move_set, seed
        self._walker, self._guide = walker, guide
        self._landmarks = floor_landmarks(scene)
        self._camera = vln_camera(*PREVIEW_PX)
        self.refusals = Counter[str]()

    def candidates(
        self, frames: Sequence[StreamFrame], target_at: Callable[[float], str] | None = None
    ) -> list[Candidate]:
        """Return the candidate trajectories of one tour, and count the rejected ones.

        Args:
            frames: The frames sorted by time.
            target_at: A function from a time to the approached landmark, if known.
        """
        segments = split_into_walks(frames, self._scene.blocks_per_metre)
        made = []
        for number, segment in enumerate(segments):
            target = target_at(segment[-1].t_s) if target_at is not None else ""
            one = self._candidate(segment, number, target)
            if not isinstance(one, str):
                made.append(one)
            elif one != NO_MOVEMENT:  # Turning on the spot is not counted as a walk.
                self.refusals[one] += 1
        return made

    def _candidate(
        self, segment: Sequence[StreamFrame], number: int, target: str
    ) -> Candidate | str:
        scene, tour_id = self._scene, segment[0].tour_id
        walk = discretize_walk(
            segment, self._move_set, scene.blocks_per_metre, self._walker, self._guide
        )
        if walk.refusal:
            return walk.refusal
        step_m = self._move_set.forward_m or scene.metres_per_block
        marks = find_keyframes(walk, self._move_set, step_m)
        length = path_length_m(marks, scene.blocks_per_metre)
        apart_m = scene.distance_m(walk.stances[0].feet, (walk.stances[-1].feet,))
        fault = path_fault(marks, length, apart_m)
        if fault:
            return fault
        way = describe_route(self._seen(walk, marks), self._landmarks, target)
        if way.stop and not self._leads(way.stop, walk.stances[-1]):
            way = replace(way, stop="", stop_side="")
        rng = np.random.default_rng([self._seed, *tour_id.encode(), number])
        instructions = tuple(generate_instructions(way, rng))
        name = f"{tour_id}_{number:03d}"
        clear = tuple(n for n in range(len(marks)) if self._is_clear(marks, n, way))
        return Candidate(name, tour_id, walk, tuple(marks), way, instructions, length, clear)

    def _is_clear(self, marks: Sequence[KeyframeMark], step: int, way: Route) -> bool:
        """Return whether the instruction determines the next action of a keyframe."""
        mark, turn_deg = marks[step], self._move_set.turn_deg
        if mark.move in (Move.FORWARD, Move.STOP):
            return True
        side = "left" if mark.move == Move.LEFT else "right"
        place_m = self._scene.to_room_m(mark.stance.feet)[:2]
        is_large = mark.run * turn_deg >= MIN_TURN_DEG
        is_plain = not is_turn_around(marks, step, turn_deg)
        return is_large and is_plain and way.tells_turn(place_m, side)

    def _leads(self, name: str, end: Stance) -> bool:
        """Return whether the name of the landmark alone would lead to this end position."""
        goals = self._scene.goals_at(self._scene.landmark(name))
        return bool(goals) and self._scene.distance_m(end.feet, goals) <= MAX_TARGET_M

    def _seen(self, walk: DiscreteWalk, marks: Sequence[KeyframeMark]) -> ObservedWalk:
        feet = np.array([stance.feet for stance in walk.stances])
        yaws = np.array([stance.yaw_deg for stance in walk.stances])
        looks = {mark.at: self._look(mark.stance) for mark in marks}
        rooms = [self._room(stance) for stance in walk.stances]
        return ObservedWalk(self._scene.to_room_m(feet)[:, :2], yaws, looks, _settled(rooms))

    def _look(self, stance: Stance) -> frozenset[int]:
        drawn = self._scene.picture(stance, self._camera, outputs=("instance",))
        numbers, counts = np.unique(np.asarray(drawn.instance), return_counts=True)
        least = MIN_SHARE * PREVIEW_PX[0] * PREVIEW_PX[1]
        return frozenset(numbers[counts >= least].tolist()) - {0}

    def _room(self, stance: Stance) -> str:
        number = self._scene.room_at(stance.feet)
        return self._scene.rooms[number].name if number >= 0 else ""


def _settled(rooms: Sequence[str]) -> list[str]:
    """Return the room names, with gaps outside rooms filled by the previous room."""
    settled, last = [], next((room for room in rooms if room), "")
    for room in rooms:
        last = room or last
        settled.append(last)
    return settled
