"""Trajectories, questions and episodes of a single scene."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

from world2minecraft.core.types import Camera
from world2minecraft.navigation.data.distractors import DistractorSampler, RankBalancer
from world2minecraft.navigation.data.keyframes import picture_fault
from world2minecraft.navigation.data.picture_store import (
    EncodedPicture,
    PictureStore,
    StoredPicture,
    encode_picture,
    vln_camera,
)
from world2minecraft.navigation.data.planned_walks import TourPlanner
from world2minecraft.navigation.data.tasks import (
    GRADE_SHARES,
    GRADES,
    ViewQuestion,
    action_steps,
    view_question,
    view_steps,
)
from world2minecraft.navigation.data.trajectory_builder import Candidate, TrajectoryBuilder
from world2minecraft.navigation.moves import apply_move
from world2minecraft.navigation.oracle import ORACLE_VERSION, plan_expert_path
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.types import (
    LEVELS,
    MOVE_SETS,
    Episode,
    Instruction,
    Keyframe,
    Move,
    MoveSet,
    Stance,
    Trajectory,
)
from world2minecraft.navigation.walk_discretization import (
    DISCRETIZATION_VERSION,
    PathPlanner,
    StepFunction,
)
from world2minecraft.navigation.walk_stream import StreamFrame

WalkCallback = Callable[[int], None]
"""Called with the number of additional walks."""

WALK_VERSION = f"{DISCRETIZATION_VERSION}+{ORACLE_VERSION}"
PREVIEW_PX = (64, 36)  # Of images that are only compared.
MAX_RECORDED_WALKS = 100_000  # Walks of one scene.
MAX_TOURS = 60  # Planned tours of a scene.


@dataclass(frozen=True)
class SceneRule:
    """The options for building the items of a scene.

    Attributes:
        trajectories: The number of trajectories.
        views: The maximum number of Next-View questions per trajectory.
        move_set: The name of the move set.
        levels: The shares of goal, route and landmark instructions.
        balanced: Whether each trajectory has one Next-Action question per action.
        size_px: The image size, width and height.
        seed: The random seed.
    """

    trajectories: int = 24
    views: int = 3
    move_set: str = "vlnce"
    levels: tuple[float, float, float] = (0.15, 0.25, 0.6)
    balanced: bool = True
    size_px: tuple[int, int] = (640, 360)
    seed: int = 0


@dataclass
class SceneItems:
    """The trajectories, questions and episodes of a scene.

    Questions and images are grouped by trajectory ID.
    """

    scene_id: str
    composition: str
    metres_per_block: float
    names: tuple[str, ...] = ()  # of the landmarks
    trajectories: list[Trajectory] = field(default_factory=list)
    spoken: dict[str, Instruction] = field(default_factory=dict)  # the instruction of the items
    pictures: dict[str, list[StoredPicture]] = field(default_factory=dict)
    views: list[ViewQuestion] = field(default_factory=list)
    actions: dict[str, list[int]] = field(default_factory=dict)
    episodes: list[Episode] = field(default_factory=list)
    refused: Counter[str] = field(default_factory=Counter)
    tours: int = 0


def scene_step_function(scene: VlnScene, move_set: MoveSet) -> StepFunction:
    """Return a function that applies moves with the physics of a scene."""
    return partial(apply_move, scene, move_set=move_set)


def scene_path_planner(scene: VlnScene, move_set: MoveSet) -> PathPlanner:
    """Return a function that plans expert paths in a scene."""

    def moves(stance: Stance, end: tuple[float, float, float]) -> tuple[Move, ...]:
        way = plan_expert_path(scene, stance, (end,), move_set)
        return way.moves if way is not None else ()

    return moves


def build_scene_items(
    scene: VlnScene,
    folder: Path,
    composition: str,
    scene_split: str,
    rule: SceneRule,
    tick: WalkCallback = lambda _: None,
    recorded: Sequence[Sequence[StreamFrame]] = (),
) -> SceneItems:
    """Walk through a scene until it has the requested number of trajectories.

    Args:
        scene: The scene.
        folder: The folder of the set. Images are written below it.
        composition: "base" or "extend".
        scene_split: "train" or "val_unseen".
        rule: The options, such as the number of trajectories.
        tick: Called with the number of new walks.
        recorded: Recorded tours. If given, all their walks are used and no tours are planned.

    Raises:
        OutputError: If an image cannot be written.
    """
    move_set = MOVE_SETS[rule.move_set]
    walker = scene_step_function(scene, move_set)
    maker = TrajectoryBuilder(
        scene, move_set, walker, scene_path_planner(scene, move_set), rule.seed
    )
    names = tuple(sorted(one.name for one in scene.landmarks))
    work = SceneItems(scene.scene_id, composition, scene.metres_per_block, names)
    crew = _TrajectoryRecorder(scene, folder, scene_split, rule, walker, work)
    most = MAX_RECORDED_WALKS if recorded else rule.trajectories
    for frames, target_at, rng in _recorded(recorded, rule) if recorded else _tours(scene, rule):
        work.tours += 1
        for candidate in maker.candidates(frames, target_at):
            if len(work.trajectories) == most:
                break
            tick(crew.take_in(candidate, rng))
        if len(work.trajectories) == most:
            break
    work.refused += maker.refusals
    return work


TourInput = tuple[Sequence[StreamFrame], Callable[[float], str] | None, np.random.Generator]
"""The frames of a tour, a function from time to the approached landmark, and a random generator."""


def _tours(scene: VlnScene, rule: SceneRule) -> Iterator[TourInput]:
    """Yield planned tours of a scene."""
    tourist = TourPlanner(scene)
    for number in range(MAX_TOURS if tourist.has_goals else 0):
        tour_id = f"{scene.scene_id}_t{number:02d}"
        rng = np.random.default_rng([rule.seed, *tour_id.encode()])
        tour = tourist.tour(tour_id, rng)
        yield tour.frames, tour.target_at, rng


def _recorded(tours: Sequence[Sequence[StreamFrame]], rule: SceneRule) -> Iterator[TourInput]:
    for frames in tours:
        if frames:
            yield frames, None, np.random.default_rng([rule.seed, *frames[0].tour_id.encode()])


class _TrajectoryRecorder:
    """A recorder that renders candidates and keeps those whose images show enough detail."""

    def __init__(
        self,
        scene: VlnScene,
        folder: Path,
        scene_split: str,
        rule: SceneRule,
        walker: StepFunction,
        work: SceneItems,
    ):
        self._scene, self._split, self._rule, self._work = scene, scene_split, rule, work
        kept, small = vln_camera(*rule.size_px), vln_camera(*PREVIEW_PX)
        self._album = PictureStore(
            folder, partial(render_pictures, scene, kept), partial(render_pictures, scene, small)
        )
        self._ranks = RankBalancer(np.random.default_rng([rule.seed, *scene.scene_id.encode()]))
        self._scout = DistractorSampler(walker, scene.metres_per_block)

    def take_in(self, candidate: Candidate, rng: np.random.Generator) -> int:
        """Add a candidate with its questions, or count the reason for its rejection.

        Returns:
            The number of trajectories added, 0 or 1.
        """
        shots = self._album.take([mark.stance for mark in candidate.marks])
        fault = picture_fault([one.mean for one in shots], [one.dhash for one in shots])
        if fault:
            self._work.refused[fault] += 1
            return 0
        pictures = self._written(candidate, shots)
        trajectory = _trajectory(self._scene, candidate, pictures, self._split)
        spoken = _choose_instruction(candidate.instructions, self._rule.levels, rng)
        work, name = self._work, candidate.trajectory_id
        work.trajectories.append(trajectory)
        work.pictures[name], work.spoken[name] = pictures, spoken
        balanced = self._rule.balanced
        work.actions[name] = action_steps(candidate.marks, candidate.clear, rng, balanced)
        work.views += self._views(candidate, pictures, spoken, rng)
        work.episodes.append(_episode(self._scene, candidate, spoken, self._split, self._rule))
        return 1

    def _written(
        self, candidate: Candidate, shots: Sequence[EncodedPicture]
    ) -> list[StoredPicture]:
        folder = f"images/{self._scene.scene_id}/{candidate.trajectory_id}"
        return [
            self._album.write(f"{folder}/{n:03d}.jpg", mark.stance, shot)
            for n, (mark, shot) in enumerate(zip(candidate.marks, shots, strict=True))
        ]

    def _views(
        self,
        candidate: Candidate,
        pictures: Sequence[StoredPicture],
        spoken: Instruction,
        rng: np.random.Generator,
    ) -> list[ViewQuestion]:
        """Return Next-View questions, without hard ones if the instruction states only the goal."""
        steps = view_steps(candidate.clear, pictures)
        chosen = sorted(rng.permutation(len(steps))[: self._rule.views])
        grades, shares = list(GRADES), np.array(GRADE_SHARES)
        shares = shares * [1, 1, spoken.level != "goal"]
        return [
            view_question(
                candidate.trajectory_id, candidate.marks, pictures, steps[n],
                str(rng.choice(grades, p=shares / shares.sum())), self._album, self._scout,
                self._ranks, rng,
            )
            for n in chosen
        ]  # fmt: skip


def render_pictures(
    scene: VlnScene, camera: Camera, stances: Sequence[Stance]
) -> list[EncodedPicture]:
    """Render and encode the views of a scene."""
    return [
        encode_picture(np.asarray(scene.picture(stance, camera, outputs=("colour",)).colour))
        for stance in stances
    ]


def _trajectory(
    scene: VlnScene, candidate: Candidate, pictures: Sequence[StoredPicture], split: str
) -> Trajectory:
    keyframes = tuple(
        Keyframe(one.image, mark.stance, mark.action, mark.chunk, one.sha256)
        for mark, one in zip(candidate.marks, pictures, strict=True)
    )
    return Trajectory(
        candidate.trajectory_id, scene.scene_id, keyframes, candidate.instructions,
        round(candidate.path_length_m, 4), split, scene.metres_per_block,
    )  # fmt: skip


def _choose_instruction(
    instructions: Sequence[Instruction],
    levels: tuple[float, float, float],
    rng: np.random.Generator,
) -> Instruction:
    """Return the instruction for a trajectory's items, sampled by the shares of the levels."""
    weights = np.array([levels[LEVELS.index(one.level)] for one in instructions]) + 1e-9
    return instructions[int(rng.choice(len(instructions), p=weights / weights.sum()))]


def _episode(
    scene: VlnScene, candidate: Candidate, spoken: Instruction, split: str, rule: SceneRule
) -> Episode:
    """Return the episode of a candidate.

    A goal-level instruction accepts any position in front of the landmark, others only the end of
    the walk.
    """
    end = candidate.walk.stances[-1].feet
    goals, name = (end,), candidate.way.stop
    if spoken.level == "goal":
        goals = (end, *scene.goals_at(scene.landmark(name)))
    return Episode(
        candidate.trajectory_id, scene.path, scene.scene_id, candidate.walk.stances[0], goals,
        name, spoken, rule.move_set, candidate.walk.moves, candidate.walk.stances,
        candidate.trajectory_id, split, oracle_version=WALK_VERSION,
    )  # fmt: skip
