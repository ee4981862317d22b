"""Counters for the statistics of a data set, which process one image at a time.

Counters for parts of a data set can be merged. The distinct cells of each world are stored as one
bit per cell in blocks of 32 x 32 x 32 cells, so memory depends only on the size of the worlds, not
on the number of images.
"""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.coordinates import apply
from world2minecraft.minecraftocc.importers.imported_samples import CLASS_KINDS
from world2minecraft.minecraftocc.statistics.types import (
    MIN_PIXELS,
    DatasetStatistics,
    FineCount,
    SceneCount,
)
from world2minecraft.minecraftocc.types import FineClass, LabelRegion, OccLabels, OccSample

SIDE = 32


class WorldCells:
    """A growing set of cells of a world."""

    def __init__(self) -> None:
        self._blocks: dict[tuple[int, int, int], np.ndarray] = {}  # bits, uint8 [SIDE**3 / 8]
        self._phase: np.ndarray | None = None  # Offset of the grid, in cells.
        self._voxel_m = 0.0

    def add(self, region: LabelRegion, chosen: np.ndarray) -> None:
        """Add the selected cells of a region.

        All cells are counted on the grid of the first region. If a region is not aligned with this
        grid, each of its cells is rounded to the nearest cell of the grid.

        Args:
            region: Region of an image in this world.
            chosen: Whether to add each cell of the region, bool [X, Y, Z].

        Raises:
            ValueError: If the cell size differs from that of earlier regions.
        """
        places = np.argwhere(chosen)
        if not len(places):
            return
        centers = apply(region.region_to_room, (places + 0.5) * region.voxel_m) / region.voxel_m
        phase = self._phase
        if phase is None:
            phase, self._voxel_m = centers[0] - np.floor(centers[0]), region.voxel_m
            self._phase = phase
        _check_size(region.voxel_m, self._voxel_m)
        self._add_cells(np.rint(centers - phase).astype(np.int64))

    def _add_cells(self, cells: np.ndarray) -> None:
        """Add cells of this set's grid, int64 [N, 3]."""
        low, high = cells.min(axis=0) // SIDE, cells.max(axis=0) // SIDE + 1
        flags = np.zeros((high - low) * SIDE, np.bool_)
        flags[tuple((cells - low * SIDE).T)] = True
        for at in np.ndindex(*(high - low)):
            part = flags[tuple(slice(SIDE * n, SIDE * (n + 1)) for n in at)]
            if part.any():
                self._put((int(low[0]) + at[0], int(low[1]) + at[1], int(low[2]) + at[2]), part)

    def merge(self, other: "WorldCells") -> None:
        """Add the cells of another set for the same world.

        If the grids are not aligned, each cell of the other set is rounded to the nearest cell of
        this one.

        Raises:
            ValueError: If the cell sizes differ.
        """
        if other._phase is None:
            return
        if self._phase is None:
            self._phase, self._voxel_m = other._phase, other._voxel_m
        _check_size(other._voxel_m, self._voxel_m)
        steps = np.rint(other._phase - self._phase).astype(np.int64)
        for key, bits in other._blocks.items():
            if not steps.any():
                self._join(key, bits)
                continue
            places = np.argwhere(np.unpackbits(bits).reshape(SIDE, SIDE, SIDE))
            self._add_cells(places + np.array(key) * SIDE + steps)

    def count(self) -> int:
        """Return the number of distinct cells."""
        return sum(int(np.bitwise_count(bits).sum()) for bits in self._blocks.values())

    def _put(self, key: tuple[int, int, int], flags: np.ndarray) -> None:
        self._join(key, np.packbits(flags))

    def _join(self, key: tuple[int, int, int], bits: np.ndarray) -> None:
        existing = self._blocks.get(key)
        self._blocks[key] = bits.copy() if existing is None else existing | bits


def _check_size(voxel_m: float, own_m: float) -> None:
    if abs(voxel_m - own_m) > 1e-9:
        raise ValueError(
            f"all cells of a world must have the same size, got {own_m} m and {voxel_m} m"
        )


@dataclass(frozen=True, eq=False)
class PictureCounts:
    """The counts for one image.

    Attributes:
        scene_id: Name of the scene.
        split: Split of the image.
        size_px: Image size, such as ``640x480``.
        region: Description of the region.
        class_voxels: Number of cells of each class in the frustum, int64 [12].
        uncut_voxels: Number of occupied cells in the whole region.
        fine_pixels: Number of pixels of each fine class by name, or None if unknown.
        room: Number of the room in the scene, if the sample states it.
    """

    scene_id: str
    split: str
    size_px: str
    region: str
    class_voxels: np.ndarray
    uncut_voxels: int
    fine_pixels: Mapping[str, int] | None
    room: int | None = None


def picture_counts(sample: OccSample) -> PictureCounts:
    """Compute the counts for the image of a sample from its labels."""
    return PictureCounts(
        sample.scene_id,
        sample.split,
        f"{sample.camera.width_px}x{sample.camera.height_px}",
        region_text(sample.occ.region.shape, sample.occ.region.voxel_m),
        class_voxels(sample.occ),
        int(np.count_nonzero(sample.occ.occupied)),
        fine_pixels(sample.occ, sample.fine_classes),
        room if isinstance(room := sample.facts.get("room"), int) else None,
    )


def class_voxels(occ: OccLabels) -> np.ndarray:
    """Return the number of cells of each class in the frustum, int64 [12], except unknown cells."""
    return np.bincount(occ.labels[occ.in_frustum], minlength=UNKNOWN + 1)[:CLASS_COUNT]


def fine_pixels(occ: OccLabels, classes: tuple[FineClass, ...]) -> dict[str, int] | None:
    """Return the number of pixels that see each fine class, without empty cells.

    Returns None if the fine classes are only the 12 classes, as in imported data sets.
    """
    if set(classes) <= set(CLASS_KINDS):
        return None
    seen = np.bincount(occ.fine[occ.visible], weights=occ.hits[occ.visible], minlength=len(classes))
    pixels: Counter[str] = Counter()
    for number in np.flatnonzero(seen):
        if number:
            pixels[classes[number].name] += int(seen[number])
    return dict(pixels)


def region_text(shape: Iterable[int], voxel_m: float) -> str:
    """Return a description of a region for the user.

    Example:
        >>> region_text((60, 60, 36), 0.08)
        '60x60x36 cells of 0.08 m'
    """
    return f"{'x'.join(map(str, shape))} cells of {voxel_m:g} m"


@dataclass
class _FineSums:
    pixels: int = 0
    pictures: int = 0
    clear: int = 0


@dataclass
class _SceneSums:
    pictures: int = 0
    voxels: int = 0
    rooms: int | None = None  # As stated for the scene.
    rooms_seen: set[int | None] = field(default_factory=set)  # As stated by its images.

    def count_rooms(self) -> int | None:
        """Return the stated number of rooms, else the number of rooms stated by images."""
        if self.rooms is not None or None in self.rooms_seen:
            return self.rooms
        return len(self.rooms_seen)


@dataclass
class StatisticsCounter:
    """Running totals over the images of a data set."""

    pictures: int = 0
    uncut_voxels: int = 0
    class_voxels: np.ndarray = field(default_factory=lambda: np.zeros(CLASS_COUNT, np.int64))
    _scenes: dict[str, _SceneSums] = field(default_factory=lambda: defaultdict(_SceneSums))
    _cells: dict[str, WorldCells] = field(default_factory=lambda: defaultdict(WorldCells))
    _fine: dict[str, _FineSums] = field(default_factory=lambda: defaultdict(_FineSums))
    _without_fine: int = 0
    _sizes: Counter[str] = field(default_factory=Counter)
    _splits: Counter[str] = field(default_factory=Counter)
    _regions: Counter[str] = field(default_factory=Counter)

    def add(self, counts: PictureCounts) -> None:
        """Add the counts for one image."""
        self.pictures += 1
        self.uncut_voxels += counts.uncut_voxels
        self.class_voxels += counts.class_voxels
        scene = self._scenes[counts.scene_id]
        scene.pictures += 1
        scene.voxels += int(counts.class_voxels[1:].sum())
        scene.rooms_seen.add(counts.room)
        self._sizes[counts.size_px] += 1
        self._splits[counts.split or "none"] += 1
        self._regions[counts.region] += 1
        self._without_fine += counts.fine_pixels is None
        for name, pixels in (counts.fine_pixels or {}).items():
            fine = self._fine[name]
            fine.pixels += pixels
            fine.pictures += 1
            fine.clear += pixels >= MIN_PIXELS

    def add_cells(self, scene_id: str, occ: OccLabels) -> None:
        """Add the occupied cells in the frustum of an image to the distinct cells of its world."""
        self._cells[scene_id].add(occ.region, occ.occupied & occ.in_frustum)

    def set_rooms(self, scene_id: str, rooms: int) -> None:
        """Set the number of rooms in a scene. Scenes without images are ignored."""
        if scene_id in self._scenes:
            self._scenes[scene_id].rooms = rooms

    def merge(self, other: "StatisticsCounter") -> None:
        """Add the totals of another counter for the same data set."""
        self.pictures += other.pictures
        self.uncut_voxels += other.uncut_voxels
        self.class_voxels += other.class_voxels
        for name, theirs in other._scenes.items():
            ours = self._scenes[name]
            ours.pictures += theirs.pictures
            ours.voxels += theirs.voxels
            ours.rooms = theirs.rooms if ours.rooms is None else ours.rooms
            ours.rooms_seen |= theirs.rooms_seen
        for name, cells in other._cells.items():
            self._cells[name].merge(cells)
        for name, fine in other._fine.items():
            ours_fine = self._fine[name]
            ours_fine.pixels += fine.pixels
            ours_fine.pictures += fine.pictures
            ours_fine.clear += fine.clear
        self._without_fine += other._without_fine
        self._sizes += other._sizes
        self._splits += other._splits
        self._regions += other._regions

    def result(self, name: str) -> DatasetStatistics:
        """Return the statistics of all images added so far, with the name of the data set."""
        scenes = (self._scene(key) for key in sorted(self._scenes))
        return DatasetStatistics(
            name,
            self.pictures,
            tuple(scenes),
            tuple(int(count) for count in self.class_voxels),
            self.uncut_voxels,
            None if self._without_fine else self._fine_counts(),
            dict(sorted(self._sizes.items())),
            dict(sorted(self._splits.items())),
            ", ".join(sorted(self._regions)),
        )

    def _scene(self, key: str) -> SceneCount:
        sums = self._scenes[key]
        cells = self._cells[key].count() if key in self._cells else None
        return SceneCount(key, sums.pictures, sums.voxels, cells, sums.count_rooms())

    def _fine_counts(self) -> tuple[FineCount, ...]:
        counts = (
            FineCount(name, one.pixels, one.pictures, one.clear) for name, one in self._fine.items()
        )
        return tuple(sorted(counts, key=lambda one: (-one.pixels, one.name)))


def add_sample(counter: StatisticsCounter, sample: OccSample) -> None:
    """Add the counts and the distinct cells of a sample to a counter."""
    counter.add(picture_counts(sample))
    counter.add_cells(sample.scene_id, sample.occ)


def count_samples(samples: Iterable[OccSample]) -> StatisticsCounter:
    """Count samples of any data set one at a time, including their distinct cells."""
    counter = StatisticsCounter()
    for sample in samples:
        add_sample(counter, sample)
    return counter
