"""Repair by rendering on a generated room that is known exactly, spoiled on purpose."""

from dataclasses import replace

import numpy as np
import pytest
from tests.reconstruction.verification.verified_room import VerifiedRoom, verified_room

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Placement
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.reconstruction.repair import RepairParameters
from world2minecraft.reconstruction.repair.exchange import Repaired, repair_placements
from world2minecraft.reconstruction.retrieval.other_furniture import OtherFurniture

FEW = RepairParameters(max_objects=2, max_candidates=4)


@pytest.fixture(scope="module")
def room() -> VerifiedRoom:
    """A living room with a sofa, an armchair and a coffee table."""
    return verified_room(7, "living")


def spoil(room: VerifiedRoom, name: str, **changes) -> tuple[int, list[Placement]]:
    """The id of an object, and the placements with its furniture changed."""
    number = next(one.id for one in room.instances if one.name == name)
    placements = [
        replace(one, **changes) if one.object_id == number else one for one in room.placements
    ]
    return number, placements


def repair(room: VerifiedRoom, placements, parameters=FEW) -> Repaired:
    parts = (room.samples[:4], room.grid, room.instances, placements, room.volume)
    return repair_placements(*parts, OtherFurniture(room.grid), parameters)


def furniture(placements) -> list[tuple[int, str, int]]:
    return [(one.object_id, one.template, one.quarter_turns) for one in placements]


def faces_alike(one: Placement, other: Placement) -> bool:
    """Whether two placements have the same turn; a table may also have turn and sides swapped."""
    if one.quarter_turns == other.quarter_turns:
        return True
    swapped = one.size_m[[1, 0, 2]]
    return "table" in one.template and np.abs(swapped - other.size_m).max() < 0.1


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        pytest.param("armchair", {"template": "stool", "parameters": {}}, id="template"),
        pytest.param("coffee table", {"template": "coffee_table_stone"}, id="material"),
        pytest.param("armchair", {"quarter_turns": 0}, id="turn"),
    ],
)
def test_wrong_furniture_is_exchanged(room, name, changes):
    number, spoiled = spoil(room, name, **changes)
    found = repair(room, spoiled)
    (change,) = (one for one in found.changes if one.object_id == number)
    (after,) = (one for one in found.placements if one.object_id == number)
    (right,) = (one for one in room.placements if one.object_id == number)
    assert change.before == tuple(one for one in spoiled if one.object_id == number)
    assert change.after == (after,)
    assert after.template in read_vocabulary().names[name].templates
    assert faces_alike(after, right)
    assert after.template != changes.get("template")
    assert change.agreement[1] > change.agreement[0] + 0.2
    assert found.headline[1] > found.headline[0] + 0.02


def test_right_furniture_stays():
    room = verified_room(5, "bed")
    found = repair(room, room.placements, RepairParameters(max_candidates=3))
    kept = {one.id for one in room.instances if one.name not in ("plant", "curtain")}
    before, after = (
        [one for one in placements if one.object_id in kept]
        for placements in (room.placements, found.placements)
    )
    assert found.tried > 8 and before == after


def test_repair_is_deterministic_and_changes_listed_objects_only(room):
    _, spoiled = spoil(room, "armchair", template="stool", parameters={})
    one, other = (repair(room, spoiled) for _ in range(2))
    assert furniture(one.placements) == furniture(other.placements)
    assert one.headline == other.headline
    listed = {change.object_id for change in one.changes}
    kept = [(old, new) for old, new in zip(spoiled, one.placements, strict=True) if old is new]
    assert {new.object_id for _, new in kept} | listed == {one.id for one in room.instances}


def test_no_iou_may_be_lost_without_allowance(room):
    _, spoiled = spoil(room, "sofa", template="sofa_white")
    strict = replace(FEW, mean_iou_loss=0.0, max_iou_loss=0.0)
    assert all(change.iou[1] >= change.iou[0] for change in repair(room, spoiled, strict).changes)


def test_options_end_with_own_cells_and_omit_what_is_placed(room):
    others = OtherFurniture(room.grid)
    number, spoiled = spoil(room, "armchair")
    instance = next(one for one in room.instances if one.id == number)
    placed = tuple(one for one in spoiled if one.object_id == number)
    listed = list(others.options(instance, placed))
    assert [one.template for one in listed[-1]] == ["cells"]
    assert placed[0].template not in [
        one.template for (one,) in listed if one.quarter_turns == placed[0].quarter_turns
    ]
    assert others.fit(instance, listed[-1]) == (1, 1)
    assert list(others.options(instance, listed[-1])) == []


@pytest.mark.parametrize("wrong", [{"max_objects": 0}, {"max_views": 101}, {"min_gain": 1.1}])
def test_limits_are_checked(wrong):
    with pytest.raises(UsageError, match=f"repair.{next(iter(wrong))} must be"):
        RepairParameters(**wrong)
