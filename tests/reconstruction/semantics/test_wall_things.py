"""Walls lose the cells of what votes name: large things only, and never without votes."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.reconstruction.instances.test_instances import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.vocabulary import nyu40_classes, nyu40_names
from world2minecraft.reconstruction.naming.name_votes import CUBE_M, NameVotes
from world2minecraft.reconstruction.semantics.wall_things import label_wall_things

WALL = SemanticClass.WALL
SHAPE = (4, 30, 24)
PATCH = (slice(1, 2), slice(8, 16), slice(6, 18))  # Of the wall at x = 1: 0.6 m2.


def wall():
    labels = np.zeros(SHAPE, np.uint8)
    labels[1] = WALL
    return replace(grid_of(labels), origin_m=np.zeros(3))


def votes_in(patch, name, share, weight=100.0):
    """Return votes for the wall at x = 1, of which a share in a patch is for a name."""
    cubes = np.argwhere(wall().labels == WALL)
    inside = np.zeros(SHAPE, bool)
    inside[patch] = True
    votes = np.zeros((len(cubes), 40), np.float32)
    own = np.where(inside[tuple(cubes.T)], share, 0.0)
    votes[:, nyu40_names()["wall"] - 1] = weight * (1 - own) + 0.25
    votes[:, nyu40_names()[name] - 1] += (weight * own).astype(np.float32)
    return NameVotes(cubes.astype(np.int32), votes)


@pytest.mark.parametrize("name", ["cabinet", "blinds", "door", "mirror", "refrigerator"])
def test_a_large_thing_in_a_wall_has_its_class(name):
    found = label_wall_things(wall(), votes_in(PATCH, name, 0.8)).labels
    assert (found[PATCH] == nyu40_classes()[nyu40_names()[name]]).all()
    assert (found == WALL).sum() == (wall().labels == WALL).sum() - found[PATCH].size


@pytest.mark.parametrize(("name", "share"), [("door", 0.5), ("cabinet", 0.3), ("paper", 0.9)])
def test_walls_keep_what_is_unsure_or_small_by_nature(name, share):
    found = label_wall_things(wall(), votes_in(PATCH, name, share))
    np.testing.assert_array_equal(found.labels, wall().labels)


def test_walls_keep_specks():
    speck = (slice(1, 2), slice(8, 11), slice(6, 9))
    found = label_wall_things(wall(), votes_in(speck, "door", 0.9))
    np.testing.assert_array_equal(found.labels, wall().labels)


def test_label_images_change_no_walls():
    votes = votes_in(PATCH, "door", 0.8)
    whole = NameVotes(votes.cubes, np.round(votes.votes))
    np.testing.assert_array_equal(label_wall_things(wall(), whole).labels, wall().labels)


@given(st.integers(0, 1 << 30))
def test_only_walls_change(seed):
    rng = np.random.default_rng(seed)
    labels = rng.integers(0, 12, (6, 6, 6)).astype(np.uint8)
    cubes = np.argwhere(rng.random((6, 6, 6)) < 0.8).astype(np.int32)
    votes = rng.dirichlet(np.full(40, 0.05), len(cubes)).astype(np.float32)
    grid = replace(grid_of(labels), origin_m=CUBE_M * rng.integers(-2, 3, 3))
    found = label_wall_things(grid, NameVotes(cubes, votes))
    changed = found.labels != grid.labels
    assert (grid.labels[changed] == WALL).all()
    assert (found.confidence[~changed] == grid.confidence[~changed]).all()


def test_nothing_happens_without_votes():
    none = NameVotes(np.zeros((0, 3), np.int32), np.zeros((0, 40), np.float32))
    np.testing.assert_array_equal(label_wall_things(wall(), none).labels, wall().labels)
