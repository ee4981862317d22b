"""What MinecraftVLN is made of: moves, where a walker stands, episodes, trajectories and items.

Places are world block coordinates of the feet (x east, y up, z south); angles are the game's: yaw 0
looks south, to +z, and grows clockwise from above; pitch grows downward; degrees. Lengths whose
name ends in ``_m`` are metres of the room.
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
    """What a walker does in a step, by Habitat's numbers."""

    STOP = 0
    FORWARD = 1
    LEFT = 2  # Turns to the left: counter-clockwise from above.
    RIGHT = 3


@dataclass(frozen=True)
class MoveSet:
    """How far a move goes. ``is_macro``: one action is a whole run of equal moves."""

    name: str
    forward_m: float
    turn_deg: float
    is_macro: bool = False


# Of VLN-CE's R2R and RxR; a block a step (its length is the scene's); and the paper's wording.
MOVE_SETS = {
    "vlnce": MoveSet("vlnce", 0.25, 15.0),
    "rxr": MoveSet("rxr", 0.25, 30.0),
    "block": MoveSet("block", 0.0, 90.0),
    "macro": MoveSet("macro", 0.25, 15.0, is_macro=True),
}


@dataclass(frozen=True)
class Stance:
    """Where a walker stands and looks: feet in world blocks, the game's angles in degrees."""

    x: float
    y: float
    z: float
    yaw_deg: float = 0.0
    pitch_deg: float = 0.0

    @property
    def feet(self) -> tuple[float, float, float]:
        """The feet, world blocks."""
        return (self.x, self.y, self.z)


@dataclass(frozen=True)
class Instruction:
    """What a walker is told. ``landmarks`` are the names that it speaks of, in their order."""

    text: str
    source: str = "template"
    level: str = "landmark"
    landmarks: tuple[str, ...] = ()
    annotator: str = ""
    language: str = "en"

    def __post_init__(self):
        _check_known("source of an instruction", self.source, INSTRUCTION_SOURCES)
        _check_known("level of an instruction", self.level, LEVELS)
        if not self.text.strip():
            raise UsageError("an instruction has words; this one is empty")


@dataclass(frozen=True)
class Episode:
    """A way to go in a scene, and what is told of it.

    ``reference`` is the expert's way, dense, a stance a move; ``moves`` are its moves, STOP at the
    end. ``goals`` are feet, world blocks: success is being near one of them, on foot. An expert
    who got there turns to ``facing``.
    """

    episode_id: str
    scene: str  # path, as ``open_scene`` takes it
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
    oracle_version: str = ""  # of the follower that made ``moves``
    facing: tuple[float, float, float] | None = None  # the thing itself, world blocks

    def __post_init__(self):
        _check_known("set of moves", self.move_set, MOVE_SETS)
        _check_known("split", self.split, SPLITS)
        if not self.goals:
            raise UsageError(f"episode {self.episode_id} has no goal")


def check_reachable(episode: Episode, distance_m: float) -> None:
    """Refuse an episode from whose start no way leads to its goal: nothing of it can be scored.

    Raises:
        InputError: ``distance_m``, the way on foot in metres, is infinite.
    """
    if not math.isfinite(distance_m):
        raise InputError(
            episode.scene,
            f"no way leads from the start of episode {episode.episode_id} to its goal; were the "
            "blocks changed since? Make episodes anew, with w2m vln build",
        )


@dataclass(frozen=True)
class Keyframe:
    """A picture of a trajectory, taken where a run of equal moves ends.

    ``chunk`` are the next moves from here, at most four, STOP among them.
    """

    image: str  # path beside the records, POSIX
    stance: Stance
    move: str  # the macro action from here: "move forward", "turn left", "turn right", "stop"
    chunk: tuple[Move, ...]
    sha256: str = ""


@dataclass(frozen=True)
class Trajectory:
    """A valid way through a scene with its keyframes and all that was said of it."""

    trajectory_id: str
    scene_id: str
    keyframes: tuple[Keyframe, ...]
    instructions: tuple[Instruction, ...]
    path_m: float
    split: str = "train"
    metres_per_block: float = 1.0
    source: str = "generated"  # or "recorded"


@dataclass(frozen=True)
class Option:
    """A choice of an item. ``kind`` says how a wrong one was made; the right one is "positive"."""

    label: str  # a letter
    kind: str
    text: str = ""
    image: str = ""
    stance: Stance | None = None


@dataclass(frozen=True)
class Item:
    """The canonical record of one question; exporters make every other format of it.

    ``history`` are images before ``current``, oldest first. ``extra`` has what a task adds, such as
    ``gold_chunk`` and ``progress`` of a Next-Action item.
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
    answer: str  # the label of the right option
    split: str
    composition: str  # "base" (reconstructions) or "extend" (large houses)
    metres_per_block: float
    oracle_version: str
    sha256: dict[str, str]  # of each image that it names
    extra: dict[str, Any]

    def __post_init__(self):
        _check_known("task", self.task, TASKS)
        _check_known("split", self.split, SPLITS)
        labels = [option.label for option in self.options]
        if labels != list(LETTERS[: len(labels)]) or self.answer not in labels:
            raise UsageError(
                f"item {self.item_id}: options are lettered A, B, ... and one is the answer, "
                f"not {labels} and {self.answer!r}"
            )

    @property
    def images(self) -> tuple[str, ...]:
        """Every image that a reader is shown, in the order of the prompt."""
        chosen = tuple(option.image for option in self.options if option.image)
        return (*self.history, self.current, *chosen)


def _check_known(what: str, value: str, allowed: Any) -> None:
    if value not in allowed:
        raise UsageError(f"{what} must be one of {', '.join(allowed)}, not {value!r}")
