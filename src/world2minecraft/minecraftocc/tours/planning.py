"""Planning of views for a volume: walks through all rooms, and the useful views on them.

Each room is visited by repeated walks. Good views of a walk that differ from earlier views are
kept.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.coordinates import PLAYER_EYE_BLOCKS
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.physics.walk_graph import (
    SLIM,
    CollisionGrid,
    WalkGraph,
    WalkRule,
    collision_grid,
    walk_graph,
)
from world2minecraft.minecraftocc.tours.headings import (
    best_yaws,
    draw_kinds,
    rate_headings,
    repetition_penalty,
    smooth_noise,
)
from world2minecraft.minecraftocc.tours.rooms import TourRoom, find_rooms, share_views
from world2minecraft.minecraftocc.tours.types import KINDS, PlannedView, TourRule, kind_of_yaw
from world2minecraft.minecraftocc.tours.view_quality import assess_views
from world2minecraft.minecraftocc.tours.walks import SAMPLE_M, WalkArea, plan_walk
from world2minecraft.rendering.scene import BlockScene, prepare_scene
from world2minecraft.rendering.views.cameras import GamePose

WALK_M_S, TURN_DEG_S = 1.0, 60.0  # Walking and turning speed between two frames.
GAP_M, GAP_DEG = 1.2, 75.0  # A tour ends if the next good view is farther away than this.
MIN_FRAMES = 3  # Of a tour, if at least as many are missing.
MAX_SPACING_M = 0.6  # Between frames.
OVERSAMPLING = 1.5  # Assessed views per missing view.
MAX_FRUITLESS_WALKS = 8  # Walks in a row without a new view after which a room is done.
EASING_FACTOR = 0.7  # By which the minimum distance between views is then multiplied.
PLANE_EASING = 0.05  # By which the maximum share of a plane is then increased.
MAX_EASINGS = 4
PITCH_MEAN_DEG, PITCH_SPREAD_DEG = 11.0, 8.0  # Furniture is lower than the eye.
SWAY_M = 0.04  # Variation of the eye height along a walk.
DECIMALS = 6  # Of poses, so that a tour file contains exactly the planned views.
MIN_FLOOR_M2 = 1.0  # Of all rooms; with less, a slimmer body is tried.


@dataclass(eq=False)
class YawKindCounts:
    """Number of views of each kind of yaw in a plan."""

    counts: np.ndarray = field(default_factory=lambda: np.zeros(len(KINDS)))

    def missing(self, rule: TourRule, more: int) -> np.ndarray:
        """Return how many views of each kind are missing if ``more`` are added, float64 [3]."""
        shares = np.array(rule.yaw_shares) / sum(rule.yaw_shares)
        return shares * (self.counts.sum() + more) - self.counts

    def add(self, yaws_deg: np.ndarray) -> None:
        """Count the kinds of the given yaws."""
        for yaw_deg in yaws_deg:
            self.counts[KINDS.index(kind_of_yaw(float(yaw_deg)))] += 1


@dataclass(eq=False)
class _ChosenViews:
    """The views of a room chosen so far."""

    poses: list[np.ndarray] = field(default_factory=list)  # [N, 5]: x, y, z, yaw, pitch

    def are_new(self, rows: np.ndarray, apart_blocks: float, apart_deg: float) -> np.ndarray:
        """Return whether each row, float64 [N, 5], differs from chosen views and earlier rows."""
        known = np.concatenate([*self.poses, rows]) if self.poses else rows
        first = len(known) - len(rows)
        result = np.ones(len(rows), bool)
        for n, row in enumerate(rows):
            others = known[: first + n]
            if first + n == 0:
                continue
            near = np.abs(others[:, :3] - row[:3]).max(axis=1) < apart_blocks
            turn = np.abs((others[:, 3] - row[3] + 180) % 360 - 180)
            alike = near & (turn < apart_deg) & (np.abs(others[:, 4] - row[4]) < apart_deg)
            alike[first:] &= result[:n]
            result[n] = not alike.any()
        return result


@dataclass(eq=False)
class RoomTour:
    """The tour of a room: repeated walks, and the good new views of each walk."""

    volume: BlockVolume
    scene: BlockScene
    room: TourRoom
    area: WalkArea
    rule: TourRule
    seed: int
    kinds: YawKindCounts
    is_done: bool = False
    taken: _ChosenViews = field(default_factory=_ChosenViews)
    tours: list[np.ndarray] = field(default_factory=list)  # [N, 6]: a pose, and seconds
    walks: int = 0
    eased: int = 0  # How often the requirements for a view were relaxed,
    nearer: int = 0  # and those for the distance between views.

    @property
    def count(self) -> int:
        """Number of views found."""
        return sum(map(len, self.tours))

    def find(self, more: int) -> None:
        """Find ``more`` further views, or fewer if the room has no more different views.

        If a room has no good view, its requirements are relaxed and a few views are planned.
        """
        wanted, vain = self.count + more, 0
        while self.count < wanted and not self.is_done:
            before = self.count
            self._walk(wanted - self.count)
            vain = 0 if self.count > before else vain + 1
            if vain == MAX_FRUITLESS_WALKS:
                self.is_done = self.count > 0 or self.eased == MAX_EASINGS
                self.eased, vain = self.eased + (not self.is_done), 0
                wanted = min(wanted, MIN_FRAMES)
        self.is_done |= wanted < more

    def ease(self, times: int) -> None:
        """Allow views that are nearer to each other, flatter and emptier."""
        self.eased, self.nearer, self.is_done = max(self.eased, times), times, False

    def views(self) -> Iterator[PlannedView]:
        """Yield the views found, in order."""
        for number, tour in enumerate(self.tours):
            for frame, row in enumerate(tour):
                x, y, z, yaw_deg, pitch_deg, t_s = (float(value) for value in row)
                pose = GamePose(x, y, z, yaw_deg, pitch_deg, "eye")
                yield PlannedView(
                    f"r{self.room.number:02d}t{number:03d}",
                    frame,
                    self.rule.camera,
                    pose.camera_to_room(self.volume.block_to_room),
                    pose,
                    t_s,
                    self.room.number,
                )

    def _walk(self, wanted: int) -> None:
        """Plan a walk and keep its good new views."""
        rng = np.random.default_rng([self.seed, self.room.number, self.walks])
        self.walks += 1
        rows = self._poses(wanted, rng)
        poses = np.array([self._camera_to_room(row) for row in rows])
        seen = assess_views(self.scene, self.volume, poses, self.rule)
        ease = EASING_FACTOR**self.nearer
        plane = self.rule.max_plane_share + PLANE_EASING * self.eased
        things = self.rule.min_things - self.eased
        good = np.flatnonzero(seen.is_good(self.volume, plane, things))
        min_distance = self.rule.apart_m * self.volume.blocks_per_metre * ease
        good = good[self.taken.are_new(rows[good], min_distance, self.rule.apart_deg * ease)]
        for found in self._split_tours(rows[good], min(MIN_FRAMES, wanted)):
            tour = found[:wanted]
            wanted -= len(tour)
            if len(tour):
                self.tours.append(np.column_stack([tour, self._times_s(tour)]))
                self.taken.poses.append(tour)
                self.kinds.add(tour[:, 3])

    def _poses(self, wanted: int, rng: np.random.Generator) -> np.ndarray:
        """Return the poses along a walk, float64 [N, 5]: eye x, y, z, yaw and pitch."""
        rule = self.rule
        way = plan_walk(self.area, rng)
        spacing_m = len(way) * SAMPLE_M / (OVERSAMPLING * wanted)
        every = max(1, round(float(np.clip(spacing_m, rule.spacing_m, MAX_SPACING_M)) / SAMPLE_M))
        feet, spacing_m = way[int(rng.integers(every)) % len(way) :: every], every * SAMPLE_M
        eyes = feet.copy()
        eyes[:, 1] += self._eyes_m(len(feet), spacing_m, rng) * self.volume.blocks_per_metre
        kinds = draw_kinds(len(feet), spacing_m, self.kinds.missing(rule, len(feet)), rng)
        rated = rate_headings(self.scene, eyes, self.volume.block_to_room, rule)
        if self.taken.poses:
            taken = np.concatenate(self.taken.poses)
            rated = rated - repetition_penalty(eyes, taken, self.volume.blocks_per_metre)
        yaws = best_yaws(rated, kinds, spacing_m, rng)
        pitch = rng.normal(PITCH_MEAN_DEG, PITCH_SPREAD_DEG / 2)
        pitch = pitch + PITCH_SPREAD_DEG * smooth_noise(len(feet), spacing_m, rng)
        pitch = np.clip(pitch, *rule.pitch_deg)
        return np.round(np.column_stack([eyes, yaws, pitch]), DECIMALS) + 0.0

    def _eyes_m(self, count: int, spacing_m: float, rng: np.random.Generator) -> np.ndarray:
        """Return the height of the eye above the feet along a walk, float64 [N]."""
        if rng.random() < self.rule.player_share:
            return np.full(count, PLAYER_EYE_BLOCKS)
        high_m = rng.uniform(*self.rule.eye_m) + SWAY_M * smooth_noise(count, spacing_m, rng)
        return np.clip(high_m, *self.rule.eye_m)

    def _camera_to_room(self, row: np.ndarray) -> np.ndarray:
        pose = GamePose(*(float(value) for value in row), at="eye")
        return pose.camera_to_room(self.volume.block_to_room)

    def _split_tours(self, rows: np.ndarray, min_frames: int) -> list[np.ndarray]:
        """Split views into tours without jumps, omitting tours with too few frames."""
        if not len(rows):
            return []
        step_m = np.linalg.norm(np.diff(rows[:, :3], axis=0), axis=1) / (
            self.volume.blocks_per_metre
        )
        turn = np.abs((np.diff(rows[:, 3]) + 180) % 360 - 180)
        cuts = np.flatnonzero((step_m > GAP_M) | (turn > GAP_DEG)) + 1
        return [part for part in np.split(rows, cuts) if len(part) >= min_frames]

    def _times_s(self, tour: np.ndarray) -> np.ndarray:
        """Return the time of each frame, based on walking and turning speed."""
        walk = np.linalg.norm(np.diff(tour[:, :3], axis=0), axis=1) / (
            self.volume.blocks_per_metre * WALK_M_S
        )
        turn = np.abs((np.diff(tour[:, 3]) + 180) % 360 - 180) / TURN_DEG_S
        return np.round(np.r_[0, np.cumsum(np.hypot(walk, turn))], DECIMALS)


def plan_views(
    volume: BlockVolume,
    count: int,
    seed: int = 0,
    rule: TourRule | None = None,
    *,
    scene: BlockScene | None = None,
    progress: Progress = no_progress,
) -> list[PlannedView]:
    """Plan views of the rooms in a volume, grouped by tour.

    The result depends only on the arguments and the seed. It contains fewer views than requested if
    the rooms do not have enough different views.

    Args:
        volume: Blocks with their classes.
        count: Number of views.
        seed: Random seed, 0 or more.
        rule: Tour settings, including the camera.
        scene: Result of ``prepare_scene`` for the volume, if already available.
        progress: Callback that reports the number of views found.

    Raises:
        UsageError: If the count is below 1, or if the volume has no place for a person to stand.
    """
    how = rule or TourRule()
    if count < 1:
        raise UsageError(f"the number of views must be 1 or more, got {count}")
    solid = collision_grid(volume)
    graph, rooms = _rooms(volume, solid, how)
    ready, kinds = scene or prepare_scene(volume), YawKindCounts()
    tours = []
    for room in rooms:
        area = WalkArea(graph.part(room.places), solid, volume.corner)
        tours.append(RoomTour(volume, ready, room, area, how, seed, kinds))
    _fill(tours, count, progress)
    return [view for tour in tours for view in tour.views()]


def _rooms(
    volume: BlockVolume, solid: CollisionGrid, rule: TourRule
) -> tuple[WalkGraph, list[TourRoom]]:
    """Return the walk graph and the rooms of a volume, for a slimmer body if necessary.

    A cluttered scan may have no floor that is wide enough for a person, although a camera fits.
    """
    for slim in (1.0, SLIM):
        graph = walk_graph(volume, WalkRule(scale=slim * volume.blocks_per_metre))
        rooms = find_rooms(volume, graph, solid, rule)
        if sum(room.floor_m2 for room in rooms) >= MIN_FLOOR_M2 or (rooms and slim < 1):
            return graph, rooms
    raise UsageError("cannot plan views: this world has no place for a person to stand")


def _fill(tours: list[RoomTour], count: int, progress: Progress) -> None:
    """Find the views of all rooms, passing on the shares that a room cannot provide.

    If all rooms together cannot provide enough, the requirements for the views are relaxed.
    """
    progress("views", 0, count)
    left, eased = count, 0
    while left > 0:
        open_ones = [one for one in tours if not one.is_done]
        if not open_ones:
            eased += 1
            if not tours or eased > MAX_EASINGS:
                break
            for one in tours:
                one.ease(eased)
            continue
        for one, share in zip(
            open_ones, share_views([t.room for t in open_ones], left), strict=True
        ):
            one.find(share)
            progress("views", min(count, sum(t.count for t in tours)), count)
        left = count - sum(one.count for one in tours)
    progress("views", count, count)
