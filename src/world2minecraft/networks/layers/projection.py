"""Projection of cells into an image, and lifting of image features to cells (FLoSP).

The projection is the same as for the frustum masks of the data sets: the centre of a cell is
transformed to camera coordinates, divided by its depth, and assigned to the pixel that contains the
point. Pixel (i, j) spans [i, i + 1) x [j, j + 1). Occlusion is ignored: each feature is assigned to
all cells along its ray, and the 3D layers must learn to which of them it belongs.

``sample_grid`` interpolates the values of maps and volumes. Coordinates are in cells, cell i spans
[i, i + 1), and values fade to 0 outside the centres of the outermost cells. PyTorch has a kernel
for this, but ONNX opset 17 supports it only for maps, so for volumes a sum over the eight
surrounding cells is exported.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import torch
from torch import Tensor

from world2minecraft.networks.batch import OccInput

MIN_DEPTH_M = 1e-3  # Cells nearer than this or behind the camera are outside the image.


def sample_grid(values: Tensor, places: Tensor) -> Tensor:
    """Sample a map or volume at given positions with linear interpolation, [B, C, N].

    Args:
        values: Map [B, C, H, W] or volume [B, C, X, Y, Z].
        places: Positions in cells, [B, N, 2] or [B, N, 3], in the axis order of ``values``.
    """
    if values.ndim == 5 and torch.onnx.is_in_onnx_export():
        return sample_corners(values, places)
    sides = torch.tensor(values.shape[2:], device=values.device, dtype=places.dtype)
    values = values.to(places.dtype)  # Half precision is too coarse for positions.
    # The kernel expects positions from -1 to 1, with the last axis first.
    grid = (2 * places / sides - 1).flip(-1)
    grid = grid.reshape(len(places), *([1] * (values.ndim - 3)), -1, values.ndim - 2)
    return torch.nn.functional.grid_sample(values, grid, align_corners=False).flatten(2)


def sample_corners(values: Tensor, places: Tensor) -> Tensor:
    """Sample a volume like ``sample_grid``, using only operations that are available in ONNX."""
    sides = [int(side) for side in values.shape[2:]]
    low = torch.floor(places - 0.5)
    after = places - 0.5 - low  # [B, N, 3], the weight of the later cell.
    flat, found = values.flatten(2), None
    for corner in product((0, 1), repeat=3):
        number, weight = None, None
        for axis, step in enumerate(corner):
            cell = low[..., axis] + step
            inside = (cell >= 0) & (cell < sides[axis])
            part = (after if step else 1 - after)[..., axis] * inside.to(values.dtype)
            cell = cell.clamp(0, sides[axis] - 1).long()
            number = cell if number is None else number * sides[axis] + cell
            weight = part if weight is None else weight * part
        if number is None or weight is None:
            raise ValueError("values must be a volume [B, C, X, Y, Z]")
        here = flat.gather(2, number[:, None].expand(-1, flat.shape[1], -1)) * weight[:, None]
        found = here if found is None else found + here
    if found is None:
        raise ValueError("values must be a volume [B, C, X, Y, Z]")
    return found


@dataclass(frozen=True)
class CellProjection:
    """The projection of the N cells of a grid into the images of a batch, in C order.

    Attributes:
        pixels: Pixel coordinates u (right) and v (down), float32 [B, N, 2].
        depth_m: Depth along the camera's z axis in metres, float32 [B, N].
        inside: Whether the cell is in front of the camera and inside the image, bool [B, N].
        size_px: Image height and width in pixels.
    """

    pixels: Tensor
    depth_m: Tensor
    inside: Tensor
    size_px: tuple[int, int]


def project_cells(inputs: OccInput) -> CellProjection:
    """Project the centres of all cells into the images of a batch."""
    height, width = int(inputs.image.shape[-2]), int(inputs.image.shape[-1])
    in_camera = cells_in_camera(inputs)
    depth = in_camera[..., 2]
    ahead = depth > MIN_DEPTH_M
    across = in_camera[..., :2] / torch.where(ahead, depth, torch.ones_like(depth))[..., None]
    focal = torch.stack([inputs.intrinsics[:, 0, 0], inputs.intrinsics[:, 1, 1]], dim=-1)
    pixels = across * focal[:, None] + inputs.intrinsics[:, None, :2, 2]
    u, v = pixels[..., 0], pixels[..., 1]
    inside = ahead & (u >= 0) & (u < width) & (v >= 0) & (v < height)
    return CellProjection(pixels, depth, inside, (height, width))


def cells_in_camera(inputs: OccInput) -> Tensor:
    """Return the centres of all cells in camera coordinates in metres, float32 [B, N, 3]."""
    centers = cell_centers_m(inputs.grid_shape, inputs.voxel_m, inputs.camera_to_grid)
    turn, place = inputs.camera_to_grid[:, :3, :3], inputs.camera_to_grid[:, :3, 3]
    # The inverse of a rotation is its transpose.
    return transform_points(centers[None] - place[:, None], turn.transpose(1, 2))


def transform_points(places: Tensor, turn: Tensor) -> Tensor:
    """Rotate points [B, N, 3] by matrices [B, 3, 3] in full precision.

    With mixed precision, matrix products would be rounded to half precision, with errors of about
    ten pixels.
    """
    return (places[:, :, None] * turn[:, None]).sum(dim=-1)


def cell_centers_m(shape: tuple[int, int, int], voxel_m: float, like: Tensor) -> Tensor:
    """Return the cell centres of a grid relative to its corner in metres, [N, 3].

    Args:
        shape: Shape of the grid.
        voxel_m: Cell size in metres.
        like: Tensor that defines the device and dtype of the result.
    """
    sides = [(torch.arange(n, device=like.device, dtype=like.dtype) + 0.5) for n in shape]
    places = torch.stack(torch.meshgrid(*sides, indexing="ij"), dim=-1)
    return places.reshape(-1, 3) * voxel_m


def lift_features(
    features: Mapping[int, Tensor], sight: CellProjection, shape: tuple[int, int, int]
) -> Tensor:
    """Sum the features at the pixel of each cell over all scales, [B, C, X, Y, Z].

    Cells outside the image get zeros.

    Args:
        features: For each scale s, a map [B, C, ceil(H / s), ceil(W / s)].
        sight: Projection of the cells.
        shape: Shape of the grid.
    """
    found = None
    for scale, values in features.items():
        here = values.flatten(2).gather(2, _places(sight, scale, values))
        found = here if found is None else found + here
    if found is None:
        raise ValueError("features must contain at least one scale")
    return (found * sight.inside[:, None]).unflatten(2, shape)


def _places(sight: CellProjection, scale: int, values: Tensor) -> Tensor:
    """Return the flat index of each cell's pixel in a map, int64 [B, C, N]."""
    height, width = int(values.shape[-2]), int(values.shape[-1])
    pixels = torch.floor(sight.pixels / scale)
    column = pixels[..., 0].clamp(0, width - 1).long()
    row = pixels[..., 1].clamp(0, height - 1).long()
    return (row * width + column)[:, None].expand(-1, values.shape[1], -1)
