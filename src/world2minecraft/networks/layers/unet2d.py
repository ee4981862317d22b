"""Our own 2D backbone: a residual encoder down to 1/32, and MonoScene's decoder.

The papers use EfficientNet-B7 trained on ImageNet, whose feature maps have 32, 48, 80, 224 and 2560
channels. The size ``full`` has the same numbers of channels and therefore the same decoder; its
encoder stages consist of ordinary pairs of 3x3 convolutions and are not pretrained.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from world2minecraft.networks.layers.normalization import Norm, conv2d

STRIDES = (2, 4, 8, 16, 32)
# Red, green and blue of ImageNet, as pretrained backbones expect.
MEAN, STD = (0.485, 0.456, 0.406), (0.229, 0.224, 0.225)


@dataclass(frozen=True)
class BackboneWidths:
    """The width and depth of a backbone.

    Attributes:
        taps: Number of channels at 1/2, 1/4, 1/8, 1/16 and 1/32.
        blocks: Number of residual blocks before each of them.
        inner: Number of channels of the last stage before it is expanded.
        decoder: Number of decoder channels at 1/32, which is halved at each following step.
    """

    taps: tuple[int, int, int, int, int]
    blocks: tuple[int, int, int, int, int]
    inner: int
    decoder: int


class Encoder(nn.Module):
    """An encoder that maps images to features at 1/2, 1/4, 1/8, 1/16 and 1/32."""

    def __init__(self, widths: BackboneWidths, norm: Norm):
        super().__init__()
        self.taps = widths.taps
        out_channels = (*widths.taps[:4], widths.inner)
        in_channels = (3, *out_channels[:4])
        self.stages = nn.ModuleList(
            _make_stage(before, after, count, norm)
            for before, after, count in zip(in_channels, out_channels, widths.blocks, strict=True)
        )
        wider = widths.inner != widths.taps[4]
        self.widen = conv2d(widths.inner, widths.taps[4], norm, kernel=1) if wider else None

    def forward(self, picture: Tensor) -> list[Tensor]:
        """Return five feature maps for normalized images [B, 3, H, W]."""
        found = []
        for stage in self.stages:
            picture = stage(picture)
            found.append(picture)
        if self.widen is not None:
            found[-1] = torch.relu(self.widen(found[-1]))
        return found


class Decoder(nn.Module):
    """A decoder that maps encoder features to feature maps at the requested scales."""

    def __init__(
        self,
        taps: Sequence[int],
        channels: int,
        out_channels: int,
        norm: Norm,
        scales: Sequence[int],
    ):
        super().__init__()
        self.enter = nn.Conv2d(taps[4], channels, 1)
        skip_channels = (taps[3], taps[2], taps[1], taps[0], 3)
        finest = min(scales)
        self.steps, self.give = nn.ModuleDict(), nn.ModuleDict()
        for step, tap in enumerate(skip_channels):
            scale = 16 >> step
            if scale < finest:
                break
            wide, narrow = max(channels >> step, 4), max(channels >> (step + 1), 4)
            self.steps[str(scale)] = _UpBlock(wide + tap, narrow, norm)
            if scale in scales:
                self.give[str(scale)] = nn.Conv2d(narrow, out_channels, 1)

    def forward(self, picture: Tensor, taps: Sequence[Tensor]) -> dict[int, Tensor]:
        """Return a map [B, C, ceil(H / s), ceil(W / s)] for each scale s."""
        values, found = self.enter(taps[4]), {}
        skips = {"16": taps[3], "8": taps[2], "4": taps[1], "2": taps[0], "1": picture}
        for name, step in self.steps.items():
            values = step(values, skips[name])
            if name in self.give:
                found[int(name)] = self.give[name](values)
        return dict(sorted(found.items()))


class UNet2D(nn.Module):
    """A network that maps images with values from 0 to 1 to feature maps at several scales."""

    def __init__(self, encoder: nn.Module, decoder: Decoder):
        super().__init__()
        self.encoder, self.decoder = encoder, decoder

    def forward(self, picture: Tensor) -> dict[int, Tensor]:
        """Return a map [B, C, ceil(H / s), ceil(W / s)] for each scale s of images [B, 3, H, W]."""
        picture = normalize_image(picture)
        return self.decoder(picture, self.encoder(picture))


def normalize_image(picture: Tensor) -> Tensor:
    """Normalize images with values from 0 to 1 with the mean and standard deviation of ImageNet."""
    mean, spread = (torch.tensor(v, device=picture.device)[:, None, None] for v in (MEAN, STD))
    return ((picture - mean) / spread).to(picture.dtype)


class ResidualBlock(nn.Module):
    """Two 3x3 convolutions with a residual connection."""

    def __init__(self, channels: int, norm: Norm):
        super().__init__()
        self.path = nn.Sequential(
            conv2d(channels, channels, norm), nn.ReLU(), conv2d(channels, channels, norm)
        )

    def forward(self, values: Tensor) -> Tensor:
        """Apply the block. The result has the shape of the input."""
        return torch.relu(values + self.path(values))


class _UpBlock(nn.Module):
    def __init__(self, in_channels: int, out_channels: int, norm: Norm):
        super().__init__()
        self.path = nn.Sequential(
            conv2d(in_channels, out_channels, norm),
            nn.LeakyReLU(),
            conv2d(out_channels, out_channels, norm),
            nn.LeakyReLU(),
        )

    def forward(self, values: Tensor, skips: Tensor) -> Tensor:
        sides = [int(side) for side in skips.shape[2:]]
        values = nn.functional.interpolate(values, sides, mode="bilinear", align_corners=False)
        return self.path(torch.cat([values, skips], dim=1))


def _make_stage(in_channels: int, out_channels: int, count: int, norm: Norm) -> nn.Sequential:
    blocks = (ResidualBlock(out_channels, norm) for _ in range(count))
    return nn.Sequential(conv2d(in_channels, out_channels, norm, stride=2), nn.ReLU(), *blocks)
