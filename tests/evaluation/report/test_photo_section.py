"""The report's comparison with photos: its figures, its crops and their order."""

import json

import pytest
from tests.reconstruction.verification.verified_room import verified_room

from world2minecraft.evaluation.report.photo_section import (
    agreement_facts,
    crop_objects,
    worst_first,
)
from world2minecraft.reconstruction.verification.world_agreement import compare_world
from world2minecraft.rendering.scene import prepare_scene


@pytest.fixture(scope="module")
def volume():
    room = verified_room()
    return room.volume(room.placements)


@pytest.fixture(scope="module")
def found(volume):
    room = verified_room()
    return compare_world(room.samples, room.grid, room.instances, room.placements, volume)


def test_figures_are_json_and_add_up(found):
    facts = agreement_facts(found, verified_room().samples)
    assert json.loads(json.dumps(facts)) == facts
    assert facts["headline"] + sum(facts["fails"].values()) == pytest.approx(1, abs=1e-3)
    assert {row["id"] for row in facts["objects"]} == set(range(1, 11))
    assert {row["view"] for row in facts["objects"]} <= {f"photo {n}" for n in range(6)}


def test_without_photos_a_reason_stands_in_place_of_the_headline():
    assert agreement_facts(None, ()) == {"headline": None, "reason": "no photo with depth"}
    reason = agreement_facts(None, verified_room().samples)["reason"]
    assert reason == "the photos have no depth of the room"


def test_crops_show_the_same_part_of_photo_and_world(found, volume):
    samples = verified_room().samples
    crops = crop_objects(found, samples, prepare_scene(volume))
    assert [crop.object_id for crop in crops] == [row.object_id for row in found.objects]
    for crop, row in zip(crops, found.objects, strict=True):
        assert crop.photo.shape == crop.built.shape and min(crop.photo.shape[:2]) > 5
        high, wide = (row.box_px[side + 2] - row.box_px[side] for side in (0, 1))
        assert crop.photo.shape[0] >= high and crop.photo.shape[1] >= wide


def test_objects_with_most_wrong_surface_come_first():
    rows = [
        {"id": 1, "right": 1.0, "pixels": 9000},
        {"id": 2, "right": 0.0, "pixels": 100},
        {"id": 3, "right": 0.5, "pixels": 400},
    ]
    assert [row["id"] for row in worst_first(rows)] == [3, 2, 1]
