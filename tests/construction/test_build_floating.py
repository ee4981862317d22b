"""Nothing hangs in the air, nothing sinks into what it lies on, nothing stands in a wall."""

import numpy as np
import pytest
from build_samples import CHAIR, OBJS, RED, TABLE, WOOD, Sketch, furnished, placement

from world2minecraft.construction import build_volume
from world2minecraft.construction.overlap_avoidance import best_place, best_step
from world2minecraft.furniture.layout_checks import floaters


def lamp_over_a_table() -> Sketch:
    sketch = Sketch()
    sketch.put((20, 32), (8, 18), (8, 9), TABLE, WOOD, 1)
    for x in (20, 31):
        for y in (8, 17):
            sketch.put((x, x + 1), (y, y + 1), (0, 8), TABLE, WOOD, 1)
    return sketch.put((24, 28), (11, 15), (20, 23), OBJS, RED, 2)


def test_a_lamp_whose_cord_was_lost_hangs_on_a_chain():
    volume = build_volume(lamp_over_a_table().grid(), (), (), corner_m=np.array([0.0, 2.0]))
    assert floaters(volume.semantic).parts == 0
    chains = [i for i, state in enumerate(volume.palette) if state.startswith("minecraft:chain")]
    assert chains and (volume.instance[np.isin(volume.states, chains)] == 2).all()


def test_a_shelf_off_the_wall_by_a_hand_is_joined_to_it():
    sketch = Sketch().put((4, 8), (10, 20), (14, 16), OBJS, WOOD, 1)
    volume = build_volume(sketch.grid(), (), (), corner_m=np.array([0.0, 2.0]))
    assert (volume.instance == 1).any() and floaters(volume.semantic).parts == 0


def test_a_speck_in_the_air_is_dropped():
    sketch = Sketch().put((24, 26), (12, 14), (14, 16), OBJS, RED, 0)
    volume = build_volume(sketch.grid(), (), (), corner_m=np.array([0.0, 2.0]))
    assert not (volume.semantic == OBJS).any()


def test_a_book_on_a_table_is_lifted_onto_it_not_lost_in_it():
    sketch = furnished()
    book = placement("box", OBJS, (2.0, 0.9, 0.76), (0.24, 0.24, 0.1), number=3)
    table = placement("dining_table", TABLE, (2.08, 0.96, 0.36), (0.72, 1.6, 0.75), 1)
    sketch.put((24, 27), (10, 13), (9, 10), OBJS, RED, 3)
    volume = build_volume(
        sketch.grid(), (book, table), (), corner_m=np.array([0.0, 2.0]), blocks_per_metre=4.0
    )
    assert (volume.instance == 3).any()


def test_nothing_hovers_half_a_block_over_the_slab_it_lies_on():
    table = placement("dining_table", TABLE, (2.0, 1.0, 0.44), (0.8, 1.6, 0.88), 1)
    book = placement("box", OBJS, (2.0, 1.0, 1.0), (0.24, 0.24, 0.24), number=3)
    sketch = Sketch().put((22, 28), (10, 15), (10, 11), TABLE, WOOD, 1)
    sketch.put((23, 27), (11, 14), (11, 14), OBJS, RED, 3)
    volume = build_volume(sketch.grid(), (table, book), (), corner_m=np.array([0.0, 2.0]))
    x, y, z = np.argwhere(volume.instance == 3)[0]
    below = volume.palette[volume.states[x, y - 1, z]]
    assert "type=top" not in volume.palette[volume.states[x, y, z]]
    assert volume.instance[x, y - 1, z] == 1 and "type=bottom" not in below


@pytest.mark.parametrize("scale", [2.0, 4.0])
def test_furniture_takes_no_floor_window_or_place_outside(scale):
    sketch = furnished()
    bare = build_volume(
        sketch.grid(), (), (), corner_m=np.array([0.0, 2.0]), blocks_per_metre=scale
    )
    outside = placement("cabinet", 10, (2.2, -0.2, 1.2), (0.5, 1.2, 1.2), number=4)
    beyond = placement("chair", CHAIR, (4.6, 2.5, 0.45), (0.5, 0.5, 0.9), number=5)
    volume = build_volume(
        sketch.grid(),
        (outside, beyond),
        (),
        corner_m=np.array([0.0, 2.0]),
        blocks_per_metre=scale,
    )
    for structure in (2, 4):
        assert (volume.semantic[bare.semantic == structure] == structure).all()
    assert not (volume.instance == 5).any()


def test_a_thing_steps_aside_only_where_it_would_lose_much():
    filled = np.ones((2, 2, 2), bool)
    low, free = np.array([2, 2, 0]), np.ones((6, 6, 6), bool)
    opened = np.zeros_like(free)
    assert best_step(filled, low, free, opened, stands=True).tolist() == [0, 0, 0]
    free[3] = False
    assert best_step(filled, low, free, opened, stands=True).tolist() == [-1, 0, 0]
    free[:, :, :2] = False
    assert best_step(filled, low, free, opened, stands=False).tolist() == [0, 0, 0]
    free[:] = True
    free[:, :, 0] = False
    free[2:4, 2:4, :1] = False
    thin = np.ones((2, 2, 1), bool)
    assert best_step(thin, low, free, opened, stands=False).tolist() == [0, 0, 1]
    assert best_step(thin, low, free, opened, stands=True).tolist() == [0, 0, 0]


def test_an_object_without_free_places_gets_the_best_free_block():
    free = np.zeros((5, 5, 5), bool)
    blocks, counts = np.array([[2, 2, 2], [2, 2, 3]]), np.array([9, 1])
    assert best_place(blocks, counts, free) is None
    free[3, 2, 2] = free[2, 3, 3] = True
    assert best_place(blocks, counts, free).tolist() == [3, 2, 2]
    free[2, 2, 2] = True
    assert best_place(blocks, counts, free).tolist() == [2, 2, 2]


def test_a_small_thing_between_others_is_never_lost():
    sketch = furnished().put((3, 4), (8, 10), (9, 10), OBJS, RED, 3)
    thing = placement("box", OBJS, (0.28, 0.72, 0.76), (0.08, 0.16, 0.08), number=3)
    volume = build_volume(sketch.grid(), (thing,), (), corner_m=np.array([0.0, 2.0]))
    assert (volume.instance == 3).any()


def test_a_chair_back_alone_gets_a_leg_and_no_bridge():
    sketch = Sketch().put((20, 26), (8, 14), (0, 11), CHAIR, WOOD, 1)
    sketch.put((34, 40), (8, 10), (8, 11), CHAIR, WOOD, 2)
    volume = build_volume(sketch.grid(), (), (), corner_m=np.array([0.0, 2.0]))
    assert floaters(volume.semantic).parts == 0
    columns = np.unique(np.argwhere(volume.instance == 2)[:, [0, 2]], axis=0)
    assert np.ptp(columns[:, 0]) <= 2  # Six cells are two blocks; a leg may stand on any of them.
    assert (volume.instance[:, 2] == 2).any()
