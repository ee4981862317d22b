"""The completion labeller: evidence wins whatever the network says."""

from dataclasses import replace

import label_rooms as rooms
import numpy as np
import pytest

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import COMPLETED, OBSERVED, UNSEEN, OccupancyGrid
from world2minecraft.reconstruction.fusion import extract_grid
from world2minecraft.reconstruction.layout.parameters import StructureParameters
from world2minecraft.reconstruction.layout.room_space import RoomSpace
from world2minecraft.reconstruction.layout.storeys import find_storeys
from world2minecraft.reconstruction.layout.surface_cells import surface_of
from world2minecraft.reconstruction.semantics import labeller
from world2minecraft.reconstruction.semantics.completion_channels import Sight
from world2minecraft.reconstruction.semantics.completion_labeller import (
    WEIGHTS,
    CompletionLabeller,
    CompletionModel,
    CompletionParameters,
    likeliest,
    piece_votes,
)
from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller
from world2minecraft.reconstruction.semantics.labeller_choice import choose_labeller


class Saying:
    """Stands for a network: says what a function of the sight's shape gives."""

    def __init__(self, chance):
        self.chance = chance

    def chances(self, sight: Sight):
        return self.chance(sight.log_odds.shape)


def labelled(scanned, chance, **parameters):
    grid, evidence, _ = scanned
    own = CompletionLabeller(CompletionParameters(**parameters))
    own.model = Saying(chance)  # type: ignore[assignment]
    return own.label(grid, evidence)


def always(kind, share=0.97):
    def chance(shape):
        result = np.full((12, *shape), (1 - share) / 11, np.float32)
        result[kind] = share
        return result

    return chance


def anywhere(shape):
    """Return a space of rooms that is everywhere and explains no floor and no wall."""
    return RoomSpace(np.ones(shape, bool), np.zeros(shape, bool), np.zeros(shape, bool))


@pytest.fixture(scope="module")
def scanned():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    return room.scanned()


def test_what_was_seen_stays_though_the_network_calls_all_empty(scanned):
    grid, evidence, _ = scanned
    base = GeometricLabeller().label(grid, evidence)
    result = labelled(scanned, always(0))
    seen = base.source != UNSEEN
    assert np.array_equal(result.occupied[seen], base.occupied[seen])
    assert np.array_equal(result.source[seen], base.source[seen])


def test_free_and_far_cells_stay_if_network_says_solid(scanned):
    grid, evidence, _ = scanned
    base = GeometricLabeller().label(grid, evidence)
    result = labelled(scanned, always(3), reach_cells=2, hint_share=0.0)
    assert not result.occupied[base.labels == 0].any()
    filled = (result.source == COMPLETED) & (base.source == UNSEEN)
    assert filled.any()
    assert (result.labels[filled] == 3).all()
    things = labelled(scanned, always(10), hint_share=0.0)
    assert (things.source[filled] == UNSEEN).all()
    assert (result.source[result.labels == 255] == UNSEEN).all()


def test_a_class_that_was_not_seen_is_not_completed(scanned):
    grid = scanned[0]
    named = replace(grid, labels=np.where(grid.occupied, np.uint8(3), grid.labels))
    result = CompletionLabeller()._completed(named, always(6)(grid.shape), anywhere(grid.shape))
    assert not (result.source == COMPLETED).any()


def test_planes_grow_along_themselves_and_no_thicker():
    labels = np.full((12, 12, 12), 255, np.uint8)
    labels[5, 2:8, 2:8] = 3
    seen = labels == 3
    grid = OccupancyGrid(
        labels, np.zeros(labels.shape, np.float16), np.zeros((*labels.shape, 3), np.uint8),
        seen.astype(np.uint8), np.zeros(labels.shape, np.uint16), 0.08, np.zeros(3),
    )  # fmt: skip
    chance, space = always(3)(labels.shape), anywhere(labels.shape)
    result = CompletionLabeller()._completed(grid, chance, space)
    filled = result.source == COMPLETED
    assert filled[5].sum() == 11 * 11 - 36
    assert not filled[:5].any()
    assert not filled[6:].any()


def test_an_unsure_network_completes_floor_and_walls_alone(scanned):
    grid, evidence, _ = scanned
    base = GeometricLabeller().label(grid, evidence)
    result = labelled(scanned, always(0, 0.5), sure=0.6)
    added = (result.source == COMPLETED) & (base.source == UNSEEN)
    assert np.isin(result.labels[added], (2, 3)).all()
    assert (result.source[result.occupied & (grid.source == OBSERVED)] == OBSERVED).mean() > 0.9


@pytest.mark.parametrize("kind", [0, 3])
def test_floor_and_wall_continue_behind_a_wardrobe(kind):
    room = rooms.SmallRoom().add((0, 1.0, 0, 0.6, 2.4, 2.0), 10)
    scan = room.scanned()
    grid, result = scan[0], labelled(scan, always(kind, 0.5))
    x, y, z = (
        (np.arange(count) + 0.5) * 0.08 + low
        for count, low in zip(grid.shape, grid.origin_m, strict=True)
    )
    behind = np.ix_((x > -0.08) & (x < 0), (y > 1.2) & (y < 2.2), (z > 0.16) & (z < 1.8))
    assert (result.labels[behind] == 3).all()
    under = np.ix_((x > 0.1) & (x < 0.5), (y > 1.2) & (y < 2.2), (z > -0.08) & (z < 0))
    assert (result.labels[under] == 2).all()
    completed = (result.source == COMPLETED).any(axis=2)
    inside = ((x > -0.09) & (x < 3.29))[:, None] & ((y > -0.09) & (y < 4.09))
    assert not completed[~inside].any()


def space_of(grid, evidence):
    surface = surface_of(grid, evidence)
    return CompletionLabeller()._space(surface, find_storeys(surface, StructureParameters()))


def test_a_floor_that_was_hardly_seen_is_not_continued(scanned):
    grid, evidence, _ = scanned
    shown = space_of(grid, evidence)
    assert shown.floor.any()
    log_odds, hits = evidence.log_odds.copy(), evidence.hits.copy()
    low = round(-evidence.origin_m[2] / 0.08) + 1
    for values in (log_odds, hits):
        values[:, :, :low] = 0
    hidden = replace(evidence, log_odds=log_odds, hits=hits)
    space = space_of(extract_grid(hidden), hidden)
    assert not space.floor.any()
    assert space.cells.any()


def test_a_piece_speaks_with_one_voice_where_it_mostly_agrees():
    hint = np.zeros((6, 4, 4), np.uint8)
    hint[1:5] = 10
    chance = np.full((12, 6, 4, 4), 0.01, np.float32)
    chance[8], chance[8, 1], chance[5, 1] = 0.9, 0.01, 0.9
    voted = piece_votes(hint, chance, 0.6)
    assert (voted[1:, 1:5].argmax(axis=0) + 1 == 8).all()
    assert np.array_equal(voted[:, 0], chance[:, 0])
    split = piece_votes(hint, chance, 0.95)
    assert (split[1:, 1].argmax(axis=0) + 1 == 5).all()


def test_weights_that_are_not_there_or_are_none_are_said(scanned, tmp_path):
    grid, evidence, _ = scanned
    missing = CompletionLabeller(weights=tmp_path / "none.onnx")
    with pytest.raises(InputError, match=r"none\.onnx"):
        missing.label(grid, evidence)
    (tmp_path / "bad.onnx").write_bytes(b"no network")
    with pytest.raises(DamagedFileError, match="is not a valid ONNX file"):
        CompletionModel(tmp_path / "bad.onnx").chances(
            Sight(np.zeros((4, 4, 4), np.int8), np.zeros(0, np.int32), np.zeros(0, np.uint8), 0.08)
        )


def test_the_shipped_weights_name_a_small_room(scanned):
    grid, evidence, truth = scanned
    result = CompletionLabeller().label(grid, evidence)
    kept = result.occupied & (truth > 0)
    assert (result.labels[kept] == truth[kept]).mean() > 0.9
    assert WEIGHTS.stat().st_size <= 6_000_000
    again = CompletionLabeller().label(grid, evidence)
    assert np.array_equal(result.labels, again.labels)
    assert np.array_equal(result.confidence, again.confidence)


def test_surface_stays_and_likelier_solid_cells_are_filled():
    chance = np.full((12, 4, 1, 1), 0.05, np.float32)
    chance[0] = np.array([0.9, 0.45, 0.55, 0.9])[:, None, None]
    chance[3], chance[8] = 0.08, 0.06
    odds = np.array([60, 0, -60, 0], np.int8)[:, None, None]
    assert likeliest(chance, odds)[:, 0, 0].tolist() == [3, 3, 0, 0]


def test_it_is_found_by_name():
    assert isinstance(labeller("completion"), CompletionLabeller)


def test_agreeing_votes_decide_else_the_network(scanned):
    grid, evidence, _ = scanned
    chairs, split = np.zeros_like(evidence.votes), np.zeros_like(evidence.votes)
    chairs[grid.occupied, 5] = 9
    split[grid.occupied] = np.eye(12)[6] + np.eye(12)[8]  # Bed or table: half and half.
    for votes, said, kind in ((chairs, 8, 5), (split, 8, 8), (split, 6, 6)):
        told = (grid, replace(evidence, votes=votes), None)
        result = labelled(told, always(said), small_cells=1)
        base = GeometricLabeller().label(grid, evidence)
        things = result.occupied & (base.source == OBSERVED) & (base.labels > 4)
        assert (result.labels[things] == kind).all()


def test_auto_takes_network_for_measured_depth_at_its_cell_size(scanned):
    evidence = scanned[1]
    assert choose_labeller(evidence, from_photos=False) == "completion"
    assert choose_labeller(evidence, from_photos=True) == "geometric"
    large = replace(evidence, voxel_m=0.16)
    assert choose_labeller(large, from_photos=False) == "geometric"
    voted = replace(large, votes=np.ones_like(large.votes))
    assert choose_labeller(voted, from_photos=False) == "votes"
