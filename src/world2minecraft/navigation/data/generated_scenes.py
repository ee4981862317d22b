"""Scenes for those who have none: rooms that are generated, scanned and reconstructed, and houses.

A room goes the whole way of a real capture: a virtual depth camera scans it, with that camera's
faults, and ``w2m reconstruct`` makes a run of it, so that a set can hold real and generated rooms
side by side. Where nothing is left to walk between, another room of the kind is made. What is there
already is taken as it is.
"""

import shutil
from collections.abc import Callable
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
TRIES = 5  # Of a room in which a scan leaves no way between things.
_FINISHED = {"room": "report.json", "house": "house.json"}  # What is written last.


@dataclass(frozen=True)
class _Order:
    """A room or a house to make, by its number from 1 in the series of a seed."""

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
) -> list[Path]:
    """Make runs of generated rooms, and houses; return their folders, rooms first.

    Args:
        folder: where; ``bed_01``, ``dining_02`` ... and ``house_01`` ... go below it, and with
            another seed than 0 ``bed_01_s7`` and so on.
        rooms: how many rooms, of the kinds in turn; a longer series begins with a shorter one.
        houses: how many houses.
        seed: another seed, other scenes.
        workers: how many processes.
        progress: told of each scene.

    Raises:
        UsageError: a number cannot be. OutputError: the folder cannot be written.
    """
    if not (0 <= rooms <= MAX_SCENES and 0 <= houses <= MAX_SCENES):
        raise UsageError(f"0 to {MAX_SCENES:,} rooms and houses can be made, not {rooms}, {houses}")
    place, mark = Path(folder), f"_s{seed}" if seed else ""  # Seeds share no folder.
    names = [f"{BASE_KINDS[n % len(BASE_KINDS)]}_{n + 1:02d}{mark}" for n in range(rooms)]
    orders = [_Order(str(place / name), "room", n, seed) for n, name in enumerate(names, 1)]
    orders += [
        _Order(str(place / f"house_{n:02d}{mark}"), "house", n, seed) for n in range(1, houses + 1)
    ]
    left = [one for one in orders if not (Path(one.folder) / _FINISHED[one.what]).is_file()]
    if left:
        progress("scenes", 0, len(left))
        with open_engine("pool", max(1, min(workers, len(left)))) as engine:
            for done, (n, _) in enumerate(engine.run(_make, left, lambda _: None), 1):
                progress("scenes", done, len(left), Path(left[n].folder).name)
    return [Path(one.folder) for one in orders]


def _make(order: _Order, tick: Callable[[int], None]) -> None:
    """Make a scene: what processes are sent to do."""
    out = Path(order.folder)
    if order.what == "house":
        write_house(house_of(order.seed, order.number), out, name=out.name.replace("_", " "))
    else:
        kind = BASE_KINDS[(order.number - 1) % len(BASE_KINDS)]
        chance = order.seed * MAX_SCENES + order.number  # Rooms of two seeds differ.
        for again in range(TRIES):
            if again:  # It was made right here.
                shutil.rmtree(out)
            _make_room(out, kind, chance + again * MAX_SEEDS)
            if TourPlanner(open_scene(out)).has_goals:
                break
    tick(1)


def _make_room(out: Path, kind: str, chance: int) -> None:
    """Generate a room, scan it and reconstruct it."""
    shutil.rmtree(out / "capture", ignore_errors=True)  # Of one that was broken off.
    scan_room(generate_room(chance, kind=kind), out / "capture", seed=chance)
    run_capture(out / "capture", out, Parameters())
    shutil.rmtree(out / "capture")
