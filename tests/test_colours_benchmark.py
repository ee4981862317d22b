import numpy as np
import pytest
from benchmarks.check_colours import figures, relief_share, wall_colours

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import AIR, BlockVolume

CREAM = (226, 220, 204)


def wall_of(block: str) -> BlockVolume:
    """Return a wall of 3 m by 2 m at x = 0, open to both sides."""
    states = np.zeros((4, 8, 12), np.uint16)
    states[1] = 1
    semantic = np.where(states > 0, int(SemanticClass.WALL), 0).astype(np.uint8)
    place = np.diag([0.25, 0.25, 0.25, 1.0])
    return BlockVolume(
        states, (AIR, f"minecraft:{block}"), semantic, np.zeros_like(states), (0, 0, 0), place
    )


def points_on_wall() -> np.ndarray:
    cells = np.argwhere(np.ones((1, 8, 12), bool))
    return 0.25 * (cells + np.array([1.5, 0.5, 0.5]))


@pytest.mark.parametrize(
    ("block", "grey", "relief"),
    [("mushroom_stem", 0, 0.0), ("polished_diorite", 2, 1.0), ("white_concrete", 2, 0.0)],
)
def test_a_cream_wall_of_a_grey_block_is_counted(block, grey, relief):
    volume, points = wall_of(block), points_on_wall()
    walls = wall_colours(volume, points, np.tile(np.array(CREAM, np.uint8), (len(points), 1)))
    row = figures("room", {"wall": np.array([3.0, 5.0])}, walls, volume)
    assert (row["walls"], row["coloured"], row["grey"]) == (2, 2, grey)
    assert (row["surface"], row["relief"]) == (4.0, relief)
    assert relief_share(volume) == relief


def test_walls_that_no_paint_is_known_of_are_left_out():
    points = points_on_wall() + np.array([0, 0, 50.0])
    colours = np.full((len(points), 3), 200, np.uint8)
    assert wall_colours(wall_of("white_concrete"), points, colours) == []
