"""Axis conventions and transforms, which no other module defines.

- **Room frame**: metres, right-handed, z up, walls along x and y. The top of the floor is z = 0.
- **Camera**: OpenCV axes (x right, y down, z forward), with pixel centres at +0.5.
- **Grid**: ``labels[x, y, z]``. ``origin_m`` is the minimum corner of cell (0, 0, 0).
- **Blocks**: x east, y up, z south, also right-handed. Room (x, y, z) becomes block (x, z, -y)
  times ``blocks_per_metre``. The corner (x_min, y_max, 0) of the room's inner box is at
  ``ROOM_CORNER_BLOCK``, so the floor is the layer below.
- **Angles**: ``yaw_deg`` is counter-clockwise from above, and 0 points along room +x. The game's
  yaw 0 points to +z (south) and increases clockwise from above. Its pitch increases downward.

The name of a transform contains both frames (``camera_to_room``), so adjacent names in a product
cancel: ``camera_to_room = scan_to_room @ camera_to_scan``.
"""

import numpy as np

ROOM_CORNER_BLOCK = (0, 64, 0)
PLAYER_EYE_BLOCKS = 1.62
ROOM_AXES_TO_BLOCK = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], np.float64)
COMPASS_OF_SIDE = {"x-": "west", "x+": "east", "y-": "south", "y+": "north"}  # Of the room.

# OpenGL cameras (x right, y up, z backward: nerfstudio, Blender) to OpenCV ones.
OPENGL_TO_OPENCV = np.diag([1.0, -1.0, -1.0, 1.0])


def apply(transform: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Transform points [..., 3] from frame a to frame b with a 4x4 ``a_to_b`` transform."""
    return points @ transform[:3, :3].T + transform[:3, 3]


def invert(transform: np.ndarray) -> np.ndarray:
    """Return the inverse of a 4x4 transform, which can be rigid or scaled."""
    return np.linalg.inv(transform)


def invert_rigid(transform: np.ndarray) -> np.ndarray:
    """Return the inverse of a 4x4 rigid transform with an exactly transposed rotation."""
    inverse = np.eye(4)
    inverse[:3, :3] = transform[:3, :3].T
    inverse[:3, 3] = -transform[:3, :3].T @ transform[:3, 3]
    return inverse


def rotation_about_z(yaw_deg: float) -> np.ndarray:
    """Return the 4x4 rotation by ``yaw_deg`` counter-clockwise from above, exact at quarters."""
    cosine, sine = np.cos(np.radians(yaw_deg)), np.sin(np.radians(yaw_deg))
    if yaw_deg % 90 == 0:
        cosine, sine = np.round(cosine), np.round(sine)
    turn = np.eye(4)
    turn[:2, :2] = [[cosine, -sine], [sine, cosine]]
    return turn


def opengl_to_opencv_pose(camera_to_world: np.ndarray) -> np.ndarray:
    """Convert the pose of an OpenGL camera to the pose of the same camera with OpenCV axes."""
    return camera_to_world @ OPENGL_TO_OPENCV


def look_at(eye_m: np.ndarray, target_m: np.ndarray) -> np.ndarray:
    """Return ``camera_to_room`` of an upright camera at ``eye_m`` that looks at ``target_m``."""
    forward = np.asarray(target_m, np.float64) - np.asarray(eye_m, np.float64)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    if np.linalg.norm(right) < 1e-9:
        right = np.array([0.0, -1.0, 0.0])
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(forward, right), forward])
    pose[:3, 3] = eye_m
    return pose


# Grid cells and metres.


def cell_centers_m(cells: np.ndarray, origin_m: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return the centres of cell indices [..., 3] in metres, float64 [..., 3]."""
    return np.asarray(origin_m) + (np.asarray(cells) + 0.5) * voxel_m


def metres_to_cells(points_m: np.ndarray, origin_m: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return the indices of the cells that contain points in metres, int64 [..., 3]."""
    return np.floor((np.asarray(points_m) - origin_m) / voxel_m).astype(np.int64)


def turn_grid(values: np.ndarray, quarter_turns: int) -> np.ndarray:
    """Rotate a grid [X, Y, Z, ...] counter-clockwise from above by quarter turns.

    With each turn, cell (i, j, k) of an X x Y grid moves to (Y-1-j, i, k), so room +x becomes +y.
    """
    return np.rot90(values, quarter_turns, axes=(0, 1))


# Room and blocks.


def room_to_block(corner_m: np.ndarray, blocks_per_metre: float) -> np.ndarray:
    """Return the 4x4 transform from room metres to world block coordinates.

    A block spans [n, n + 1].

    Args:
        corner_m: Corner (x_min, y_max) of the room's inner box in metres, float64 [2].
        blocks_per_metre: Number of blocks per metre.

    Example:
        >>> apply(room_to_block(np.array([0.0, 3.0]), 4.0), np.array([1.0, 3.0, 0.5])).tolist()
        [4.0, 66.0, 0.0]
    """
    transform = np.eye(4)
    transform[:3, :3] = ROOM_AXES_TO_BLOCK * blocks_per_metre
    transform[:3, 3] = ROOM_CORNER_BLOCK - transform[:3, :3] @ [corner_m[0], corner_m[1], 0.0]
    return transform


def block_to_room(corner_m: np.ndarray, blocks_per_metre: float) -> np.ndarray:
    """Return the 4x4 transform from world block coordinates to room metres.

    This is the inverse of ``room_to_block``.
    """
    return invert(room_to_block(corner_m, blocks_per_metre))


def grid_to_block_axes(values: np.ndarray) -> np.ndarray:
    """Convert a grid [X, Y, Z, ...] from room to block axes: (i, j, k) moves to (i, k, ny-1-j)."""
    return np.ascontiguousarray(np.swapaxes(values[:, ::-1], 1, 2))


def block_axes_to_grid(values: np.ndarray) -> np.ndarray:
    """Convert a grid from block axes to room axes, the inverse of ``grid_to_block_axes``."""
    return np.ascontiguousarray(np.swapaxes(values, 1, 2)[:, ::-1])


def cells_to_block_axes(cells: np.ndarray, y_cells: int) -> np.ndarray:
    """Convert cell indices [N, 3] of a grid with ``y_cells`` cells along y to block axes."""
    return np.stack([cells[:, 0], cells[:, 2], y_cells - 1 - cells[:, 1]], axis=1)


# Angles.


def nearest_quarter_turns(yaw_deg: float) -> int:
    """Return the quarter turns, 0 to 3, nearest to a yaw; of two, the larger yaw.

    Example:
        >>> nearest_quarter_turns(100), nearest_quarter_turns(-45)
        (1, 0)
    """
    return int(np.floor(yaw_deg / 90 + 0.5)) % 4


def camera_to_block_of_game_pose(
    eye_block: np.ndarray, game_yaw_deg: float, game_pitch_deg: float
) -> np.ndarray:
    """Return the 4x4 pose in block axes of the game's camera with its eye at ``eye_block``.

    The columns of the rotation are right, down and forward. The paper's matrix is the transpose
    (world to camera, see ``paper_rotation``).
    """
    yaw, pitch = np.radians(game_yaw_deg), np.radians(game_pitch_deg)
    forward = np.array([-np.sin(yaw) * np.cos(pitch), -np.sin(pitch), np.cos(yaw) * np.cos(pitch)])
    right = np.array([-np.cos(yaw), 0.0, -np.sin(yaw)])
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([right, np.cross(forward, right), forward])
    pose[:3, 3] = eye_block
    return pose


def eye_height_blocks(blocks_per_metre: float) -> float:
    """Return the height of a player's eye above the feet in blocks, scaled to the room."""
    return PLAYER_EYE_BLOCKS * blocks_per_metre


def game_pose_of_camera_to_block(camera_to_block: np.ndarray) -> tuple[np.ndarray, float, float]:
    """Return the eye position, float64 [3], game yaw and game pitch of a camera pose in block axes.

    This is the inverse of ``camera_to_block_of_game_pose``. The yaw is from -180 (inclusive) to 180
    (exclusive) and is also defined if the camera looks straight up or down. Camera roll cannot be
    represented in a game pose and is dropped.
    """
    right, down, forward = camera_to_block[:3, :3].T
    yaw_deg = np.degrees(np.arctan2(-right[2], -right[0]))
    pitch_deg = np.degrees(np.arctan2(-forward[1], max(-down[1], 0.0)))
    wrapped = (float(yaw_deg) + 180.0) % 360.0 - 180.0
    return camera_to_block[:3, 3].copy(), wrapped, float(pitch_deg)


def carry_camera(camera_to_a: np.ndarray, a_to_b: np.ndarray) -> np.ndarray:
    """Return ``camera_to_b``, scaling the camera position but not its rotation.

    For blocks and rooms, ``camera_to_room = carry_camera(camera_to_block, block_to_room)``. Use the
    inverse of ``block_to_room`` for the opposite direction.
    """
    scale = np.linalg.norm(a_to_b[:3, 0])
    pose = np.eye(4)
    pose[:3, :3] = a_to_b[:3, :3] @ camera_to_a[:3, :3] / scale
    pose[:3, 3] = apply(a_to_b, camera_to_a[:3, 3])
    return pose


def focal_px_of_fov(side_px: int, fov_deg: float) -> float:
    """Return the focal length in pixels of a field of view across ``side_px`` pixels.

    The game's field of view is vertical, so pass the height. The paper passes the width with the
    same angle.
    """
    return side_px / (2 * np.tan(np.radians(fov_deg) / 2))


def fov_deg_of_focal_px(side_px: int, focal_px: float) -> float:
    """Return the field of view in degrees across ``side_px`` pixels of a focal length in pixels."""
    return float(np.degrees(2 * np.arctan(side_px / (2 * focal_px))))


# The paper's own formulas, for ``paper_compat``; docs/reference/conventions.md describes their
# two errors.


def paper_rotation(game_yaw_deg: float, game_pitch_deg: float) -> np.ndarray:
    """Return the paper's rotation R_pitch R_yaw as printed, float64 [3, 3].

    The paper uses the matrix as camera to world, but it is world to camera: the transpose of the
    rotation of ``camera_to_block_of_game_pose``.
    """
    yaw, pitch = np.radians([game_yaw_deg + 180.0, game_pitch_deg + 180.0])
    turn_yaw = [[np.cos(yaw), 0, np.sin(yaw)], [0, 1, 0], [-np.sin(yaw), 0, np.cos(yaw)]]
    turn_pitch = [[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]]
    return np.array(turn_pitch) @ np.array(turn_yaw)


def paper_focal_px(width_px: int, fov_deg: float) -> float:
    """Return the paper's focal length in pixels, which treats the game's FOV as horizontal.

    The game's FOV is vertical, so ``focal_px_of_fov(height_px, fov_deg)`` is correct. The paper's
    focal length is too long by the aspect ratio of the image.
    """
    return focal_px_of_fov(width_px, fov_deg)
