"""Saved predictions: which file belongs to which view, where it lies, and what contradicts it."""

from pathlib import Path

import numpy as np
import pytest
from tests.reconstruction.occupancy.predicted_room import (
    ROOM,
    labels_at,
    scene_labels,
    views_of,
    write_prediction,
    write_predictions,
)

from world2minecraft.core.coordinates import apply, cell_centers_m, rotation_about_z
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Scan
from world2minecraft.formats.predicted_grids import GridRules
from world2minecraft.formats.safe_pickle import dump_pickle, read_pickle
from world2minecraft.reconstruction.occupancy import PredictionParameters, predictor
from world2minecraft.reconstruction.occupancy.saved_grid_evidence import (
    SavedGridPredictor,
    frame_evidence,
    in_nyu_image,
    point_votes,
)
from world2minecraft.reconstruction.occupancy.saved_grids import (
    find_grids,
    place_frame,
    place_scene,
    read_grid,
)

CONVENTIONS = ("monoscene", "iso", "embodiedocc", "sscnet")
ROOM_TO_SCAN = rotation_about_z(20.0)
ROOM_TO_SCAN[:3, 3] = [1.0, 2.0, 0.4]


def scan_of(views) -> Scan:
    scan_to_room = np.linalg.inv(ROOM_TO_SCAN)
    return Scan(views, scan_to_room, np.array(ROOM.size_m), tuple(view.name for view in views))


@pytest.fixture(scope="module")
def with_depth() -> Scan:
    return scan_of(views_of(6, ROOM_TO_SCAN, depth=True))


@pytest.fixture(scope="module")
def without_depth() -> Scan:
    return scan_of(views_of(6, ROOM_TO_SCAN, depth=False))


@pytest.fixture(scope="module")
def folders(with_depth, tmp_path_factory) -> dict[str, Path]:
    root = tmp_path_factory.mktemp("predictions")
    for convention in CONVENTIONS:
        write_predictions(root / convention, with_depth.views, ROOM_TO_SCAN, convention)
    return {convention: root / convention for convention in CONVENTIONS}


def evidence(scan, path, **rules):
    used = SavedGridPredictor(predictor("depth"), PredictionParameters(path=str(path), **rules))
    return list(used.predict(scan)), used.notes


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("kind", ["with_depth", "without_depth"])
def test_true_grids_say_the_truth_where_they_lie(folders, convention, kind, request):
    """Each cell of the evidence, carried into the room, has the class that the room has there."""
    scan = request.getfixturevalue(kind)
    items, notes = evidence(scan, folders[convention], convention=convention)
    grids = [item for item in items if hasattr(item, "seen")]
    assert [grid.view for grid in grids] == list(scan.frames_used)
    assert len(items) == len(grids) * (2 if kind == "with_depth" else 1)
    for grid in grids:
        cells = np.argwhere(grid.seen)
        assert len(cells) > 500
        centres = cell_centers_m(cells, np.zeros(3), grid.voxel_m)
        at_room = apply(scan.scan_to_room @ grid.grid_to_scan, centres)
        found = grid.probabilities[tuple(cells.T)].argmax(axis=1)
        assert np.array_equal(found, labels_at(np.round(at_room, 6)))
    assert notes[0].startswith(f"6 of 6 views have predictions ({convention}, axes ")


def test_what_depth_shows_is_left_to_it(folders, with_depth):
    items, _ = evidence(with_depth, folders["embodiedocc"], convention="embodiedocc")
    points = [item for item in items if not hasattr(item, "seen")]
    for view, grid in zip(with_depth.views, items[len(points) :], strict=True):
        centres = cell_centers_m(np.argwhere(grid.seen), np.zeros(3), grid.voxel_m)
        at = apply(np.linalg.inv(view.camera_to_scan) @ grid.grid_to_scan, centres)
        camera = view.depth_camera
        u = np.clip((at[:, 0] / at[:, 2] * camera.fx_px + camera.cx_px), 0, 159).astype(int)
        v = np.clip((at[:, 1] / at[:, 2] * camera.fy_px + camera.cy_px), 0, 119).astype(int)
        assert (at[:, 2] > view.depth_m[v, u]).all(), "no cell in front of a measured surface"


def test_points_take_the_votes_of_their_cells(folders, with_depth):
    items, _ = evidence(with_depth, folders["embodiedocc"], convention="embodiedocc")
    for item in items[:6]:
        inward = np.array(item.points_m, np.float64)
        inward -= 0.02 * np.array(item.normals)
        true = labels_at(apply(with_depth.scan_to_room, inward))
        voted = item.votes.max(axis=1) > 0
        assert voted.mean() > 0.5 and not item.votes[:, 0].any()
        right = item.votes[voted].argmax(axis=1) == true[voted]
        assert right.mean() > 0.9


def test_a_point_votes_by_the_first_occupied_cell_behind_it():
    shares = np.zeros((4, 1, 1, 12), np.float16)
    shares[0, 0, 0, 0] = shares[3, 0, 0, 5] = 1
    shares[1, 0, 0, [0, 3]], shares[2, 0, 0, [0, 8]] = (0.25, 0.75), (0.75, 0.25)
    points = np.array([[x, 0.05, 0.05] for x in (0.05, 0.099, 0.12, 0.25, 0.45)], np.float32)
    votes = point_votes(points, np.array([-1.0, 0.05, 0.05]), shares, np.eye(4), 0.1)
    assert votes.argmax(axis=1)[:4].tolist() == [3, 3, 3, 5]
    assert votes.sum(axis=1).tolist() == [0.75, 0.75, 0.75, 1, 0]


def test_networks_of_nyuv2_see_a_cropped_image():
    """320 px beside the axis at a focal length of 518.8579, and a twentieth for other centres."""
    edge = 320 / 518.8579
    points = np.array([[edge, 0, 1], [1.2 * edge, 0, 1], [0, 1.2 * 240 / 518.8579, 1], [0, 0, -1]])
    assert in_nyu_image(2 * points, np.eye(4)).tolist() == [True, False, False, False]


def test_a_grid_without_a_place_is_the_box_of_the_data_set(with_depth, tmp_path):
    """The box that was cut by the rule is put there, when the file says nothing of it."""
    view = next(iter(with_depth.views))
    for convention in ("monoscene", "sscnet"):
        camera_to_room = with_depth.scan_to_room @ view.camera_to_scan
        labels = write_prediction(tmp_path / convention, "a", camera_to_room, "monoscene")
        np.save(tmp_path / "a.npy", labels.transpose(0, 2, 1))
        grid = read_grid(tmp_path / "a.npy", GridRules(convention), is_frame=True)
        placed = place_frame(grid, view.camera_to_scan, with_depth.scan_to_room, np.eye(4))
        stored = read_grid(tmp_path / convention / "a.pkl", GridRules(), is_frame=True)
        stated = place_frame(stored, view.camera_to_scan, with_depth.scan_to_room, np.eye(4))
        np.testing.assert_allclose(placed, stated, atol=1e-9)
        assert frame_evidence(grid, view, placed).seen.sum() > 500


def test_grids_of_a_survey_move_with_its_capture(tmp_path):
    """Corners in the world of the survey, in that of the moved poses, and in a stated one."""
    shift_m, near_m = np.array([450_000.0, 5_400_000, 100]), np.array([1.0, 2.0, -0.16])
    to_scan = np.eye(4)
    to_scan[:3, 3] = -shift_m
    stated = {"scan_to_room": np.linalg.inv(ROOM_TO_SCAN)}
    labels = np.zeros((60, 60, 36), np.uint8)
    corners = {"far": (near_m + shift_m, {}), "near": (near_m, {}), "stated": (near_m, stated)}
    for name, (origin_m, more) in corners.items():
        np.savez(tmp_path / f"{name}.npz", labels=labels, origin_m=origin_m, voxel_m=0.08, **more)
        grid = read_grid(tmp_path / f"{name}.npz", GridRules("w2m"), is_frame=True)
        place = place_scene(grid, to_scan)
        expected = apply(ROOM_TO_SCAN, near_m) if more else near_m
        np.testing.assert_allclose(place[:3, 3], expected, atol=1e-6)
        framed = place_frame(grid, np.eye(4), np.eye(4), to_scan)
        np.testing.assert_array_equal(framed, place)


def test_files_belong_to_views_by_their_names(tmp_path):
    for name in ("a.npy", "NYU0001_0000.pkl", "extra.npz", ".hidden.npy", "notes.txt"):
        (tmp_path / name).touch()
    found = find_grids(tmp_path, ["a.jpg", "NYU0001_0000_color", "b"])
    assert {name: path.name for name, path in found.of_view.items()} == {
        "a.jpg": "a.npy",
        "NYU0001_0000_color": "NYU0001_0000.pkl",
    }
    assert found.unused == ("extra.npz",) and found.scene is None
    alone = find_grids(tmp_path / "extra.npz", ["a", "b"])
    assert alone.scene == tmp_path / "extra.npz" and not alone.of_view


def refused(path, views=("v1", "v2")):
    with pytest.raises(InputError) as caught:
        find_grids(path, list(views))
    return str(caught.value).removeprefix(f"{path}: ")


def test_folders_that_fit_no_view_are_refused(tmp_path):
    assert refused(tmp_path) == "contains no predictions as .npy, .npz, .pkl or .bin files"
    assert refused(tmp_path / "none") == (
        "not found; expected predictions as .npy, .npz, .pkl or .bin files"
    )
    for name in ("a.npy", "b.npy"):
        (tmp_path / name).touch()
    assert refused(tmp_path, [f"view{n}" for n in range(9)]) == (
        "no file is named like a view: the views are view0, view1, view2 ... (9), the files a.npy, "
        "b.npy"
    )
    (tmp_path / "a.npz").touch()
    with pytest.raises(InputError, match="and a.npy predict the same view; remove one"):
        find_grids(tmp_path, ["a"])


def contradicted(scan, path, **rules):
    with pytest.raises(InputError) as caught:
        evidence(scan, path, **rules)
    message = str(caught.value)
    assert "\n" not in message and caught.value.exit_code == 3
    return message.removeprefix(f"{path}: ")


@pytest.mark.parametrize("kind", ["with_depth", "without_depth"])
@pytest.mark.parametrize(
    ("saved", "given", "axes"),
    [("iso", "embodiedocc", "x, y, z"), ("embodiedocc", "iso", "y, x, z")],
)
def test_exchanged_axes_are_named(folders, kind, saved, given, axes, request):
    scan = request.getfixturevalue(kind)
    message = contradicted(scan, folders[saved], convention=given)
    assert message.startswith(f"read as {given} (axes {axes}), ")
    assert f"; --convention {saved} fits: " in message
    assert "agreement of views 1" in message  # 100 % or nearly.
    assert ("blocked rays" in message) == (kind == "with_depth")


@pytest.mark.parametrize("kind", ["with_depth", "without_depth"])
def test_the_grid_of_a_scene_with_other_axes_is_named(kind, tmp_path, request):
    scan = request.getfixturevalue(kind)
    labels, origin_m = scene_labels()
    place = {"voxel_m": 0.08, "origin_m": origin_m, "scan_to_room": np.linalg.inv(ROOM_TO_SCAN)}
    np.savez(tmp_path / "true.npz", labels=labels, **place)
    items, notes = evidence(scan, tmp_path / "true.npz")
    assert items[-1].view == "scene" or items[0].view == "scene"
    assert notes[0].startswith("true.npz predicts the whole scene (w2m, axes x, y, z, class ids")
    np.savez(tmp_path / "xzy.npz", labels=labels.transpose(0, 2, 1), **place)
    message = contradicted(scan, tmp_path / "xzy.npz")
    assert message.startswith("read as w2m (axes x, y, z), the floor is not level: ")
    assert "; --convention monoscene fits: level floor 100% instead of " in message
    np.savez(tmp_path / "down.npz", labels=labels[:, :, ::-1], **place)
    message = contradicted(scan, tmp_path / "down.npz")
    assert (
        "of the other occupied cells are below the floor; a z axis that points up fits" in message
    )


@pytest.mark.parametrize("kind", ["with_depth", "without_depth"])
def test_an_inverted_pose_is_named(folders, tmp_path, kind, request):
    for path in folders["monoscene"].glob("*.pkl"):
        stored = read_pickle(path)
        inverse = np.linalg.inv(np.asarray(stored["cam_pose"]))
        (tmp_path / path.name).write_bytes(dump_pickle({**stored, "cam_pose": inverse}))
    message = contradicted(request.getfixturevalue(kind), tmp_path)
    assert "the z axis is tilted by " in message
    assert "; the inverse of cam_pose (camera to world) fits: " in message


def test_ids_without_empty_cells_are_named(with_depth, tmp_path):
    """Empty cells that are left out, as of a network that gives no id to them."""
    for view in with_depth.views:
        pose = with_depth.scan_to_room @ view.camera_to_scan
        labels = write_prediction(tmp_path / "true", view.name, pose, "monoscene")
        stored = read_pickle(tmp_path / "true" / f"{view.name}.pkl")
        labels = np.where(labels == 0, 255, labels).transpose(0, 2, 1)
        (tmp_path / f"{view.name}.pkl").write_bytes(dump_pickle({**stored, "y_pred": labels}))
    assert contradicted(with_depth, tmp_path) == (
        "read as monoscene (axes x, z, y), only 0% of the cells are empty; check the classes "
        "(--classes), or skip this check with --set predictions.check=false"
    )


def test_the_check_can_be_left_out(folders, with_depth):
    items, notes = evidence(with_depth, folders["iso"], convention="embodiedocc", check=False)
    assert len(items) == 12 and "6 of 6 views" in notes[0]
