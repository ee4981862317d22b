"""A house shown: its storeys side by side, its inner walls low, its rooms in sight."""

import numpy as np

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import BlockVolume
from world2minecraft.rendering.cutaway import (
    arrange_side_by_side,
    split_storeys,
    without_ceiling,
    without_partitions,
)
from world2minecraft.rendering.preview import plan_view, preview

CEILING, FLOOR, WALL, TABLE, OBJS = 1, 2, 3, 8, 11
SIZE = (24, 22, 18)


def volume_of(semantic: np.ndarray, instance: np.ndarray | None = None) -> BlockVolume:
    return BlockVolume(
        states=(semantic > 0).astype(np.uint16),
        palette=("minecraft:air", "minecraft:stone"),
        semantic=semantic,
        instance=np.zeros(semantic.shape, np.uint16) if instance is None else instance,
        corner=(-1, 63, -1),
        block_to_room=block_to_room(np.array([0.0, 4.0]), 4.0),
    )


def house() -> BlockVolume:
    """Two storeys of 11 blocks; a wall with a doorway and a picture parts the lower one."""
    semantic = np.zeros(SIZE, np.uint8)
    instance = np.zeros(SIZE, np.uint16)
    for base in (0, 11):
        semantic[:, base] = FLOOR
        semantic[[0, -1], base : base + 11] = WALL
        semantic[:, base : base + 11, [0, -1]] = WALL
        semantic[1:-1, base + 10, 1:-1] = CEILING
    semantic[12, 1:10, 1:-1] = WALL
    semantic[12, 1:9, 4:8] = 0
    semantic[13, 7, 10:13], instance[13, 7, 10:13] = OBJS, 1
    semantic[4:8, 1:4, 4:8], instance[4:8, 1:4, 4:8] = TABLE, 2
    return volume_of(semantic, instance)


def test_storeys_add_up_to_the_house():
    whole = house()
    storeys = split_storeys(whole)
    assert [one.states.shape[1] for one in storeys] == [11, 11]
    assert sum(int((one.semantic > 0).sum()) for one in storeys) == (whole.semantic > 0).sum()
    assert [one.corner[1] for one in storeys] == [63, 74]
    assert len(split_storeys(storeys[0])) == 1


def test_side_by_side_nothing_is_lost_and_nothing_overlaps():
    storeys = [without_ceiling(one) for one in split_storeys(house())]
    row = arrange_side_by_side(storeys)
    assert row.states.shape == (24, 11, 2 * 18 + 6), "along the shorter side, 1.5 m apart"
    assert (row.semantic > 0).sum() == sum(int((one.semantic > 0).sum()) for one in storeys)
    assert arrange_side_by_side(storeys[:1]) is storeys[0]


def test_inner_walls_end_at_breast_height_and_outer_ones_do_not():
    lower = without_ceiling(split_storeys(house())[0])
    cut = without_partitions(lower)
    assert not (cut.semantic[12, 6:, 1:-1] == WALL).any()
    assert (cut.semantic[12, 1:4, 9:-1] == WALL).all()
    assert np.array_equal(cut.semantic[[0, -1]], lower.semantic[[0, -1]])
    assert not (cut.instance == 1).any(), "the picture goes with the wall it hangs on"
    assert (cut.instance == 2).sum() == (lower.instance == 2).sum()


def test_a_room_of_its_own_keeps_all_its_walls():
    upper = split_storeys(house())[1]
    assert np.array_equal(without_partitions(upper).semantic, upper.semantic)


def test_the_preview_and_the_plan_show_both_storeys():
    picture = preview(house(), 320, 240)
    assert picture.shape == (240, 320, 3)
    plan = plan_view(house(), px_per_block=2)
    assert plan.shape == (24 * 2, 42 * 2, 3) or plan.shape == (42 * 2, 24 * 2, 3)
