"""Generated worlds: seconds a house, ways, room kinds, and how many fine classes they show.

``python -m benchmarks.check_worlds [--houses 156 --seed 1 --views 3 --size 640x480]``

A fine class is a block id, or a furniture design whatever it is made of. It counts as seen where
at least 100 pixels show it in each of at least 3 pictures; ``--views`` are taken in each room, from
free places at a person's eye. ``--views 0`` leaves the pictures out; in smaller pictures than of
640 by 480 as many fewer pixels are asked for.
"""

import argparse
import os
import time
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
from rich.console import Console

from world2minecraft.coordinates import look_at
from world2minecraft.furniture import TEMPLATES
from world2minecraft.minecraft.states import known_blocks
from world2minecraft.render import prepare_scene, render_volume
from world2minecraft.render.views import camera_of
from world2minecraft.rooms.worlds import HouseWorld, house_of
from world2minecraft.rooms.worlds.house import BlockRoom
from world2minecraft.rooms.worlds.reach import reached_floors

LEAST_PIXELS, LEAST_PICTURES = 100, 3
PIXELS = 640 * 480
WANTED = 1452  # Of the paper's data set.
EYE_M = 1.6
UNSEEN = {"air", "light"}


@dataclass
class Found:
    """What a series of houses holds and shows."""

    seconds: list[float] = field(default_factory=list)
    rooms: Counter = field(default_factory=Counter)
    styles: Counter = field(default_factory=Counter)
    held: Counter = field(default_factory=Counter)  # fine class -> houses
    pairs: set = field(default_factory=set)  # (design, block)
    shown: Counter = field(default_factory=Counter)  # fine class -> pictures
    made_of: Counter = field(default_factory=Counter)  # (design, its commonest block) -> pictures
    pictures: int = 0
    reached: int = 0
    places: int = 0
    shut: list[str] = field(default_factory=list)


def main() -> None:
    """Print what a series of houses holds and shows."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--houses", type=int, default=156)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--views", type=int, default=3)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--missing", action="store_true", help="name what is not shown")
    chosen = parser.parse_args()
    size = tuple(int(side) for side in chosen.size.split("x"))
    found = Found()
    for number in range(1, chosen.houses + 1):
        start = time.process_time()
        made = house_of(chosen.seed, number)
        found.seconds.append(time.process_time() - start)
        take(found, made, number)
        if chosen.views:
            show(found, made, chosen.views, (size[0], size[1]))
    report(found, Console(width=None if os.isatty(1) else 120), missing=chosen.missing)


def take(found: Found, made: HouseWorld, number: int) -> None:
    """Count what a house holds, and whether its rooms are reached."""
    found.styles[made.style] += 1
    counts = reached_floors(made.volume, made.house, made.spawn.position)
    for room, (there, places) in zip(made.house.rooms, counts, strict=True):
        found.rooms[room.kind] += 1
        found.reached += there
        found.places += places
        if there == 0:
            found.shut.append(f"house {number}, {room.kind} {room.number}")
    names, of_cell = classes(made)
    found.held.update(names[n] for n in np.unique(of_cell) if n)
    pair = made.design.astype(np.int64) * len(made.volume.palette) + made.volume.states
    for value in np.unique(pair[made.design > 0]).tolist():
        design, state = divmod(value, len(made.volume.palette))
        found.pairs.add((made.designs[design], block_of(made.volume.palette[state])))


def classes(made: HouseWorld) -> tuple[list[str], np.ndarray]:
    """Return the names of fine classes and, for each block, which it is; 0 is air."""
    blocks = [block_of(state) for state in made.volume.palette]
    names = [
        "",
        *sorted({*blocks[1:]} - {"air", "light"}),
        *(f"design:{d}" for d in made.designs[1:]),
    ]
    number = {name: n for n, name in enumerate(names)}
    of_state = np.array([number.get(block, 0) for block in blocks])
    of_design = np.array([0, *(number[f"design:{d}"] for d in made.designs[1:])])
    return names, np.where(made.design > 0, of_design[made.design], of_state[made.volume.states])


def block_of(state: str) -> str:
    """Return a state's block without namespace and properties."""
    return state.partition("[")[0].removeprefix("minecraft:")


def show(found: Found, made: HouseWorld, views: int, size: tuple[int, int]) -> None:
    """Take pictures in each room and count what they show."""
    scene, camera = prepare_scene(made.volume), camera_of(*size, vertical_fov_deg=60.0)
    names, of_cell = classes(made)
    main = main_blocks(made)
    flat = of_cell.reshape(-1)
    least = LEAST_PIXELS * min(1.0, size[0] * size[1] / PIXELS)
    for room in made.house.rooms:
        for pose in poses(made, room, views):
            picture = render_volume(scene, camera, pose, outputs=(), threads=2)
            hits = picture.block_index[picture.block_index >= 0]
            pixels = np.bincount(flat[hits], minlength=len(names))
            seen = [names[n] for n in np.flatnonzero(pixels >= least) if n]
            found.shown.update(seen)
            found.made_of.update((one, main[one]) for one in seen if one in main)
            found.pictures += 1


def main_blocks(made: HouseWorld) -> dict[str, str]:
    """Return for each design of a house the block that most of it is made of."""
    result = {}
    for number, name in enumerate(made.designs[1:], 1):
        counts = np.bincount(made.volume.states[made.design == number])
        result[f"design:{name}"] = block_of(made.volume.palette[int(counts.argmax())])
    return result


def poses(made: HouseWorld, room: BlockRoom, views: int) -> list[np.ndarray]:
    """Return cameras at free places of a room that look across it."""
    scale = made.house.blocks_per_metre
    corner = np.array(made.volume.corner)
    low = np.array([room.low[0], room.ground, made.house.size[1] - room.high[1]])
    low = low - corner + [0, 64, 0]
    side = (room.size[0], round(2 * scale), room.size[1])
    box = made.volume.states[tuple(slice(a, a + b) for a, b in zip(low, side, strict=True))]
    lights = [
        n for n, state in enumerate(made.volume.palette) if block_of(state) in ("air", "light")
    ]
    free = (
        np.isin(box, lights).all(axis=1)[:, ::-1]
        & room.floor(made.house.size)[room.low[0] : room.high[0], room.low[1] : room.high[1]]
    )
    places = np.argwhere(free)
    rng = np.random.default_rng([room.number, len(places)])
    middle, result = np.array(room.size) / 2, []
    for _ in range(views if len(places) else 0):
        few = places[rng.integers(len(places), size=6)]
        far = few[np.argmax(np.hypot(*(few + 0.5 - middle).T))]
        eye = (far + 0.5 + room.low) / scale
        goal = (middle + (middle - far) * rng.uniform(0.2, 0.9) + room.low) / scale
        goal = goal + rng.uniform(-0.8, 0.8, size=2)
        ground = room.ground / scale
        if np.hypot(*(goal - eye)) > 0.3:
            result.append(look_at(np.r_[eye, ground + EYE_M], np.r_[goal, ground + 0.9]))
    return result


def report(found: Found, console: Console, *, missing: bool) -> None:
    """Print the figures."""
    cpu = np.array(found.seconds)
    console.print(f"{len(cpu)} houses, {sum(found.rooms.values())} rooms")
    console.print(f"CPU seconds a house: mean {cpu.mean():.2f}, most {cpu.max():.2f}")
    console.print(f"floor reached on foot from the spawn: {found.reached / found.places:.2%}")
    console.print(f"rooms not reached: {', '.join(found.shut) or 'none'}")
    console.print("rooms: " + ", ".join(f"{k} {n}" for k, n in found.rooms.most_common()))
    console.print("styles: " + ", ".join(f"{k} {n}" for k, n in found.styles.most_common()))
    designs = sum(name.startswith("design:") for name in found.held)
    every = len(known_blocks()) + len(TEMPLATES.names())
    console.print(
        f"fine classes held: {len(found.held)} ({len(found.held) - designs} block ids, {designs} "
        f"designs) of the {every} that there are; {WANTED} are wanted"
    )
    console.print(f"pairs of a design and a block that it is made of: {len(found.pairs)}")
    if not found.pictures:
        return
    seen = [name for name, count in found.shown.items() if count >= LEAST_PICTURES]
    own = sum(name.startswith("design:") for name in seen)
    made_of = sum(count >= LEAST_PICTURES for count in found.made_of.values())
    console.print(
        f"seen by {LEAST_PIXELS} pixels in {LEAST_PICTURES} of {found.pictures} pictures: "
        f"{len(seen)} ({len(seen) - own} block ids, {own} designs); "
        f"with each main material of a design as one: {len(seen) - own + made_of}"
    )
    if missing:
        left = sorted(set(found.held) - set(seen))
        console.print(f"held and not so seen: {' '.join(left)}")


if __name__ == "__main__":
    main()
