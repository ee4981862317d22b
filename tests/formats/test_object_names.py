"""Names of objects in the files of runs and worlds, of this version and of former ones."""

import json

import numpy as np
import pytest

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.formats.object_names import (
    NamedObject,
    name_table,
    read_run_names,
    read_world_names,
)
from world2minecraft.formats.world_labels import read_scene, scene_from_volume, write_scene

NAMED = (NamedObject(1, 5, "bar stool", 0.75), NamedObject(3, 11, "my robot", 1.0))


def write_world(folder, objects=()):
    cells = np.zeros((2, 2, 2), np.uint16)
    kinds = cells.astype(np.uint8)
    to_room = block_to_room(np.zeros(2), 4.0)
    volume = BlockVolume(cells, (AIR,), kinds, cells, (0, 0, 0), to_room)
    place = {"spawn": (0.0, 0.0, 0.0), "spawn_yaw_deg": 0.0}
    scene = scene_from_volume(volume, mc_version="1", data_version=1, **place, objects=objects)
    write_scene(folder, scene)


def write_rows(folder, rows):
    folder.mkdir(exist_ok=True)
    (folder / "objects.json").write_text(json.dumps(rows))


def test_a_world_keeps_names_without_its_run(tmp_path):
    write_world(tmp_path / "run" / "build", NAMED)
    assert read_scene(tmp_path / "run" / "build").objects == NAMED
    assert (
        read_world_names(tmp_path / "run") == read_world_names(tmp_path / "run" / "build") == NAMED
    )
    assert [one.title for one in NAMED] == ["bar stool", "my robot"]
    write_rows(tmp_path / "run", [{"id": 1, "class": "chair", "name": "sofa"}])
    assert name_table(read_world_names(tmp_path / "run")) == {1: "bar stool", 3: "my robot"}
    assert name_table(read_run_names(tmp_path / "run")) == {1: "sofa"}


def test_worlds_of_former_versions_take_names_from_the_run(tmp_path):
    write_world(tmp_path / "build")
    assert "objects" not in json.loads((tmp_path / "build" / "scene.json").read_text())
    assert read_world_names(tmp_path) == ()
    write_rows(tmp_path, [{"id": 1, "class": "chair"}, {"id": 2, "class": "bed", "name": "bed"}])
    assert read_world_names(tmp_path / "build") == (NamedObject(2, 6, "bed"),)


@pytest.mark.parametrize(
    "row",
    [
        {"id": 0, "class": "chair", "name": "a"},
        {"id": 1, "class": "nosuch", "name": "a"},
        {"id": 1, "class": "chair", "name": "a\nb"},
        {"id": 1, "class": "chair", "name": "a" * 201},
        {"id": 1, "class": "chair", "name": "a", "name_confidence": 2},
        "chair",
    ],
)
def test_rows_that_are_no_names_are_refused(tmp_path, row):
    write_rows(tmp_path, [row])
    with pytest.raises(DamagedFileError, match="object 0 is not valid"):
        read_run_names(tmp_path)
