"""Votes for fine names: summed by place, given to the objects there, read as they were written."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.reconstruction.instances.test_instances import grid_of

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import write_npz
from world2minecraft.core.vocabulary import label_id_names, label_id_of, nyu40_names
from world2minecraft.reconstruction.naming import name_votes
from world2minecraft.reconstruction.naming.name_votes import (
    CUBE_M,
    CubeIndex,
    NameVoteMap,
    NameVotes,
    class_votes,
    read_name_votes,
    votes_of_objects,
    write_name_votes,
)


def slow_sums(views):
    """Add the votes of the first point of each pixel, cube by cube."""
    sums = {}
    for points, pixels, chances in views:
        seen = set()
        for point, pixel in zip(points, pixels.tolist(), strict=True):
            if pixel not in seen:
                seen.add(pixel)
                cube = tuple(np.floor(point / CUBE_M).astype(int).tolist())
                sums[cube] = sums.get(cube, 0) + chances[pixel]
    return sums


@given(st.integers(0, 1 << 30), st.integers(1, 3))
def test_each_pixel_votes_once_in_the_cube_of_its_point(seed, count):
    rng = np.random.default_rng(seed)
    votes, views = NameVoteMap(), []
    for _ in range(count):
        points = rng.uniform(-0.3, 0.3, (40, 3))
        pixels, chances = rng.integers(0, 25, 40), rng.dirichlet(np.ones(40), 25)
        votes.add(points, pixels, chances)
        views.append((points, pixels, chances.astype(np.float32)))
    found, wanted = votes.votes(), slow_sums(views)
    assert {tuple(cube) for cube in found.cubes.tolist()} == set(wanted)
    for cube, row in zip(found.cubes.tolist(), found.votes, strict=True):
        assert np.allclose(row, wanted[tuple(cube)], atol=1e-5)


@given(st.integers(0, 1 << 30), st.integers(0, 30))
def test_cubes_are_found_by_place(seed, count):
    rng = np.random.default_rng(seed)
    cubes = np.unique(rng.integers(-3, 4, (count, 3)), axis=0)
    cubes = rng.permutation(cubes).astype(np.int32)
    wanted = rng.integers(-5, 6, (60, 3))
    rows = {tuple(cube): row for row, cube in enumerate(cubes.tolist())}
    expected = [rows.get(tuple(cube), -1) for cube in wanted.tolist()]
    assert CubeIndex(cubes).find(wanted).tolist() == expected


def test_labels_vote_beside_a_network():
    votes, toilet = NameVoteMap(), label_id_of("toilet")
    points = np.array([[0.01, 0.01, 0.01], [0.02, 0.01, 0.01], [0.5, 0.5, 0.5]])
    votes.add(points, np.array([0, 1, 2]), np.eye(40)[[3, 3, 3]])
    votes.add_labels(points, np.array([0, 0, 1]), np.array([toilet, 0], np.uint16))
    found = votes.votes()
    row = found.votes[(found.cubes == 0).all(axis=1)][0]
    assert row[3] == 2 and row[toilet - 1] == 1 and row.sum() == 3
    assert found.votes.sum() == 4, "label 0 does not vote"


def test_no_view_is_no_vote():
    found = NameVoteMap().votes()
    assert found.cubes.shape == (0, 3)
    assert not votes_of_objects(found, grid_of(np.zeros((3, 3, 3), np.uint8)), 2).any()


def test_an_object_gets_the_votes_in_its_cells():
    labels = np.zeros((6, 6, 6), np.uint8)
    labels[1:3, 1, 1], labels[4, 4, 4] = 11, 10
    owners = np.zeros(labels.shape, np.uint16)
    owners[1:3, 1, 1], owners[4, 4, 4] = 1, 2
    grid = replace(grid_of(labels), instance=owners)
    first = np.round(grid.origin_m / CUBE_M).astype(np.int32)
    cubes = first + np.array([[1, 1, 1], [2, 1, 1], [4, 4, 4], [0, 0, 0], [99, 0, 0]], np.int32)
    votes = np.zeros((5, 40), np.float32)
    votes[:, 5] = [1, 2, 4, 8, 16]
    found = votes_of_objects(NameVotes(cubes, votes), grid, 2)
    assert found[:, 5].tolist() == [8, 3, 4]


def test_votes_are_read_as_written(tmp_path):
    votes = NameVotes(np.array([[1, -2, 3]], np.int32), np.full((1, 40), 0.5, np.float32))
    write_name_votes(tmp_path / "names.npz", votes)
    again = read_name_votes(tmp_path / "names.npz")
    assert np.array_equal(again.cubes, votes.cubes)
    assert np.array_equal(again.votes, votes.votes)
    write_npz(tmp_path / "names.npz", {"cubes": votes.cubes, "votes": votes.votes[:, :7]})
    with pytest.raises(DamagedFileError, match="does not contain votes"):
        read_name_votes(tmp_path / "names.npz")


def test_votes_for_a_name_support_its_class():
    votes = np.zeros((1, len(label_id_names()) - 1))
    votes[0, label_id_of("armchair") - 1], votes[0, nyu40_names()["bed"] - 1] = 0.7, 0.3
    found = class_votes(votes)[0]
    assert found[nyu40_names()["chair"] - 1] == 0.7 and found[nyu40_names()["bed"] - 1] == 0.3
    assert found.sum() == 1


def test_votes_are_found_again_in_another_vocabulary(tmp_path, monkeypatch):
    votes = np.zeros((1, len(label_id_names()) - 1), np.float32)
    votes[0, label_id_of("toilet") - 1], votes[0, label_id_of("piano") - 1] = 200_000, 100_000
    votes[0, 2] = 8
    path = tmp_path / "names.npz"
    write_name_votes(path, NameVotes(np.zeros((1, 3), np.int32), votes))
    fewer = ("", *label_id_names()[1:41], "gizmo", "piano")
    monkeypatch.setattr(name_votes, "label_id_names", lambda: fewer)
    (found,) = read_name_votes(path).votes
    assert found.shape == (42,) and found[41] == 30_000 and found[2] == pytest.approx(2.4, rel=0.01)
    assert found.sum() == found[41] + found[2], "no other name has votes"
