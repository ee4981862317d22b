"""The data types of MinecraftVLN: moves, stances, episodes, trajectories and items.

Positions are those of the feet in world blocks (x east, y up, z south). Angles are the game's, in
degrees: yaw 0 looks south (+z) and increases clockwise from above, and pitch increases downward.
Names that end in ``_m`` are lengths in metres of the room.
"""

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from world2minecraft.core.errors import InputError, UsageError

INSTRUCTION_SOURCES = ("template", "human", "llm")
LEVELS = ("goal", "route", "landmark")
TASKS = ("next_view", "next_action")
SPLITS = ("train", "val_seen", "val_unseen")
LETTERS = "ABCDEFGH"


class Move(IntEnum):
    """A discrete move, with Habitat's number."""

    STOP = 0
    FORWARD = 1
    LEFT = 2  # A turn on the spot, counter-clockwise from above.
    RIGHT = 3


@dataclass(frozen=True)
class MoveSet:
    """The lengths and angles of discrete moves.

    Attributes:
        name: The name of the move set.
        forward_m: The length of a forward step in metres, or 0 for one block.
        turn_deg: The angle of a turn in degrees.
        is_macro: Whether one action is a whole run of equal moves.
    """

    name: str
    forward_m: float
    turn_deg: float
    is_macro: bool = False


# VLN-CE's sets for R2R and RxR, steps of one block, and runs of moves as in the paper.
MOVE_SETS = {
    "vlnce": MoveSet("vlnce", 0.25, 15.0),
    "rxr": MoveSet("rxr", 0.25, 30.0),
    "block": MoveSet("block", 0.0, 90.0),
    "macro": MoveSet("macro", 0.25, 15.0, is_macro=True),
}


@dataclass(frozen=True)
class Stance:
    """A position and viewing direction: feet in world blocks, and the game's angles in degrees."""

    x: float
    y: float
    z: float
    yaw_deg: float = 0.0
    pitch_deg: float = 0.0

    @property
    def feet(self) -> tuple[float, float, float]:
        """The position of the feet in world blocks."""
        return (self.x, self.y, self.z)


@dataclass(frozen=True)
class Instruction:
    """An instruction for a walk.

    Attributes:
        text: The text.
        source: One of ``INSTRUCTION_SOURCES``.
        level: One of ``LEVELS``.
        landmarks: The names of the mentioned landmarks in order.
        annotator: The person or model that wrote the text.
        language: The language code.
    """

    text: str
    source: str = "template"
    level: str = "landmark"
    landmarks: tuple[str, ...] = ()
    annotator: str = ""
    language: str = "en"

    def __post_init__(self):
        _check_known("instruction source", self.source, INSTRUCTION_SOURCES)
        _check_known("instruction level", self.level, LEVELS)
        if not self.text.strip():
            raise UsageError("an instruction must not be empty")


@dataclass(frozen=True)
class Episode:
    """A navigation task in a scene, with its instruction and the expert's path.

    Attributes:
        episode_id: The ID of the episode.
        scene: The path of the scene, as accepted by ``open_scene``.
        scene_id: The ID of the scene.
        start: The start.
        goals: The goal positions of the feet in world blocks. Success means stopping close to one.
        goal_name: The name of the goal landmark or room.
        instruction: The instruction.
        move_set: The name of the move set.
        moves: The moves of the expert, with STOP at the end.
        reference: The dense path of the expert, with one stance per move.
        trajectory_id: The trajectory that the episode was made from.
        split: One of ``SPLITS``.
        max_steps: The maximum number of steps.
        oracle_version: The version of the planner that produced ``moves``.
        facing: The position of the goal object in world blocks, which the expert faces at the end.
    """

    episode_id: str
    scene: str
    scene_id: str
    start: Stance
    goals: tuple[tuple[float, float, float], ...]
    goal_name: str
    instruction: Instruction
    move_set: str = "vlnce"
    moves: tuple[Move, ...] = ()
    reference: tuple[Stance, ...] = ()
    trajectory_id: str = ""
    split: str = "train"
    max_steps: int = 500
    oracle_version: str = ""
    facing: tuple[float, float, float] | None = None

    def __post_init__(self):
        _check_known("move set", self.move_set, MOVE_SETS)
        _check_known("split", self.split, SPLITS)
        if not self.goals:
            raise UsageError(f"episode {self.episode_id} has no goals")


def check_reachable(episode: Episode, distance_m: float) -> None:
    """Check that the goal of an episode can be reached from its start.

    Args:
        episode: The episode.
        distance_m: The walking distance to the goal in metres, or inf if unreachable.

    Raises:
        InputError: If ``distance_m`` is infinite.
    """
    if not math.isfinite(distance_m):
        raise InputError(
            episode.scene,
            f"no path leads from the start of episode {episode.episode_id} to its goal; if "
            "blocks have changed, create the episodes again with w2m vln build",
        )


@dataclass(frozen=True)
class Keyframe:
    """An image of a trajectory at the end of a run of equal moves.

    Attributes:
        image: The POSIX path of the image in the set.
        stance: The position and viewing direction.
        move: The next macro action: "move forward", "turn left", "turn right" or "stop".
        chunk: The next moves, at most four, including STOP.
        sha256: The SHA-256 of the image.
    """

    image: str
    stance: Stance
    move: str
    chunk: tuple[Move, ...]
    sha256: str = ""


@dataclass(frozen=True)
class Trajectory:
    """A path through a scene with its keyframes and instructions.

    Attributes:
        trajectory_id: The ID of the trajectory.
        scene_id: The ID of the scene.
        keyframes: The keyframes in order.
        instructions: All instructions for the path.
        path_m: The path length in metres.
        split: One of ``SPLITS``.
        metres_per_block: The scale of the scene.
        source: "generated" or "recorded".
    """

    trajectory_id: str
    scene_id: str
    keyframes: tuple[Keyframe, ...]
    instructions: tuple[Instruction, ...]
    path_m: float
    split: str = "train"
    metres_per_block: float = 1.0
    source: str = "generated"


@dataclass(frozen=True)
class Option:
    """An answer option of an item, with a text or an image.

    Attributes:
        label: The letter of the option.
        kind: "positive" for the correct option, otherwise the kind of distractor.
        text: The text of a Next-Action option.
        image: The image path of a Next-View option.
        stance: The stance of the image, if known.
    """

    label: str
    kind: str
    text: str = ""
    image: str = ""
    stance: Stance | None = None


@dataclass(frozen=True)
class Item:
    """A multiple-choice question, from which exporters create all other formats.

    Attributes:
        item_id: The ID of the item.
        task: One of ``TASKS``.
        scene_id: The ID of the scene.
        trajectory_id: The ID of the trajectory.
        step: The index of the current keyframe.
        instruction: The instruction.
        history: The images before ``current``, oldest first.
        current: The current image.
        options: The answer options.
        answer: The label of the correct option.
        split: One of ``SPLITS``.
        composition: "base" for reconstructions or "extend" for large houses.
        metres_per_block: The scale of the scene.
        oracle_version: The version of the code that planned the moves.
        sha256: The SHA-256 of each image.
        extra: Task-specific values, such as ``gold_chunk`` and ``progress``.
    """

    item_id: str
    task: str
    scene_id: str
    trajectory_id: str
    step: int
    instruction: Instruction
    history: tuple[str, ...]
    current: str
    options: tuple[Option, ...]
    answer: str
    split: str
    composition: str
    metres_per_block: float
    oracle_version: str
    sha256: dict[str, str]
    extra: dict[str, Any]

    def __post_init__(self):
        _check_known("task", self.task, TASKS)
        _check_known("split", self.split, SPLITS)
        labels = [option.label for option in self.options]
        if labels != list(LETTERS[: len(labels)]) or self.answer not in labels:
            raise UsageError(
                f"item {self.item_id}: options must be labelled A, B, ... and include the "
                f"answer, got options {labels} and answer {self.answer!r}"
            )

    @property
    def images(self) -> tuple[str, ...]:
        """The images that the prompt shows, in order."""
        chosen = tuple(option.image for option in self.options if option.image)
        return (*self.history, self.current, *chosen)


def _check_known(what: str, value: str, allowed: Any) -> None:
    if value not in allowed:
        raise UsageError(f"{what} must be one of {', '.join(allowed)}, got {value!r}")
