"""A stream in a scene becomes trajectories: moves, keyframes and what is told of each."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.navigation.data.keyframes import (
    NOWHERE,
    Mark,
    fault_of_way,
    is_about_turn,
    marks_of,
    path_m,
)
from world2minecraft.navigation.data.pictures import vln_camera
from world2minecraft.navigation.data.planned_walks import standing
from world2minecraft.navigation.data.stream_cleaning import segments_of
from world2minecraft.navigation.language.generation import instructions_of
from world2minecraft.navigation.language.route_events import Seen, Way, way_of
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.values import Instruction, Move, MoveSet, Stance
from world2minecraft.navigation.walk_discretization import (
    DiscreteWalk,
    PathPlanner,
    StepFunction,
    discretize_walk,
)
from world2minecraft.navigation.walk_stream import StreamFrame

LOOK_PX = (96, 54)  # A picture for counting what is in it.
LEAST_SHARE = 0.006  # Of a picture: what is smaller is not seen.
LEAST_TURN_DEG = 30.0  # A smaller turn is a correction that no picture tells.
LEADS_M = 1.0  # On foot: what a text names at its end is no farther from the end.


@dataclass(frozen=True, eq=False)
class Candidate:
    """A way that may become a trajectory, before its pictures."""

    trajectory_id: str
    tour_id: str
    walk: DiscreteWalk
    marks: tuple[Mark, ...]
    way: Way
    instructions: tuple[Instruction, ...]
    path_m: float
    clear: tuple[int, ...]  # keyframes whose next action an instruction tells


class Maker:
    """Makes candidates of the streams of one scene."""

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
        self._landmarks = standing(scene)
        self._camera = vln_camera(*LOOK_PX)
        self.refusals = Counter[str]()

    def candidates(
        self, frames: Sequence[StreamFrame], target_at: Callable[[float], str] | None = None
    ) -> list[Candidate]:
        """Return the trajectories of one tour.

        Args:
            frames: in time's order.
            target_at: the landmark that was being gone to at a time, where that is known.
        """
        segments = segments_of(frames, self._scene.blocks_per_metre)
        made = []
        for number, segment in enumerate(segments):
            target = target_at(segment[-1].t_s) if target_at is not None else ""
            one = self._candidate(segment, number, target)
            if not isinstance(one, str):
                made.append(one)
            elif one != NOWHERE:  # Turning on the spot is no walk.
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
        marks = marks_of(walk, self._move_set, step_m)
        length = path_m(marks, scene.blocks_per_metre)
        apart = scene.distance_m(walk.stances[0].feet, (walk.stances[-1].feet,))
        fault = fault_of_way(marks, length, apart)
        if fault:
            return fault
        way = way_of(self._seen(walk, marks), self._landmarks, target)
        if way.stop and not self._leads(way.stop, walk.stances[-1]):
            way = replace(way, stop="", stop_side="")
        rng = np.random.default_rng([self._seed, *tour_id.encode(), number])
        instructions = tuple(instructions_of(way, rng))
        name = f"{tour_id}_{number:03d}"
        clear = tuple(n for n in range(len(marks)) if self._is_clear(marks, n, way))
        return Candidate(name, tour_id, walk, tuple(marks), way, instructions, length, clear)

    def _is_clear(self, marks: Sequence[Mark], step: int, way: Way) -> bool:
        """Whether what follows a keyframe is told: no correction, no turn that has two sides."""
        mark, turn_deg = marks[step], self._move_set.turn_deg
        if mark.move in (Move.FORWARD, Move.STOP):
            return True
        side = "left" if mark.move == Move.LEFT else "right"
        place_m = self._scene.to_room_m(mark.stance.feet)[:2]
        is_large = mark.run * turn_deg >= LEAST_TURN_DEG
        is_plain = not is_about_turn(marks, step, turn_deg)
        return is_large and is_plain and way.tells_turn(place_m, side)

    def _leads(self, name: str, end: Stance) -> bool:
        """Whether one who knows only the name would come to this end."""
        goals = self._scene.goals_at(self._scene.landmark(name))
        return bool(goals) and self._scene.distance_m(end.feet, goals) <= LEADS_M

    def _seen(self, walk: DiscreteWalk, marks: Sequence[Mark]) -> Seen:
        feet = np.array([stance.feet for stance in walk.stances])
        yaws = np.array([stance.yaw_deg for stance in walk.stances])
        looks = {mark.at: self._look(mark.stance) for mark in marks}
        rooms = [self._room(stance) for stance in walk.stances]
        return Seen(self._scene.to_room_m(feet)[:, :2], yaws, looks, _settled(rooms))

    def _look(self, stance: Stance) -> frozenset[int]:
        drawn = self._scene.picture(stance, self._camera, outputs=("instance",))
        numbers, counts = np.unique(np.asarray(drawn.instance), return_counts=True)
        least = LEAST_SHARE * LOOK_PX[0] * LOOK_PX[1]
        return frozenset(numbers[counts >= least].tolist()) - {0}

    def _room(self, stance: Stance) -> str:
        number = self._scene.room_at(stance.feet)
        return self._scene.rooms[number].name if number >= 0 else ""


def _settled(rooms: Sequence[str]) -> list[str]:
    """Return the rooms' names with places of no room taken for the one before."""
    settled, last = [], next((room for room in rooms if room), "")
    for room in rooms:
        last = room or last
        settled.append(last)
    return settled
