"""Episodes of a scene: from somewhere to a thing that has a name, with the oracle's way.

``random_episodes`` draws them; ``score_walk`` scores a walk through one. Files of episodes are read
and written by ``navigation.records``.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.landmarks import Landmark
from world2minecraft.navigation.moves import get_move_set
from world2minecraft.navigation.oracle import ORACLE_VERSION, ExpertPath, plan_expert_path
from world2minecraft.navigation.scene import VlnScene
from world2minecraft.navigation.scores import EpisodeScore, WalkedPath, score_episode
from world2minecraft.navigation.types import Episode, Instruction, MoveSet, Stance

MIN_PATH_M, MAX_PATH_M = 1.0, 25.0  # Of the way on foot; shorter is no walk.
MAX_HEIGHT_M = 1.2  # What hangs so high over the floor is nothing to walk to.
TRIES = 40  # Of places for one episode.


@dataclass(frozen=True)
class Target:
    """What one can be sent to: its name, where one stands before it, and where it is itself."""

    name: str
    goals: tuple[tuple[float, float, float], ...]  # feet, world blocks
    point: tuple[float, float, float] | None = None  # world blocks


def targets_of(scene: VlnScene) -> tuple[Target, ...]:
    """Return what one can be sent to in a scene: things, or its rooms where no thing has a name.

    Raises:
        UsageError: it has one room and nothing in it that a name tells.
    """
    things = []
    for landmark in scene.landmarks:
        goals = scene.goals_at(landmark) if landmark.is_unambiguous else ()
        floors = scene.to_room_m(np.array(goals))[:, 2] if goals else np.zeros(0)
        if len(floors) and landmark.low_m[2] - floors.min() <= MAX_HEIGHT_M:
            things.append(target_of(scene, landmark, goals))
    rooms = [Target(room.name, (room.center,)) for room in scene.rooms]
    if not things and len(rooms) < 2:
        raise UsageError(
            f"{scene.path} has one room and nothing in it with a name of its own; give episodes "
            "with goals, or another world"
        )
    return tuple(things or rooms)


def target_of(
    scene: VlnScene, landmark: Landmark, goals: tuple[tuple[float, float, float], ...]
) -> Target:
    """Return a landmark as a target."""
    x, y, z = apply(invert(scene.volume.block_to_room), landmark.center_m).tolist()
    return Target(landmark.name, goals, (x, y, z))


def random_episodes(
    scene: VlnScene,
    count: int,
    seed: int = 0,
    *,
    move_set: str = "vlnce",
    min_m: float = MIN_PATH_M,
    max_m: float = MAX_PATH_M,
    split: str = "train",
) -> list[Episode]:
    """Return episodes that the oracle solves; the same for the same seed, a longer list begins so.

    Args:
        scene: where one walks.
        count: how many.
        seed: 0 or more.
        move_set: the moves' name.
        min_m: the shortest way on foot.
        max_m: the longest.
        split: train, val_seen or val_unseen.

    Raises:
        UsageError: the scene gives none, or a number cannot be. UnknownNameError: no such moves.
    """
    if count < 1 or not 0 <= min_m < max_m:
        raise UsageError(
            f"episodes are 1 or more with ways of 0 <= least < most metres, not {count} of "
            f"{min_m:g} to {max_m:g}"
        )
    get_move_set(move_set)
    targets = targets_of(scene)
    made = []
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        name = f"{scene.scene_id}-{seed}-{number:04d}"
        how = {"move_set": move_set, "span_m": (min_m, max_m), "split": split}
        made.append(random_episode(scene, rng, targets, name, **how))
    return made


def random_episode(
    scene: VlnScene,
    rng: np.random.Generator,
    targets: Sequence[Target],
    episode_id: str,
    *,
    move_set: str = "vlnce",
    span_m: tuple[float, float] = (MIN_PATH_M, MAX_PATH_M),
    split: str = "train",
) -> Episode:
    """Draw one episode to one of some targets.

    Raises:
        UsageError: no place and target were found that a way of this length leads between.
    """
    turn_deg = get_move_set(move_set).turn_deg
    for _ in range(TRIES):
        target = targets[int(rng.integers(len(targets)))]
        away = scene.distances_m(target.goals)[scene.main_places]
        fit = np.flatnonzero((away >= span_m[0]) & (away <= span_m[1]))
        if not len(fit):
            continue
        x, y, z = scene.graph.feet[scene.main_places[int(rng.choice(fit))]].tolist()
        yaw_deg = float(rng.integers(round(360 / turn_deg))) * turn_deg - 180.0
        stance = Stance(x, y, z, yaw_deg)
        way = plan_expert_path(scene, stance, target.goals, move_set, facing=target.point)
        if way is not None:
            return episode_of(scene, way, target, episode_id, move_set, split)
    raise UsageError(
        f"{scene.path}: in {TRIES} tries no way of {span_m[0]:g} to {span_m[1]:g} m to a thing "
        f"was found by the moves of {move_set!r}; ask for shorter ways"
    )


def episode_of(
    scene: VlnScene,
    way: ExpertPath,
    target: Target,
    episode_id: str,
    move_set: str,
    split: str = "train",
) -> Episode:
    """Return the episode of the oracle's way to a target."""
    called = target.name if target.name[-1:].isdigit() else f"the {target.name}"  # "Go to room 2."
    words = Instruction(f"Go to {called}.", level="goal", landmarks=(target.name,))
    return Episode(
        episode_id=episode_id,
        scene=scene.path,
        scene_id=scene.scene_id,
        start=way.stances[0],
        goals=target.goals,
        goal_name=target.name,
        instruction=words,
        move_set=move_set,
        moves=way.moves,
        reference=way.stances,
        trajectory_id=episode_id,
        split=split,
        oracle_version=ORACLE_VERSION,
        facing=target.point,
    )


def score_walk(
    scene: VlnScene,
    episode: Episode,
    stances: Sequence[Stance],
    *,
    stopped: bool,
    steps: int,
    collisions: int = 0,
    radius_m: float = 3.0,
) -> EpisodeScore:
    """Return the scores of a walk; an episode without a reference is held against the oracle's.

    Args:
        scene: where it was walked.
        episode: what was asked.
        stances: where the walker was, the start first.
        stopped: whether it said STOP.
        steps: actions, STOP among them.
        collisions: how many of them met something.
        radius_m: success in SPL and SDTW.

    Raises:
        ValueError: no way leads from the start to a goal.
    """
    reference = episode.reference
    if not reference:
        way = plan_expert_path(scene, episode.start, episode.goals, moves_of(episode))
        reference = way.stances if way else (episode.start,)
    walked = WalkedPath(
        scene.to_room_m([stance.feet for stance in stances]),
        np.array([scene.distance_m(stance.feet, episode.goals) for stance in stances]),
        stopped,
        steps,
        collisions,
    )
    points = scene.to_room_m([stance.feet for stance in reference])
    return score_episode(walked, points, radius_m=radius_m)


def moves_of(episode: Episode) -> MoveSet:
    """Return the moves of an episode."""
    return get_move_set(episode.move_set)
