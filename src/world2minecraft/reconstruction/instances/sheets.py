"""What hangs on a wall: the columns of a curtain or a picture among those of small things."""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import connected_parts

NEAR_CELLS = 2  # A curtain hangs this near its wall.
LEAST_CELLS = 12  # At 0.08 m, a picture of 0.3 m side.
HIGH_M = 1.8  # What reaches so high beside a wall hangs there, wherever it ends below.
CLEAR_M = 0.24  # As does what has so much free air below it.
AROUND_CELLS = 4  # What stands this near is compared:
UNLIKE = 0.08  # in Oklab, one thing in light and shade differs by less;
ABOVE_M = 0.16  # and a sheet rises above it,
FAR_ABOVE_M = 0.5  # or so far that it may have its colour.
PLAN_BOX = np.ones((3, 3), np.bool_)


class Scene(NamedTuple):
    """What is known of a box of cells beside their labels."""

    colour: np.ndarray  # float [X, Y, Z, 3], in Oklab
    floor: int  # the layer on the floor
    voxel_m: float


def hung_plans(
    own: np.ndarray, labels: np.ndarray, stood: np.ndarray, scene: Scene
) -> list[np.ndarray]:
    """Return the plans, bool [X, Y], of what hangs on a wall.

    Args:
        own: bool [X, Y, Z], the cells of one cluster of small things.
        labels: uint8 [X, Y, Z].
        stood: bool [X, Y], the columns that stand on something.
        scene: what else is known.
    """
    near = _by_wall(own, labels, scene.floor, scene.voxel_m)
    sheets, count = connected_parts(near)
    plans = [sheets == sheet for sheet in range(1, count + 1)]
    return [plan for plan in plans if _is_sheet(plan, stood & ~near, own, scene)]


def joined_in_air(plans: list[np.ndarray], own: np.ndarray, stood: np.ndarray) -> list[np.ndarray]:
    """Return the plans, joined where what lies between them stands on nothing: a hood is one."""
    pieces, count = connected_parts(own & ~stood[:, :, None])
    joined: dict[int, np.ndarray] = {}
    for plan in plans:
        inside = np.bincount(pieces[own & plan[:, :, None]], minlength=count + 1)
        inside[0] = 0
        piece = int(inside.argmax())
        joined[piece] = joined[piece] | plan if piece in joined else plan
    return list(joined.values())


def _by_wall(own: np.ndarray, labels: np.ndarray, floor: int, voxel_m: float) -> np.ndarray:
    """Return bool [X, Y]: columns of ``own`` that hang beside a wall."""
    wall = ((labels == SemanticClass.WALL) | (labels == SemanticClass.WINDOW)).any(axis=2)
    if not wall.any():
        return wall
    near = np.asarray(ndimage.distance_transform_cdt(~wall)) <= NEAR_CELLS
    near &= own.any(axis=2)
    top = own.shape[2] - own[:, :, ::-1].argmax(axis=2)
    bottom = own.argmax(axis=2)
    layer = np.arange(own.shape[2])
    under = (layer < bottom[..., None]) & (layer >= bottom[..., None] - int(CLEAR_M / voxel_m))
    clear = (bottom > 0) & ~(under & (labels != 0)).any(axis=2)
    return near & (((top - floor) >= HIGH_M / voxel_m) | clear)


def _is_sheet(plan: np.ndarray, stood: np.ndarray, own: np.ndarray, scene: Scene) -> bool:
    """Tell whether what hangs in some columns is no part of what stands beside them.

    The leaves of a plant that lean to a wall are no thing of their own.
    """
    sheet = own & plan[:, :, None]
    around = ndimage.binary_dilation(plan, PLAN_BOX, iterations=AROUND_CELLS)
    beside = own & (around & stood)[:, :, None]
    if np.count_nonzero(sheet) < LEAST_CELLS:
        return False
    if not beside.any():
        return True
    tops = [np.flatnonzero(cells.any(axis=(0, 1)))[-1] for cells in (sheet, beside)]
    above_m = float(tops[0] - tops[1]) * scene.voxel_m
    apart = np.median(scene.colour[sheet], axis=0) - np.median(scene.colour[beside], axis=0)
    unlike = float(np.linalg.norm(apart)) >= UNLIKE
    return above_m >= FAR_ABOVE_M or (unlike and above_m >= ABOVE_M)
