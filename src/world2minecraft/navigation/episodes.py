"""Random episodes of a scene, and the scoring of walks.

An episode leads from a random start to a named goal along the expert path. ``navigation.records``
reads and writes episode files.
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

MIN_PATH_M, MAX_PATH_M = 1.0, 25.0  # Walking distance to the goal.
MAX_HEIGHT_M = 1.2  # Maximum height of the underside of a goal above the floor.
TRIES = 40  # Starts and targets that are tried for one episode.


@dataclass(frozen=True)
class Target:
    """A possible goal: its name, the positions in front of it, and its own position.

    Attributes:
        name: The name of the landmark or room.
        goals: The goal positions of the feet in world blocks.
        point: The centre of the landmark in world blocks, or None for a room.
    """

    name: str
    goals: tuple[tuple[float, float, float], ...]
    point: tuple[float, float, float] | None = None


def targets_of(scene: VlnScene) -> tuple[Target, ...]:
    """Return the possible goals of a scene: its landmarks, or its rooms if no landmark is suitable.

    Raises:
        UsageError: If the scene has a single room without uniquely named landmarks.
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
            f"{scene.path} has a single room without uniquely named objects, so no goals "
            "can be chosen; give episodes with goals, or another world"
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
    """Return random episodes that the oracle can solve.

    The same seed gives the same episodes, and a longer list starts with the shorter one.

    Args:
        scene: The scene.
        count: The number of episodes.
        seed: The random seed, 0 or more.
        move_set: The name of the move set.
        min_m: The minimum path length in metres.
        max_m: The maximum path length in metres.
        split: "train", "val_seen" or "val_unseen".

    Raises:
        UsageError: If a number is invalid, or the scene permits no such episodes.
        UnknownNameError: If the move set is unknown.
    """
    if count < 1 or not 0 <= min_m < max_m:
        raise UsageError(
            "random episodes require a count of 1 or more and 0 <= minimum < maximum path "
            f"length, got count {count} and {min_m:g} to {max_m:g} m"
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
    """Sample one episode to a random target.

    Args:
        scene: The scene.
        rng: The random generator.
        targets: The possible targets.
        episode_id: The ID of the new episode.
        move_set: The name of the move set.
        span_m: The minimum and maximum path length in metres.
        split: The split of the new episode.

    Raises:
        UsageError: If no start and target with a path of this length are found.
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
        f"{scene.path}: no path of {span_m[0]:g} to {span_m[1]:g} m to a goal was found in "
        f"{TRIES} attempts with the move set {move_set!r}; allow shorter paths"
    )


def episode_of(
    scene: VlnScene,
    way: ExpertPath,
    target: Target,
    episode_id: str,
    move_set: str,
    split: str = "train",
) -> Episode:
    """Return the episode of an expert path to a target."""
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
    """Score a walk against the episode's reference path, or against the expert path if it has none.

    Args:
        scene: The scene of the walk.
        episode: The episode.
        stances: The stances of the walk, starting with the first one.
        stopped: Whether the agent ended the walk with STOP.
        steps: The number of actions, including STOP.
        collisions: The number of actions that collided.
        radius_m: The success radius for SPL and SDTW in metres.

    Raises:
        ValueError: If no path leads from the start to a goal.
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
    """Return the move set of an episode."""
    return get_move_set(episode.move_set)
