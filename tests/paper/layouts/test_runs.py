"""Our own runs beside others: held to their own rooms, or to the true ones."""

import numpy as np
import pytest
from made_layouts import write

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.errors import InputError
from world2minecraft.core.files import write_npz
from world2minecraft.core.types import Layout, Opening
from world2minecraft.formats.layout import layout_to_json, write_layouts
from world2minecraft.formats.objects_and_placements import write_placements
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.paper.layouts import ComparedScene, score_scene
from world2minecraft.paper.layouts.importers import How, read_layouts_of
from world2minecraft.paper.layouts.importers.value_checks import Box, object_of
from world2minecraft.paper.layouts.layout_to_world import plan_of
from world2minecraft.paper.layouts.reference_scene import is_truth, true_scene
from world2minecraft.reconstruction.floorplans import layouts_of
from world2minecraft.reconstruction.floorplans.plan_grid import rasterize_plan

ROOM = Layout([[0, 0], [4, 0], [4, 3], [0, 3]], 2.6, (Opening("window", [1, 3], [2, 3], 0.9, 2),))
THINGS = (
    object_of(Box("dining_table", (2.0, 1.5, 0.375), (0.9, 1.6, 0.75), 0.0)),
    object_of(Box("chair", (2.0, 0.64, 0.44), (0.45, 0.45, 0.88), 90.0)),
)
SCAN_TO_ROOM = rotation_about_z(30.0)
SCAN_TO_ROOM[:3, 3] = [1.0, 2.0, 0.3]


@pytest.fixture
def run(tmp_path):
    """A folder as a run leaves it, but for its world."""
    plan = plan_of(ComparedScene("room", "m", (ROOM,), THINGS))
    held, folder = rasterize_plan(plan), tmp_path / "OUT"
    write_room(folder / "room.npz", held.grid, SCAN_TO_ROOM)
    write_layouts(folder / "layout.json", layouts_of(plan))
    write_placements(folder / "placements.json", held.placements)
    return folder


def capture(folder, width):
    """A truth whose room is so wide, in a frame of its own."""
    truth = Layout([[0, 0], [width, 0], [width, 3], [0, 3]], 2.6)
    objects = [
        {"class": "table", "name": "table", "center_m": [2, 1.5, 0.4], "size_m": [1, 1, 0.8],
         "yaw_deg": 0.0},
        {"class": "bed", "name": "bed", "center_m": [1, 1, 0.3], "size_m": [2, 1, 0.6],
         "yaw_deg": 0.0},
    ]  # fmt: skip
    write(folder / "truth.json", {"objects": objects, "layouts": [layout_to_json(truth)]})
    grid = rasterize_plan(plan_of(ComparedScene("room", "m", (ROOM,), THINGS))).grid
    write_npz(
        folder / "truth.npz",
        {
            "labels": grid.labels,
            "voxel_m": np.float64(grid.voxel_m),
            "origin_m": grid.origin_m,
            "truth_room_to_scan": np.linalg.inv(SCAN_TO_ROOM),
        },
    )
    return folder


def test_a_run_is_scored_by_its_boxes_and_by_what_is_solid(run):
    (scene,) = read_layouts_of(run)
    told = score_scene(scene)
    assert scene.method == "World2Minecraft" and told.objects == 2
    assert not told.outside and told.colliding == ((0, 1),) and told.collided == 0
    assert int(SemanticClass.WINDOW) in told.structure


def test_a_run_is_held_to_its_true_rooms(run, tmp_path):
    (wide,) = read_layouts_of(run, How(truth=capture(tmp_path / "wide", 4.0)))
    assert wide.rooms[0].floor_polygon_m == pytest.approx(ROOM.floor_polygon_m, abs=1e-6)
    assert not score_scene(wide).outside
    (narrow,) = read_layouts_of(run, How(truth=capture(tmp_path / "narrow", 2.0)))
    assert score_scene(narrow).outside == (0, 1)
    assert int(SemanticClass.WINDOW) in score_scene(narrow).structure


def test_the_true_scene_is_a_truth_or_a_run(run, tmp_path):
    folder = capture(tmp_path / "scan", 4.0)
    assert is_truth(folder) and not is_truth(run)
    told = score_scene(true_scene(folder))
    assert told.categories == {int(SemanticClass.TABLE), int(SemanticClass.BED)}
    assert score_scene(true_scene(run)).objects == 2
    write(folder / "truth.json", {"objects": []})
    with pytest.raises(InputError, match="the scan does not contain a room"):
        true_scene(folder)


def test_a_run_without_a_room_is_refused(run):
    (run / "layout.json").unlink()
    with pytest.raises(InputError, match="the run has no rooms; run w2m reconstruct again"):
        read_layouts_of(run)
