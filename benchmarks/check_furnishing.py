"""How varied the furniture of generated houses is, and what floats there or is gone.

``python -m benchmarks.check_furnishing [--houses 10]``

The houses have six rooms, every third of them on two storeys. Printed are the number of things and
of designs, the share of the five commonest designs, the most common ones, and the things that
nothing holds or of which no block is left.
"""

import argparse
import time
from collections import Counter

import numpy as np

from world2minecraft.core.coordinates import block_axes_to_grid
from world2minecraft.furniture import template
from world2minecraft.procgen.worlds import HouseWorld, generate_world
from world2minecraft.procgen.worlds.furnishing import HANGING

ROOMS, COMMON = 6, 5
SIDES = ((-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0))


def loose_designs(made: HouseWorld) -> list[str]:
    """Return the designs of the things that nothing holds or that have no block."""
    filled = np.array([name != "minecraft:air" for name in made.volume.palette])
    states = block_axes_to_grid(filled[made.volume.states])
    owner = block_axes_to_grid(made.volume.instance)
    loose = []
    for thing in made.things:
        cells = np.argwhere(owner == thing.instance)
        mount = template(thing.design).mount
        if mount == "wall" or thing.design in HANGING:
            steps = SIDES
        else:
            steps = ((0, 0, 1),) if mount == "ceiling" else ((0, 0, -1),)
        beside = [tuple((cells + step).T) for step in steps]
        held = (states[at] & (owner[at] != thing.instance) for at in beside)
        if not len(cells) or not any(one.any() for one in held):
            loose.append(thing.design)
    return loose


def main() -> None:
    """Generate the houses and print the figures."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--houses", type=int, default=10)
    chosen = parser.parse_args()
    counts: Counter[str] = Counter()
    loose: Counter[str] = Counter()
    begun = time.process_time()
    houses = [
        generate_world(seed, rooms=ROOMS, storeys=1 + (seed % 3 == 2))
        for seed in range(chosen.houses)
    ]
    each_s = (time.process_time() - begun) / len(houses)
    for made in houses:
        counts.update(thing.design for thing in made.things)
        loose.update(loose_designs(made))
    total = counts.total()
    share = sum(count for _, count in counts.most_common(COMMON)) / total
    print(f"{len(houses)} houses, {each_s:.2f} s of CPU each")
    print(f"{total} things of {len(counts)} designs; the {COMMON} commonest make {share:.1%}")
    print(", ".join(f"{name} {count}" for name, count in counts.most_common(12)))
    print(f"held by nothing or gone: {loose.total()}", dict(loose))


if __name__ == "__main__":
    main()
