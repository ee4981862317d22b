"""A row is split where its votes change, and a bath from its curtain."""

from itertools import pairwise

import numpy as np
import pytest
from tests.reconstruction.instances.test_instances import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.vocabulary import nyu40_names
from world2minecraft.reconstruction.instances.split_by_votes import split_by_votes

FURN, OBJS = SemanticClass.FURN, SemanticClass.OBJS


def votes_for(cells: np.ndarray, names: list[str], weight: float = 10.0) -> np.ndarray:
    votes = np.zeros((len(cells), 40), np.float32)
    votes[np.arange(len(cells)), [nyu40_names()[name] - 1 for name in names]] = weight
    return votes


def row(names: list[str], bottom: int = 0, axis: int = 0) -> tuple[np.ndarray, list[int]]:
    """Return the owners of the cells of a row of units of 0.64 m, along its axis."""
    shape = [8 * len(names), 8] if axis == 0 else [8, 8 * len(names)]
    own = np.zeros((*shape, 24), np.bool_)
    own[:, :, bottom : bottom + 11] = True
    labels = np.where(own, FURN, 0).astype(np.uint8)
    cells = np.argwhere(own)
    votes = votes_for(cells, [names[place // 8] for place in cells[:, axis]])
    owners = split_by_votes(own.astype(np.int32), grid_of(labels), cells, votes)
    assert (owners[~own] == 0).all()
    side = owners[:, 4, bottom] if axis == 0 else owners[4, :, bottom]
    assert (owners[own] > 0).all()
    return owners, [n + 1 for n, (a, b) in enumerate(pairwise(side)) if a != b]


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("unit", ["other furniture", "refrigerator", "sink", "other structure"])
def test_a_unit_in_a_row_becomes_an_object(unit, axis):
    owners, cuts = row(["cabinet", unit, "counter"], axis=axis)
    assert cuts == [8, 16] and len(np.unique(owners)) == 4


def test_rows_of_one_kind_stay_whole():
    assert row(["cabinet", "counter", "cabinet"])[1] == []
    assert row(["other furniture", "other structure"])[1] == []


def test_what_hangs_stays_whole():
    assert row(["cabinet", "refrigerator"], bottom=10)[1] == []


def test_few_votes_split_nothing():
    own = np.ones((16, 8, 11), np.bool_)
    cells = np.argwhere(own)[::40]
    names = ["sink" if place < 8 else "cabinet" for place in cells[:, 0]]
    owners = split_by_votes(
        own.astype(np.int32),
        grid_of(np.where(own, FURN, 0).astype(np.uint8)),
        cells,
        votes_for(cells, names, weight=1.0),
    )
    assert len(np.unique(owners)) == 1


def bath(upper: str, class_id: int = OBJS) -> np.ndarray:
    """Return the owners of a bath with something on the long side of its rim."""
    own = np.zeros((10, 21, 26), np.bool_)
    own[:, :, :8] = True
    own[:1, :, 8:24] = True
    cells = np.argwhere(own)
    names = ["bathtub" if height < 8 else upper for height in cells[:, 2]]
    grid = grid_of(np.where(own, class_id, 0).astype(np.uint8))
    return split_by_votes(own.astype(np.int32), grid, cells, votes_for(cells, names))


@pytest.mark.parametrize("class_id", [FURN, OBJS])
@pytest.mark.parametrize("upper", ["shower curtain", "wall", "towel"])
def test_a_curtain_is_cut_off_at_the_rim(upper, class_id):
    owners = bath(upper, class_id)
    assert set(np.unique(owners)) == {0, 1, 2}
    assert (owners[:, :, :8] == 1).all() and (owners[:1, :, 8:24] == 2).all()


def test_a_tall_thing_that_is_all_bath_stays_whole():
    assert set(np.unique(bath("bathtub"))) == {0, 1}
