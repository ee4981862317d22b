"""Scores of the benchmark of real captures, on arrays whose scores are known."""

import io

import numpy as np
import pytest
from benchmarks.real_captures import __main__ as command
from benchmarks.real_captures.scenes import (
    KITCHEN_UP,
    NYU_CAMERA,
    Reference,
    Scene,
    fold_nyu,
    list_scenes,
    remove_above,
    validation_numbers,
)
from benchmarks.real_captures.scoring import (
    NOT_FOUND,
    accuracy_by_class,
    agreement,
    class_accuracy,
    confusion,
    fit_floor,
    floor_error_m,
    found_classes,
    labelled_cells,
    share_not_found,
    surface_of,
    thing_stability,
    tilt_deg,
    wall_share,
)
from benchmarks.real_captures.stability import MAX_TURN_DEG, perturbation
from benchmarks.real_captures.tables import markdown_table, overview, summarize, terminal_table
from benchmarks.real_captures.walls import border_wall_points
from rich.console import Console

from world2minecraft.core.classes import SemanticClass as C
from world2minecraft.core.coordinates import apply, cell_centers_m
from world2minecraft.core.types import Camera, OccupancyGrid

VOXEL = 0.08


def furnished(shape=(30, 25, 20)):
    """A room of one-cell surfaces: a floor, two walls, a table and a bed."""
    labels = np.zeros(shape, np.uint8)
    labels[:, :, 0] = C.FLOOR
    labels[0, :, 1:] = C.WALL
    labels[:, 0, 1:] = C.WALL
    labels[8:14, 8:14, 9] = C.TABLE
    labels[20:28, 10:22, 5] = C.BED
    return labels


def grid_of(labels, origin_m=(0.0, 0.0, 0.0)):
    return OccupancyGrid(
        labels,
        np.ones(labels.shape, np.float16),
        np.zeros((*labels.shape, 3), np.uint8),
        np.ones(labels.shape, np.uint8),
        np.zeros(labels.shape, np.uint16),
        VOXEL,
        np.array(origin_m),
    )


def truth_of(labels, seed=0):
    """Points within the occupied cells of a room, several in each, with their classes."""
    cells = np.repeat(np.argwhere(labels > 0), 5, axis=0)
    inside = np.random.default_rng(seed).uniform(0.05, 0.95, cells.shape)
    classes = labels[tuple(cells.T)]
    return labelled_cells(
        (cells + inside) * VOXEL, classes, np.ones(len(cells)), np.zeros(3), VOXEL
    )


def counts_of(truth, found):
    return confusion(truth.classes, found_classes(found, truth.cells))


def test_a_perfect_labelling_scores_one():
    labels = furnished()
    truth = truth_of(labels)
    counts = counts_of(truth, labels)
    assert len(truth.cells) == (labels > 0).sum() == counts.sum()
    assert class_accuracy(counts) == wall_share(counts) == 1
    assert share_not_found(counts) == 0
    assert set(accuracy_by_class(counts)) == {"floor", "wall", "table", "bed"}


def test_swapped_classes_lose_exactly_their_cells():
    labels = furnished()
    swapped = labels.copy()
    swapped[labels == C.TABLE], swapped[labels == C.BED] = C.BED, C.TABLE
    counts = counts_of(truth_of(labels), swapped)
    things = np.isin(labels, (C.TABLE, C.BED)).sum()
    assert class_accuracy(counts) == pytest.approx(1 - things / (labels > 0).sum())
    assert accuracy_by_class(counts)["bed"] == 0
    assert wall_share(counts) == 1


def test_a_shift_of_one_voxel_is_forgiven_but_not_of_three():
    labels = furnished()
    truth = truth_of(labels)
    by_one, by_three = (counts_of(truth, np.roll(labels, by, axis=2)) for by in (1, 3))
    assert accuracy_by_class(by_one)["table"] == 1
    assert share_not_found(by_one) == 0
    assert accuracy_by_class(by_three)["table"] == 0
    assert class_accuracy(by_three) < 0.8
    assert share_not_found(by_three) > 0.2


def test_walls_called_furniture_are_no_walls():
    labels = furnished()
    wrong = labels.copy()
    wrong[0][labels[0] == C.WALL] = C.FURN
    counts = counts_of(truth_of(labels), wrong)
    walls = labels == C.WALL
    assert wall_share(counts) == pytest.approx(1 - walls[0].sum() / walls.sum())


def test_cells_outside_the_grid_are_not_found():
    labels = furnished()
    cells = np.array([[-40, 0, 0], [0, 0, 500], [29, 24, 0]])
    assert found_classes(labels, cells).tolist() == [NOT_FOUND, NOT_FOUND, C.FLOOR]


def test_unknown_cells_take_the_class_across_a_face_first():
    labels = np.full((5, 5, 5), 255, np.uint8)
    labels[2, 2, 1] = C.TABLE
    labels[1, 1, 2] = labels[3, 3, 2] = C.CHAIR
    assert found_classes(labels, np.array([[2, 2, 2], [0, 4, 4]])).tolist() == [C.TABLE, NOT_FOUND]


def test_a_cell_has_the_class_of_most_of_its_surface():
    points = np.full((4, 3), 0.04)
    classes = np.array([C.CHAIR, C.CHAIR, C.WALL, 255], np.uint8)
    truth = labelled_cells(points, classes, np.array([1, 1, 3, 9.0]), np.zeros(3), VOXEL)
    assert truth.classes.tolist() == [C.WALL]
    assert truth.cells.tolist() == [[0, 0, 0]]


def test_nyu_labels_fold_to_the_twelve_classes():
    stored = np.array([[0, 1, 4, 6, 13, 21, 24, 38, 39]], np.uint8)  # NYU40 ids minus 1.
    names = (C.WALL, C.FLOOR, C.CHAIR, C.TABLE, C.TABLE, C.CEILING, C.TVS, C.FURN, 255)
    assert fold_nyu(stored).tolist() == [list(names)]


def test_validation_frames_avoid_the_borders_of_blocks():
    numbers = validation_numbers(range(1450))
    assert len(numbers) % 44 == 0
    assert {n // 50 % 5 for n in numbers} == {4}
    assert {n % 50 for n in numbers} == set(range(3, 47))


def test_tilt_and_floor_against_a_reference():
    up = np.array(KITCHEN_UP) / np.linalg.norm(KITCHEN_UP)
    across = np.cross(up, [1, 0, 0])
    across /= np.linalg.norm(across)
    exact = np.eye(4)
    exact[:3, :3] = np.cross(across, up), across, up
    exact[2, 3] = 1.5
    assert tilt_deg(exact, np.array(KITCHEN_UP)) == pytest.approx(0, abs=1e-5)
    size = np.array([4.0, 3.0, 2.5])
    assert floor_error_m(exact, size, up, -1.5) == pytest.approx(0)
    assert floor_error_m(exact, size, up, -1.6) == pytest.approx(0.1)
    leaning = np.eye(4)
    leaning[:3, :3] = [[1, 0, 0], [0, np.cos(0.02), -np.sin(0.02)], [0, np.sin(0.02), np.cos(0.02)]]
    assert tilt_deg(leaning @ exact, up) == pytest.approx(np.degrees(0.02))


def test_the_plane_of_labelled_floor_survives_coarse_depth():
    rng = np.random.default_rng(0)
    floor = np.zeros((12_000, 3))
    floor[:, :2] = rng.uniform((-1, 1), (1, 4), (12_000, 2))
    floor[:500, 2] = 0.5  # Labelled wrongly.
    floor[:, 1] = np.round(floor[:, 1] / 0.04) * 0.04
    up, middle = fit_floor(floor, np.array([0, 0, 1.5]))
    assert tilt_deg(np.eye(4), up) < 0.2
    assert abs(middle[2]) < 0.01
    assert fit_floor(floor[:5000], np.zeros(3)) is None
    assert fit_floor(floor * [0.1, 1, 1], np.array([0, 0, 1.5])) is None


def moved_copy(grid, moved):
    """The grid's occupied cells in another frame: what a perfectly stable program would find."""
    cells = np.argwhere(grid.occupied)
    at = apply(moved, cell_centers_m(cells, grid.origin_m, grid.voxel_m))
    origin = np.floor(at.min(axis=0) / VOXEL - 2) * VOXEL
    index = np.floor((at - origin) / VOXEL).astype(int)
    labels = np.zeros(index.max(axis=0) + 3, np.uint8)
    labels[tuple(index.T)] = grid.labels[tuple(cells.T)]
    return grid_of(labels, origin)


def test_the_same_room_in_turned_frames_is_stable():
    base, rng = grid_of(furnished()), np.random.default_rng(3)
    runs = [(base, np.eye(4))]
    for _ in range(4):
        moved = perturbation(rng, np.array([1.2, 1.0, 0.8]), VOXEL)
        assert np.allclose(moved[:3, :3] @ moved[:3, :3].T, np.eye(3))
        turn = np.degrees(np.arccos(min((np.trace(moved[:3, :3]) - 1) / 2, 1)))
        assert turn <= MAX_TURN_DEG
        runs.append((moved_copy(base, moved), moved))
    exact, near = thing_stability(runs)
    assert exact > 0.97
    assert near == 1


def test_one_run_that_renames_a_thing_makes_its_cells_unstable():
    labels = furnished()
    renamed = labels.copy()
    renamed[labels == C.BED] = C.SOFA
    runs = [(grid_of(labels), np.eye(4))] * 4 + [(grid_of(renamed), np.eye(4))]
    bed, table = (labels == C.BED).sum(), (labels == C.TABLE).sum()
    assert thing_stability(runs) == pytest.approx((table / (bed + table),) * 2)
    walls = np.where(labels == C.WALL, labels, 0).astype(np.uint8)
    assert thing_stability([(grid_of(walls), np.eye(4))] * 5) is None


def test_agreement_with_a_better_reconstruction():
    whole = grid_of(furnished())
    moved = perturbation(np.random.default_rng(1), np.zeros(3), VOXEL)
    truth = surface_of(whole, moved)
    same = moved_copy(whole, moved)
    assert class_accuracy(agreement(truth, same)) > 0.97
    low = agreement(truth, grid_of(furnished()[:, :, :8]), below_m=0.5)
    assert accuracy_by_class(low).keys() == {"floor", "wall", "bed"}


def wall_points(along, up, depth_m=0.0, seed=0):
    rng = np.random.default_rng(seed)
    points = np.stack(np.meshgrid([depth_m], along, up, indexing="ij"), axis=-1).reshape(-1, 3)
    points[:, 0] += rng.normal(0, 0.02, len(points))
    return points, np.tile([1.0, 0.0, 0.0], (len(points), 1))


def test_border_walls_are_large_and_have_nothing_behind():
    wall, wall_normals = wall_points(np.arange(0, 3, 0.05), np.arange(0, 2.4, 0.05))
    # A cupboard 0.6 m in front of one third of the wall, and a low chest beyond the wall's end.
    front, front_normals = wall_points(np.arange(0, 1, 0.05), np.arange(0, 1.5, 0.05), 0.6)
    chest, chest_normals = wall_points(np.arange(3.5, 5, 0.05), np.arange(0, 0.8, 0.05), 0.4)
    shown = border_wall_points(
        np.concatenate([wall, front, chest]),
        np.concatenate([wall_normals, front_normals, chest_normals]),
    )
    assert np.abs(shown[:, 0]).max() < 0.1
    assert len(shown) > 1000
    assert not len(border_wall_points(chest, chest_normals))


def test_the_crop_removes_what_is_above_the_height():
    camera = Camera(64, 48, 60, 60, 32, 24)
    depth = np.full((48, 64), 2000, np.uint16)
    up = np.array([0.0, -1.0, 0.0])
    kept = remove_above(depth, camera, np.eye(4), up, 0.1) > 0
    heights = -(np.arange(48) + 0.5 - 24) / 60 * 2
    assert (kept == (heights <= 0.1)[:, None]).all()


def rows():
    counts = np.zeros((12, 13), int)
    counts[C.WALL, C.WALL], counts[C.BED, C.FURN] = 30, 10
    ran = {"group": "nyuv2", "ran": True, "objects": 4, "cpu_s": 2.0}
    return [
        {"scene": "kitchen", "group": "kitchen", "ran": True, "tilt_deg": 0.41, "floor_m": -0.012},
        {**ran, "scene": "nyuv2-0203", "pixel_accuracy": 0.7, "confusion": counts.tolist()},
        {**ran, "scene": "nyuv2-0204", "pixel_accuracy": 0.7, "confusion": counts.tolist()},
        {"scene": "nyuv2-0205", "group": "nyuv2", "ran": False, "reason": "too low | 0.7 m"},
    ]


def test_frames_of_one_data_set_share_a_row():
    kitchen, frames = summarize(rows())
    assert kitchen["tilt_deg"] == 0.41
    assert frames["scene"] == "nyuv2 (3 frames)"
    assert frames["class_accuracy"] == 0.75
    assert frames["pixel_accuracy"] == pytest.approx(0.7)
    assert frames["wall_share"] == 1
    assert frames["by_class"] == {"wall": 1, "bed": 0}
    assert frames["reason"] == "1 of 3 refused: too low | 0.7 m"


def test_the_tables_show_every_scene():
    console = Console(file=io.StringIO(), width=200)
    console.print(terminal_table(rows()))
    lines = markdown_table(rows()).splitlines()
    assert len({line.count("|") for line in lines}) == 1
    for text in (console.file.getvalue(), "\n".join(lines)):
        for word in ("kitchen", "0.41", "-1.2", "0.750", "1 of 3 refused"):
            assert word in text


def test_a_line_of_the_table_over_time():
    windows = [
        {"scene": name, "group": name, "ran": True, "tilt_deg": tilt, "stability": 0.5}
        for name, tilt in (("kitchen-0-19", 0.2), ("kitchen-10-29", 0.4), ("kitchen-20-39", 0.9))
    ]
    flat = {"scene": "flat", "group": "flat", "ran": True, "objects": 41, "stability": 0.7}
    cells = overview([*rows(), *windows, flat], "2026-11-24", "abc").split(" | ")
    assert cells[2:] == ["7 of 8", "0.40, 0.90", "-, -", "-, 0.750", "1.000", "0.550", "41 |"]


def test_results_of_the_same_settings_are_not_computed_again(tmp_path, monkeypatch, capsys):
    from benchmarks.real_captures import running

    ran = []

    def refuse(data, folder):
        ran.append(folder.parent.name)
        raise running.World2MinecraftError("no room\nhere")

    scenes = [Scene(name, refuse, Reference()) for name in ("one", "two")]
    options = running.Options(tmp_path, tmp_path / "out")
    first = command.run_scenes(scenes, options)
    assert [row["reason"] for row in first] == ["no room here"] * 2
    assert command.run_scenes(scenes, options) == first
    assert ran == ["one", "two"]
    changed = running.Options(tmp_path, tmp_path / "out", settings=("labeller=geometric",))
    command.run_scenes(scenes[:1], changed)
    command.run_scenes(scenes[:1], changed, again=True)
    assert ran == ["one", "two", "one", "one"]
    assert "2 of 2 scenes are done" in capsys.readouterr().err


def test_scenes_are_selected_by_name_or_group(shared_data):
    scenes = list_scenes(shared_data, 5)
    assert len({scene.name for scene in scenes}) == len(scenes)
    assert len(command.selected(scenes, ["nyuv2"])) == 5
    assert [one.name for one in command.selected(scenes, ["lounge"])] == ["lounge"]
    low = command.selected(scenes, ["kitchen-low"])
    assert [one.name for one in command.needed(low, scenes)] == ["kitchen"]
    assert not command.needed(scenes, scenes)
    assert command.selected(scenes, None) == scenes


def test_a_labelled_frame_becomes_a_capture_of_its_camera(shared_data, tmp_path):
    from world2minecraft.capture.readers.capture_json import PlainSource

    scene = next(one for one in list_scenes(shared_data, 5) if one.label_image)
    (frame,) = PlainSource().read(scene.prepare(shared_data, tmp_path)).frames
    assert frame.depth_camera == frame.colour_camera == NYU_CAMERA
    assert frame.labels_path is None
