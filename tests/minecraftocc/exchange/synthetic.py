"""A small furnished room whose every pixel is known exactly, as samples."""

import numpy as np

from world2minecraft.core.classes import CLASS_COLOURS
from world2minecraft.core.coordinates import apply, look_at, rotation_about_z
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA
from world2minecraft.minecraftocc.formats.label_grids import cells_in_image
from world2minecraft.minecraftocc.types import FineClass, LabelRegion, OccLabels, OccSample
from world2minecraft.rendering.voxel_camera import cast_voxels

VOXEL_M = 0.08
ORIGIN_M = np.array([-0.08, -0.08, -0.08])
KINDS = (FineClass("minecraft:air"), FineClass("minecraft:stone"), FineClass("x:y", "chair_cafe"))


def room_cells() -> np.ndarray:
    """uint8 [62, 82, 36]: walls, floor, ceiling and one thing of each class, none in a mirror."""
    cells = np.zeros((62, 82, 36), np.uint8)
    cells[:, :, 0], cells[:, :, -1] = 2, 1
    for wall in (cells[0], cells[-1], cells[:, 0], cells[:, -1]):
        wall[:] = 3
    cells[20:40, -1, 12:24] = 4  # A window in the far wall.
    cells[8:14, 30:36, 1:7] = 5
    cells[40:58, 50:70, 1:8] = 6
    cells[4:16, 60:70, 1:10] = 7
    cells[26:38, 40:48, 8:10] = 8
    cells[0:3, 44:54, 12:20] = 9
    cells[52:61, 34:38, 1:24] = 10
    cells[30:33, 42:45, 10:14] = 11
    return cells


CELLS = room_cells()


def sample(
    key: str = "house_0001-t0-00000",
    *,
    eye_m: tuple[float, float, float] = (2.4, 0.5, 1.5),
    target_m: tuple[float, float, float] = (2.5, 4.0, 0.9),
    quarters: int = 0,
    turn_deg: float = 0.0,
    camera: Camera = NYU_CAMERA,
    split: str = "train",
    scene_id: str = "house_0001",
    frame: int = 0,
) -> OccSample:
    """Make the sample of a camera; its region lies before it, ``quarters`` turned."""
    pose = look_at(np.array(eye_m), np.array(target_m))
    hits = cast_voxels(CELLS, camera, pose, voxel_m=VOXEL_M, origin_m=ORIGIN_M)
    region = _region(eye_m, quarters, turn_deg)
    labels = _labels(region)
    to_camera = np.linalg.inv(pose) @ region.region_to_room
    in_view = cells_in_image(region.shape, VOXEL_M, to_camera, camera)[0]
    seen = _first_seen(hits, region, camera, pose)
    counts = np.bincount(seen[seen >= 0], minlength=labels.size).reshape(labels.shape)
    met = CELLS.reshape(-1)[np.maximum(hits.voxel_index, 0)]
    shade = np.array([200, 255, 170, 230, 255, 255, *[0] * 250], np.uint16)[hits.face]
    colour = (np.array(CLASS_COLOURS)[met] * shade[..., None] // 255).astype(np.uint8)
    occ = OccLabels(
        region,
        labels,
        np.where((labels > 0) & (labels < 12), 1, 0).astype(np.uint16),
        np.zeros(labels.shape, np.uint16),
        in_view,
        counts.astype(np.uint32),
        np.zeros(labels.shape, bool),
    )
    facts = {"first_seen": seen}
    return OccSample(
        key, scene_id, "t0", frame, camera, pose, occ, KINDS, colour, hits.depth_m, split, facts
    )


def _region(eye_m, quarters: int, turn_deg: float) -> LabelRegion:
    """Return a box before the eye, its corner on the room's cells."""
    turn = rotation_about_z(90 * quarters + turn_deg if turn_deg else 90 * quarters)
    steps = np.round((np.array(eye_m) - ORIGIN_M) / VOXEL_M)
    middle = ORIGIN_M + steps * VOXEL_M
    region_to_room = turn.copy()
    region_to_room[:3, 3] = middle - turn[:3, :3] @ (np.array([30, 0, 0]) * VOXEL_M)
    region_to_room[2, 3] = ORIGIN_M[2]
    return LabelRegion((60, 60, 36), VOXEL_M, region_to_room, "free" if turn_deg else "axis")


def _labels(region: LabelRegion) -> np.ndarray:
    cells = np.floor((region.centers_m() - ORIGIN_M) / VOXEL_M).astype(int)
    inside = np.all((cells >= 0) & (cells < CELLS.shape), axis=-1)
    safe = np.where(inside[..., None], cells, 0)
    return np.where(inside, CELLS[tuple(np.moveaxis(safe, -1, 0))], 255).astype(np.uint8)


def _first_seen(hits, region: LabelRegion, camera: Camera, pose: np.ndarray) -> np.ndarray:
    """Return for each pixel the region's cell that it sees first, C-order index or -1."""
    room_cells = np.stack(np.unravel_index(np.maximum(hits.voxel_index, 0), CELLS.shape), axis=-1)
    centres = ORIGIN_M + (room_cells + 0.5) * VOXEL_M
    cells = np.floor(apply(np.linalg.inv(region.region_to_room), centres) / VOXEL_M).astype(int)
    inside = np.all((cells >= 0) & (cells < region.shape), axis=-1) & (hits.voxel_index >= 0)
    safe = np.where(inside[..., None], cells, 0)
    index = np.ravel_multi_index(tuple(np.moveaxis(safe, -1, 0)), region.shape)
    return np.where(inside, index, -1)
