"""Where one looks along a way: ahead and into the rooms, never long at a wall that is near.

All headings of all places are rated by rays; the best sequence of them, in which turning costs
too, is found exactly by going through the places once.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.rendering.views.hiding import Hiding
from world2minecraft.rendering.views.sight import look_around

HEADINGS = 72  # Five degrees apart.
PITCHES_DEG = (-4.0, 8.0, 22.0)  # Of the rays, down is positive.
NEAR_M, GOOD_M = 0.6, 3.2  # No view, a good view.
LOST_WORTH = 0.1  # Of a ray that meets nothing: the sky is no room.
THING_WORTH = 0.45  # More for a ray that meets furniture,
AHEAD_WORTH = 0.22  # for looking the way one goes,
WALL_COST = 0.8  # less for a wall before one's nose, within
WALL_M = 1.1
TURN_COST = 0.035  # Of five degrees.
MOST_TURN = 5  # Headings from one place to the next.


def best_headings(
    hiding: Hiding,
    semantic: np.ndarray,
    eyes: np.ndarray,
    ways: np.ndarray,
    half_fov_deg: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return a smooth sequence of game yaws, in degrees and not wrapped, and how good each view is.

    Both are float64 [N]; a view's worth is about 0 for a wall before one's nose, 1 for a good one.

    Args:
        hiding: what hides the view.
        semantic: uint8 [X, Y, Z], the classes of blocks.
        eyes: float64 [N, 3], world blocks, along a way.
        ways: float64 [N], the game yaw of the way there, degrees.
        half_fov_deg: half the camera's horizontal field of view.
    """
    yaws_deg = np.arange(HEADINGS) * (360.0 / HEADINGS)
    far_m, cell = look_around(hiding, eyes, yaws_deg, np.array(PITCHES_DEG))
    thing = (cell >= 0) & (semantic.reshape(-1)[cell] >= SemanticClass.CHAIR)
    worth = np.clip((far_m - NEAR_M) / (GOOD_M - NEAR_M), 0, 1)
    worth = np.where(cell < 0, LOST_WORTH, worth) + THING_WORTH * thing
    column = worth.mean(axis=1)  # [N, HEADINGS]
    middle_m = far_m[:, 1:].min(axis=1)
    rating = _windows(column, half_fov_deg)
    rating -= WALL_COST * _windows(np.clip(1 - middle_m / WALL_M, 0, 1), half_fov_deg / 2)
    views = rating.copy()
    rating += AHEAD_WORTH * np.cos(np.radians(yaws_deg[None] - ways[:, None]))
    best = _best_sequence(rating)
    return np.degrees(np.unwrap(np.radians(yaws_deg[best]))), views[np.arange(len(best)), best]


def _windows(column: np.ndarray, half_deg: float) -> np.ndarray:
    """Return the mean over the headings within so many degrees, around the circle."""
    reach = max(1, round(half_deg / (360.0 / HEADINGS)))
    turned = [np.roll(column, step, axis=1) for step in range(-reach, reach + 1)]
    return np.mean(turned, axis=0)


def _best_sequence(rating: np.ndarray) -> np.ndarray:
    """Return the headings, int64 [N], with the highest sum of ratings less the cost of turns."""
    steps = np.arange(-MOST_TURN, MOST_TURN + 1)
    cost = TURN_COST * np.abs(steps) * (1 + np.abs(steps) / MOST_TURN)
    best = rating[0].copy()
    came = np.zeros(rating.shape, np.int64)
    every = np.arange(rating.shape[1])
    for n in range(1, len(rating)):
        # From heading h - step one comes to h.
        options = np.stack([np.roll(best, step) for step in steps]) - cost[:, None]
        choice = options.argmax(axis=0)
        came[n] = (every - steps[choice]) % rating.shape[1]
        best = options[choice, every] + rating[n]
    sequence = np.empty(len(rating), np.int64)
    sequence[-1] = best.argmax()
    for n in range(len(rating) - 1, 0, -1):
        sequence[n - 1] = came[n, sequence[n]]
    return sequence
