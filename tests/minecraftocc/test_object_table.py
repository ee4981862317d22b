"""The object table of a scene: names of reconstructions, of designs, and of classes."""

import json

import numpy as np
import pytest

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.formats.object_names import NamedObject
from world2minecraft.minecraftocc.object_table import object_rows, read_object_table

DESIGNS = ("", "fridge_double")


def four_objects():
    """A floor, and a bed, a thing, a refrigerator by design and an unnamed chair above it."""
    states = np.ones((4, 2, 3), np.uint16)
    semantic = np.full(states.shape, 2, np.uint8)
    instance, design = np.zeros((2, *states.shape), np.uint16)
    for number, class_id in enumerate((6, 11, 10, 5), 1):
        semantic[number - 1, 1], instance[number - 1, 1] = class_id, number
    semantic[0, 1, 0] = 11  # A cell of the bed by mistake.
    design[2, 1] = 1
    to_room = block_to_room(np.zeros(2), 4.0)
    palette = (AIR, "minecraft:stone")
    volume = BlockVolume(states, palette, semantic, instance, (0, 0, 0), to_room)
    return volume, (design, DESIGNS)


def test_names_come_from_reconstruction_design_or_class(tmp_path):
    names = [NamedObject(1, 6, "bunk bed", 0.9), NamedObject(2, 11, "toilet", 0.3)]
    rows = object_rows(*four_objects(), names)
    assert [(row["instance"], row["class"], row["name"], row["nyu40"]) for row in rows] == [
        (1, "bed", "bunk bed", 4),
        (2, "objs", "object", 40),
        (3, "furn", "refrigerator", 24),
        (4, "chair", "chair", 5),
    ]
    assert [row["name_confidence"] for row in rows] == [0.9, 0.3, 1.0, 0.0]
    (tmp_path / "a.objects.json").write_text(json.dumps(rows))
    table = read_object_table(tmp_path / "a.objects.json")
    assert {number: one.name for number, one in table.items()} == {
        row["instance"]: row["name"] for row in rows
    }


def test_older_sets_have_no_table(tmp_path):
    assert read_object_table(tmp_path / "none.json") == {}


@pytest.mark.parametrize("text", ["{}", "[1]", '[{"class": "bed", "name": "bed"}]'])
def test_damaged_tables_are_refused(tmp_path, text):
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(DamagedFileError):
        read_object_table(tmp_path / "a.json")
