"""Specks within a surface belong to it; uncertain lumps on walls belong to the wall."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.reconstruction.instances.test_instances import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.types import FusedEvidence
from world2minecraft.formats.run_arrays import read_room, write_evidence, write_room
from world2minecraft.reconstruction.file_stages import find_stage
from world2minecraft.reconstruction.instances import InstanceParameters, find_objects
from world2minecraft.reconstruction.instances.denoise import relabel_specks
from world2minecraft.reconstruction.parameters import Parameters

TABLE, OBJS, FURN = SemanticClass.TABLE, SemanticClass.OBJS, SemanticClass.FURN


def _room():
    """Return labels with a table's top two cells thick and a cupboard."""
    labels = np.zeros((30, 28, 20), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[4:18, 4:14, 8:10] = TABLE
    labels[20:26, 4:16, 1:14] = FURN
    return labels


@pytest.mark.parametrize("cells", [(3, 2, 1), (2, 1, 2), (1, 1, 1), (1, 6, 1)])
def test_a_speck_in_a_surface_is_of_it(cells):
    labels = _room()
    labels[8 : 8 + cells[0], 7 : 7 + cells[1], 10 - cells[2] : 10] = OBJS
    np.testing.assert_array_equal(relabel_specks(labels), _room())


@pytest.mark.parametrize(
    "where",
    [
        np.s_[8:10, 7:9, 10:11],  # On the table.
        np.s_[8:9, 7:9, 9:12],  # Sunk into the table by a cell.
        np.s_[19:20, 6:9, 6:8],  # Before the cupboard.
        np.s_[17:18, 6:7, 8:10],  # At the table's edge.
        np.s_[8:12, 6:9, 9:10],  # In the table, but as large as an object.
        np.s_[27:29, 20:22, 1:2],  # Alone on the floor.
    ],
)
def test_what_stands_on_or_before_a_surface_stays(where):
    labels = _room()
    labels[where] = OBJS
    np.testing.assert_array_equal(relabel_specks(labels), labels)


def test_a_speck_between_two_classes_stays():
    labels = _room()
    labels[18:20, 4:16, 8:10] = FURN
    labels[17:19, 8:10, 8:10] = OBJS
    np.testing.assert_array_equal(relabel_specks(labels), labels)


@given(st.integers(0, 2**32 - 1), st.integers(1, 3))
@settings(max_examples=25, deadline=None)
def test_turning_the_grid_turns_what_is_joined(seed, turns):
    labels = _room()
    rng = np.random.default_rng(seed)
    noisy = (labels > 4) & (rng.random(labels.shape) < 0.05)
    labels[noisy] = rng.integers(5, 12, int(noisy.sum()))
    turned = np.ascontiguousarray(turn_grid(labels, turns))
    np.testing.assert_array_equal(relabel_specks(turned), turn_grid(relabel_specks(labels), turns))


def test_object_owns_its_specks_and_grid_keeps_labels():
    labels = _room()
    labels[8:10, 7:9, 9] = OBJS
    found = find_objects(grid_of(labels))
    np.testing.assert_array_equal(found.grid.labels, labels)
    table = next(item for item in found.instances if item.class_id == TABLE)
    assert (found.grid.instance[8:10, 7:9, 9] == table.id).all()
    assert found.leftover == 0
    plain = find_objects(grid_of(labels), InstanceParameters(paper_compat=True))
    assert plain.grid.instance[8, 7, 9] != plain.grid.instance[4, 4, 9]


WALL = SemanticClass.WALL
WALL_RGB, PICTURE_RGB = (200, 198, 190), (120, 40, 40)


def _wall_with(box, rgb, confidence, label=OBJS):
    """Return a grid with a wall at low x and a box in front of it."""
    labels = np.zeros((30, 28, 30), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[2, :, 1:] = WALL
    labels[box] = label
    grid = grid_of(labels)
    sure = np.full(labels.shape, 0.9, np.float16)
    sure[box] = confidence
    colour = np.full((*labels.shape, 3), WALL_RGB, np.uint8)
    colour[box] = rgb
    return replace(grid, confidence=sure, colour=colour)


@pytest.mark.parametrize("label", [OBJS, FURN])
@pytest.mark.parametrize(
    ("box", "rgb", "confidence"),
    [
        (np.s_[3:5, 8:14, 10:16], PICTURE_RGB, 0.1),  # Uncertain.
        (np.s_[3:6, 8:14, 10:16], WALL_RGB, 0.8),  # Of the wall's colour.
    ],
)
def test_a_lump_on_a_wall_becomes_wall(box, rgb, confidence, label):
    found = find_objects(_wall_with(box, rgb, confidence, label))
    assert found.instances == () and found.leftover == 0
    assert (found.grid.labels[box] == WALL).all() and not found.grid.instance.any()


@pytest.mark.parametrize(
    ("box", "rgb", "confidence"),
    [
        (np.s_[3:4, 8:14, 10:16], PICTURE_RGB, 0.4),  # A picture on the wall.
        (np.s_[3:9, 8:14, 1:16], WALL_RGB, 0.1),  # A white cupboard at the wall.
        (np.s_[20:22, 8:14, 10:16], WALL_RGB, 0.1),  # Something away from the wall.
    ],
)
def test_pictures_and_what_stands_before_walls_are_kept(box, rgb, confidence):
    grid = _wall_with(box, rgb, confidence)
    found = find_objects(grid)
    assert len(found.instances) == 1
    np.testing.assert_array_equal(found.grid.labels, grid.labels)


def test_the_method_of_the_paper_keeps_lumps():
    box = np.s_[3:5, 8:14, 10:16]
    found = find_objects(_wall_with(box, WALL_RGB, 0.1), InstanceParameters(paper_compat=True))
    assert (found.grid.labels[box] == OBJS).all()


LUMP = np.s_[3:6, 8:14, 10:16]


def test_a_lump_that_label_images_state_is_kept():
    grid = _wall_with(LUMP, WALL_RGB, 0.1)
    stated = np.zeros(grid.shape, bool)
    stated[LUMP] = True
    found = find_objects(grid, stated=stated)
    assert [one.class_id for one in found.instances] == [OBJS]
    np.testing.assert_array_equal(found.grid.labels, grid.labels)
    stated[:, 10:] = False  # A third of it is left.
    assert find_objects(grid, stated=stated).instances == ()


@pytest.mark.parametrize(("vote", "kept"), [(2.0, True), (1.5, False)])
def test_the_find_stage_trusts_votes_of_label_images_alone(tmp_path, vote, kept):
    grid = _wall_with(LUMP, WALL_RGB, 0.1)
    votes = np.zeros((*grid.shape, 12), np.float16)
    votes[LUMP][..., OBJS] = vote
    evidence = FusedEvidence(
        log_odds=np.where(grid.occupied, 1, -1).astype(np.float16),
        votes=votes,
        colour_sum=np.zeros((*grid.shape, 3), np.float32),
        hits=grid.occupied.astype(np.uint16),
        offset_sum=np.zeros((*grid.shape, 3), np.float32),
        origin_m=grid.origin_m,
        voxel_m=grid.voxel_m,
        scan_to_room=np.eye(4),
    )
    write_evidence(tmp_path / "evidence.npz", evidence)
    write_room(tmp_path / "room.npz", grid, np.eye(4))
    find_stage(tmp_path, Parameters())
    found, _ = read_room(tmp_path / "room.npz")
    assert bool(found.instance[LUMP].any()) == kept
