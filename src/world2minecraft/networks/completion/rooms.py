"""Which rooms the completion network learns from: every kind and shape, tidy or full, and houses.

Training takes seeds from 10,000 on, so that no seed of a benchmark (1000 to 1049, 2000 to 2019,
500 to 549 to tune) is ever learnt; ``held_out`` seeds lie below.
"""

import numpy as np

from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.procgen import generate_house, generate_room
from world2minecraft.procgen.rooms.room import Room

FIRST_SEED = 10_000
HOUSE_SHARE = 0.06  # A house takes four times a room's time.
BOX_SHARE = 0.6
# The rooms that people scan most come most often.
KIND_SHARES = {
    "living": 0.17,
    "bed": 0.17,
    "kitchen": 0.15,
    "office": 0.12,
    "dining": 0.11,
    "study": 0.1,
    "children": 0.08,
    "bathroom": 0.06,
    "hall": 0.04,
}


def training_room(seed: int) -> Room:
    """Return the room or house of a seed; the same seed gives the same bytes."""
    rng = np.random.default_rng([seed, 11])
    clutter = float(rng.choice([0.0, rng.uniform(0, 1)], p=[0.2, 0.8]))
    if rng.random() < HOUSE_SHARE:
        return generate_house(seed, rooms=int(rng.integers(3, 5)), clutter=clutter)
    kind = str(rng.choice(list(KIND_SHARES), p=list(KIND_SHARES.values())))
    shape = "box" if rng.random() < BOX_SHARE else None
    try:
        return generate_room(seed, kind=kind, clutter=clutter, shape=shape)
    except World2MinecraftError:  # A few kinds do not fit into a few shapes.
        return generate_room(seed, kind=kind, clutter=clutter)
