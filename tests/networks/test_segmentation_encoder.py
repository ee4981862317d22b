"""The encoder of the segmentation network: padding, dropped blocks, the start from a file."""

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.networks.segmentation.backbone import start_encoder
from world2minecraft.networks.segmentation.network import (
    LITE0,
    LITE2,
    TINY,
    InvertedResidual,
    Padded,
    SegmentationNet,
)
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    COLOUR_MEAN,
    COLOUR_SPREAD,
)


def slow_convolution(image, kernel, stride):
    """TensorFlow's padding ``SAME``: the total is halved, and the end gets what is odd."""
    side = kernel.shape[0]
    counts = [-(-n // stride) for n in image.shape]
    total = [
        max((count - 1) * stride + side - n, 0)
        for count, n in zip(counts, image.shape, strict=True)
    ]
    padded = np.pad(image, [(one // 2, one - one // 2) for one in total])
    result = np.zeros(counts)
    for i in range(counts[0]):
        for j in range(counts[1]):
            window = padded[i * stride : i * stride + side, j * stride : j * stride + side]
            result[i, j] = (window * kernel).sum()
    return result


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 9), st.integers(1, 9), st.sampled_from([3, 5]), st.sampled_from([1, 2]))
def test_even_sides_are_padded_as_by_tensorflow(high, wide, kernel, stride):
    layer = Padded(1, 1, kernel, stride).double()
    image = np.random.default_rng(high).random((2 * high, 2 * wide))
    found = layer(torch.from_numpy(image)[None, None])[0, 0].detach().numpy()
    wanted = slow_convolution(image, layer.weight[0, 0].detach().numpy(), stride)
    np.testing.assert_allclose(found, wanted, atol=1e-12)


@pytest.mark.parametrize("kernel", [3, 5])
@pytest.mark.parametrize("shape", [(7, 9), (8, 5), (1, 1)])
def test_half_of_odd_sides_is_rounded_up(kernel, shape):
    found = Padded(2, 3, kernel, 2)(torch.zeros(1, 2, *shape))
    assert found.shape[2:] == tuple((n + 1) // 2 for n in shape)


def test_left_out_blocks_keep_the_expectation():
    block = InvertedResidual(4, 4, 3, 1, 2)
    for module in block.body.modules():
        if isinstance(module, torch.nn.BatchNorm2d):
            module.momentum = 0  # Norms see the same batch, so all images get the same.
    torch.manual_seed(0)
    image = torch.randn(1, 4, 6, 6)
    images = image.expand(4000, -1, -1, -1)
    block.dropped = 0.0
    added = block(images)[0] - image[0]
    block.dropped = 0.3
    found = (block(images) - images).detach()
    is_out = (found == 0).all(dim=(1, 2, 3))
    assert float(is_out.float().mean()) == pytest.approx(0.3, abs=0.03)
    torch.testing.assert_close(found[~is_out][0], added / 0.7, rtol=1e-3, atol=1e-4)
    torch.testing.assert_close(found.mean(dim=0), added, rtol=0.1, atol=0.05)


def test_blocks_are_left_out_in_training_only():
    block = InvertedResidual(4, 4, 3, 1, 2).eval()
    image = torch.randn(8, 4, 6, 6)
    whole = block(image)
    block.dropped = 0.9
    assert torch.equal(block(image), whole)


def test_later_blocks_are_left_out_more_often():
    encoder = SegmentationNet(TINY).encoder
    dropped = [block.dropped for level in encoder.levels for block in level]
    assert dropped[0] == 0
    assert np.allclose(np.diff(dropped), 0.2 / len(dropped))


@pytest.mark.parametrize(("size", "blocks"), [(LITE0, 16), (LITE2, 21)])
def test_encoders_have_the_published_blocks(size, blocks):
    with torch.device("meta"):
        encoder = SegmentationNet(size).encoder
    assert sum(len(level) for level in encoder.levels) == blocks
    # A convolution and a norm of the stem and of each block: 6 arrays; expansion has 6 more.
    assert len(encoder.state_dict()) == 6 + 18 * blocks - 6


def published_state(seed=0):
    """A state as published: other names, the same order, and the layers of a head."""
    torch.manual_seed(seed)
    own = SegmentationNet(TINY).encoder.state_dict()
    state = {}
    for n, value in enumerate(own.values()):
        state[f"_blocks.{n}"] = torch.rand_like(value) + 0.1 if value.dim() else value
    for name in ("_conv_head.weight", "_bn1.weight", "_fc.weight", "_fc.bias"):
        state[name] = torch.zeros(3)
    return state


@pytest.fixture
def published(tmp_path):
    state = published_state()
    torch.save(state, tmp_path / "lite.pth")
    return state, tmp_path / "lite.pth"


def test_encoder_takes_the_published_weights(published):
    state, path = published
    network = SegmentationNet(TINY)
    decoder = {key: value.clone() for key, value in network.decoder.state_dict().items()}
    start_encoder(network, path)
    own = network.encoder.state_dict()
    for (name, found), wanted in zip(own.items(), state.values(), strict=False):
        if name not in ("stem.0.weight", "stem.1.running_mean"):
            assert torch.equal(found, wanted), name
    kept = network.decoder.state_dict()
    assert all(torch.equal(value, kept[key]) for key, value in decoder.items())


def test_first_layers_answer_as_published(published):
    state, path = published
    network = SegmentationNet(TINY).eval()
    start_encoder(network, path)
    values = list(state.values())
    reference = SegmentationNet(TINY).encoder.stem.eval()
    reference.load_state_dict(dict(zip(reference.state_dict(), values, strict=False)))
    colour = torch.randint(0, 256, (1, 3, 32, 40)).float()
    mean, spread = (torch.tensor(one).view(1, 3, 1, 1) for one in (COLOUR_MEAN, COLOUR_SPREAD))
    # Without the activation, which would hide differences. The border pads another colour.
    found = network.encoder.stem[:2]((colour - mean) / spread)
    wanted = reference[:2]((colour - 127) / 128)
    torch.testing.assert_close(found[:, :, :-1, :-1], wanted[:, :, :-1, :-1], rtol=0, atol=1e-3)
    assert wanted.std() > 1


def test_missing_backbone_says_what_to_take(tmp_path):
    with pytest.raises(InputError, match=r"does not exist.*efficientnet-lite0"):
        start_encoder(SegmentationNet(TINY), tmp_path / "lite.pth")


@pytest.mark.parametrize(
    "content", [torch.zeros(3), {"epoch": 3, "state_dict": {}}, {3: torch.zeros(2)}]
)
def test_other_torch_files_are_refused(tmp_path, content):
    torch.save(content, tmp_path / "lite.pth")
    with pytest.raises(DamagedFileError, match="no PyTorch file of weights"):
        start_encoder(SegmentationNet(TINY), tmp_path / "lite.pth")


def test_a_text_file_is_refused(tmp_path):
    (tmp_path / "lite.pth").write_text("hello\n")
    with pytest.raises(DamagedFileError, match="no PyTorch file of weights"):
        start_encoder(SegmentationNet(TINY), tmp_path / "lite.pth")


@pytest.mark.parametrize("change", ["shape", "less", "more"])
def test_weights_of_another_size_are_refused(tmp_path, change):
    state = published_state()
    name = list(state)[0 if change == "shape" else 3]
    if change == "shape":
        state[name] = torch.zeros(9, 3, 3, 3)
    elif change == "less":
        del state[name]
    else:
        state["_blocks.999"] = torch.zeros(2)
    torch.save(state, tmp_path / "lite.pth")
    network = SegmentationNet(TINY)
    before = {key: value.clone() for key, value in network.state_dict().items()}
    with pytest.raises(DamagedFileError, match="of the size of the network"):
        start_encoder(network, tmp_path / "lite.pth")
    assert all(torch.equal(value, before[key]) for key, value in network.state_dict().items())
