"""Each network: shapes, the same weights of a seed, gradients everywhere, and that it can learn."""

import pytest
import torch
from room_frames import SHAPE, VOXEL_M, room_batch

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.networks.losses import LossWeights, occupancy_losses
from world2minecraft.networks.models import NETWORKS, make_network

STEPS = 32  # Each network learns two frames within so many, at RATE, or by its own numbers.
RATE = 1.2e-2
OWN = {"symphonies": (50, 6e-3), "embodied": (32, 8e-3)}  # Attention wants smaller steps.
LEARNED = 0.7  # IoU; where all is called occupied it is 0.21, and 0.9 after twice as many steps.
# Published is 0.05 for empty cells, which would take more steps to find the edges of things.
WEIGHTS = LossWeights(classes=(0.3, *([1.0] * 11)))
EACH = pytest.mark.parametrize("name", NETWORKS.names())


def tiny(name, seed=0, **words):
    return make_network(name, "tiny", grid_shape=SHAPE, voxel_m=VOXEL_M, seed=seed, **words)


def overlap(said, labels):
    known = labels != 255
    mine, true = (said > 0) & known, (labels > 0) & known
    return float((mine & true).sum() / (mine | true).sum())


@EACH
def test_it_learns_two_frames(name):
    inputs, target = room_batch()
    network = tiny(name)
    steps, rate = OWN.get(name, (STEPS, RATE))
    learner = torch.optim.AdamW(network.parameters(), lr=rate)
    pace = torch.optim.lr_scheduler.OneCycleLR(learner, rate, total_steps=steps, pct_start=0.2)
    for _ in range(steps):
        loss = sum(occupancy_losses(network(inputs), target, inputs, WEIGHTS).values())
        learner.zero_grad()
        loss.backward()
        learner.step()
        pace.step()
    network.eval()
    with torch.no_grad():
        said = network(inputs).logits.argmax(dim=1)
    assert overlap(said, target.labels) > LEARNED


@EACH
def test_shapes_and_gradients(name):
    inputs, target = room_batch()
    network = tiny(name)
    output = network(inputs)
    assert output.logits.shape == (2, 12, *SHAPE)
    assert output.logits.dtype == torch.float32
    assert all(one.shape == output.logits.shape for one in output.auxiliary)
    torch.stack(list(occupancy_losses(output, target, inputs).values())).sum().backward()
    for path, weights in network.named_parameters():
        assert weights.grad is not None, f"no gradient reaches {path}"
        assert torch.isfinite(weights.grad).all(), path
        assert weights.grad.abs().max() > 0, f"nothing flows back to {path}"


@EACH
def test_a_seed_gives_the_same_weights_and_answers(name):
    inputs, _ = room_batch()
    torch.manual_seed(7)
    before = torch.random.get_rng_state()
    one, two, other = tiny(name, 3).eval(), tiny(name, 3).eval(), tiny(name, 4).eval()
    assert torch.equal(torch.random.get_rng_state(), before)
    for mine, same in zip(one.parameters(), two.parameters(), strict=True):
        assert torch.equal(mine, same)
    with torch.no_grad():
        said, again, else_ = (network(inputs).logits for network in (one, two, other))
    assert torch.equal(said, again)
    assert not torch.equal(said, else_)


@EACH
def test_frames_of_a_batch_do_not_mix(name):
    inputs, _ = room_batch()
    network = tiny(name).eval()
    alone = type(inputs)(
        inputs.image[1:], inputs.intrinsics[1:], inputs.camera_to_grid[1:], SHAPE, VOXEL_M,
        inputs.depth_m[1:],
    )  # fmt: skip
    with torch.no_grad():
        torch.testing.assert_close(
            network(inputs).logits[1:], network(alone).logits, atol=1e-3, rtol=1e-3
        )


@EACH
@pytest.mark.parametrize("size", ["small", "full"])
def test_larger_sizes_can_be_made(name, size):
    with torch.device("meta"):
        network = make_network(name, size, grid_shape=(60, 60, 36), voxel_m=0.08)
    assert sum(weights.numel() for weights in network.parameters()) > 1e6


@pytest.mark.parametrize(
    ("words", "error", "text"),
    [
        ({"name": "monoscen"}, UnknownNameError, "no network is named 'monoscen'; did you mean"),
        ({"size": "large"}, UnknownNameError, "no network size is named 'large'"),
        ({"grid_shape": (30, 30, 4)}, UsageError, "three sides of at least 8 cells"),
        ({"voxel_m": 0.0}, UsageError, "voxel_m must be above 0, got 0.0"),
        ({"backbone": "resnet"}, UsageError, "backbone must be hf:ORG/NAME or hf:FOLDER, got"),
    ],
)
def test_what_cannot_be_made_says_so(words, error, text):
    usual = {"name": "monoscene", "size": "tiny", "grid_shape": SHAPE, "voxel_m": VOXEL_M}
    given = {**usual, **words}
    with pytest.raises(error, match=text):
        make_network(given.pop("name"), given.pop("size"), **given)
