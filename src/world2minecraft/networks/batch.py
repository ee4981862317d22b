"""The inputs, targets and outputs of a monocular occupancy network, as tensors of a batch.

Grids are ``[X, Y, Z]`` as everywhere: x right, y forward, z up of the region. A network that was
published for another order of axes turns them inside.
"""

from dataclasses import dataclass, field, fields, replace
from typing import TypeVar

import torch
from torch import Tensor

Movable = TypeVar("Movable", "OccInput", "OccTarget")


@dataclass(frozen=True)
class OccInput:
    """B pictures of one size, each with the grid before its camera.

    ``camera_to_grid`` carries OpenCV camera metres to metres from the minimum corner of cell
    (0, 0, 0); the centre of cell i is ``(i + 0.5) * voxel_m``. Depth is along the camera's z.
    """

    image: Tensor  # float32 [B, 3, H, W], RGB, 0 to 1
    intrinsics: Tensor  # float32 [B, 3, 3], pixels of ``image``; pixel centres lie at +0.5
    camera_to_grid: Tensor  # float32 [B, 4, 4]
    grid_shape: tuple[int, int, int]
    voxel_m: float
    depth_m: Tensor | None = None  # float32 [B, H, W], 0 where there is none

    def to(self, device: torch.device | str) -> "OccInput":
        """Return the same with its tensors on a device."""
        return _to_device(self, device)


@dataclass(frozen=True)
class OccTarget:
    """What is true of the grids of a batch."""

    labels: Tensor  # int64 [B, X, Y, Z], 0 to 11 or 255
    in_frustum: Tensor  # bool [B, X, Y, Z]: the cell's centre falls into the picture
    # float32 [B, H, W], 0 where there is none: the target of a depth branch, where that is not
    # the depth that the network is given.
    depth_m: Tensor | None = None

    def to(self, device: torch.device | str) -> "OccTarget":
        """Return the same with its tensors on a device."""
        return _to_device(self, device)


@dataclass(frozen=True)
class OccOutput:
    """The output of a network: ``logits`` of the 12 classes, and what its own losses need.

    ``auxiliary`` holds further logits of the same shape, from earlier layers. ``relations`` are
    those of MonoScene's context prior, ``depth_logits`` those of a depth branch.
    """

    logits: Tensor  # float32 [B, 12, X, Y, Z]
    auxiliary: tuple[Tensor, ...] = ()
    relations: Tensor | None = None  # float32 [B, R, mega-voxels, voxels at 1/16]
    depth_logits: Tensor | None = None  # float32 [B, bins, h, w]
    facts: dict[str, Tensor] = field(default_factory=dict)  # scalars worth a log line


def _to_device(value: Movable, device: torch.device | str) -> Movable:
    values = {entry.name: getattr(value, entry.name) for entry in fields(value)}
    tensors = {name: one.to(device) for name, one in values.items() if isinstance(one, Tensor)}
    return replace(value, **tensors)
