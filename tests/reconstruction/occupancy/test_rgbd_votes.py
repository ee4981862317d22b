"""Votes of the built-in segmentation network: where, which, and from which views."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.exact_room import CAMERA, BoxRoom

from world2minecraft.core.classes import CLASS_COUNT, SemanticClass
from world2minecraft.core.types import Scan, View
from world2minecraft.core.vocabulary import nyu40_classes, nyu40_names
from world2minecraft.reconstruction.occupancy import OccupancyParameters, predictor
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor
from world2minecraft.reconstruction.occupancy.rgbd_votes import (
    MIN_TURN_DEG,
    RgbdVoter,
    class_matrix,
)
from world2minecraft.reconstruction.parameters import Parameters, with_method
from world2minecraft.reconstruction.recognition.segmentation import (
    GENERATED_WEIGHTS,
    WEIGHTS,
    splat_depth,
)

ROOM = BoxRoom()
CHAIR, SOFA, WALL = (nyu40_names()[name] - 1 for name in ("chair", "sofa", "wall"))


class Halves:
    """A network that sees a chair on the left, and on the right anything."""

    def __init__(self):
        self.asked = []

    def predict(self, colour, depth_m, camera, up, camera_height_m):
        self.asked.append((depth_m, up, camera_height_m))
        shares = np.zeros((12, 16, 40), np.float32)
        shares[:, :8, CHAIR], shares[:, :8, SOFA] = 0.8, 0.2
        shares[:, 8:, [CHAIR, SOFA, WALL]] = 0.3, 0.35, 0.35
        return shares


def voter() -> tuple[RgbdVoter, Halves]:
    made, network = RgbdVoter(), Halves()
    made.model = network  # type: ignore[assignment]
    return made, network


def lift(made: RgbdVoter, seen: View):
    return DepthPredictor(voters=[made]).lift(seen, np.eye(4)).point_votes


def votes_of(made: RgbdVoter, seen: View) -> np.ndarray:
    votes = lift(made, seen)
    assert votes is not None
    return votes


def view(**changes) -> View:
    pose = ROOM.poses(1)[0]
    depth_m, colour = ROOM.render(pose)
    return replace(View("v", pose, colour, CAMERA, depth_m, CAMERA), **changes)


def test_pixels_without_a_likely_class_do_not_vote():
    found = DepthPredictor(voters=[voter()[0]]).lift(view())
    assert found.point_votes is not None
    at_px = np.asarray(found.points_m, np.float64) @ view().camera_to_scan[:3, :3]
    at_px -= view().camera_to_scan[:3, 3] @ view().camera_to_scan[:3, :3]
    left = at_px[:, 0] / at_px[:, 2] * CAMERA.fx_px + CAMERA.cx_px < CAMERA.width_px / 2
    assert (found.point_votes[left, SemanticClass.CHAIR] > 0.7).all()
    assert not found.point_votes[~left].any()
    assert (found.point_votes.sum(axis=1) <= 1.001).all()


def test_the_network_gets_depth_gravity_and_height():
    (made, network), seen = voter(), view()
    found = DepthPredictor(voters=[made]).lift(seen, np.eye(4))
    ((depth_m, up, height_m),) = network.asked
    np.testing.assert_allclose(up, seen.camera_to_scan[2, :3])
    assert height_m == pytest.approx(seen.camera_to_scan[2, 3])
    assert seen.depth_m is not None and found.points_m.size
    known = depth_m > 0
    assert known.mean() > 0.9
    assert seen.depth_m.min() - 1e-3 <= depth_m[known].min()
    assert depth_m.max() <= seen.depth_m.max() + 1e-3


def test_views_with_labels_or_from_one_place_do_not_vote():
    (made, network), seen = voter(), view()
    labels = np.zeros(seen.colour.shape[:2], np.uint8)  # type: ignore[union-attr]
    assert lift(made, replace(seen, labels=labels)) is None
    assert not network.asked
    assert votes_of(made, seen).any()
    assert lift(made, seen) is None
    assert len(network.asked) == 1
    turned = seen.camera_to_scan.copy()
    angle = np.deg2rad(2 * MIN_TURN_DEG)  # Of a camera that looks down.
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    turned[:3, :3] = turn @ turned[:3, :3]
    assert votes_of(made, replace(seen, camera_to_scan=turned)).any()
    assert len(network.asked) == 2


@pytest.mark.parametrize(("kind", "votes"), [("sensor", True), ("stereo", True), ("exact", False)])
def test_views_of_meshes_get_no_votes_by_default(kind, votes):
    (made, _), seen = voter(), view()
    made.photos_only = True
    scan = Scan([seen], np.eye(4), np.ones(3), ("v",), depth_kind=kind)
    (found,) = DepthPredictor(voters=[made]).predict(scan)
    assert (found.point_votes is not None and bool(found.point_votes.any())) is votes
    assert voters("auto")[0].photos_only
    assert not voters("nyu")[0].photos_only


def test_classes_of_nyu_vote_for_the_classes_of_the_program():
    matrix = class_matrix()
    for number, row in enumerate(matrix, start=1):
        wanted = nyu40_classes()[number]
        assert row.sum() == (0 < wanted < CLASS_COUNT)
        assert row[0] == 0
        assert not row.any() or row.argmax() == wanted


@settings(max_examples=50, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(0.1, 9), st.floats(0, 1, exclude_max=True), st.floats(0, 1)),
        max_size=40,
    )
)
def test_each_pixel_has_the_depth_of_its_nearest_point(points):
    depth_m, down, right = np.array(points, np.float64).reshape(-1, 3).T
    found = splat_depth(depth_m, down, right, (5, 4))
    wanted = np.zeros((4, 5), np.float32)
    for z, v, u in points:
        row, column = min(int(v * 4), 3), min(int(u * 5), 4)
        if wanted[row, column] == 0 or z < wanted[row, column]:
            wanted[row, column] = z
    np.testing.assert_array_equal(found, wanted)


def voters(name: str, **chosen) -> tuple:
    """Return the voters of the predictor of depth."""
    return predictor("depth", OccupancyParameters(semantics=name, **chosen)).voters  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("name", "file"),
    [("auto", WEIGHTS), ("nyu", WEIGHTS), ("generated", GENERATED_WEIGHTS)],
)
def test_the_built_in_network_is_chosen_by_name(name, file):
    (made,) = voters(name)
    assert isinstance(made, RgbdVoter)
    assert made.model.weights == file
    assert file.is_file()


def test_no_network_votes_where_none_is_wanted():
    for name in ("", "none"):
        assert voters(name) == ()
    assert OccupancyParameters().semantics == "auto"
    assert with_method(Parameters(), "paper").occupy.semantics == "none"


def test_shipped_weights_give_the_same_votes_on_each_run():
    first, again = votes_of(RgbdVoter(), view()), votes_of(RgbdVoter(), view())
    np.testing.assert_array_equal(first, again)
    assert first.any(axis=1).mean() > 0.1
    assert (first.astype(np.float32).sum(axis=1) <= 1.01).all()
