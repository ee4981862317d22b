"""What a path knows of itself: one record that the kernels of a band of rows pass around.

Lengths are cells of the grid, directions unit vectors, colours linear.
"""

import numpy as np

from world2minecraft.core.jit import inlined

# Where the light of a path goes: found at its first surface that is no glass.
UNDECIDED, SPREAD, GLOSS = 0, 1, 2

_NUMBER, _WHOLE, _POINT = np.float64, np.int64, (np.float64, (3,))
PATH = np.dtype(
    [
        ("key", np.uint32),  # of the pixel's random numbers
        ("sample", _WHOLE),
        ("use", _WHOLE),  # of random numbers, the next
        # The ray, and how wide a pixel's beam is at its origin and how it widens.
        ("o", *_POINT), ("d", *_POINT), ("wide", _NUMBER), ("widens", _NUMBER),
        # What a surface there would send on to the eye.
        ("share", *_POINT), ("lobe", _WHOLE), ("sharp", _WHOLE), ("bounces", _WHOLE),
        # The surface: where it is, its outward normal, the one of its relief, and its look.
        ("t", _NUMBER), ("cell", np.int64, (3,)), ("face", _WHOLE), ("element", _WHOLE),
        ("at", *_POINT), ("out", *_POINT), ("normal", *_POINT), ("colour", *_POINT),
        ("alpha", _NUMBER), ("clear", _WHOLE), ("rough", _NUMBER), ("metal", _NUMBER),
        ("level", _NUMBER), ("own", _WHOLE), ("first", *_POINT), ("first_out", *_POINT),
        # How it scatters: shares of both lobes, and how often the gloss is followed.
        ("matt", *_POINT), ("shine", *_POINT), ("gloss_odds", _NUMBER),
        # The light that is aimed at: direction, distance, light over density, density.
        ("to", *_POINT), ("far", _NUMBER), ("aimed", *_POINT), ("density", _NUMBER),
        ("unseen", _WHOLE),  # whether no ray can meet it
        ("way", *_POINT),
        # The last bounce: density of its direction, and what the choice of a lamp depended on.
        ("last", _NUMBER), ("from_at", *_POINT), ("from_out", *_POINT), ("weights", _NUMBER),
        ("aim_odds", _NUMBER),  # how often lamps are aimed at
        # What the sample has come to.
        ("seen", *_POINT), ("spread", *_POINT), ("gloss", *_POINT),
        ("spread_share", *_POINT), ("gloss_share", *_POINT),
    ],
    align=True,
)  # fmt: skip


def new_path() -> np.ndarray:
    """Return the record of a path, an array of one."""
    return np.zeros(1, PATH)


@inlined
def put(to, vector):
    """Copy three numbers; numba's own way would want to allocate."""
    to[0], to[1], to[2] = vector[0], vector[1], vector[2]
