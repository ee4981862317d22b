"""Parts of the networks against slow references and laws."""

from itertools import pairwise, product

import numpy as np
import pytest
import torch

from world2minecraft.core.errors import InputError, MissingExtraError
from world2minecraft.networks.batch import OccInput
from world2minecraft.networks.layers import backbones as hf_backbone
from world2minecraft.networks.layers.attention import DeformableAttention
from world2minecraft.networks.layers.backbones import WIDTHS, make_backbone
from world2minecraft.networks.layers.depth_bins import (
    DepthBranch,
    bin_coordinate,
    bin_edges_m,
    bin_of,
    known_depth,
    min_pool_depth,
    weight_by_depth,
)
from world2minecraft.networks.layers.projection import CellProjection, sample_corners, sample_grid
from world2minecraft.networks.layers.residual_3d import DDRBlock, Upsample3d


def mixed(values, place):
    """What lies at a place of [C, ...], from the cells around it; 0 beyond."""
    found = np.zeros(len(values))
    low = np.floor(place - 0.5).astype(int)
    for corner in product((0, 1), repeat=len(place)):
        cell = low + corner
        if any(not 0 <= c < s for c, s in zip(cell, values.shape[1:], strict=True)):
            continue
        found += values[(slice(None), *cell)] * np.prod(1 - np.abs(place - (cell + 0.5)))
    return found


@pytest.mark.parametrize("shape", [(5, 7), (4, 5, 6)])
def test_sampling_is_that_of_a_loop(shape):
    rng = np.random.default_rng(1)
    values = rng.normal(size=(2, 3, *shape))
    places = rng.uniform(-1, np.array(shape) + 1, (2, 40, len(shape)))
    found = sample_grid(torch.tensor(values), torch.tensor(places)).numpy()
    for b, n in product(range(2), range(40)):
        np.testing.assert_allclose(found[b, :, n], mixed(values[b], places[b, n]), atol=1e-9)
    if len(shape) == 3:
        by_corners = sample_corners(torch.tensor(values), torch.tensor(places)).numpy()
        np.testing.assert_allclose(by_corners, found, atol=1e-9)


@pytest.mark.parametrize("shape", [(5, 7), (4, 5, 6)])
def test_deformable_attention_is_that_of_a_loop(shape):
    torch.manual_seed(2)
    layer = DeformableAttention(8, 2, 1, 3, len(shape)).double()
    torch.nn.init.normal_(layer.shift.weight, std=0.3)
    queries = torch.randn(1, 4, 8).double()
    places = torch.rand(1, 4, len(shape)).double()
    value = torch.randn(1, 8, *shape).double()
    found = layer(queries, places, [value])[0].detach().numpy()
    with torch.no_grad():
        shifts = layer.shift(queries).view(4, 2, 3, len(shape)).numpy()
        weights = layer.weigh(queries).view(4, 2, 3).softmax(-1).numpy()
        carried = layer.value(value[0].movedim(0, -1)).movedim(-1, 0).numpy()
    for q in range(4):
        heads = []
        for head in range(2):
            part = carried[head * 4 : head * 4 + 4]
            at = places[0, q].numpy() * np.array(shape)
            here = [mixed(part, at + shifts[q, head, p]) for p in range(3)]
            heads.append(sum(w * one for w, one in zip(weights[q, head], here, strict=True)))
        said = layer.out(torch.tensor(np.concatenate(heads))).detach().numpy()
        np.testing.assert_allclose(found[q], said, atol=1e-9)


@pytest.mark.parametrize("shape", [(8, 8, 8), (9, 7, 5), (15, 15, 9), (2, 3, 1)])
def test_half_and_double_give_back_the_sides(shape):
    cells = torch.randn(1, 8, *shape)
    half = DDRBlock(8, "group", halve=True)(cells)
    assert half.shape == (1, 16, *(-(-side // 2) for side in shape))
    assert Upsample3d(16, 8, "group")(half, shape).shape == cells.shape


def test_depths_lie_in_their_bins():
    edges = bin_edges_m(64)
    widths = np.diff(edges)
    assert edges[0] == 0 and edges[-1] == pytest.approx(10)
    np.testing.assert_allclose(np.diff(widths), np.diff(widths)[0])
    depth_m = torch.linspace(0.001, 9.999, 500, dtype=torch.float64)
    found, known = bin_of(depth_m, 64)
    assert known.all()
    assert np.array_equal(found, np.searchsorted(edges, depth_m.numpy(), side="right") - 1)
    np.testing.assert_allclose(bin_coordinate(torch.tensor(edges), 64), np.arange(65), atol=1e-9)
    assert not bin_of(torch.tensor([0.0, 10.0, -1.0]), 64)[1].any()


def test_a_cell_reads_its_own_depth():
    """One pixel whose surface is surely in one bin: cells there get 1, others less or nothing."""
    shares = torch.zeros(1, 1, 16, 3, 4)
    shares[0, 0, 5] = 1
    edges = bin_edges_m(16)
    middles = torch.tensor([[(a + b) / 2 for a, b in pairwise(edges)]])
    pixels = torch.tensor([[[2.0 * 4, 1.5 * 4]]]).expand(1, 16, 2)
    sight = CellProjection(pixels, middles, torch.ones(1, 16, dtype=torch.bool), (12, 16))
    found = weight_by_depth(shares, sight, 4)[0, 0]
    assert found[5] > 0.9
    assert (found[[0, 1, 2, 3, 7, 8, 9, 10]] == 0).all()


def test_given_depth_comes_before_expected_depth():
    depth_m = torch.zeros(1, 8, 8)
    depth_m[0, 1, 2], depth_m[0, 3, 3] = 2.0, 1.5
    assert min_pool_depth(depth_m, 4)[0].tolist() == [[1.5, 0.0], [0.0, 0.0]]
    lens = torch.tensor([[[6.0, 0, 4], [0, 6, 4], [0, 0, 1]]])
    inputs = OccInput(torch.zeros(1, 3, 8, 8), lens, torch.eye(4)[None], (8, 8, 8), 0.1, depth_m)
    logits = torch.zeros(1, 16, 2, 2)
    logits[:, 7] = 50.0
    edges = bin_edges_m(16)
    found = known_depth(logits, inputs, 4)[0]
    assert float(found[0, 0]) == 1.5
    assert float(found[1, 1]) == pytest.approx((edges[7] + edges[8]) / 2, abs=1e-3)
    branch = DepthBranch(3, 4, 16, 4, "group")
    assert branch.given(torch.zeros(1, 3, 2, 2), inputs)[0, 0, 0, 0] == pytest.approx(0.15)


@pytest.fixture(scope="module")
def backbones(tmp_path_factory):
    """A convolutional one, and a vision transformer whose maps are all of one stride."""
    import transformers

    folder = tmp_path_factory.mktemp("backbones")
    torch.manual_seed(0)
    net = transformers.ConvNextConfig(
        hidden_sizes=[8, 12, 16, 20], depths=[1, 1, 1, 1], num_channels=3
    )
    transformers.ConvNextBackbone(net).save_pretrained(folder / "convnext")
    vit = transformers.Dinov2Config(
        hidden_size=16, num_hidden_layers=4, num_attention_heads=2, image_size=28, patch_size=14
    )
    transformers.Dinov2Backbone(vit).save_pretrained(folder / "dinov2")
    return folder


@pytest.mark.parametrize("name", ["convnext", "dinov2"])
def test_any_backbone_of_transformers(backbones, name):
    scales = (1, 2, 4, 8)
    network = make_backbone(f"hf:{backbones / name}", "tiny", 6, scales)
    picture = torch.rand(2, 3, 45, 62)
    found = network(picture)
    assert {s: tuple(one.shape) for s, one in found.items()} == {
        s: (2, 6, -(-45 // s), -(-62 // s)) for s in scales
    }
    sum(one.square().mean() for one in found.values()).backward()
    held = [weights for _, weights in network.encoder.network.named_parameters()]
    assert sum(weights.grad is not None for weights in held) > 0.8 * len(held)
    again = make_backbone(f"hf:{backbones / name}", "tiny", 6, scales)
    mine, other = (next(one.encoder.network.parameters()) for one in (network, again))
    assert torch.equal(mine, other)  # They are loaded, not drawn.


def test_what_is_no_backbone_says_so(tmp_path):
    with pytest.raises(InputError, match="not a valid model name; expected ORG/NAME"):
        make_backbone("hf:/no/such/folder!", "tiny", 6, (1,))
    (tmp_path / "config.json").write_text("{}")
    with pytest.raises(InputError, match="cannot be loaded as a transformers backbone"):
        make_backbone(f"hf:{tmp_path}", "tiny", 6, (1,))


def test_without_transformers_the_extra_is_named(monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "transformers", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'world2minecraft\[hf\]'"):
        hf_backbone.HuggingFaceEncoder("org/name", WIDTHS["tiny"])
