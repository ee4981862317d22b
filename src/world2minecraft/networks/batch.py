"""The inputs, targets and outputs of a monocular occupancy network, as tensors of a batch.

Grids have the axes ``[X, Y, Z]`` of the region, as in the whole program: x right, y forward, z up.
Networks that were published with another axis order convert it internally.
"""

from dataclasses import dataclass, field, fields, replace
from typing import TypeVar

import torch
from torch import Tensor

Movable = TypeVar("Movable", "OccInput", "OccTarget")


@dataclass(frozen=True)
class OccInput:
    """A batch of B images of the same size, with the pose of the grid in front of each camera.

    Attributes:
        image: RGB images with values from 0 to 1, float32 [B, 3, H, W].
        intrinsics: Camera matrices in pixels of ``image`` with pixel centres at +0.5, float32 [B,
            3, 3].
        camera_to_grid: Matrices from OpenCV camera coordinates to the position relative to the
            minimum corner of cell (0, 0, 0), both in metres, float32 [B, 4, 4]. The centre of cell
            i is at ``(i + 0.5) * voxel_m``.
        grid_shape: Number of cells along each axis.
        voxel_m: Cell size in metres.
        depth_m: Depth along the camera's z axis in metres, float32 [B, H, W], 0 for none; or None.
    """

    image: Tensor
    intrinsics: Tensor
    camera_to_grid: Tensor
    grid_shape: tuple[int, int, int]
    voxel_m: float
    depth_m: Tensor | None = None

    def to(self, device: torch.device | str) -> "OccInput":
        """Return a copy with all tensors on the given device."""
        return _to_device(self, device)


@dataclass(frozen=True)
class OccTarget:
    """The ground truth for a batch.

    Attributes:
        labels: Class of each cell (0 to 11 or 255), int64 [B, X, Y, Z].
        in_frustum: Whether each cell centre is inside the image, bool [B, X, Y, Z].
        depth_m: Target depth for a depth branch in metres, float32 [B, H, W], 0 for none; or None.
            It may differ from the input depth.
    """

    labels: Tensor
    in_frustum: Tensor
    # float32 [B, H, W], 0 where there is none: the target of a depth branch, where that is not
    # the depth that the network is given.
    depth_m: Tensor | None = None

    def to(self, device: torch.device | str) -> "OccTarget":
        """Return a copy with all tensors on the given device."""
        return _to_device(self, device)


@dataclass(frozen=True)
class OccOutput:
    """The output of a network: the logits of the 12 classes, and tensors for additional losses.

    Attributes:
        logits: Class logits of each cell, float32 [B, 12, X, Y, Z].
        auxiliary: Further logits of the same shape from earlier layers.
        relations: Relations of MonoScene's context prior, float32 [B, R, mega-voxels, voxels at
            1/16].
        depth_logits: Logits of a depth branch, float32 [B, bins, h, w].
        facts: Scalars to log.
    """

    logits: Tensor
    auxiliary: tuple[Tensor, ...] = ()
    relations: Tensor | None = None
    depth_logits: Tensor | None = None
    facts: dict[str, Tensor] = field(default_factory=dict)


def _to_device(value: Movable, device: torch.device | str) -> Movable:
    values = {entry.name: getattr(value, entry.name) for entry in fields(value)}
    tensors = {name: one.to(device) for name, one in values.items() if isinstance(one, Tensor)}
    return replace(value, **tensors)
