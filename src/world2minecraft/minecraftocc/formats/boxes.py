"""The labelled box of an image, in a world of its own or in the room's, and its masks."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply, invert_rigid, turn_grid
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.values import USUAL_SHAPE, USUAL_VOXEL_M, OccSample

TURN_SLACK_DEG = 0.01


@dataclass(frozen=True, eq=False)
class LabelledBox:
    """A box of cells along the axes of a world, and the camera in that world."""

    labels: np.ndarray  # uint8 [60, 60, 36] as x, y, z up
    origin_m: np.ndarray  # float64 [3], minimum corner of cell (0, 0, 0)
    camera_to_world: np.ndarray  # float64 [4, 4]


def check_usual(sample: OccSample) -> None:
    """Refuse a region that the papers' loaders cannot hold.

    Raises:
        InputError: its shape or its voxel size is another.
    """
    region = sample.occ.region
    if region.shape != USUAL_SHAPE or abs(region.voxel_m - USUAL_VOXEL_M) > 1e-9:
        sides = "x".join(str(side) for side in region.shape)
        raise InputError(
            sample.key,
            f"its region is {sides} cells of {region.voxel_m:g} m; this format holds 60x60x36 of "
            "0.08 m alone: build the data set so, or export to npz",
        )


def region_box(sample: OccSample) -> LabelledBox:
    """Return the box in the region's own world: x right, y forward, z up, its corner at 0."""
    camera_to_region = invert_rigid(sample.occ.region.region_to_room) @ sample.camera_to_room
    return LabelledBox(sample.occ.labels, np.zeros(3), camera_to_region)


def room_box(sample: OccSample) -> LabelledBox | None:
    """Return the box along the room's axes, or None where it is turned by no quarter."""
    region = sample.occ.region
    turn_deg = np.degrees(np.arctan2(region.region_to_room[1, 0], region.region_to_room[0, 0]))
    quarters = round(turn_deg / 90)
    if abs(turn_deg - 90 * quarters) > TURN_SLACK_DEG:
        return None
    ends = np.array([[0.0, 0, 0], region.shape]) * region.voxel_m
    origin_m = apply(region.region_to_room, ends).min(axis=0)
    labels = np.ascontiguousarray(turn_grid(sample.occ.labels, quarters))
    return LabelledBox(labels, origin_m, sample.camera_to_room)


def cells_in_image(
    shape: tuple[int, ...],
    voxel_m: float,
    box_to_camera: np.ndarray,
    camera: Camera,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Project the centres of a box's cells, as the loaders do.

    Returns:
        Which fall into the image in front of the camera, bool [X, Y, Z]; their pixels int64
        [X, Y, Z, 2] (column, row) and their depths float64 [X, Y, Z], sound only where they do.
    """
    centres = (np.moveaxis(np.indices(shape), 0, -1) + 0.5) * voxel_m
    points = apply(box_to_camera, centres)
    depth_m = points[..., 2]
    in_front = depth_m > 1e-6
    safe = np.where(in_front, depth_m, 1.0)
    across = points[..., 0] / safe * camera.fx_px + camera.cx_px
    down = points[..., 1] / safe * camera.fy_px + camera.cy_px
    inside = in_front & (across >= 0) & (across < camera.width_px)
    inside &= (down >= 0) & (down < camera.height_px)
    pixels = np.stack([np.where(inside, across, 0), np.where(inside, down, 0)], axis=-1)
    return inside, np.floor(pixels).astype(np.int64), depth_m


def box_in_image(box: LabelledBox, camera: Camera) -> np.ndarray:
    """Return which cells of a box fall into an image, bool [60, 60, 36]."""
    box_to_world = np.eye(4)
    box_to_world[:3, 3] = box.origin_m
    box_to_camera = invert_rigid(box.camera_to_world) @ box_to_world
    return cells_in_image(box.labels.shape, USUAL_VOXEL_M, box_to_camera, camera)[0]


def chosen_labels(labels: np.ndarray, in_image: np.ndarray | None, unknown: str) -> np.ndarray:
    """Return labels with cells outside the image unknown, and unknown kept or made empty."""
    result = labels if in_image is None else np.where(in_image, labels, UNKNOWN)
    if unknown == "empty":
        result = np.where(result == UNKNOWN, 0, result)
    return np.ascontiguousarray(result.astype(np.uint8))
