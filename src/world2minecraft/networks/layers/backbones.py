"""What turns a picture into features: our own small network, or one of transformers."""

from collections.abc import Sequence

from torch import nn

from world2minecraft.core.errors import UsageError
from world2minecraft.networks.layers.norms import Norm
from world2minecraft.networks.layers.unet2d import Decoder, Encoder, PictureWidths, UNet2D

WIDTHS = {
    "tiny": PictureWidths((8, 12, 16, 24, 32), (0, 0, 0, 0, 1), 32, 48),
    "small": PictureWidths((16, 24, 48, 96, 128), (1, 1, 2, 2, 2), 128, 256),
    "full": PictureWidths((32, 48, 80, 224, 2560), (1, 2, 4, 8, 4), 640, 2560),
    # As full, without the wide top that EfficientNet-B7 has: for networks that never had it.
    "lean": PictureWidths((32, 48, 80, 224, 640), (1, 2, 4, 8, 4), 640, 1024),
}
NORMS: dict[str, Norm] = {"tiny": "group", "small": "group", "full": "batch", "lean": "batch"}
PREFIX = "hf:"


def make_backbone(name: str | None, size: str, channels: int, scales: Sequence[int]) -> UNet2D:
    """Return a network from pictures to maps of one width.

    Args:
        name: None for our own, or ``hf:ID_OR_FOLDER``.
        size: one of ``WIDTHS``: how wide our own is, and the decoder of either.
        channels: of each map.
        scales: which maps are wanted, of 1, 2, 4, 8 and 16.

    Raises:
        UsageError: the name is neither. MissingExtraError, InputError: of transformers.
    """
    widths, norm = WIDTHS[size], NORMS[size]
    encoder = make_encoder(name, widths, norm)
    return UNet2D(encoder, Decoder(widths.taps, widths.decoder, channels, norm, scales))


def make_encoder(name: str | None, widths: PictureWidths, norm: Norm) -> nn.Module:
    """Return a network from normalised pictures to maps at 1/2 to 1/32; see ``make_backbone``."""
    if name is None:
        return Encoder(widths, norm)
    if not name.startswith(PREFIX):
        raise UsageError(f"a backbone is {PREFIX}ORG/NAME or {PREFIX}FOLDER, not {name!r}")
    from world2minecraft.networks.layers.hf_backbone import (  # noqa: PLC0415
        HuggingFaceEncoder,
    )

    return HuggingFaceEncoder(name.removeprefix(PREFIX), widths)
