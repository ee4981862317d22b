"""The agreement of a generated room's world with photos of it, whole and spoiled on purpose."""

from dataclasses import replace

import numpy as np
import pytest
from tests.reconstruction.verification.verified_room import VerifiedRoom, verified_room

from world2minecraft.core.types import BlockVolume, Placement
from world2minecraft.reconstruction.verification.world_agreement import (
    PhotoAgreement,
    compare_world,
)


@pytest.fixture(scope="module")
def room() -> VerifiedRoom:
    return verified_room()


@pytest.fixture(scope="module")
def volume(room) -> BlockVolume:
    """The world as it was built."""
    return room.volume(room.placements)


@pytest.fixture(scope="module")
def whole(room, volume) -> PhotoAgreement:
    return compare(room, volume)


def compare(room: VerifiedRoom, volume, samples=None, placements=None) -> PhotoAgreement:
    chosen = room.samples if samples is None else samples
    placements = room.placements if placements is None else placements
    found = compare_world(chosen, room.grid, room.instances, placements, volume)
    assert found is not None
    return found


def swapped(placements: tuple[Placement, ...]) -> list[Placement]:
    """Each piece of furniture in the place of another."""
    half = len(placements) // 2
    others = placements[half:] + placements[:half]
    return [
        replace(one, template=other.template, parameters=other.parameters)
        for one, other in zip(placements, others, strict=True)
    ]


def test_a_faithful_world_agrees_with_its_photos(whole):
    assert whole.headline > 0.65 and whole.views == 6
    assert whole.standard_error is not None and 0 < whole.standard_error < 0.1
    rows = {row.titles[0]: row for row in whole.objects}
    assert rows["shower"].right > 0.7 and rows["shower"].silhouette_iou > 0.8
    assert rows["toilet"].named > 0.8 and rows["toilet"].seen[0][0] == "toilet"


def test_the_shares_add_up(whole):
    total = whole.headline + whole.missing + whole.look + whole.name
    assert total == pytest.approx(1)
    assert whole.headline == pytest.approx((whole.objects_right + whole.structure_right) / 2)


def test_swapped_objects_fall_below_half(room, whole):
    others = swapped(room.placements)
    spoiled = compare(room, room.volume(others), placements=others)
    assert spoiled.headline < 0.5 and spoiled.headline < 0.6 * whole.headline
    assert spoiled.objects_right is not None and spoiled.objects_right < 0.15


def test_a_bare_room_falls_below_half(room, volume):
    states = np.where(volume.instance > 0, 0, volume.states).astype(np.uint16)
    semantic = np.where(states > 0, volume.semantic, np.uint8(0))
    found = compare(room, replace(volume, states=states, semantic=semantic))
    assert found.objects_right == 0 and found.headline < 0.5


def test_other_colours_fail_by_look_alone(room, volume, whole):
    samples = [replace(one, colour=255 - one.colour) for one in room.samples]
    other = compare(room, volume, samples)
    assert other.missing == pytest.approx(whole.missing)
    assert other.look > whole.look + 0.3 and other.headline < 0.5


def test_other_names_fail_by_name_alone(room, volume, whole):
    samples = [replace(one, seen=np.full_like(one.seen, 4)) for one in room.samples]
    other = compare(room, volume, samples)
    assert other.headline == 0 and other.look == pytest.approx(whole.look)


def test_one_view_has_no_standard_error(room, volume):
    assert compare(room, volume, room.samples[:1]).standard_error is None


def test_photos_without_depth_are_not_compared(room, volume):
    blind = replace(room.samples[0], depth_m=np.zeros_like(room.samples[0].depth_m))
    parts = (room.grid, room.instances, room.placements, volume)
    assert compare_world([blind], *parts) is None
