"""The segmentation network: a ShuffleNetV2 for colour, a stem for geometry and a light decoder.

The encoder is ShuffleNetV2 1.0x (Ma et al., 2018) with LeakyReLU and with norms folded into the
convolutions, as in the backbone that may start it. Geometry has its own small stem and is added to
the features of colour at strides 4, 8 and 16 through convolutions that start at zero, so that a
trained encoder is not disturbed. Either of the two inputs may be all zero.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional

from world2minecraft.reconstruction.recognition.segmentation_channels import GEOMETRY_CHANNELS

CLASSES = 40
SLOPE = 0.1
OUTPUT_STRIDE = 4


@dataclass(frozen=True)
class SegmentationSize:
    """The numbers of channels of a segmentation network.

    Attributes:
        encoder: Channels of the colour features at strides 4, 8, 16 and 32.
        blocks: Number of units of stride 1 in each of the last three stages of the encoder.
        geometry: Channels of the geometry features at strides 4, 8 and 16.
        decoder: Channels of the decoder.
    """

    encoder: tuple[int, int, int, int] = (24, 116, 232, 464)
    blocks: tuple[int, int, int] = (3, 7, 3)
    geometry: tuple[int, int, int] = (32, 64, 96)
    decoder: int = 80


TINY = SegmentationSize((8, 12, 16, 24), (1, 1, 1), (8, 8, 8), 12)


def _activation() -> nn.Module:
    return nn.LeakyReLU(SLOPE, inplace=True)


def _depthwise(channels: int, kernel: int, stride: int, *, bias: bool) -> nn.Conv2d:
    return nn.Conv2d(channels, channels, kernel, stride, kernel // 2, groups=channels, bias=bias)


class Pointwise(nn.Conv2d):
    """A 1x1 convolution, which is trained as a matrix product: on CPUs this is faster."""

    def __init__(self, channels_in: int, channels_out: int, *, bias: bool = True):
        super().__init__(channels_in, channels_out, 1, bias=bias)

    def forward(self, input: Tensor) -> Tensor:
        """Apply the convolution to [B, C, H, W]."""
        if not self.training or input.device.type != "cpu":
            return super().forward(input)
        rows = input.permute(0, 2, 3, 1)
        return functional.linear(rows, self.weight[:, :, 0, 0], self.bias).permute(0, 3, 1, 2)


class ShuffleUnit(nn.Module):
    """A unit of ShuffleNetV2. With a stride of 2 it has two branches, else half is passed on."""

    def __init__(self, channels_in: int, channels_out: int, stride: int):
        super().__init__()
        half = channels_out // 2
        self.stride = stride
        self.shortcut = nn.Sequential()
        if stride == 2:
            self.shortcut = nn.Sequential(
                _depthwise(channels_in, 3, 2, bias=True),
                Pointwise(channels_in, half),
                _activation(),
            )
        self.body = nn.Sequential(
            Pointwise(channels_in if stride == 2 else half, half),
            _activation(),
            _depthwise(half, 3, stride, bias=True),
            Pointwise(half, half),
            _activation(),
        )

    def forward(self, x: Tensor) -> Tensor:
        """Apply the unit and interleave the channels of its two halves."""
        if self.stride == 2:
            first, second = self.shortcut(x), self.body(x)
        else:
            first, second = x.chunk(2, dim=1)
            second = self.body(second)
        if not self.training:
            return torch.stack([first, second], dim=2).flatten(1, 2)
        rows = [half.permute(0, 2, 3, 1) for half in (first, second)]  # Channels stay last.
        return torch.stack(rows, dim=4).flatten(3, 4).permute(0, 3, 1, 2)


class ColourEncoder(nn.Module):
    """ShuffleNetV2 without its classifier. ``stem`` has stride 4, ``stages`` 8, 16 and 32."""

    def __init__(self, size: SegmentationSize):
        super().__init__()
        widths = size.encoder
        self.stem = nn.Sequential(
            nn.Conv2d(3, widths[0], 3, 2, 1), _activation(), nn.MaxPool2d(3, 2, 1)
        )
        self.stages = nn.ModuleList(
            nn.Sequential(
                ShuffleUnit(before, after, 2), *(ShuffleUnit(after, after, 1) for _ in range(count))
            )
            for before, after, count in zip(widths, widths[1:], size.blocks, strict=False)
        )


class SeparableBlock(nn.Module):
    """A depthwise 5x5 and a 1x1 convolution with norms and a residual connection."""

    def __init__(self, channels: int):
        super().__init__()
        self.body = nn.Sequential(
            _depthwise(channels, 5, 1, bias=False),
            nn.BatchNorm2d(channels),
            Pointwise(channels, channels, bias=False),
            nn.BatchNorm2d(channels),
        )

    def forward(self, x: Tensor) -> Tensor:
        """Apply the block. The result has the shape of the input."""
        return functional.leaky_relu(x + self.body(x), SLOPE)


class GeometryStem(nn.Module):
    """Features of the geometry channels, which have half the resolution, at strides 4, 8, 16."""

    def __init__(self, size: SegmentationSize):
        super().__init__()
        first, second, third = size.geometry
        self.levels = nn.ModuleList(
            [
                _lowered(GEOMETRY_CHANNELS, first, nn.Conv2d(GEOMETRY_CHANNELS, first, 3, 2, 1)),
                _lowered(first, second, None),
                _lowered(second, third, None),
            ]
        )
        self.joins = nn.ModuleList(
            Pointwise(given, taken)
            for given, taken in zip(size.geometry, size.encoder, strict=False)
        )
        for join in self.joins:
            for parameter in join.parameters():
                nn.init.zeros_(parameter)

    def forward(self, geometry: Tensor) -> list[Tensor]:
        """Return what is added to the colour features at strides 4, 8 and 16."""
        result = []
        for level, join in zip(self.levels, self.joins, strict=True):
            geometry = level(geometry)
            result.append(join(geometry))
        return result


def _lowered(channels_in: int, channels_out: int, first: nn.Conv2d | None) -> nn.Sequential:
    """Return layers that halve the resolution, with a block after them."""
    lower = (
        [first]
        if first
        else [_depthwise(channels_in, 3, 2, bias=True), Pointwise(channels_in, channels_out)]
    )
    return nn.Sequential(
        *lower, nn.BatchNorm2d(channels_out), _activation(), SeparableBlock(channels_out)
    )


class Decoder(nn.Module):
    """A decoder from the features at four strides to logits at stride 4."""

    def __init__(self, size: SegmentationSize):
        super().__init__()
        width = size.decoder
        self.context = nn.Sequential(
            Pointwise(size.encoder[-1], width), _activation(), Pointwise(width, width)
        )
        self.laterals = nn.ModuleList(
            nn.Sequential(Pointwise(given, width, bias=False), nn.BatchNorm2d(width))
            for given in size.encoder
        )
        counts = (1, 2, 2, 2)
        self.blocks = nn.ModuleList(
            nn.Sequential(*(SeparableBlock(width) for _ in range(count))) for count in counts
        )
        self.classify = nn.Sequential(nn.Dropout2d(0.1), Pointwise(width, CLASSES))

    def forward(self, features: list[Tensor]) -> Tensor:
        """Return logits at stride 4 for features at strides 4, 8, 16 and 32."""
        top = features[-1]
        x = self.laterals[-1](top) + self.context(top.mean(dim=(2, 3), keepdim=True))
        x = self.blocks[-1](functional.leaky_relu(x, SLOPE))
        for level in (2, 1, 0):
            lateral = self.laterals[level](features[level])
            x = functional.interpolate(
                x, size=lateral.shape[2:], mode="bilinear", align_corners=False
            )
            x = self.blocks[level](functional.leaky_relu(x + lateral, SLOPE))
        return self.classify(x)


class SegmentationNet(nn.Module):
    """The segmentation network."""

    def __init__(self, size: SegmentationSize | None = None):
        super().__init__()
        self.size = size or SegmentationSize()
        self.encoder = ColourEncoder(self.size)
        self.geometry = GeometryStem(self.size)
        self.decoder = Decoder(self.size)

    def forward(self, colour: Tensor, geometry: Tensor) -> Tensor:
        """Return logits.

        Args:
            colour: Normalised colours [B, 3, H, W], all 0 where there are none.
            geometry: Geometry channels [B, 7, ceil(H / 2), ceil(W / 2)], all 0 where unknown.

        Returns:
            Logits of the 40 classes [B, 40, ceil(H / 4), ceil(W / 4)].
        """
        added = self.geometry(geometry)
        x = self.encoder.stem(colour) + added[0]
        features = [x]
        for level, stage in enumerate(self.encoder.stages):
            x = stage(x)
            if level + 1 < len(added):
                x = x + added[level + 1]
            features.append(x)
        return self.decoder(features)
