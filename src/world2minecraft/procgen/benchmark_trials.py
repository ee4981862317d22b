"""The fixed benchmark: fifty scans in five difficulties, and fifty more for tuning.

A trial is a room or house and its scan, all generated from one seed. ``list_trials("tune")`` has
the seeds 500 to 549 and ``list_trials("test")`` the seeds 1000 to 1049. Use only "tune" to choose a
parameter, a threshold or a model, because results on "test" are meaningful only without tuning.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.procgen.houses.house import generate_house
from world2minecraft.procgen.rooms.room import Room, generate_room
from world2minecraft.procgen.virtual_scan import scan_room

Split = Literal["tune", "test"]
FIRST_SEED: dict[str, int] = {"tune": 500, "test": 1000}
PER_DIFFICULTY = 10
DIFFICULTIES = ("noise", "coverage", "clutter", "scale", "all")
LABEL_ERROR = 0.1  # The share of the label images that is wrong, in every trial.
# Written out, so that the benchmark stays as it is when kinds and shapes are added.
PLAIN_KINDS = ("bed", "dining", "kitchen", "living", "study")
ODD_KINDS = ("living", "children", "kitchen", "office", "dining")
ODD_SHAPES = ("ell", "cut", "sloped")


@dataclass(frozen=True)
class Trial:
    """One scan of the benchmark: the room or house to generate and the scan settings.

    ``kind`` is ``house`` if there are several ``rooms``.
    """

    name: str
    difficulty: str
    seed: int
    kind: str
    rooms: int = 1
    storeys: int = 1
    shape: str = "box"
    clutter: float = 0.0
    frames: int = 40
    sensor: str = "rgbd"
    depth_scale_sigma: float = 0.0
    coverage: float = 1.0
    label_error: float = LABEL_ERROR

    def clean(self) -> "Trial":
        """Return the same trial without noise, pose jitter or depth scale."""
        return replace(self, name=f"{self.name}-clean", sensor="clean", depth_scale_sigma=0.0)

    def room(self) -> Room:
        """Generate the room or house of the trial."""
        if self.rooms > 1:
            return generate_house(
                self.seed, rooms=self.rooms, storeys=self.storeys, clutter=self.clutter
            )
        return generate_room(self.seed, kind=self.kind, clutter=self.clutter, shape=self.shape)


def list_trials(split: Split, difficulty: str | None = None) -> tuple[Trial, ...]:
    """Return the trials of a split, ten per difficulty, in the order of ``DIFFICULTIES``.

    Args:
        split: ``tune`` or ``test``. Do not use ``test`` for tuning.
        difficulty: One of ``DIFFICULTIES``. The default is all of them.

    Raises:
        UnknownNameError: If the split or the difficulty is unknown.
    """
    if split not in FIRST_SEED:
        raise UnknownNameError("split", split, FIRST_SEED)
    if difficulty is not None and difficulty not in DIFFICULTIES:
        raise UnknownNameError("difficulty", difficulty, DIFFICULTIES)
    chosen = DIFFICULTIES if difficulty is None else (difficulty,)
    return tuple(_trial(name, split, n) for name in chosen for n in range(PER_DIFFICULTY))


def find_trial(name: str) -> Trial:
    """Return a trial by name, such as ``noise-500`` or ``noise-500-clean``.

    Raises:
        UnknownNameError: If no trial has this name.
    """
    every = {trial.name: trial for split in ("tune", "test") for trial in list_trials(split)}
    found = every.get(name.removesuffix("-clean"))
    if found is None:
        raise UnknownNameError("trial", name, every)
    return found.clean() if name.endswith("-clean") else found


def write_trial(trial: Trial, folder: str | Path, progress: Progress = no_progress) -> None:
    """Generate and scan a trial, and write its capture with label images and its ground truth.

    Raises:
        OutputError: If the folder cannot be written.
    """
    scan_room(
        trial.room(),
        folder,
        sensor=trial.sensor,
        frames=trial.frames,
        seed=trial.seed,
        with_labels=True,
        label_error=trial.label_error,
        depth_scale_sigma=trial.depth_scale_sigma,
        coverage=trial.coverage,
        progress=progress,
    )


def _trial(difficulty: str, split: str, number: int) -> Trial:
    seed = FIRST_SEED[split] + PER_DIFFICULTY * DIFFICULTIES.index(difficulty) + number
    kind = PLAIN_KINDS[number % len(PLAIN_KINDS)]
    plain = Trial(f"{difficulty}-{seed}", difficulty, seed, kind)
    return replace(plain, **_CHANGES[difficulty](number))


def _odd(number: int) -> dict[str, Any]:
    """Return the settings of a cluttered room whose shape is not a box."""
    return {
        "kind": ODD_KINDS[number % len(ODD_KINDS)],
        "shape": ODD_SHAPES[number % len(ODD_SHAPES)],
        "clutter": 1.0,
    }


def _home(number: int) -> dict[str, Any]:
    """Return the settings of a flat with 3 to 5 rooms, or sometimes of a house with two storeys."""
    return {
        "kind": "house",
        "rooms": 3 + number % 3,
        "storeys": 2 if number in (4, 8) else 1,
        "clutter": 0.6,
        "depth_scale_sigma": 0.02,
        "frames": 120,
    }


_CHANGES: dict[str, Callable[[int], dict[str, Any]]] = {
    "noise": lambda number: {},
    "coverage": lambda number: {"coverage": 0.55},
    "clutter": _odd,
    "scale": lambda number: {"depth_scale_sigma": 0.03},
    "all": _home,
}
