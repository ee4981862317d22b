"""Project cells into an image, and lift features: each cell takes those of its pixel (FLoSP).

The arithmetic is that of the data set's frustum masks: the centre of a cell is carried into the
camera, divided by its depth, and lies in the pixel that holds the point. Pixel (i, j) spans
[i, i + 1) x [j, j + 1). Occlusion is ignored: a feature is laid on all cells of its ray, and the 3D
layers have to find out which of them it belongs to.

``sample_grid`` reads values between the cells of maps and volumes: coordinates are in cells, cell i
spans [i, i + 1), and beyond the centres of the outermost cells values fade to 0. PyTorch has a
kernel for this; ONNX of opset 17 has it for maps alone, so that volumes are exported as sums over
the eight cells around.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import torch
from torch import Tensor

from world2minecraft.networks.batch import OccInput

MIN_DEPTH_M = 1e-3  # Cells nearer than that, or behind, are in no picture.


def sample_grid(values: Tensor, places: Tensor) -> Tensor:
    """Return what lies at places, mixed linearly from the cells around: [B, C, N].

    Args:
        values: [B, C, H, W] or [B, C, X, Y, Z].
        places: [B, N, 2] or [B, N, 3], in the order of the axes of ``values``.
    """
    if values.ndim == 5 and torch.onnx.is_in_onnx_export():
        return sample_corners(values, places)
    sides = torch.tensor(values.shape[2:], device=values.device, dtype=places.dtype)
    values = values.to(places.dtype)  # Not the other way: half precision is too coarse for places.
    # The kernel's places run from -1 to 1, with the last axis first.
    grid = (2 * places / sides - 1).flip(-1)
    grid = grid.reshape(len(places), *([1] * (values.ndim - 3)), -1, values.ndim - 2)
    return torch.nn.functional.grid_sample(values, grid, align_corners=False).flatten(2)


def sample_corners(values: Tensor, places: Tensor) -> Tensor:
    """Return the same as ``sample_grid`` of volumes, by what any runtime can do."""
    sides = [int(side) for side in values.shape[2:]]
    low = torch.floor(places - 0.5)
    after = places - 0.5 - low  # [B, N, 3], the share of the later cell.
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
            raise ValueError("a volume has three axes")
        here = flat.gather(2, number[:, None].expand(-1, flat.shape[1], -1)) * weight[:, None]
        found = here if found is None else found + here
    if found is None:
        raise ValueError("a volume has eight corners")
    return found


@dataclass(frozen=True)
class CellProjection:
    """Where the N cells of a grid lie in their pictures, in C order."""

    pixels: Tensor  # float32 [B, N, 2]: u to the right, v down
    depth_m: Tensor  # float32 [B, N], along the camera's z
    inside: Tensor  # bool [B, N]: before the camera, and in the picture
    size_px: tuple[int, int]  # height, width


def project_cells(inputs: OccInput) -> CellProjection:
    """Return where the centres of all cells lie in the pictures of a batch."""
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
    """Return the centres of all cells in the camera's axes, float32 [B, N, 3], metres."""
    centers = cell_centers_m(inputs.grid_shape, inputs.voxel_m, inputs.camera_to_grid)
    turn, place = inputs.camera_to_grid[:, :3, :3], inputs.camera_to_grid[:, :3, 3]
    # A turn's inverse is its transpose.
    return transform_points(centers[None] - place[:, None], turn.transpose(1, 2))


def transform_points(places: Tensor, turn: Tensor) -> Tensor:
    """Return places [B, N, 3] turned by [B, 3, 3], whatever precision layers work in.

    Matrix products are rounded to half precision where training is mixed: to some ten pixels.
    """
    return (places[:, :, None] * turn[:, None]).sum(dim=-1)


def cell_centers_m(shape: tuple[int, int, int], voxel_m: float, like: Tensor) -> Tensor:
    """Return the centres of a grid's cells from its corner, [N, 3], of the type of ``like``."""
    sides = [(torch.arange(n, device=like.device, dtype=like.dtype) + 0.5) for n in shape]
    places = torch.stack(torch.meshgrid(*sides, indexing="ij"), dim=-1)
    return places.reshape(-1, 3) * voxel_m


def lift_features(
    features: Mapping[int, Tensor], sight: CellProjection, shape: tuple[int, int, int]
) -> Tensor:
    """Return the sum over scales of the feature at each cell's pixel, [B, C, X, Y, Z].

    Args:
        features: of each scale s the map [B, C, ceil(H / s), ceil(W / s)].
        sight: where the cells lie.
        shape: of the grid.

    Cells outside of the picture get zeros.
    """
    found = None
    for scale, values in features.items():
        here = values.flatten(2).gather(2, _places(sight, scale, values))
        found = here if found is None else found + here
    if found is None:
        raise ValueError("lifting needs the features of one scale or more")
    return (found * sight.inside[:, None]).unflatten(2, shape)


def _places(sight: CellProjection, scale: int, values: Tensor) -> Tensor:
    """Return the number of each cell's pixel in a map, int64 [B, C, N]."""
    height, width = int(values.shape[-2]), int(values.shape[-1])
    pixels = torch.floor(sight.pixels / scale)
    column = pixels[..., 0].clamp(0, width - 1).long()
    row = pixels[..., 1].clamp(0, height - 1).long()
    return (row * width + column)[:, None].expand(-1, values.shape[1], -1)
