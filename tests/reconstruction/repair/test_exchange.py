"""Repair by rendering on a generated room that is known exactly, spoiled on purpose."""

from dataclasses import replace

import pytest
from tests.reconstruction.verification.verified_room import VerifiedRoom, verified_room

from world2minecraft.core.types import Placement
from world2minecraft.reconstruction.repair import RepairParameters
from world2minecraft.reconstruction.repair.exchange import Repaired, repair_placements
from world2minecraft.reconstruction.retrieval.other_furniture import OtherFurniture

FEW = RepairParameters(max_objects=2)


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
    parts = (room.samples, room.grid, room.instances, placements, room.volume)
    return repair_placements(*parts, OtherFurniture(room.grid), parameters)


def furniture_of(placements, number: int) -> list[tuple[str, int]]:
    return [(one.template, one.quarter_turns) for one in placements if one.object_id == number]


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        pytest.param("armchair", {"template": "stool", "parameters": {}}, id="template"),
        pytest.param("sofa", {"template": "sofa_white"}, id="material"),
        pytest.param("armchair", {"quarter_turns": 0}, id="turn"),
    ],
)
def test_wrong_furniture_is_exchanged(room, name, changes):
    number, spoiled = spoil(room, name, **changes)
    found = repair(room, spoiled)
    after = furniture_of(found.placements, number)
    print(furniture_of(room.placements, number), furniture_of(spoiled, number), after, found.changes, found.headline)
