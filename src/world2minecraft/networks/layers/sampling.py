"""Values between the cells of maps and volumes: places are in cells, cell i spans [i, i + 1).

Beyond the middles of the outermost cells values fade to 0. PyTorch has a kernel for this; ONNX of
opset 17 has it for maps alone, so that volumes are exported as sums over the eight cells around.
"""

from itertools import product

import torch
from torch import Tensor


def sample(values: Tensor, places: Tensor) -> Tensor:
    """Return what lies at places, mixed linearly from the cells around: [B, C, N].

    Args:
        values: [B, C, H, W] or [B, C, X, Y, Z].
        places: [B, N, 2] or [B, N, 3], in the order of the axes of ``values``.
    """
    if values.ndim == 5 and torch.onnx.is_in_onnx_export():
        return sample_by_corners(values, places)
    sides = torch.tensor(values.shape[2:], device=values.device, dtype=places.dtype)
    values = values.to(places.dtype)  # Not the other way: half precision is too coarse for places.
    # The kernel's places run from -1 to 1, with the last axis first.
    grid = (2 * places / sides - 1).flip(-1)
    grid = grid.reshape(len(places), *([1] * (values.ndim - 3)), -1, values.ndim - 2)
    return torch.nn.functional.grid_sample(values, grid, align_corners=False).flatten(2)


def sample_by_corners(values: Tensor, places: Tensor) -> Tensor:
    """Return the same as ``sample`` of volumes, by what any runtime can do."""
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
