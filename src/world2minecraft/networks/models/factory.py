"""Creation of networks by name and size, with initial weights."""

import torch
from torch import nn

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.registry import Registry

SIZES = ("tiny", "small", "full")
MIN_SIDE = 8  # Cells; the coarsest level has a quarter of them, and mega-voxels have two.

NETWORKS = Registry(
    "network",
    {
        "monoscene": "world2minecraft.networks.models.monoscene:MonoScene",
        "ndc_scene": "world2minecraft.networks.models.ndc_scene:NdcScene",
        "iso": "world2minecraft.networks.models.iso:Iso",
        "symphonies": "world2minecraft.networks.models.symphonies:Symphonies",
        "embodied": "world2minecraft.networks.models.embodied:Embodied",
    },
)


def make_network(
    name: str,
    size: str = "small",
    *,
    grid_shape: tuple[int, int, int],
    voxel_m: float,
    backbone: str | None = None,
    seed: int = 0,
) -> nn.Module:
    """Create a network that maps ``OccInput`` to ``OccOutput``, with initial weights.

    Args:
        name: Name of a network in ``NETWORKS``.
        size: ``tiny`` (for tests), ``small`` (for two CPU cores and cells of 0.16 m) or ``full``
            (the published width).
        grid_shape: Shape of the grids in cells [X, Y, Z].
        voxel_m: Cell size in metres.
        backbone: None for our own backbone, or ``hf:ID_OR_FOLDER`` for one from transformers.
        seed: Random seed for weights that are not pretrained.

    Raises:
        UnknownNameError: If there is no such network or size.
        UsageError: If the grid is too small, or if the backbone name is not valid.
        MissingExtraError: If the backbone requires transformers, which is not installed.
        InputError: If the backbone cannot be loaded.

    Example:
        >>> net = make_network("monoscene", "tiny", grid_shape=(30, 30, 18), voxel_m=0.16)
        >>> sum(weights.numel() for weights in net.parameters()) < 1_000_000
        True
    """
    if size not in SIZES:
        raise UnknownNameError("network size", size, SIZES)
    if len(grid_shape) != 3 or min(grid_shape) < MIN_SIDE:
        raise UsageError(
            f"grid_shape must be three sides of at least {MIN_SIDE} cells, got {grid_shape}"
        )
    if not voxel_m > 0:
        raise UsageError(f"voxel_m must be above 0, got {voxel_m}")
    kind = NETWORKS.load(name)
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        return _use_channels_last(kind(size, tuple(grid_shape), voxel_m, backbone))


def _use_channels_last(network: nn.Module) -> nn.Module:
    """Store 3D kernels in channels-last format, which is a quarter faster."""
    for part in network.modules():
        if isinstance(part, (nn.Conv3d, nn.ConvTranspose3d)):
            part.to(memory_format=torch.channels_last_3d)  # type: ignore[call-overload]
    return network
