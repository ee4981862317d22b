"""Validation of furniture templates, for authors of templates."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.furniture.rasterization import rasterize, size_in_cells
from world2minecraft.furniture.template import Part, Template

GAP_M = 1e-6  # Parts nearer than this touch.
FINE_VOXEL_M = 0.02
DESIGN_SCALES = (1.0, 2.0, 4.0)


def check_template(template: Template) -> tuple[str, ...]:
    """Return the problems of a template as sentences, or an empty tuple for a valid template.

    The template is checked at its minimum, typical and maximum size, and with each parameter at
    either end of its range. Parts must have a volume and be inside the bounding box, reach its
    bottom, top and sides, and be connected to a part on the floor (for wall furniture, at the
    back). ``turns`` must match the symmetry of the shape. The block design must be inside its
    bounding box at 1, 2 and 4 blocks per metre.
    """
    problems: dict[str, None] = {}
    for size, parameters in _cases(template):
        for problem in _check_parts(template, size, template.parts(size, parameters)):
            problems[f"{template.name} at {_sizes(size)}: {problem}"] = None
    for problem in (*_check_turns(template), *_check_design(template)):
        problems[f"{template.name}: {problem}"] = None
    return tuple(problems)


def _cases(template: Template) -> Iterator[tuple[np.ndarray, dict[str, float]]]:
    spans = np.array(template.size_m)
    ends = [
        [(name, span.minimum), (name, span.typical), (name, span.maximum)]
        for name, span in template.parameters.items()
    ]
    for column in range(3):
        for values in product(*ends):
            yield spans[:, column], dict(values)


def _check_parts(template: Template, size: np.ndarray, parts: tuple[Part, ...]) -> Iterator[str]:
    boxes = np.array([part.box_m for part in parts])
    low = np.array([-size[0] / 2, -size[1] / 2, 0.0])
    high = low + size
    for part in parts:
        if (part.box_m[3:] - part.box_m[:3] <= GAP_M).any():
            yield f"the {part.role} is flat: {_sizes(part.box_m)}"
        if (part.box_m[:3] < low - GAP_M).any() or (part.box_m[3:] > high + GAP_M).any():
            yield f"the {part.role} extends beyond the bounding box: {_sizes(part.box_m)}"
    reached = np.concatenate([boxes[:, :3].min(axis=0), boxes[:, 3:].max(axis=0)])
    if np.abs(reached - np.concatenate([low, high])).max() > FINE_VOXEL_M:
        yield f"the parts only span {_sizes(reached)} of the bounding box"
    for index in _floating(boxes, low, template.mount == "wall"):
        yield f"the {parts[index].role} is not connected to the other parts"


def _floating(boxes: np.ndarray, low: np.ndarray, hangs: bool) -> list[int]:
    """Return the parts that are not connected to the floor or the back by touching parts."""
    begin = np.maximum(boxes[:, None, :3], boxes[None, :, :3])
    end = np.minimum(boxes[:, None, 3:], boxes[None, :, 3:])
    touch = np.all(begin <= end + GAP_M, axis=2)
    axis = 0 if hangs else 2
    held = boxes[:, axis] <= low[axis] + GAP_M
    for _ in boxes:
        held |= touch[held].any(axis=0)
    return np.flatnonzero(~held).tolist()


def _check_turns(template: Template) -> Iterator[str]:
    depth, width, height = size_in_cells(template.typical_m, FINE_VOXEL_M)
    side = max(depth, width) if template.turns == 1 else depth
    values = tuple(template.complete().items())
    across = side if template.turns == 1 else width
    solid = rasterize(template, (side, across, height), values, FINE_VOXEL_M)
    half = np.array_equal(solid, turn_grid(solid, 2))
    if template.turns in (1, 2) and not half:
        yield f"turns is {template.turns}, but the shape is not symmetric under a half turn"
    if template.turns == 1 and not np.array_equal(solid, turn_grid(solid, 1)):
        yield "turns is 1, but a square piece is not symmetric under a quarter turn"


def _check_design(template: Template) -> Iterator[str]:
    from world2minecraft.furniture.block_designs import block_size  # noqa: PLC0415 - loads blocks.

    for scale in DESIGN_SCALES:
        size = block_size(np.array(template.typical_m), scale)
        blocks = template.blocks(size)
        cells = [block.cell for block in blocks]
        if not cells:
            yield f"the design at {scale:g} blocks per metre contains no blocks"
        elif len(set(cells)) < len(cells):
            yield f"the design at {scale:g} blocks per metre fills a cell twice"
        elif min(map(min, cells)) < 0:
            yield f"the design at {scale:g} blocks per metre extends beyond its bounding box"


def _sizes(values: np.ndarray) -> str:
    return " x ".join(f"{value:.2f}" for value in values)
