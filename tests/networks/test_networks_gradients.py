"""Layers that are trained another way than torch trains them say and learn the same."""

import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from torch import nn

from world2minecraft.networks.layers.normalization import (
    DilatedConv3d,
    GroupNorm,
    merge_phases,
    split_phases,
)

SIDES = st.tuples(*[st.integers(1, 7)] * 3)
STEPS = st.tuples(*[st.integers(1, 3)] * 3)


@settings(max_examples=40, deadline=None)
@given(SIDES, STEPS)
def test_merged_phases_are_the_grid(sides, steps):
    cells = torch.arange(2 * 3 * torch.tensor(sides).prod()).float().reshape(2, 3, *sides)
    apart = split_phases(cells, steps)
    assert torch.equal(merge_phases(apart, steps, sides), cells)
    x, y, z = (-(-side // step) for side, step in zip(sides, steps, strict=True))
    assert apart.shape == (2 * steps[0] * steps[1] * steps[2], 3, x, y, z)
    assert torch.equal(apart[0, :, 0, 0, 0], cells[0, :, 0, 0, 0])


def gradients(layer, given):
    given = given.clone().requires_grad_()
    found = layer(given)
    (found * torch.linspace(-1, 1, found.numel()).view_as(found)).sum().backward()
    return [found.detach(), given.grad, *(one.grad.clone() for one in layer.parameters())]


@settings(max_examples=20, deadline=None)
@given(SIDES, STEPS, st.sampled_from([(3, 3, 3), (3, 1, 1), (1, 1, 3)]), st.booleans())
def test_a_dilated_kernel_learns_what_torch_says(sides, steps, kernel, bias):
    torch.manual_seed(0)
    padding = tuple(step * (side // 2) for step, side in zip(steps, kernel, strict=True))
    plain = nn.Conv3d(2, 3, kernel, 1, padding, steps, bias=bias).double()
    ours = DilatedConv3d(2, 3, kernel, 1, padding, steps, bias=bias).double()
    ours.load_state_dict(plain.state_dict())
    cells = torch.randn(2, 2, *sides, dtype=torch.float64)
    for said, wanted in zip(gradients(ours, cells), gradients(plain, cells), strict=True):
        torch.testing.assert_close(said, wanted)
    assert torch.equal(ours.eval()(cells), plain(cells))


@pytest.mark.parametrize("last", [False, True])
@pytest.mark.parametrize("shape", [(2, 8, 5, 6), (2, 8, 4, 5, 3), (3, 8)])
def test_group_norm_in_bfloat16_learns_what_float32_says(shape, last):
    torch.manual_seed(0)
    ours, plain = GroupNorm(4, 8), nn.GroupNorm(4, 8)
    nn.init.normal_(ours.weight)
    nn.init.normal_(ours.bias)
    plain.load_state_dict(ours.state_dict())
    given = torch.randn(shape).bfloat16()
    if last and len(shape) > 2:
        kind = torch.channels_last if len(shape) == 4 else torch.channels_last_3d
        given = given.contiguous(memory_format=kind)
    said, wanted = gradients(ours, given), gradients(plain, given.float())
    assert said[0].dtype == said[1].dtype == torch.bfloat16
    for one, other in zip(said, wanted, strict=True):
        torch.testing.assert_close(one.float(), other, atol=0.05, rtol=0.02)


def test_group_norm_takes_values_with_gaps():
    given = torch.randn(2, 8, 6, 6).bfloat16()[:, :, 1:5, ::2]
    torch.testing.assert_close(GroupNorm(4, 8)(given), nn.GroupNorm(4, 8)(given))
