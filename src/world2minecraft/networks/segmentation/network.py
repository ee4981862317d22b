"""The segmentation network: an EfficientNet-Lite for colour, a stem for geometry, a light decoder.

The encoder is EfficientNet-Lite (Tan and Le, 2019, without squeeze-and-excitation and with ReLU6),
so that published weights can start it. Geometry has its own small stem and is added to the features
of colour at strides 4, 8 and 16 through convolutions that start at zero, so that a trained encoder
is not disturbed. Either of the two inputs may be all zero.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn
from torch.nn import functional

from world2minecraft.reconstruction.recognition.segmentation_channels import GEOMETRY_CHANNELS

CLASSES = 40
SLOPE = 0.1
# Of the seven groups of blocks of an EfficientNet.
KERNELS, STRIDES = (3, 3, 5, 3, 5, 5, 3), (1, 2, 2, 2, 1, 2, 1)
EXPANSIONS = (1, 6, 6, 6, 6, 6, 6)
LEVELS = ((0, 1), (2,), (3, 4), (5, 6))  # Groups that end at strides 4, 8, 16 and 32.
NORM_EPSILON = 1e-3  # Of the published weights.
MAX_DROPPED = 0.2  # How often training leaves out the last block.


@dataclass(frozen=True)
class SegmentationSize:
    """The numbers of channels and blocks of a segmentation network. The default is ``LITE2``.

    Attributes:
        stem: Channels of the first convolution of the encoder.
        widths: Channels of the seven groups of blocks of the encoder.
        repeats: Number of blocks in each group.
        geometry: Channels of the geometry features at strides 4, 8 and 16.
        decoder: Channels of the decoder.
    """

    stem: int = 32
    widths: tuple[int, ...] = (16, 24, 48, 88, 120, 208, 352)
    repeats: tuple[int, ...] = (1, 3, 3, 4, 4, 5, 1)
    geometry: tuple[int, int, int] = (32, 64, 96)
    decoder: int = 96

    @property
    def encoder(self) -> tuple[int, ...]:
        """Channels of the colour features at strides 4, 8, 16 and 32."""
        return tuple(self.widths[groups[-1]] for groups in LEVELS)


LITE2 = SegmentationSize()
LITE0 = SegmentationSize(widths=(16, 24, 40, 80, 112, 192, 320), repeats=(1, 2, 2, 3, 3, 4, 1))
TINY = SegmentationSize(8, (8, 8, 12, 16, 16, 24, 24), (1,) * 7, (8, 8, 8), 12)


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


class Padded(nn.Conv2d):
    """A convolution with the padding of TensorFlow where the sides of the input are even.

    With a stride of 2 the result has half the size, rounded up.
    """

    def __init__(self, given: int, taken: int, kernel: int, stride: int, groups: int = 1):
        half = kernel // 2
        super().__init__(
            given, taken, kernel, stride, half if stride == 1 else 0, groups=groups, bias=False
        )
        self.sides = (half - 1, half + 1) * 2 if stride == 2 else None

    def forward(self, input: Tensor) -> Tensor:
        """Apply the convolution to [B, C, H, W]."""
        if self.sides:
            input = functional.pad(input, self.sides)
        return super().forward(input)


def _norm(channels: int) -> nn.BatchNorm2d:
    return nn.BatchNorm2d(channels, eps=NORM_EPSILON)


class InvertedResidual(nn.Module):
    """A block of EfficientNet-Lite: expand, depthwise convolution, project."""

    def __init__(self, given: int, taken: int, kernel: int, stride: int, expansion: int):
        super().__init__()
        wide = given * expansion
        expand = [Pointwise(given, wide, bias=False), _norm(wide), nn.ReLU6(inplace=True)]
        self.body = nn.Sequential(
            *(expand if expansion > 1 else []),
            Padded(wide, wide, kernel, stride, groups=wide),
            _norm(wide),
            nn.ReLU6(inplace=True),
            Pointwise(wide, taken, bias=False),
            _norm(taken),
        )
        self.is_residual = stride == 1 and given == taken
        self.dropped = 0.0

    def forward(self, x: Tensor) -> Tensor:
        """Apply the block. Training leaves a residual block out at random, for each image."""
        added = self.body(x)
        if not self.is_residual:
            return added
        if self.training and self.dropped:
            kept = torch.rand(len(x), 1, 1, 1, device=x.device) >= self.dropped
            added = added * (kept / (1 - self.dropped)).to(added.dtype)
        return x + added


class ColourEncoder(nn.Module):
    """The EfficientNet-Lite without its head. Its levels end at strides 4, 8, 16 and 32."""

    def __init__(self, size: SegmentationSize):
        super().__init__()
        self.stem = nn.Sequential(
            Padded(3, size.stem, 3, 2), _norm(size.stem), nn.ReLU6(inplace=True)
        )
        given, done, total = size.stem, 0, sum(size.repeats)
        self.levels = nn.ModuleList()
        for groups in LEVELS:
            level = nn.Sequential()
            for group in groups:
                width, kernel, expansion = size.widths[group], KERNELS[group], EXPANSIONS[group]
                for number in range(size.repeats[group]):
                    stride = STRIDES[group] if number == 0 else 1
                    block = InvertedResidual(given, width, kernel, stride, expansion)
                    block.dropped = MAX_DROPPED * done / total  # Later blocks more often.
                    level.append(block)
                    given, done = width, done + 1
            self.levels.append(level)


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
        x = self.encoder.stem(colour)
        features = []
        for number, level in enumerate(self.encoder.levels):
            x = level(x)
            if number < len(added):
                x = x + added[number]
            features.append(x)
        return self.decoder(features)
