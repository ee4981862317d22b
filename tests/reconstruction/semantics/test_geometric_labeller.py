"""The geometric labeller on small rooms: what each surface is, and what may never happen."""

from dataclasses import replace

import label_rooms as rooms
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.types import COMPLETED, OBSERVED
from world2minecraft.reconstruction.semantics import LABELLERS, labeller
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller


def labelled(room, **options):
    grid, evidence, truth = room.scanned(**options)
    return GeometricLabeller().label(grid, evidence), truth


def test_an_empty_room_is_structure_alone():
    result, truth = labelled(rooms.SmallRoom())
    for class_id in (1, 2, 3):
        assert rooms.label_share(result, truth, class_id) > 0.95
    assert set(np.unique(result.labels[result.occupied])) == {1, 2, 3}


def test_without_a_ceiling_in_sight_walls_are_walls():
    result, truth = labelled(rooms.SmallRoom(ceiling=False))
    assert rooms.label_share(result, truth, 3) > 0.95
    assert not (result.labels == 1).any()


def test_a_table_with_a_chair_tucked_under_is_both():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    rooms.chair(room, 1.1, 2.0, facing=1)
    rooms.chair(room, 2.4, 2.1, facing=-1)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 8) > 0.85
    assert rooms.label_share(result, truth, 5) > 0.7


def test_a_sofa_is_no_bed_and_a_bed_no_sofa():
    room = rooms.SmallRoom()
    rooms.sofa(room, 0.6, 0.0)
    rooms.bed(room, 0.0, 2.4)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 7) > 0.9
    assert rooms.label_share(result, truth, 6) > 0.9


def test_counters_and_hung_cupboards_are_furniture_not_wall():
    room = rooms.SmallRoom()
    room.add((0, 0, 0, 0.6, 3.0, 0.86), 10, rooms.RED)
    room.add((0, 0, 0.86, 0.62, 3.0, 0.9), 10, rooms.DARK)
    room.add((0, 0, 1.4, 0.36, 3.0, 2.1), 10, rooms.RED)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 10) > 0.85
    assert rooms.label_share(result, truth, 3) > 0.95


def test_a_wardrobe_up_to_man_height_is_furniture():
    room = rooms.SmallRoom().add((0, 1.0, 0, 0.6, 2.4, 2.0), 10)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 10) > 0.9


def test_dark_plate_before_a_wall_is_a_screen_bright_is_not():
    box = (3.04, 1.4, 1.0, 3.1, 2.5, 1.6)
    dark, truth = labelled(rooms.SmallRoom().add(box, 9, rooms.DARK))
    assert rooms.label_share(dark, truth, 9) > 0.8
    bright, _ = labelled(rooms.SmallRoom().add(box, 9, rooms.WHITE))
    assert not (bright.labels == 9).any()


def test_the_inner_walls_of_an_l_shaped_room_are_walls():
    room = rooms.SmallRoom(size_m=(4.0, 4.0, 2.4)).add((2.4, 2.4, 0, 4.0, 4.0, 2.4), 3, rooms.WHITE)
    result, truth = labelled(room)
    assert rooms.label_share(result, truth, 3) > 0.95


def test_a_recess_in_a_wall_is_a_window():
    # The wall stands 6 cm before its glass, which it leaves free from 1.2 to 2.6 and 0.9 to 2.0.
    room = rooms.SmallRoom()
    for low, high, bottom, top in (
        (0.0, 1.2, 0.0, 2.4),
        (2.6, 4.0, 0.0, 2.4),
        (1.2, 2.6, 0.0, 0.9),
        (1.2, 2.6, 2.0, 2.4),
    ):
        room.add((0, low, bottom, 0.06, high, top), 3, rooms.WHITE)
    grid, evidence, _ = room.scanned()
    result = GeometricLabeller().label(grid, evidence)
    y, z = (rooms.MARGIN + np.array(edge) / rooms.VOXEL_M for edge in ((1.2, 2.6), (0.9, 2.0)))
    glass, beyond = np.zeros((2, *grid.shape), bool)
    glass[:3, int(y[0]) + 2 : int(y[1]) - 1, int(z[0]) + 2 : int(z[1]) - 1] = True
    beyond[:3, int(y[0]) - 1 : int(y[1]) + 2, int(z[0]) - 1 : int(z[1]) + 2] = True
    assert (result.labels[glass & result.occupied] == 4).mean() > 0.9
    assert not (result.labels[~beyond] == 4).any()


def test_spill_comes_down_to_the_floor():
    grid, evidence, _ = rooms.SmallRoom().scanned()
    floor_layer = rooms.MARGIN - 1
    labels, log_odds = np.array(grid.labels), np.array(evidence.log_odds)
    offset, hits = np.array(evidence.offset_sum), np.array(evidence.hits)
    colour, source = np.array(grid.colour), np.array(grid.source)
    lifted, high = (20, 20), (30, 20)
    for column, z_m in ((lifted, 0.015), (high, 0.07)):
        at, under = (*column, floor_layer + 1), (*column, floor_layer)
        labels[at], log_odds[at], hits[at], source[at] = 11, 2.0, 10, OBSERVED
        offset[at] = [0, 0, 10 * (z_m - 0.04)]
        colour[at] = (90, 10, 10)
        labels[under], log_odds[under], source[under] = 255, 0, 0
    grid = replace(grid, labels=labels, colour=colour, source=source)
    evidence = replace(evidence, log_odds=log_odds, offset_sum=offset, hits=hits)
    result = GeometricLabeller().label(grid, evidence)
    assert result.labels[(*lifted, floor_layer + 1)] == 0
    assert result.labels[(*lifted, floor_layer)] == 2
    assert result.source[(*lifted, floor_layer)] == COMPLETED
    assert result.colour[(*lifted, floor_layer)].tolist() == [90, 10, 10]
    # A thing that rises higher is no spill, and stays.
    assert result.labels[(*high, floor_layer + 1)] == 11
    assert result.labels[(*high, floor_layer)] == 255


@settings(max_examples=8)
@given(st.integers(0, 3), st.integers(0, 1000))
def test_evidence_wins_and_nothing_is_invented(kind, seed):
    random = np.random.default_rng(seed)
    room = rooms.SmallRoom(size_m=(2.4, 2.8, 2.4), ceiling=bool(kind % 2))
    for _ in range(4):
        low = random.uniform(0, [2.0, 2.4, 1.2])
        room.add((*low, *(low + random.uniform(0.1, 0.7, 3))), 11, random.integers(0, 255, 3))
    grid, evidence, _ = room.scanned(noise_m=0.01, seed=seed)
    result = GeometricLabeller().label(grid, evidence)
    structure = (result.labels >= 1) & (result.labels <= 4)
    lost = grid.occupied & ~result.occupied
    made = result.occupied & ~grid.occupied
    # Only cells of a plane are pulled into its layer; they stay within two cells of it.
    near = ndimage.binary_dilation(structure, np.ones((5, 5, 5), bool))
    assert not (lost & ~near).any()
    assert structure[made].all()
    assert not (made & ~ndimage.binary_dilation(grid.occupied, iterations=2)).any()
    kept = grid.occupied & result.occupied
    assert np.array_equal(result.source[kept], grid.source[kept])


@pytest.mark.parametrize("shift_m", [0.0, 0.012, 0.03, -0.012])
def test_wall_is_one_cell_thick_in_its_matter_layer(shift_m):
    # The wall towards x = 0 stands before or behind the edge of two cells by a shift.
    room = rooms.SmallRoom(size_m=(3.2, 4.0, 2.4))
    if shift_m > 0:
        room.add((0, 0, 0, shift_m, 4.0, 2.4), 3, rooms.WHITE)
    grid, evidence, _ = room.scanned(noise_m=0.012)
    if shift_m < 0:
        offset = np.array(evidence.offset_sum)
        offset[:4, ..., 0] += shift_m * np.array(evidence.hits, np.float32)[:4]
        evidence = replace(evidence, offset_sum=offset)
    result = GeometricLabeller().label(grid, evidence)
    inner = (slice(0, 6), slice(6, -6), slice(6, -6))
    layer = rooms.MARGIN if shift_m > 0.01 else rooms.MARGIN - 1
    wall = result.labels[inner] == 3
    assert wall[layer].mean() > 0.99
    assert wall.sum() == wall[layer].sum()
    assert not result.occupied[inner][layer + 1 :].any()


def test_labels_do_not_depend_on_which_way_the_room_lies():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    rooms.sofa(room, 0.6, 0.0)
    grid, evidence, _ = room.scanned(noise_m=0.0)
    result = GeometricLabeller().label(grid, evidence)
    turned_grid, turned_evidence = _turned(grid, evidence)
    turned = GeometricLabeller().label(turned_grid, turned_evidence)
    assert (turned.labels == turn_grid(result.labels, 1)).mean() > 0.999


def _turned(grid, evidence):
    """A grid and its evidence, turned by a quarter about their own corner."""
    arrays = ("labels", "confidence", "colour", "source", "instance")
    turned_grid = replace(grid, **{name: turn_grid(getattr(grid, name), 1) for name in arrays})
    arrays = ("log_odds", "votes", "colour_sum", "hits")
    turned = {name: turn_grid(getattr(evidence, name), 1) for name in arrays}
    offset = turn_grid(evidence.offset_sum, 1)
    turned["offset_sum"] = np.stack([-offset[..., 1], offset[..., 0], offset[..., 2]], axis=-1)
    return turned_grid, replace(evidence, **turned)


def test_confidence_is_higher_for_structure_than_for_objects():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    result, _ = labelled(room)
    mean = [float(result.confidence[result.labels == c].astype(float).mean()) for c in (2, 3, 8)]
    assert mean[0] > mean[2] and mean[1] > mean[2] > 0


def test_the_same_input_gives_the_same_labels():
    room = rooms.SmallRoom()
    rooms.chair(room, 1.6, 2.0)
    assert np.array_equal(labelled(room)[0].labels, labelled(room)[0].labels)


def test_nothing_occupied_is_labelled_without_complaint():
    grid, evidence, _ = rooms.SmallRoom().scanned()
    labels = np.where(grid.occupied, np.uint8(0), grid.labels)
    result = GeometricLabeller().label(replace(grid, labels=labels), evidence)
    assert not result.occupied.any()


def test_a_grid_of_other_cells_is_refused():
    grid, evidence, _ = rooms.SmallRoom().scanned()
    moved = replace(grid, origin_m=grid.origin_m + 0.08)
    with pytest.raises(ValueError, match="must have the same shape and origin"):
        GeometricLabeller().label(moved, evidence)


def test_both_labellers_are_found_by_name():
    assert LABELLERS.names()[:2] == ("geometric", "votes")
    assert isinstance(labeller("geometric"), GeometricLabeller)
