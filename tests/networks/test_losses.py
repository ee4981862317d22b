"""Losses are those of slow references, and have finite gradients where little is to be judged."""

import math

import loss_reference as reference
import numpy as np
import pytest
import torch

from world2minecraft.core.errors import UsageError
from world2minecraft.networks.batch import OccInput, OccOutput, OccTarget
from world2minecraft.networks.layers.depth_bins import min_pool_depth
from world2minecraft.networks.losses import (
    LossWeights,
    coarse_labels,
    cross_entropy,
    depth_loss,
    frustum_loss,
    geometric_affinity,
    occupancy_losses,
    relation_loss,
    relations_of,
    semantic_affinity,
)

SHAPE = (9, 8, 6)
SEEDS = pytest.mark.parametrize("seed", range(4))


def scene(seed, shape=SHAPE, classes=12):
    rng = np.random.default_rng(seed)
    labels = np.where(rng.random((2, *shape)) < 0.4, rng.integers(0, classes, (2, *shape)), 0)
    labels[rng.random(labels.shape) < 0.1] = 255
    return rng.normal(0, 1.5, (2, 12, *shape)).astype(np.float32), labels


def inputs_of(shape=SHAPE, depth=None):
    """A camera behind the grid that looks along y, so that some cells are out of its picture."""
    to_grid = torch.tensor(
        [[1.0, 0, 0, 0.7], [0, 0, 1, -0.4], [0, -1, 0, 0.5], [0, 0, 0, 1]]
    ).repeat(2, 1, 1)
    to_grid[1, :3, 3] += torch.tensor([0.1, 0.3, -0.1])
    lens = torch.tensor([[30.0, 0, 16], [0, 31, 12], [0, 0, 1]]).repeat(2, 1, 1)
    return OccInput(torch.zeros(2, 3, 24, 32), lens, to_grid, shape, 0.16, depth)


@SEEDS
def test_cross_entropy(seed):
    logits, labels = scene(seed)
    weights = np.linspace(0.05, 2, 12)
    found = cross_entropy(torch.tensor(logits), torch.tensor(labels), torch.tensor(weights))
    assert float(found) == pytest.approx(reference.cross_entropy(logits, labels, weights), rel=1e-4)


@SEEDS
@pytest.mark.parametrize("classes", [12, 5])
def test_affinities(seed, classes):
    logits, labels = scene(seed, classes=classes)
    told = torch.tensor(logits), torch.tensor(labels)
    assert float(semantic_affinity(*told)) == pytest.approx(
        reference.semantic(logits, labels), rel=1e-4
    )
    assert float(geometric_affinity(*told)) == pytest.approx(
        reference.geometric(logits, labels), rel=1e-4
    )


@SEEDS
def test_frusta(seed):
    logits, labels = scene(seed)
    found = frustum_loss(torch.tensor(logits), torch.tensor(labels), inputs_of())
    expected = reference.frusta(logits, labels, inputs_of())
    assert expected > 0.1
    assert float(found) == pytest.approx(expected, rel=1e-4)


@SEEDS
def test_relations(seed):
    _, labels = scene(seed, (9, 16, 12))
    coarse = coarse_labels(torch.tensor(labels))
    expected = np.stack([reference.coarse(one) for one in labels])
    assert np.array_equal(coarse.numpy(), expected)
    held, known = relations_of(coarse)
    slow = [reference.relations(one) for one in expected]
    assert np.array_equal(held.numpy(), np.stack([one[0] for one in slow]))
    assert np.array_equal(known[:, 0].numpy(), np.stack([one[1] for one in slow]))
    logits = np.random.default_rng(seed).normal(size=held.shape).astype(np.float32)
    found = relation_loss(torch.tensor(logits), torch.tensor(labels))
    assert float(found) == pytest.approx(reference.relation_loss(logits, labels), rel=1e-4)


@SEEDS
def test_depth(seed):
    rng = np.random.default_rng(seed)
    logits = rng.normal(size=(2, 7, 3, 4)).astype(np.float32)
    depth_m = (rng.uniform(0, 12, (2, 12, 16)) * (rng.random((2, 12, 16)) < 0.3)).astype(np.float32)
    found = depth_loss(torch.tensor(logits), torch.tensor(depth_m))
    assert float(found) == pytest.approx(reference.depth(logits, depth_m), rel=1e-4)


def test_pooled_depth_is_the_nearest_of_its_pixels():
    depth_m = torch.tensor([[[0.0, 3.0, 0.0, 0.0], [2.0, 9.0, 0.0, 0.0]]])
    assert min_pool_depth(depth_m, 2).tolist() == [[[2.0, 0.0]]]


def test_by_hand():
    """Two cells, of which one is a wall: even logits give a twelfth to each class."""
    logits, labels = torch.zeros(1, 12, 1, 1, 2), torch.tensor([[[[0, 3]]]])
    assert float(cross_entropy(logits, labels)) == pytest.approx(math.log(12))
    # Each of two classes: precision 1/12 over 2/12, recall 1/12, specificity 11/12.
    each = math.log(2) + math.log(12) + math.log(12 / 11)
    assert float(semantic_affinity(logits, labels)) == pytest.approx(each)
    # Occupied: 11/12 of each cell. Precision 1/2, recall 11/12, specificity 1/12.
    each = math.log(2) + math.log(12 / 11) + math.log(12)
    assert float(geometric_affinity(logits, labels)) == pytest.approx(each)


def test_what_is_right_costs_nothing():
    _, labels = scene(1)
    told = torch.where(torch.tensor(labels) == 255, 0, torch.tensor(labels))
    logits = 40 * torch.nn.functional.one_hot(told, 12).movedim(-1, 1).float()
    found = occupancy_losses(OccOutput(logits), target_of(labels), inputs_of())
    assert set(found) == {"cross_entropy", "semantic", "geometric", "frusta"}
    assert all(float(value) < 1e-5 for value in found.values())


@pytest.mark.parametrize("case", ["all unknown", "all empty", "one class", "sure and wrong"])
def test_gradients_are_finite(case):
    logits, labels = scene(3)
    labels = {
        "all unknown": np.full_like(labels, 255),
        "all empty": np.zeros_like(labels),
        "one class": np.full_like(labels, 9),
        "sure and wrong": labels,
    }[case]
    logits = torch.tensor(logits)
    if case == "sure and wrong":
        logits[:, 0] += 300
    given = [logits, torch.randn(2, 4, 1, 12), torch.randn(2, 8, 3, 4), logits.clone()]
    given = [value.requires_grad_() for value in given]
    output = OccOutput(given[0], (given[3],), given[1], given[2])
    found = occupancy_losses(output, target_of(labels), inputs_of(depth=torch.zeros(2, 24, 32)))
    assert set(found) == {
        "cross_entropy", "semantic", "geometric", "frusta", "relations", "depth", "auxiliary",
    }  # fmt: skip
    total = torch.stack(list(found.values())).sum()
    total.backward()
    assert math.isfinite(total.item())
    assert all(torch.isfinite(value.grad).all() for value in given)
    assert case != "all unknown" or (total == 0 and all((v.grad == 0).all() for v in given))


def test_weights_scale_and_leave_out():
    logits, labels = scene(2)
    output = OccOutput(torch.tensor(logits), auxiliary=(torch.tensor(logits),))
    once = occupancy_losses(output, target_of(labels), inputs_of())
    doubled = LossWeights(cross_entropy=2, semantic=0, auxiliary=1)
    found = occupancy_losses(output, target_of(labels), inputs_of(), doubled)
    assert set(found) == set(once) - {"semantic"}
    assert float(found["cross_entropy"]) == pytest.approx(2 * float(once["cross_entropy"]))
    # An earlier layer that says the same costs the same, at its own weight.
    assert float(once["auxiliary"]) == pytest.approx(
        0.5 * sum(float(v) for k, v in once.items() if k != "auxiliary"), rel=1e-5
    )


def test_the_targets_depth_comes_first():
    said = torch.zeros(2, 8, 3, 4)
    said[:, 2] = 9.0
    logits, labels = scene(2)
    near, far = torch.full((2, 24, 32), 1.0), torch.full((2, 24, 32), 9.9)
    output = OccOutput(torch.tensor(logits), depth_logits=said)
    by_target = occupancy_losses(output, target_of(labels, near), inputs_of(depth=far))["depth"]
    assert (
        float(by_target)
        < 0.01
        < float(occupancy_losses(output, target_of(labels), inputs_of(depth=far))["depth"])
    )


def test_half_precision_is_judged_in_single():
    logits, labels = scene(2)
    output = OccOutput(torch.tensor(logits).bfloat16())
    found = occupancy_losses(output, target_of(labels), inputs_of())
    assert all(value.dtype == torch.float32 for value in found.values())


@pytest.mark.parametrize(
    ("classes", "text"),
    [((1.0,) * 11, "there must be 12 class weights, got 11"), ((-1.0,) + (1.0,) * 11, "finite")],
)
def test_bad_class_weights(classes, text):
    with pytest.raises(UsageError, match=text):
        LossWeights(classes=classes)


def target_of(labels, depth_m=None):
    labels = torch.tensor(labels).long()
    return OccTarget(labels, torch.ones_like(labels, dtype=torch.bool), depth_m)
