"""Frames into one scene: in any order the same, nothing forgotten, on the scene's own cells."""

import numpy as np
import pytest
import torch
from room_frames import SHAPE, VOXEL_M, room_batch

from world2minecraft.core.coordinates import look_at
from world2minecraft.networks.batch import OccInput
from world2minecraft.networks.models import make_network
from world2minecraft.networks.models.embodied import SceneStream, window_in_front

SCENE = (40, 36, 18)
EYES = [(3.0, 0.6, 1.6), (3.4, 5.6, 1.6), (0.7, 3.0, 1.5)]
AIMS = [(3.1, 3.0, 1.2), (3.0, 2.0, 1.2), (4.0, 3.1, 1.2)]


@pytest.fixture(scope="module")
def network():
    return make_network("embodied", "tiny", grid_shape=SHAPE, voxel_m=VOXEL_M, seed=2).eval()


def frames():
    inputs, _ = room_batch()
    poses = [look_at(np.array(eye), np.array(aim)) for eye, aim in zip(EYES, AIMS, strict=True)]
    for n, pose in enumerate(poses):
        b = n % 2
        yield (
            inputs.image[b],
            inputs.intrinsics[b],
            torch.from_numpy(pose).float(),
            inputs.depth_m[b],
        )


def streamed(network, order):
    stream, shots = SceneStream(network, SCENE, SHAPE, VOXEL_M), list(frames())
    for n in order:
        stream.add(*shots[n])
    return stream


def test_the_order_of_frames_does_not_matter(network):
    streams = [streamed(network, order) for order in ((0, 1, 2), (2, 0, 1))]
    first = streams[0].evidence
    assert (first.weight > 0).float().mean() > 0.1
    for other in streams[1:]:
        torch.testing.assert_close(other.evidence.values, first.values, atol=1e-5, rtol=1e-5)
    torch.testing.assert_close(streams[-1].logits(), streams[0].logits(), atol=1e-3, rtol=1e-3)


def test_nothing_is_forgotten(network):
    before = streamed(network, [0]).evidence
    after = streamed(network, [0, 1, 2]).evidence
    assert (after.weight >= before.weight - 1e-6).all()
    assert (after.votes >= before.votes - 1e-6).all()
    assert (after.weight > before.weight + 1e-3).any()
    # A frame adds to what it sees, and to nothing else.
    once, twice = streamed(network, [1]).evidence, streamed(network, [1, 1]).evidence
    torch.testing.assert_close(twice.values, 2 * once.values)
    assert (once.values[:, :, once.weight[0] == 0] == 0).all()


def test_a_scene_as_large_as_a_box_is_what_the_frame_says(network):
    image, lens, _, depth_m = next(frames())
    pose = look_at(np.array([2.4, 0.02, 1.6]), np.array([2.4, 2.0, 1.4]))
    camera_to_scene = torch.from_numpy(pose).float()
    assert window_in_front(camera_to_scene, SHAPE, VOXEL_M).low == (0, 0, 0)
    stream = SceneStream(network, SHAPE, SHAPE, VOXEL_M)
    stream.add(image, lens, camera_to_scene, depth_m)
    inputs = OccInput(image[None], lens[None], camera_to_scene[None], SHAPE, VOXEL_M, depth_m[None])
    with torch.no_grad():
        alone = network(inputs).logits[0]
    torch.testing.assert_close(stream.logits(), alone, atol=1e-4, rtol=1e-4)


@pytest.mark.parametrize("quarters", range(4))
@pytest.mark.parametrize("shape", [(30, 30, 18), (20, 26, 12)])
def test_boxes_lie_before_the_camera_on_the_scenes_cells(quarters, shape):
    rng = np.random.default_rng(quarters)
    eye = np.array([5.03, 4.41, 1.62])
    turn = np.deg2rad(90 * quarters + rng.uniform(-40, 40))
    ahead = np.array([-np.sin(turn), np.cos(turn), -0.2])
    window = window_in_front(torch.from_numpy(look_at(eye, eye + ahead)), shape, VOXEL_M)
    assert window.quarters == quarters
    to_scene = window.box_to_scene(VOXEL_M).numpy()
    # The box's forward axis is the camera's, its cells are the scene's.
    assert to_scene[:2, 1] @ ahead[:2] > 0.7
    numbers = torch.arange(int(np.prod(shape))).reshape(1, 1, *shape)
    turned = torch.rot90(numbers, window.quarters, (2, 3))[0, 0].numpy()
    right, forward, up = shape
    assert turned.shape == ((forward, right, up) if quarters % 2 else shape)
    for cell in [(0, 0, 0), (3, 5, 2), (shape[0] - 1, 0, 1), (7, shape[1] - 1, 4)]:
        place = (to_scene @ [*((np.array(cell) + 0.5) * VOXEL_M), 1])[:3] / VOXEL_M - 0.5
        at = np.round(place).astype(int) - window.low
        np.testing.assert_allclose(place, np.round(place), atol=1e-6)
        assert turned[tuple(at)] == numbers[(0, 0, *cell)]
    # The camera stands at the middle of the near side, eye height over the floor.
    near = np.linalg.inv(to_scene) @ [*eye, 1]
    assert abs(near[0] - shape[0] * VOXEL_M / 2) <= VOXEL_M
    assert abs(near[1]) <= VOXEL_M


def test_frames_that_leave_the_scene_are_cut(network):
    stream, (image, lens, _, depth_m) = SceneStream(network, SCENE, SHAPE, VOXEL_M), next(frames())
    for eye, aim in [
        ((6.5, 6.0, 1.6), (9, 9, 1)),
        ((40, 3, 1.6), (50, 3, 1)),
        ((-30, 3, 1), (-40, 3, 1)),
    ]:
        pose = torch.from_numpy(look_at(np.array(eye, float), np.array(aim, float))).float()
        stream.add(image, lens, pose, depth_m)
    assert torch.isfinite(stream.logits()).all()
    assert stream.logits().shape == (12, *SCENE)


def test_in_training_scenes_are_read_at_any_quarter_turn():
    inputs, _ = room_batch()
    small = make_network("embodied", "small", grid_shape=SHAPE, voxel_m=VOXEL_M)
    one = OccInput(
        inputs.image[:1], inputs.intrinsics[:1], inputs.camera_to_grid[:1], SHAPE, VOXEL_M
    )
    with torch.no_grad():
        torch.manual_seed(0)
        said = [small(one).logits for _ in range(6)]
        quiet = [small.eval()(one).logits for _ in range(2)]
    assert not all(torch.equal(said[0], other) for other in said[1:])
    assert torch.equal(*quiet)
