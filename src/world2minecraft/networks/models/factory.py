"""Make a network by its name and size, with its initial weights."""

import torch
from torch import nn

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.registry import Registry

SIZES = ("tiny", "small", "full")
MIN_SIDE = 8  # Cells; the coarsest level has a quarter of them, in mega-voxels of two.

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
    """Return a network that maps ``OccInput`` to ``OccOutput``, with weights of a seed.

    Args:
        name: one of ``NETWORKS``.
        size: tiny (tests), small (two CPU cores, cells of 0.16 m) or full (the published widths).
        grid_shape: X, Y, Z of the grids that it will see.
        voxel_m: their cells, metres.
        backbone: None for our own, or ``hf:ID_OR_FOLDER`` for a backbone of transformers.
        seed: of the weights that are not loaded.

    Raises:
        UnknownNameError: there is no such network or size.
        UsageError: a grid that is too small, or a backbone that cannot be understood.
        MissingExtraError: the backbone needs transformers, which is not installed.
        InputError: the backbone cannot be had.

    Example:
        >>> net = make_network("monoscene", "tiny", grid_shape=(30, 30, 18), voxel_m=0.16)
        >>> sum(weights.numel() for weights in net.parameters()) < 1_000_000
        True
    """
    if size not in SIZES:
        raise UnknownNameError("size of a network", size, SIZES)
    if len(grid_shape) != 3 or min(grid_shape) < MIN_SIDE:
        raise UsageError(f"a grid has three sides of {MIN_SIDE} cells or more, not {grid_shape}")
    if not voxel_m > 0:
        raise UsageError(f"cells are larger than 0 m, not {voxel_m}")
    kind = NETWORKS.load(name)
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        return _use_channels_last(kind(size, tuple(grid_shape), voxel_m, backbone))


def _use_channels_last(network: nn.Module) -> nn.Module:
    """Lay the kernels of cells out so that a cell's channels lie together: a quarter faster."""
    for part in network.modules():
        if isinstance(part, (nn.Conv3d, nn.ConvTranspose3d)):
            part.to(memory_format=torch.channels_last_3d)  # type: ignore[call-overload]
    return network
