"""Generated scenes for navigation sets: rooms that are scanned and reconstructed, and houses.

A generated room passes through the same pipeline as a real capture: a virtual depth camera with
realistic errors scans it, and ``w2m reconstruct`` reconstructs it. A set can therefore combine real
and generated rooms. If a reconstructed room has no walkable path between objects, another room of
the same kind is generated. Finished scenes are reused.
"""

import shutil
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.navigation.data.planned_walks import TourPlanner
from world2minecraft.navigation.scene import open_scene
from world2minecraft.procgen import BASE_KINDS, generate_room, scan_room
from world2minecraft.procgen.worlds import house_of, write_house
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.runs import run_capture

MAX_SCENES, MAX_SEEDS = 1_000, 1_000_000
TRIES = 5  # Attempts to generate a room with a walkable path between objects.
_FINISHED = {"room": "report.json", "house": "house.json"}  # The files that are written last.


@dataclass(frozen=True)
class _Order:
    """A room or house to generate, numbered from 1 within the series of a seed."""

    folder: str
    what: str
    number: int
    seed: int


def make_scenes(
    folder: str | Path,
    rooms: int,
    houses: int,
    seed: int = 0,
    workers: int = 1,
    progress: Progress = no_progress,
    only: Collection[str] | None = None,
) -> list[Path]:
    """Generate rooms and houses, and return their folders, rooms first.

    Args:
        folder: The output folder. Scenes are written to subfolders such as ``bed_01`` and
            ``house_01``, with a suffix such as ``_s7`` for seeds other than 0.
        rooms: The number of rooms. The kinds of rooms alternate, and a longer series starts with
            the same rooms as a shorter one.
        houses: The number of houses.
        seed: The random seed.
        workers: The number of worker processes.
        progress: Called after each scene.
        only: The names of the scenes to generate. None means all.

    Raises:
        UsageError: If a number is out of range.
        OutputError: If the folder cannot be written.
    """
    if not (0 <= rooms <= MAX_SCENES and 0 <= houses <= MAX_SCENES):
        raise UsageError(
            f"rooms and houses must each be 0 to {MAX_SCENES:,}, got {rooms} and {houses}"
        )
    place, mark = Path(folder), f"_s{seed}" if seed else ""  # Each seed has its own folders.
    names = [f"{BASE_KINDS[n % len(BASE_KINDS)]}_{n + 1:02d}{mark}" for n in range(rooms)]
    orders = [_Order(str(place / name), "room", n, seed) for n, name in enumerate(names, 1)]
    orders += [
        _Order(str(place / f"house_{n:02d}{mark}"), "house", n, seed) for n in range(1, houses + 1)
    ]
    if only is not None:
        orders = [one for one in orders if Path(one.folder).name in only]
    left = [one for one in orders if not (Path(one.folder) / _FINISHED[one.what]).is_file()]
    if left:
        progress("scenes", 0, len(left))
        with open_engine("pool", max(1, min(workers, len(left)))) as engine:
            for done, (n, _) in enumerate(engine.run(_make, left, lambda _: None), 1):
                progress("scenes", done, len(left), Path(left[n].folder).name)
    return [Path(one.folder) for one in orders]


def _make(order: _Order, tick: Callable[[int], None]) -> None:
    """Generate one scene in a worker process."""
    out = Path(order.folder)
    if order.what == "house":
        write_house(house_of(order.seed, order.number), out, name=out.name.replace("_", " "))
    else:
        kind = BASE_KINDS[(order.number - 1) % len(BASE_KINDS)]
        chance = order.seed * MAX_SCENES + order.number  # Differs between the rooms of all seeds.
        for again in range(TRIES):
            if again:  # Remove the previous attempt.
                shutil.rmtree(out)
            _make_room(out, kind, chance + again * MAX_SEEDS)
            if TourPlanner(open_scene(out)).has_goals:
                break
    tick(1)


def _make_room(out: Path, kind: str, chance: int) -> None:
    """Generate a room, scan it and reconstruct it."""
    shutil.rmtree(out / "capture", ignore_errors=True)  # Left by an interrupted attempt.
    scan_room(generate_room(chance, kind=kind), out / "capture", seed=chance)
    run_capture(out / "capture", out, Parameters())
    shutil.rmtree(out / "capture")
