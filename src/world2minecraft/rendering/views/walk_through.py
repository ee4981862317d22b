"""Planning of smooth walks through the rooms of a volume at eye height.

The camera looks ahead and into the rooms, and avoids near walls. Rays rate all headings at all
positions, and dynamic programming finds the best sequence of headings, with a cost for turning.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import AIR, BlockVolume, Camera
from world2minecraft.minecraft.physics.walk_graph import is_shut, open_door
from world2minecraft.rendering.views.cameras import GamePose, Shot
from world2minecraft.rendering.views.viewpoint_planning import WalkRoutes
from world2minecraft.rendering.views.visibility import (
    ViewBlockers,
    cast_view_rays,
    view_blockers_of,
)

HEADINGS = 72  # Five degrees apart.
PITCHES_DEG = (-4.0, 8.0, 22.0)  # Pitch angles of the rays; positive is down.
NEAR_M, GOOD_M = 0.6, 3.2  # No view, a good view.
SKY_WORTH = 0.1  # Value of a ray that hits nothing.
FURNITURE_WORTH = 0.45  # More for a ray that meets furniture,
AHEAD_WORTH = 0.22  # for looking the way one goes,
WALL_COST = 0.8  # less for a wall before one's nose, within
WALL_M = 1.1
TURN_COST = 0.035  # Cost of a turn by five degrees.
MAX_TURN = 5  # Headings from one place to the next.
SAMPLE_M = 0.15  # Between places of the way at which one decides where to look.
SMOOTH_M = 0.45  # Corners are rounded so much,
TURN_SMOOTH_M = 0.5  # and turns of the head.
WALK_M_S, TURN_DEG_S = 1.0, 50.0  # One slows down to turn.
MAX_DURATION_S = 40.0  # Of a moving picture, where nobody says how many frames it has.
PITCH_DEG = 9.0  # Furniture lies lower than the eye.
OPEN_PITCH_DEG = 17.0  # Without a ceiling: a build that ends at the eye's height is below.
UPWARD_DEG, OPEN_SHARE = -20.0, 0.5  # There is no ceiling where more rays upward hit nothing.
MIN_STILL_RATE = 0.08  # Of stills, where a view is bad; 1 where it is good.
MIN_WALK_M = 0.4  # A way that is shorter is none: one turns round on the spot.


def best_headings(
    hiding: ViewBlockers,
    semantic: np.ndarray,
    eyes: np.ndarray,
    ways: np.ndarray,
    half_fov_deg: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Return a smooth sequence of yaws along a path, and the quality of each view.

    The yaws follow Minecraft's convention, in degrees, and are not wrapped. The quality is about 0
    for a near wall and 1 for a good view. Both arrays are float64 [N].

    Args:
        hiding: The cells that block the view.
        semantic: Class of each block, uint8 [X, Y, Z].
        eyes: Eye positions along the path in world blocks, float64 [N, 3].
        ways: Yaw of the path at each position in degrees, float64 [N].
        half_fov_deg: Half of the camera's horizontal field of view in degrees.
    """
    yaws_deg = np.arange(HEADINGS) * (360.0 / HEADINGS)
    far_m, cell = cast_view_rays(hiding, eyes, yaws_deg, np.array(PITCHES_DEG))
    furniture = (cell >= 0) & (semantic.reshape(-1)[cell] >= SemanticClass.CHAIR)
    worth = np.clip((far_m - NEAR_M) / (GOOD_M - NEAR_M), 0, 1)
    worth = np.where(cell < 0, SKY_WORTH, worth) + FURNITURE_WORTH * furniture
    column = worth.mean(axis=1)  # [N, HEADINGS]
    middle_m = far_m[:, 1:].min(axis=1)
    rating = _windows(column, half_fov_deg)
    rating -= WALL_COST * _windows(np.clip(1 - middle_m / WALL_M, 0, 1), half_fov_deg / 2)
    views = rating.copy()
    rating += AHEAD_WORTH * np.cos(np.radians(yaws_deg[None] - ways[:, None]))
    best = _best_sequence(rating)
    return np.degrees(np.unwrap(np.radians(yaws_deg[best]))), views[np.arange(len(best)), best]


def _windows(column: np.ndarray, half_deg: float) -> np.ndarray:
    """Return the mean over the headings within so many degrees, around the circle."""
    reach = max(1, round(half_deg / (360.0 / HEADINGS)))
    turned = [np.roll(column, step, axis=1) for step in range(-reach, reach + 1)]
    return np.mean(turned, axis=0)


def _best_sequence(rating: np.ndarray) -> np.ndarray:
    """Return the headings, int64 [N], with the highest sum of ratings less the cost of turns."""
    steps = np.arange(-MAX_TURN, MAX_TURN + 1)
    cost = TURN_COST * np.abs(steps) * (1 + np.abs(steps) / MAX_TURN)
    best = rating[0].copy()
    came = np.zeros(rating.shape, np.int64)
    every = np.arange(rating.shape[1])
    for n in range(1, len(rating)):
        # From heading h - step one comes to h.
        options = np.stack([np.roll(best, step) for step in steps]) - cost[:, None]
        choice = options.argmax(axis=0)
        came[n] = (every - steps[choice]) % rating.shape[1]
        best = options[choice, every] + rating[n]
    sequence = np.empty(len(rating), np.int64)
    sequence[-1] = best.argmax()
    for n in range(len(rating) - 1, 0, -1):
        sequence[n - 1] = came[n, sequence[n]]
    return sequence


@dataclass(frozen=True, eq=False)
class Tour:
    """The shots of a walk, the length of its path and the doors that it passes."""

    shots: list[Shot]
    length_m: float
    seconds: float
    way: np.ndarray  # float64 [N, 3], the feet along it in world blocks


def plan_tour(
    volume: BlockVolume,
    camera: Camera,
    frames: int | None,
    *,
    rate_hz: float = 24.0,
    start: tuple[float, float, float] | None = None,
) -> Tour:
    """Return a walk past positions spread over all rooms.

    Frames of an animation are evenly spaced in time, still images are denser at good views.

    Args:
        volume: The blocks. Rooms are areas with a roof and walls. Without rooms, the walk is
            outdoors.
        camera: Camera intrinsics. The field of view affects the choice of views.
        frames: Number of shots. None creates an animation of up to ``MAX_DURATION_S``.
        rate_hz: Frames per second of the animation.
        start: Start of the walk in world blocks, such as the spawn point. None starts anywhere.

    Raises:
        UsageError: If the volume has no place for a player to stand.
    """
    volume = _without_rim(_with_headroom(volume))
    hiding = view_blockers_of(volume)
    ways = WalkRoutes(volume, hiding)
    if not len(ways.feet):
        raise UsageError(
            "cannot plan a tour: the build has no place for a player to stand; try an orbit "
            "(--orbit)"
        )
    eye_blocks = eye_height_blocks(hiding.blocks_per_metre)
    feet = ways.feet[ways.way(None if start is None else np.array(start))]
    feet = _sampled(feet, SAMPLE_M * hiding.blocks_per_metre)
    eyes = _smoothed(feet, hiding, eye_blocks)
    yaws_deg, worth = _yaws_deg(eyes, hiding, volume.semantic, camera)
    length_m = _length(eyes) / hiding.blocks_per_metre
    if length_m < MIN_WALK_M:
        eyes, yaws_deg = np.repeat(eyes[:1], 73, axis=0), yaws_deg[0] + np.arange(73) * 5.0
        worth = np.ones(73)
    times = _times_s(eyes / hiding.blocks_per_metre, yaws_deg)
    columns = np.column_stack([eyes, yaws_deg, _pitches_deg(eyes, hiding)])
    moments = _moments_s(times, worth, frames, rate_hz)
    rows = np.column_stack([np.interp(moments, times, column) for column in columns.T])
    if frames is None:  # A long walk is shown faster.
        moments = np.arange(len(moments)) / rate_hz
    shots = [
        _shot(camera, row, volume.block_to_room, float(moment))
        for row, moment in zip(rows, moments, strict=True)
    ]
    return Tour(shots, length_m, float(times[-1]), feet)


def with_open_doors(volume: BlockVolume, way: np.ndarray) -> tuple[BlockVolume, int]:
    """Return the volume with all doors along a path open, and the number of these doors.

    Args:
        volume: The blocks.
        way: Feet positions along the path in world blocks, float64 [N, 3].
    """
    cells = np.floor(way - np.array(volume.corner)).astype(np.int64)
    high = int(np.ceil(2 * volume.blocks_per_metre))
    near = np.unique(cells[:, None] + [[0, dy, 0] for dy in range(-1, high)], axis=0)
    near = near.reshape(-1, 3)
    near = near[((near >= 0) & (near < volume.states.shape)).all(axis=1)]
    palette = list(volume.palette)
    open_of = {n: open_door(state) for n, state in enumerate(palette) if is_shut(state)}
    states, count = volume.states.copy(), 0
    for place in np.unique(near, axis=0):
        number = int(states[tuple(place)])
        if number not in open_of:
            continue
        if open_of[number] not in palette:
            palette.append(open_of[number])
        states[tuple(place)] = palette.index(open_of[number])
        count += "half=upper" not in open_of[number]
    return replace(volume, states=states, palette=tuple(palette)), count


def _with_headroom(volume: BlockVolume) -> BlockVolume:
    """Return the volume with air above it, so that one can stand on its top."""
    above = ((0, 0), (0, int(np.ceil(2 * volume.blocks_per_metre))), (0, 0))
    return replace(
        volume,
        states=np.pad(volume.states, above),
        semantic=np.pad(volume.semantic, above),
        instance=np.pad(volume.instance, above),
    )


def _without_rim(volume: BlockVolume) -> BlockVolume:
    """Return the volume without the invisible barriers that keep players from falling off it.

    A barrier with none above or below it stays, because it can close a hole in the floor.
    """
    names = [state.partition("[")[0] for state in volume.palette]
    barriers = [n for n, name in enumerate(names) if name == "minecraft:barrier"]
    held = np.isin(volume.states, barriers) & (volume.semantic == 0)
    padded = np.pad(held, ((0, 0), (1, 1), (0, 0)))
    states = volume.states.copy()
    states[held & (padded[:, 2:] | padded[:, :-2])] = len(volume.palette)
    return replace(volume, states=states, palette=(*volume.palette, AIR))


def _sampled(points: np.ndarray, spacing: float) -> np.ndarray:
    """Return points of a polyline at even distances, float64 [N, 3], its ends among them."""
    along = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    count = max(2, int(np.ceil(along[-1] / spacing)) + 1)
    places = np.linspace(0, along[-1], count)
    return np.column_stack([np.interp(places, along, column) for column in points.T])


def _smoothed(feet: np.ndarray, hiding: ViewBlockers, eye_blocks: float) -> np.ndarray:
    """Return the eyes over a way, rounded where that leads through nothing."""
    eyes = feet + np.array([0, eye_blocks, 0])
    sigma = SMOOTH_M / SAMPLE_M
    best = gaussian_filter1d(eyes, sigma, axis=0, mode="nearest")
    share = np.ones(len(eyes))
    for _ in range(6):
        mixed = share[:, None] * best + (1 - share[:, None]) * eyes
        bad = _too_near(mixed, hiding)
        if not bad.any():
            break
        share[bad] = 0
        share = np.minimum(share, gaussian_filter1d(share, sigma / 2, mode="nearest"))
    return share[:, None] * best + (1 - share[:, None]) * eyes


def _too_near(eyes: np.ndarray, hiding: ViewBlockers) -> np.ndarray:
    """Return which eyes are within 12 cm of a cell that hides the view, bool [N]."""
    reach = 0.12 * hiding.blocks_per_metre
    bad = np.zeros(len(eyes), bool)
    for dx in (-reach, reach):
        for dz in (-reach, reach):
            at = np.floor(eyes + np.array([dx, 0, dz]) - np.array(hiding.corner)).astype(np.int64)
            inside = ((at >= 0) & (at < hiding.hides.shape)).all(axis=1)
            safe = np.clip(at, 0, np.array(hiding.hides.shape) - 1)
            bad |= inside & hiding.hides[tuple(safe.T)]
    return bad


def _yaws_deg(
    eyes: np.ndarray, hiding: ViewBlockers, semantic: np.ndarray, camera: Camera
) -> tuple[np.ndarray, np.ndarray]:
    going = np.gradient(eyes, axis=0)
    ways = np.degrees(np.arctan2(-going[:, 0], going[:, 2]))
    half = np.degrees(np.arctan(camera.width_px / 2 / camera.fx_px))
    yaws_deg, worth = best_headings(hiding, semantic, eyes, ways, float(half))
    return gaussian_filter1d(yaws_deg, TURN_SMOOTH_M / SAMPLE_M, mode="nearest"), worth


def _pitches_deg(eyes: np.ndarray, hiding: ViewBlockers) -> np.ndarray:
    """Return a look slightly down, more where the way climbs down and less where it climbs.

    A tour without a ceiling looks lower, so that the sky does not fill the picture.
    """
    upward = cast_view_rays(hiding, eyes, np.arange(0.0, 360.0, 30.0), np.array([UPWARD_DEG]))
    level_deg = OPEN_PITCH_DEG if (upward.cell < 0).mean() > OPEN_SHARE else PITCH_DEG
    going = gaussian_filter1d(np.gradient(eyes, axis=0), 4, axis=0, mode="nearest")
    slope = np.degrees(np.arctan2(-going[:, 1], np.hypot(going[:, 0], going[:, 2]) + 1e-9))
    return np.clip(level_deg + 0.4 * slope, -15, 35)


def _times_s(eyes_m: np.ndarray, yaws_deg: np.ndarray) -> np.ndarray:
    """Return when one is at each place: as fast as walking and turning allow together."""
    walk = np.linalg.norm(np.diff(eyes_m, axis=0), axis=1) / WALK_M_S
    turn = np.abs(np.diff(yaws_deg)) / TURN_DEG_S
    return np.r_[0, np.cumsum(np.hypot(walk, turn) + 1e-6)]


def _moments_s(
    times: np.ndarray, worth: np.ndarray, frames: int | None, rate_hz: float
) -> np.ndarray:
    """Return when pictures are taken: evenly for a moving one, else more where views are good."""
    if frames is None:
        seconds = float(times[-1])
        return np.linspace(0, seconds, round(min(seconds, MAX_DURATION_S) * rate_hz) + 1)
    low, high = np.quantile(worth, (0.15, 0.6))
    good = np.clip((worth - low) / max(high - low, 1e-6), MIN_STILL_RATE, 1)
    gathered = np.r_[0, np.cumsum(np.diff(times) * (good[1:] + good[:-1]) / 2)]
    wanted = (np.arange(frames) + 0.5) / frames * gathered[-1]
    return np.interp(wanted, gathered, times)


def _length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _shot(camera: Camera, row: np.ndarray, block_to_room: np.ndarray, moment_s: float) -> Shot:
    x, y, z, yaw_deg, pitch_deg = (float(value) for value in row)
    pose = GamePose(x, y, z, (yaw_deg + 180) % 360 - 180, pitch_deg, "eye")
    return Shot(camera, pose.camera_to_room(block_to_room), moment_s)
