"""Cutaway preview images of generated rooms and houses, seen from above at an angle."""

from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import apply, look_at
from world2minecraft.core.types import Camera
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.photo_rendering import prepare_photos, take_photo

ELEVATION_DEG = {"room": 42.0, "house": 58.0}  # Inner walls hide less from a steeper place.
TURN_DEG = 32.0
FOV_DEG = 24.0
RIM_M = 0.3  # What stays of the near walls of a room,
CUT_M = 1.5  # and of everything in a house.
NEAR_M = 0.16  # What hangs on a near wall goes with it.
NEAR = (1, -1)  # Signs of x and y: the camera looks from high x and low y.
BACKGROUND = np.array([238, 238, 235], np.uint8)
SUPERSAMPLE = 2


def room_picture(room: Room, width_px: int = 1280, height_px: int | None = None) -> np.ndarray:
    """Render a cutaway image as uint8 [height, width, 3], with storeys side by side.

    Args:
        room: The room or house.
        width_px: Width of the image in pixels.
        height_px: Height of the image in pixels. The default is three quarters of the width, or
            half for two storeys.
    """
    levels = sorted({layout.floor_z_m for layout in room.layouts})
    share = width_px // len(levels)
    if height_px is None:
        height_px = width_px // 2 if len(levels) > 1 else width_px * 3 // 4
    return np.concatenate(
        [_storey_picture(room, level, share, height_px) for level in levels], axis=1
    )


def room_view(
    room: Room, camera: Camera, camera_to_room: np.ndarray, near: tuple[int, int] = NEAR
) -> np.ndarray:
    """Render a room or a house of one storey without its ceiling and near walls from a pose.

    Args:
        room: The room or house.
        camera: A pinhole camera.
        camera_to_room: The pose of the camera, float64 [4, 4].
        near: The near sides of a room: signs of x and y.

    Returns:
        The image as uint8 [height, width, 3].
    """
    return _draw(_open_storey(room, room.layouts[0].floor_z_m, near), camera, camera_to_room)


def _storey_picture(room: Room, floor_z_m: float, width_px: int, height_px: int) -> np.ndarray:
    opened = _open_storey(room, floor_z_m, NEAR)
    kind = "house" if len(room.layouts) > 1 else "room"
    return _draw(opened, *_camera(opened, kind, width_px, height_px))


def _draw(opened: Room, camera: Camera, camera_to_room: np.ndarray) -> np.ndarray:
    """Render an opened storey as uint8 [height, width, 3]."""
    width_px, height_px = camera.width_px, camera.height_px
    large = camera.resized(width_px * SUPERSAMPLE, height_px * SUPERSAMPLE)
    photo = take_photo(prepare_photos(opened), large, camera_to_room)
    picture = np.where((photo.voxel_index < 0)[..., None], BACKGROUND, photo.colour)
    blocks = picture.reshape(height_px, SUPERSAMPLE, width_px, SUPERSAMPLE, 3).astype(np.uint16)
    return ((blocks.sum(axis=(1, 3)) + 2) // 4).astype(np.uint8)


def _open_storey(room: Room, floor_z_m: float, near: tuple[int, int]) -> Room:
    """Return one storey without the parts that hide its interior from the near sides."""
    storey = [layout for layout in room.layouts if layout.floor_z_m == floor_z_m]
    slab = round(-room.origin_m[2] / room.voxel_m)
    low = round((floor_z_m - room.origin_m[2]) / room.voxel_m) - slab
    height = CUT_M if len(room.layouts) > 1 else storey[0].wall_height_m
    high = low + slab + round(height / room.voxel_m)
    labels = room.labels[:, :, low:high].copy()
    if len(room.layouts) == 1:
        near_x, near_y = near
        # Views, of which x = max and y = 0 are near.
        turned = labels[::near_x, ::-near_y]
        instance = room.instance[::near_x, ::-near_y, low:high]
        _drop_near_roofs(turned)
        _drop_near_walls(room, turned, instance, slab)
    origin = np.array([*room.origin_m[:2], room.origin_m[2] + low * room.voxel_m])
    return replace(
        room,
        layouts=tuple(storey),
        labels=np.ascontiguousarray(labels),
        instance=room.instance[:, :, low:high],
        colour=np.ascontiguousarray(room.colour[:, :, low:high]),
        origin_m=origin,
    )


def _drop_near_roofs(labels: np.ndarray) -> None:
    """Remove sloped ceilings above the near half of the room."""
    x, y = (side // 2 for side in labels.shape[:2])
    for part in (labels[x:], labels[:, :y]):
        part[part == int(SemanticClass.CEILING)] = 0


def _drop_near_walls(room: Room, labels: np.ndarray, instance: np.ndarray, slab: int) -> None:
    """Remove the walls at x = max and y = 0, near the camera, down to a rim, and what hangs there.

    Objects that reach higher than a metre hang or lean there, such as curtains and doors.
    """
    rim, deep = slab + round(RIM_M / room.voxel_m), slab + round(NEAR_M / room.voxel_m)
    labels[-slab:, :, rim:] = 0
    labels[:, :slab, rim:] = 0
    hung = slab + round(1.0 / room.voxel_m)
    objects = int(SemanticClass.OBJS)
    for part in (np.s_[-deep:], np.s_[:, :deep]):
        things = np.where(labels[part] == objects, instance[part], 0)
        high = np.unique(things[:, :, hung:])
        labels[part][np.isin(things, high[high > 0])] = 0


def _camera(room: Room, kind: str, width_px: int, height_px: int) -> tuple[Camera, np.ndarray]:
    """Return a camera and ``camera_to_room`` that show everything from high x and low y."""
    size = np.array(room.labels.shape) * room.voxel_m
    corners = np.stack(np.meshgrid(*([0.0, 1.0],) * 3, indexing="ij"), -1).reshape(-1, 3) * size
    corners += room.origin_m
    middle = corners.mean(axis=0)
    up, turn = np.radians(ELEVATION_DEG[kind]), np.radians(TURN_DEG)
    # The longer side lies across the picture.
    flat = (np.sin(turn), -np.cos(turn)) if size[0] > size[1] else (np.cos(turn), -np.sin(turn))
    toward = np.array([flat[0] * np.cos(up), flat[1] * np.cos(up), np.sin(up)])
    focal = min(width_px, height_px) / (2 * np.tan(np.radians(FOV_DEG) / 2))
    distance = 1.0
    while True:
        pose = look_at(middle + toward * distance, middle)
        seen = apply(np.linalg.inv(pose), corners)
        if (seen[:, 2] > 0.1).all():
            u, v = focal * seen[:, 0] / seen[:, 2], focal * seen[:, 1] / seen[:, 2]
            if np.ptp(u) < 0.96 * width_px and np.ptp(v) < 0.96 * height_px:
                break
        distance *= 1.03
    centre = (width_px / 2 - (u.min() + u.max()) / 2, height_px / 2 - (v.min() + v.max()) / 2)
    return Camera(width_px, height_px, focal, focal, *centre), pose
