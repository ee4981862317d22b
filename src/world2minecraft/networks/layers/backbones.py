"""Image backbones: our own small network, or a model from transformers.

The feature maps of a transformers backbone are resized to the strides that the decoder expects,
from 1/4 for the first to 1/32 for the last, whatever their own strides are (a vision transformer
has about 1/14 for all). An additional convolution provides features at 1/2. The image processors of
the library are not used, because they require torchvision.
"""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from world2minecraft.core.errors import InputError, MissingExtraError, UsageError
from world2minecraft.networks.layers.normalization import Norm
from world2minecraft.networks.layers.unet2d import STRIDES, BackboneWidths, Decoder, Encoder, UNet2D

MODEL_NAME = re.compile(r"[A-Za-z0-9][\w.-]*(/[A-Za-z0-9][\w.-]*)?", re.ASCII)
LEVELS = 4  # At 1/4, 1/8, 1/16 and 1/32.
WIDTHS = {
    "tiny": BackboneWidths((8, 12, 16, 24, 32), (0, 0, 0, 0, 1), 32, 48),
    "small": BackboneWidths((16, 24, 48, 96, 128), (1, 1, 2, 2, 2), 128, 256),
    "full": BackboneWidths((32, 48, 80, 224, 2560), (1, 2, 4, 8, 4), 640, 2560),
    # As full, without the wide last stage of EfficientNet-B7, for networks published without it.
    "lean": BackboneWidths((32, 48, 80, 224, 640), (1, 2, 4, 8, 4), 640, 1024),
}
NORMS: dict[str, Norm] = {"tiny": "group", "small": "group", "full": "batch", "lean": "batch"}
PREFIX = "hf:"


class HuggingFaceEncoder(nn.Module):
    """A backbone from transformers, loaded from the Hugging Face hub or from a folder.

    Raises:
        MissingExtraError: If transformers is not installed.
        InputError: If the backbone cannot be loaded.
    """

    def __init__(self, model: str, widths: BackboneWidths):
        super().__init__()
        self.network = _load_model(model)
        self.multiple = _size_multiple(self.network.config)
        given = list(self.network.channels)
        self.levels = [min(level, len(given) - 1) for level in range(LEVELS)]
        self.fine = nn.Sequential(nn.Conv2d(3, widths.taps[0], 3, 2, 1), nn.ReLU())
        self.carry = nn.ModuleList(
            nn.Conv2d(given[level], made, 1)
            for level, made in zip(self.levels, widths.taps[1:], strict=True)
        )

    def forward(self, picture: Tensor) -> list[Tensor]:
        """Return five feature maps at 1/2 to 1/32 for normalized images [B, 3, H, W]."""
        sides = [[-(-int(side) // stride) for side in picture.shape[2:]] for stride in STRIDES]
        wanted = [max(round(int(s) / self.multiple), 1) * self.multiple for s in picture.shape[2:]]
        maps = self.network(pixel_values=_resize(picture, wanted)).feature_maps
        coarse = [
            _resize(carry(maps[level]), side)
            for carry, level, side in zip(self.carry, self.levels, sides[1:], strict=True)
        ]
        return [self.fine(picture), *coarse]


def _resize(values: Tensor, sides: list[int]) -> Tensor:
    if list(values.shape[2:]) == sides:
        return values
    return nn.functional.interpolate(values, sides, mode="bilinear", align_corners=False)


def _load_model(model: str) -> Any:
    try:
        import transformers  # noqa: PLC0415  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise MissingExtraError("a backbone from transformers", "hf") from None
    if not Path(model).is_dir() and not MODEL_NAME.fullmatch(model):
        raise InputError(model, "not a folder and not a valid model name; expected ORG/NAME")
    transformers.utils.logging.disable_progress_bar()
    try:
        config = transformers.AutoConfig.from_pretrained(model)
        config.out_indices = _feature_channels(config)
        # AutoBackbone.from_pretrained rejects folders; the class that it selects accepts them.
        with torch.device("meta"):
            kind = type(transformers.AutoBackbone.from_config(config))
        return kind.from_pretrained(model, config=config, dtype=torch.float32, use_safetensors=True)
    except (OSError, ValueError, KeyError) as error:
        reason = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
        raise InputError(model, f"cannot be loaded as a transformers backbone: {reason}") from None


def _feature_channels(config: Any) -> list[int]:
    """Return the indices of four stages of a backbone, including the last one."""
    names = list(getattr(config, "stage_names", None) or [])
    count = len(names) - 1 if names else int(getattr(config, "num_hidden_layers", LEVELS))
    if count <= LEVELS:
        return list(range(1, count + 1))
    return [round((level + 1) * count / LEVELS) for level in range(LEVELS)]


def _size_multiple(config: Any) -> int:
    """Return the number of which the sides of an image must be multiples."""
    patch = getattr(config, "patch_size", None)
    patch = patch[0] if isinstance(patch, (list, tuple)) else patch
    return int(patch) if isinstance(patch, int) and patch > 4 else STRIDES[-1]


def make_backbone(name: str | None, size: str, channels: int, scales: Sequence[int]) -> UNet2D:
    """Create a network that maps images to feature maps with the same number of channels.

    Args:
        name: None for our own backbone, or ``hf:ID_OR_FOLDER``.
        size: Size in ``WIDTHS``, which defines our own backbone and the decoder.
        channels: Number of channels of each feature map.
        scales: Scales of the feature maps to return, from 1, 2, 4, 8 and 16.

    Raises:
        UsageError: If the name is not valid.
        MissingExtraError: If transformers is required but not installed.
        InputError: If the backbone cannot be loaded.
    """
    widths, norm = WIDTHS[size], NORMS[size]
    encoder = make_encoder(name, widths, norm)
    return UNet2D(encoder, Decoder(widths.taps, widths.decoder, channels, norm, scales))


def make_encoder(name: str | None, widths: BackboneWidths, norm: Norm) -> nn.Module:
    """Create a network that maps normalized images to feature maps at 1/2 to 1/32.

    Raises the same exceptions as ``make_backbone``.
    """
    if name is None:
        return Encoder(widths, norm)
    if not name.startswith(PREFIX):
        raise UsageError(f"backbone must be {PREFIX}ORG/NAME or {PREFIX}FOLDER, got {name!r}")

    return HuggingFaceEncoder(name.removeprefix(PREFIX), widths)
