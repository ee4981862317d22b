"""Choice of the camera heading along a walk: into the room, along its axes and its diagonals.

At each position, small images are rendered in all directions, and each of 24 headings is rated by
what the camera would see. The sequence of headings with the highest total rating, with a cost for
turning, is found exactly by dynamic programming.
"""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import apply, camera_to_block_of_game_pose, carry_camera
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.tours.types import KINDS, TourRule
from world2minecraft.rendering.batch import render_batch
from world2minecraft.rendering.scene import BlockScene

HEADINGS = 24  # Fifteen degrees apart.
PANORAMA_CAMERA = Camera(24, 16, 12.0, 12.0, 12.0, 8.0)  # 90 degrees wide.
NEAR_M, GOOD_M = 0.6, 3.2  # Depths of a blocked view and of a good view.
THING_WORTH = 0.8  # Bonus for a pixel of furniture.
CEILING_COST = 0.3  # Penalty for a pixel of the ceiling.
NEAR_COST = 1.0  # Penalty for a pixel nearer than ``NEAR_M``.
LOST_WORTH = 0.05  # Rating of a pixel of the sky or a window.
SEEN_COST = 0.7  # Maximum penalty for headings of earlier views nearby.
SEEN_M, SEEN_DEG, SEEN_VIEWS = 1.2, 25.0, 400  # Scales of this penalty, and views considered.
KIND_WORTH = 0.9  # Bonus for a heading of the kind that was chosen for this part of the walk.
TURN_COST = 0.12  # Of turning by fifteen degrees between two frames.
MAX_TURN_STEPS = 2  # Of fifteen degrees between two frames.
SWAY_DEG = 7.0  # Random deviation of free views from multiples of fifteen degrees.
AXIS, DIAGONAL, FREE = range(len(KINDS))


def rate_headings(
    scene: BlockScene, eyes: np.ndarray, block_to_room: np.ndarray, rule: TourRule
) -> np.ndarray:
    """Rate the view in each heading from each eye position, float64 [N, HEADINGS].

    Args:
        scene: Scene prepared with ``prepare_scene``.
        eyes: Eye positions in world block coordinates, float64 [N, 3].
        block_to_room: Matrix from block coordinates to room coordinates, float64 [4, 4].
        rule: Tour settings, which define the camera.
    """
    around = [
        carry_camera(camera_to_block_of_game_pose(np.zeros(3), yaw_deg, 0.0), block_to_room)
        for yaw_deg in (0.0, 90.0, 180.0, 270.0)
    ]
    poses = np.tile(around, (len(eyes), 1, 1))
    poses[:, :3, 3] = np.repeat(apply(block_to_room, eyes), len(around), axis=0)
    seen = render_batch(scene, PANORAMA_CAMERA, poses, outputs=("depth", "semantic"))
    depth_m, semantic = np.asarray(seen.depth_m), np.asarray(seen.semantic)
    worth = np.clip((depth_m - NEAR_M) / (GOOD_M - NEAR_M), 0, 1)
    worth += THING_WORTH * ((semantic >= SemanticClass.CHAIR) & (semantic != 255))
    worth -= CEILING_COST * (semantic == SemanticClass.CEILING)
    worth = np.where((depth_m == 0) | (semantic == SemanticClass.WINDOW), LOST_WORTH, worth)
    worth = np.where((depth_m > 0) & (depth_m < NEAR_M), -NEAR_COST, worth)
    columns = worth.mean(axis=1).reshape(len(eyes), -1)  # 4 x 24 columns from yaw -45 onwards.
    side = np.degrees(np.arctan((np.arange(24) + 0.5 - 12) / 12))
    yaws_deg = np.concatenate([turn + side for turn in (0, 90, 180, 270)])
    half_deg = np.degrees(np.arctan(rule.camera.width_px / 2 / rule.camera.fx_px))
    wanted = np.arange(HEADINGS) * (360 / HEADINGS)
    difference = np.abs((yaws_deg[None] - wanted[:, None] + 180) % 360 - 180)
    within = (difference <= half_deg).astype(float)
    return columns @ (within / within.sum(axis=1, keepdims=True)).T


def repetition_penalty(eyes: np.ndarray, taken: np.ndarray, blocks_per_metre: float) -> np.ndarray:
    """Return the penalty of each heading for similar views nearby, float64 [N, HEADINGS].

    Args:
        eyes: Eye positions in world block coordinates, float64 [N, 3].
        taken: Views chosen so far, float64 [M, 5]: x, y, z, yaw and pitch.
        blocks_per_metre: Scale of the world.
    """
    last = taken[-SEEN_VIEWS:]
    away_m = np.linalg.norm(eyes[:, None] - last[None, :, :3], axis=2) / blocks_per_metre
    angle = np.arange(HEADINGS) * (360.0 / HEADINGS)
    turn = np.abs((last[:, 3, None] - angle[None] + 180) % 360 - 180)
    alike = np.exp(-((away_m / SEEN_M) ** 2)) @ np.exp(-((turn / SEEN_DEG) ** 2))
    return SEEN_COST * (1 - np.exp(-alike / 3))


def draw_kinds(
    frames: int, spacing_m: float, wanted: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    """Choose a random kind of yaw for each frame, int64 [N], constant over 1.5 to 4 m of the walk.

    Args:
        frames: Number of frames.
        spacing_m: Distance between frames in metres.
        wanted: Weight of each kind of yaw, float64 [3].
        rng: Random generator.
    """
    kinds, shares = np.empty(frames, np.int64), np.maximum(wanted, 0.0) + 1e-9
    first = 0
    while first < frames:
        last = first + max(3, round(rng.uniform(1.5, 4.0) / spacing_m))
        kinds[first:last] = rng.choice(len(KINDS), p=shares / shares.sum())
        first = last
    return kinds


def best_yaws(
    rated: np.ndarray, kinds: np.ndarray, spacing_m: float, rng: np.random.Generator
) -> np.ndarray:
    """Return the yaw of each frame in the game, float64 [N] in degrees from -180 to 180.

    Frames of the kinds ``axis`` and ``diagonal`` face exactly in these directions, except while
    turning.

    Args:
        rated: Rating of each heading, float64 [N, HEADINGS].
        kinds: Kind of yaw of each frame, int64 [N].
        spacing_m: Distance between frames in metres.
        rng: Random generator.
    """
    angle = np.arange(HEADINGS) * (360 // HEADINGS)
    of_kind = np.stack([angle % 90 == 0, angle % 90 == 45, angle % 45 != 0])
    rating = rated + KIND_WORTH * of_kind[kinds]
    sequence = _best_sequence(rating, TURN_COST, MAX_TURN_STEPS)
    steps = (np.diff(sequence) + HEADINGS // 2) % HEADINGS - HEADINGS // 2
    yaws = (sequence[0] + np.concatenate([[0], np.cumsum(steps)])) * (360.0 / HEADINGS)
    is_exact = of_kind[kinds, sequence] & (kinds != FREE)
    sway = SWAY_DEG * smooth_noise(len(yaws), spacing_m, rng)
    loose = gaussian_filter1d(yaws, 1.2, mode="nearest") + sway
    chosen = np.where(is_exact, yaws, loose)
    return (chosen + 180.0) % 360.0 - 180.0


def smooth_noise(frames: int, spacing_m: float, rng: np.random.Generator) -> np.ndarray:
    """Return a slowly varying random number between about -1 and 1 for each frame."""
    raw = rng.normal(size=frames + 64)
    smooth = gaussian_filter1d(raw, max(1.0, 0.8 / spacing_m))[32 : 32 + frames]
    return np.clip(smooth / max(float(np.std(smooth)), 1e-9) * 0.6, -1, 1)


@njit
def _best_sequence(rating, cost, max_turn):
    """Return the headings, int64 [N], with the highest sum of ratings minus the cost of turns."""
    frames, count = rating.shape
    best, came = rating[0].copy(), np.zeros((frames, count), np.int64)
    for n in range(1, frames):
        after = np.empty(count)
        for h in range(count):
            top, source = -np.inf, 0
            for step in range(-max_turn, max_turn + 1):
                before = (h - step) % count
                value = best[before] - cost * abs(step) * (1 + abs(step))
                if value > top:
                    top, source = value, before
            after[h] = top + rating[n, h]
            came[n, h] = source
        best = after
    sequence = np.empty(frames, np.int64)
    sequence[-1] = best.argmax()
    for n in range(frames - 1, 0, -1):
        sequence[n - 1] = came[n, sequence[n]]
    return sequence
