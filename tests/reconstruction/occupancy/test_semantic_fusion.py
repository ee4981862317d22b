"""Votes of networks on what depth sees: aligned with the picture, soft, kept, and told of."""

from dataclasses import replace

import numpy as np
import pytest
from tests.exact_room import CAMERA, BoxRoom
from tests.reconstruction.occupancy.tiny_network import sized, write_network

from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera, Scan, View
from world2minecraft.core.vocabulary import label_id_names
from world2minecraft.geometry.unprojection import project
from world2minecraft.reconstruction.fusion import EvidenceMap
from world2minecraft.reconstruction.occupancy import OccupancyParameters, notes_of, predictor
from world2minecraft.reconstruction.occupancy import semantic_fusion as kept
from world2minecraft.reconstruction.occupancy import semantic_fusion as voters
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor
from world2minecraft.reconstruction.occupancy.monocular_occupancy import MonoPredictor
from world2minecraft.reconstruction.occupancy.semantic_fusion import CellVoter, PixelVoter, spread

ROOM = BoxRoom()


class Halves:
    """A segmenter of two labels: the left half is chair, the right sofa by three quarters."""

    name, identity = "fake:halves", "1"
    labels = ("chair", "sofa", "gizmo")

    def __init__(self):
        self.asked = 0

    def predict(self, colour, classes):
        self.asked += 1
        scores = np.zeros((6, 8, 3), np.float32)
        scores[:, :4] = [1, 0, 0]
        scores[:, 4:] = [0.125, 0.75, 0.125]
        return scores @ classes


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "cache"))


def view(**changes) -> View:
    pose = ROOM.poses(1)[0]
    depth_m, colour = ROOM.render(pose)
    return replace(View("v", pose, colour, CAMERA, depth_m, CAMERA), **changes)


def test_each_point_has_the_votes_of_the_pixel_that_shows_it():
    network = Halves()
    found = DepthPredictor(voters=[PixelVoter(network)]).lift(view())
    assert found.point_votes is not None and found.point_votes.dtype == np.float16
    at_px = project(apply(np.linalg.inv(view().camera_to_scan), found.points_m), CAMERA)
    left, right = at_px[:, 0] < 70, at_px[:, 0] > 90  # Between, the halves are read between.
    np.testing.assert_allclose(found.point_votes[left][:, 5], 1)
    np.testing.assert_allclose(found.point_votes[right][:, 5], 0.125, atol=1 / 255)
    np.testing.assert_allclose(found.point_votes[right][:, 7], 0.75, atol=1 / 255)
    np.testing.assert_allclose(found.point_votes[right].sum(axis=1), 0.875, atol=2 / 255)


def test_labels_vote_for_their_fine_names():
    voter = PixelVoter(Halves())
    DepthPredictor(voters=[voter]).lift(view())
    votes = voter.names.votes().votes.sum(axis=0)
    named = {label_id_names()[number + 1] for number in np.flatnonzero(votes)}
    assert named == {"chair", "sofa"}
    _, label_ids = voter.prediction(view().colour)
    assert label_id_names()[label_ids[0, 0]] == "chair"


def test_a_divided_label_names_nothing():
    network = Halves()
    network.labels = ("gizmo", "stool", "sofa")
    _, label_ids = PixelVoter(network).prediction(view().colour)
    assert label_id_names()[label_ids[0, -1]] == "stool" and not label_ids[:, :70].any()


def test_a_depth_camera_in_another_place_is_heeded():
    """Depth of a camera of another size, 10 cm aside: its points still meet their pixels."""
    aside = np.eye(4)
    aside[:3, 3] = [0.1, 0.02, 0.0]
    lens = Camera(80, 60, 60.0, 60.0, 40.0, 30.0)
    depth_m, _ = ROOM.render(view().camera_to_scan @ aside, lens)
    moved = view(depth_m=depth_m, depth_camera=lens, depth_to_colour=aside)
    found = DepthPredictor(voters=[PixelVoter(Halves())]).lift(moved)
    at_px = project(apply(np.linalg.inv(moved.camera_to_scan), found.points_m), CAMERA)
    assert found.point_votes is not None
    np.testing.assert_allclose(found.point_votes[at_px[:, 0] < 70][:, 5], 1)
    assert (found.point_votes[at_px[:, 0] > 90][:, 7] > 0.7).all()


def test_a_second_run_costs_nothing():
    network = Halves()
    first = PixelVoter(network).prediction(view().colour)[0]
    again = PixelVoter(network).prediction(view().colour)[0]
    assert network.asked == 1 and first.tobytes() == again.tobytes()
    other = view().colour.copy()
    other[0, 0] ^= 1
    PixelVoter(network).prediction(other)
    assert network.asked == 2
    newer = Halves()
    newer.identity = "2"
    PixelVoter(newer).prediction(view().colour)[0]
    assert newer.asked == 1


def test_what_labels_mean_decides_what_is_kept(tmp_path):
    own = tmp_path / "names.yaml"
    own.write_text("table: [chair]\n")
    network = Halves()
    plain, changed = (
        PixelVoter(network, names).prediction(view().colour)[0] for names in ("", str(own))
    )
    assert network.asked == 2
    assert np.array_equal(plain[..., 5], changed[..., 8]) and not changed[..., 5].any()


def test_the_oldest_go_when_too_much_is_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(kept, "MAX_BYTES", 2_000)
    shares = np.random.default_rng(0).integers(0, 256, (4, 4, 12), dtype=np.uint8)
    for number in range(12):
        key = kept.key_of(np.full((2, 2, 3), number, np.uint8))
        kept.cached_prediction(key, lambda: shares, tmp_path)
    files = list(tmp_path.glob("*/*.npz"))
    assert 0 < len(files) < 12 and sum(path.stat().st_size for path in files) <= 2_000


def test_a_cache_that_is_damaged_or_closed_is_done_without(tmp_path):
    key = kept.key_of(np.zeros((2, 2, 3), np.uint8))
    shares = np.ones((2, 2, 12), np.uint8)
    path = tmp_path / key[:2] / f"{key}.npz"
    path.parent.mkdir()
    path.write_bytes(b"damaged")
    assert kept.cached_prediction(key, lambda: shares, tmp_path).all()
    (tmp_path / "file").write_text("")
    assert kept.cached_prediction(key, lambda: shares, tmp_path / "file").all()


def test_shares_are_spread_over_the_picture():
    shares = np.zeros((2, 3, 12), np.uint8)
    shares[:, :, 4] = [[0, 100, 200]] * 2
    wide = spread(shares, 30, 20)
    assert wide.shape == (20, 30, 12) and (np.diff(wide[:, :, 4].astype(int), axis=1) >= 0).all()
    assert wide[0, 0, 4] == 0 and wide[0, -1, 4] == 200 and not wide[..., 5].any()


def test_unknown_names_are_told_once_with_the_file_to_edit(monkeypatch):
    monkeypatch.setattr(voters, "segmenter", lambda name: Halves())
    used = predictor("depth", OccupancyParameters(semantics="fake:halves"))
    list(used.predict(Scan([view(), view(name="w")], np.eye(4), np.ones(3), ("v", "w"))))
    assert notes_of(used) == (
        "1 of 3 labels of fake:halves have no class and do not vote: gizmo; "
        "assign classes with --set occupy.label_names=FILE, see vocabulary.yaml",
    )


def test_soft_votes_reach_the_map():
    map_ = EvidenceMap(np.eye(4))
    map_.add(DepthPredictor(voters=[PixelVoter(Halves())]).lift(view()))
    votes = map_.fused().votes.astype(np.float32)
    assert votes[..., 5].max() > 0 and votes[..., 7].max() > 0
    assert votes[..., [1, 2, 3, 4, 6, 8, 9, 10, 11]].max() == 0


def test_monocular_network_votes_by_the_cell_of_a_point(tmp_path):
    """Its cells of the nearer half are tables, beyond they are furniture; points vote so."""
    bias = np.zeros((12, 60, 60, 36))
    bias[8, :, :20], bias[10, :, 20:] = 30.0, 30.0
    path = write_network(tmp_path / "n.onnx", sized((60, 60, 36), 0.08), bias=bias)
    mono = MonoPredictor(path)
    found = DepthPredictor(voters=[CellVoter(mono)]).lift(view(), np.eye(4))
    said = mono.look(view(), np.eye(4))
    forward = apply(np.linalg.inv(said.grid_to_scan), found.points_m.astype(float))[:, 1]
    assert found.point_votes is not None
    voted = found.point_votes.any(axis=1)
    assert voted.mean() > 0.9
    assert (found.point_votes[voted & (forward < 1.6)][:, 8] > 0.99).all()
    assert (found.point_votes[voted & (forward >= 1.6)][:, 10] > 0.99).all()
    assert not found.point_votes[:, 0].any()


def test_voters_are_for_depth_alone(tmp_path):
    with pytest.raises(UsageError, match="require the predictor depth, got 'mono'"):
        predictor("mono:x.onnx", OccupancyParameters(semantics="hf:a/b"))
    with pytest.raises(UsageError, match="requires --set occupy.mono_votes=true"):
        predictor("depth", OccupancyParameters(network="x.onnx"))
