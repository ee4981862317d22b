"""Finite nonsense in a file: readers return a value or raise one of the project's own errors.

Each file is a valid one in which some numbers are replaced by extremes. A reader that allocates
memory for them, loops over them or divides by them fails here.
"""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from tests.capture.layouts import write_nerfstudio, write_plain, write_seven_scenes
from tests.exact_room import BoxRoom
from tests.formats.test_run_files import some_grid, some_object
from tests.hostile_files import PICKS, limited_memory, replace_in
from tests.navigation.vln_sets import a_trajectory, an_episode, next_view
from tests.roomplans import captured_room

from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.meshes.mesh_source import load_geometry
from world2minecraft.capture.validation import validate_capture
from world2minecraft.construction.build_files import write_build
from world2minecraft.core.errors import World2MinecraftError
from world2minecraft.core.files import write_json, write_npz
from world2minecraft.core.types import (
    BlockVolume,
    Corrections,
    FusedEvidence,
    Layout,
    LayoutObject,
    Opening,
    Placement,
    Scan,
)
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.formats.build_reader import read_build
from world2minecraft.formats.layout import read_layouts, write_layouts
from world2minecraft.formats.objects_and_placements import (
    read_objects,
    read_placements,
    write_objects,
    write_placements,
)
from world2minecraft.formats.occupancy_files import (
    inner_corner_m,
    read_any_centers,
    read_any_occ,
    read_occupancy,
)
from world2minecraft.formats.paper_json import write_centers_json, write_occ_json
from world2minecraft.formats.predicted_grids import GridRules, interpret_grid, read_stored_grid
from world2minecraft.formats.roomplan import read_roomplan
from world2minecraft.formats.run_arrays import read_evidence, read_room, write_evidence, write_room
from world2minecraft.formats.scan_record import (
    read_poses,
    read_room_size,
    with_recorded_alignment,
    write_poses,
    write_scan,
)
from world2minecraft.minecraftocc.scene_completion import read_grid_place
from world2minecraft.navigation.records import (
    read_episodes,
    read_items,
    read_trajectories,
    to_json_line,
)
from world2minecraft.procgen.room_files import read_generated, write_generated
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.reconstruction.floorplans.plan_grid import rasterize_plan

SHAPE = (8, 7, 6)
LAYOUT = Layout(
    [[0, 0], [3, 0], [3, 2], [0, 2]],
    2.5,
    (Opening("window", [1, 0], [2, 0], 0.9, 2.1),),
    (LayoutObject(8, [1, 1, 0.36], [0.6, 1.0, 0.72], 0.0, "desk"),),
)

grid = some_grid(3, SHAPE)
room_views = BoxRoom().views(3)
scan = Scan(room_views, np.eye(4), [4.2, 3.1, 2.6], tuple(v.name for v in room_views))


@dataclass(frozen=True)
class Reader:
    """A reader: what writes a valid file or folder, which part of it is changed, and the read."""

    write: Callable[[Path], object]
    read: Callable[[Path], object]
    file: str


def evidence() -> FusedEvidence:
    zeros = np.zeros((*SHAPE, 12), np.float16)
    sums = np.zeros((*SHAPE, 3), np.float32)
    hits = np.ones(SHAPE, np.uint16)
    return FusedEvidence(zeros[..., 0], zeros, sums, sums, hits, 0.08, np.zeros(3), np.eye(4))


def generated() -> Room:
    cells = np.zeros((*SHAPE, 3), np.uint8)
    ids = cells[..., 0].astype(np.uint16)
    return Room("hall", 1, (LAYOUT,), cells[..., 0], ids, cells, 0.02, np.zeros(3))


def read_prediction(folder: Path) -> None:
    interpret_grid(read_stored_grid(folder / "y.npz"), GridRules("w2m"), is_frame=False)


def read_paper(folder: Path) -> None:
    found, unit = read_any_occ(folder / "occ.json")
    read_any_centers(folder / "centers.json", found, unit)


def write_paper(folder: Path) -> None:
    write_occ_json(folder / "occ.json", grid)
    write_centers_json(folder / "centers.json", (some_object(grid),))


def write_prediction(folder: Path, **more: Any) -> None:
    labels = np.where(grid.labels == 255, 0, grid.labels)
    place = {"origin_m": np.zeros(3), "camera_to_world": np.eye(4), "voxel_m": np.array(0.08)}
    write_npz(folder / "y.npz", {"labels": labels, **place, **more})


def write_cloud(folder: Path) -> None:
    head = "ply\nformat ascii 1.0\nelement vertex 40\nproperty float x\nproperty float y\n"
    rows = np.random.default_rng(0).random((40, 3)) * 3
    lines = "\n".join(" ".join(f"{v:.3f}" for v in row) for row in rows)
    (folder / "c.ply").write_text(f"{head}property float z\nend_header\n{lines}\n")
    (folder / "c.xyz").write_text(lines + "\n")


def write_obj(folder: Path) -> None:
    points = [(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0), (0, 0, 2.5)]
    lines = [f"v {x} {y} {z}" for x, y, z in points] + ["f 1 2 3", "f 1 3 4", "f 1 2 5"]
    (folder / "m.obj").write_text("\n".join(lines))


def check(folder: Path) -> None:
    validate_capture(folder, ScanOptions())


def plan_of(folder: Path) -> None:
    rasterize_plan(read_roomplan(folder / "Room.json"))


PLACEMENT = Placement(1, 8, "desk", [1, 1, 0.36], [0.6, 1.0, 0.72], 0, 0.8)
CORRECTIONS = Corrections(("a",), np.eye(4)[None], np.ones(1))
AIR_AND_STONE = ("minecraft:air", "minecraft:stone")
ids = np.ones((4, 4, 4), np.uint16)
volume = BlockVolume(ids, AIR_AND_STONE, ids.astype(np.uint8), ids, (0, 63, 0), np.eye(4))
READERS = {
    "room": Reader(
        lambda d: write_room(d / "room.npz", grid, np.eye(4)),
        lambda d: (read_room(d / "room.npz"), inner_corner_m(read_occupancy(d / "room.npz"))),
        "room.npz",
    ),
    "evidence": Reader(
        lambda d: write_evidence(d / "evidence.npz", evidence()),
        lambda d: read_evidence(d / "evidence.npz"),
        "evidence.npz",
    ),
    "poses": Reader(
        lambda d: write_poses(d / "poses.npz", CORRECTIONS),
        lambda d: read_poses(d / "poses.npz"),
        "poses.npz",
    ),
    "scan": Reader(
        lambda d: write_scan(d / "scan.json", scan),
        lambda d: (
            read_room_size(d / "scan.json"),
            with_recorded_alignment(scan, d / "scan.json"),
        ),
        "scan.json",
    ),
    "layout": Reader(
        lambda d: write_layouts(d / "layout.json", (LAYOUT,)),
        lambda d: read_layouts(d / "layout.json"),
        "layout.json",
    ),
    "objects": Reader(
        lambda d: write_objects(d / "objects.json", (some_object(grid),)),
        lambda d: read_objects(d / "objects.json", grid),
        "objects.json",
    ),
    "placements": Reader(
        lambda d: write_placements(d / "placements.json", (PLACEMENT,)),
        lambda d: read_placements(d / "placements.json"),
        "placements.json",
    ),
    "occ": Reader(write_paper, read_paper, "occ.json"),
    "occ_file": Reader(write_paper, lambda d: read_occupancy(d / "occ.json"), "occ.json"),
    "centers": Reader(write_paper, read_paper, "centers.json"),
    "prediction": Reader(write_prediction, read_prediction, "y.npz"),
    "labels": Reader(write_prediction, lambda d: read_occupancy(d / "y.npz"), "y.npz"),
    "grid_place": Reader(write_prediction, lambda d: read_grid_place(d / "y.npz"), "y.npz"),
    "generated": Reader(lambda d: write_generated(generated(), d), read_generated, "truth.npz"),
    "generated_layout": Reader(
        lambda d: write_generated(generated(), d), read_generated, "layout.json"
    ),
    "truth": Reader(
        lambda d: (
            write_json(d / "truth.json", {"layouts": [], "size_m": [4, 3, 2.5], "objects": []}),
            write_npz(d / "truth.npz", {name: getattr(generated(), name) for name in (
                "labels", "instance", "voxel_m", "origin_m")} | {
                "truth_room_to_scan": np.eye(4)}),
        ),
        read_truth,
        "truth.npz",
    ),
    "roomplan": Reader(
        lambda d: write_json(d / "Room.json", captured_room(LAYOUT)), plan_of, "Room.json"
    ),
    "plain": Reader(lambda d: write_plain(d, room_views), check, "capture.json"),
    "nerfstudio": Reader(lambda d: write_nerfstudio(d, room_views), check, "transforms.json"),
    "seven_scenes": Reader(
        lambda d: write_seven_scenes(d, room_views), check, "frame-000001.pose.txt"
    ),
    "intrinsics": Reader(
        lambda d: write_seven_scenes(d, room_views), check, "camera-intrinsics.txt"
    ),
    "ply": Reader(write_cloud, lambda d: load_geometry(d / "c.ply"), "c.ply"),
    "xyz": Reader(write_cloud, lambda d: load_geometry(d / "c.xyz"), "c.xyz"),
    "obj": Reader(write_obj, lambda d: load_geometry(d / "m.obj"), "m.obj"),
    "scene": Reader(
        lambda d: write_build(d, volume, name="x"), read_build, "scene.json"
    ),
    "items": Reader(
        lambda d: (d / "items.jsonl").write_text(to_json_line(next_view()) + "\n"),
        lambda d: read_items(d / "items.jsonl"),
        "items.jsonl",
    ),
    "trajectories": Reader(
        lambda d: (d / "trajectories.jsonl").write_text(to_json_line(a_trajectory()) + "\n"),
        lambda d: read_trajectories(d / "trajectories.jsonl"),
        "trajectories.jsonl",
    ),
    "episodes": Reader(
        lambda d: (d / "episodes.jsonl").write_text(to_json_line(an_episode("a")) + "\n"),
        lambda d: read_episodes(d / "episodes.jsonl"),
        "episodes.jsonl",
    ),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", READERS)
@settings(max_examples=40, suppress_health_check=list(HealthCheck))
@given(picks=PICKS)
def test_extreme_numbers_are_read_or_refused(name, tmp_path_factory, picks):
    reader = READERS[name]
    folder = tmp_path_factory.mktemp(name)
    reader.write(folder)
    replace_in(folder / reader.file, picks)
    try:
        with limited_memory():
            reader.read(folder)
    except World2MinecraftError as error:
        assert "\n" not in str(error)
        assert len(str(error)) < 1500
    finally:
        shutil.rmtree(folder)


@pytest.mark.parametrize("name", READERS)
def test_the_files_are_read_unchanged(name, tmp_path):
    READERS[name].write(tmp_path)
    READERS[name].read(tmp_path)
