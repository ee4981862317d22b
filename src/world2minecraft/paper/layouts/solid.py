"""Collisions of what is solid: a chair pushed under a table is in its box and meets nothing.

A thing of a layout is as solid as the design that stands for it (``designs``), turned as the layout
says; what no design stands for is solid all through. So layouts of others are held to the rule
that our own furniture is held to (``metrics.layout.collisions``), with its 4 cm.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.core.types import LayoutObject
from world2minecraft.furniture import template
from world2minecraft.furniture.layout_checks import OVERLAP_M, overlap_depth_m, overlapping_boxes
from world2minecraft.paper.layouts.designs import design_of
from world2minecraft.paper.layouts.values import ComparedScene
from world2minecraft.reconstruction.floorplans.furniture_categories import OWN_CELLS


def solid_collisions(scene: ComparedScene) -> int:
    """Return how many pairs of things meet with their solid parts; a run's count is its own."""
    if scene.collided is not None:
        return scene.collided
    boxes = [item for item in scene.objects if isinstance(item, LayoutObject)]
    parts: dict[int, list[LayoutObject]] = {}
    met = 0
    for m, n in overlapping_boxes(boxes):
        for index in (m, n):
            if index not in parts:
                parts[index] = solid_parts(boxes[index])
        met += _meet(_near(parts[m], boxes[n]), _near(parts[n], boxes[m]))
    return met


def solid_parts(item: LayoutObject) -> list[LayoutObject]:
    """Return the solid boxes of a thing; itself where no design stands for it."""
    name = design_of(item).template
    if name == OWN_CELLS:
        return [item]
    angle = np.radians(item.yaw_deg)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    foot = item.center_m - [0, 0, item.size_m[2] / 2]
    parts = []
    for part in template(name).parts(item.size_m, {}):
        low, high = np.asarray(part.box_m, np.float64).reshape(2, 3)
        if (high > low).all():
            middle = (low + high) / 2
            center = foot + np.array([*(turn @ middle[:2]), middle[2]])
            parts.append(replace(item, center_m=center, size_m=high - low))
    return parts or [item]


def _near(parts: list[LayoutObject], box: LayoutObject) -> list[LayoutObject]:
    return [part for part in parts if overlap_depth_m(part, box) > OVERLAP_M]


def _meet(one: list[LayoutObject], other: list[LayoutObject]) -> bool:
    return any(overlap_depth_m(a, b) > OVERLAP_M for a in one for b in other)
