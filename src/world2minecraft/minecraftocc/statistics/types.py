"""Data types for the statistics of fine classes, scenes and data sets."""

from collections.abc import Mapping
from dataclasses import dataclass

from world2minecraft.core.classes import CLASS_NAMES

# A fine class is counted if at least this many pixels see it in at least this many images.
MIN_PIXELS, MIN_PICTURES = 100, 3


@dataclass(frozen=True, order=True)
class FineCount:
    """How often a fine class is seen in the images of a data set.

    Attributes:
        name: Block id, or ``design:NAME`` for a piece of furniture, whatever its blocks.
        pixels: Number of pixels in all images.
        pictures: Number of images in which the class is seen.
        clear_pictures: Number of images in which at least ``MIN_PIXELS`` pixels see the class.
    """

    name: str
    pixels: int
    pictures: int
    clear_pictures: int

    @property
    def is_furniture(self) -> bool:
        """Whether the fine class is a piece of furniture instead of a block."""
        return self.name.startswith("design:")

    @property
    def is_seen_enough(self) -> bool:
        """Whether the fine class is seen often enough to be counted as a class of the data set."""
        return self.clear_pictures >= MIN_PICTURES


@dataclass(frozen=True)
class SceneCount:
    """The counts for one scene.

    Attributes:
        scene_id: Name of the scene.
        pictures: Number of images.
        voxels: Number of semantic voxels, counted as in the paper.
        distinct_cells: Number of distinct occupied cells, or None if not counted.
        rooms: Number of rooms, or None if unknown.
    """

    scene_id: str
    pictures: int
    voxels: int
    distinct_cells: int | None = None
    rooms: int | None = None


@dataclass(frozen=True)
class DatasetStatistics:
    """The statistics of a data set.

    Attributes:
        name: Name of the data set.
        pictures: Number of images.
        scenes: Counts for each scene, sorted by name.
        class_voxels: Number of cells of each of the 12 classes, counted as in the paper: cells of
            the region whose centres are inside the image, added up over all images. A cell in ten
            images is counted ten times; ``distinct_cells`` counts it once.
        uncut_voxels: Number of occupied cells in the complete regions.
        fine: Counts for each fine class in descending order of pixels, or None if unknown.
        sizes_px: Number of images of each size, such as ``640x480``.
        splits: Number of images in each split.
        region: Description of the region, such as ``60x60x36 cells of 0.08 m``.
    """

    name: str
    pictures: int
    scenes: tuple[SceneCount, ...]
    class_voxels: tuple[int, ...]
    uncut_voxels: int
    fine: tuple[FineCount, ...] | None
    sizes_px: Mapping[str, int]
    splits: Mapping[str, int]
    region: str = ""

    @property
    def voxels(self) -> int:
        """Number of semantic voxels, counted as in the paper."""
        return sum(self.class_voxels[1:])

    @property
    def rooms(self) -> int | None:
        """Number of rooms in all scenes, or None if unknown for a scene."""
        counts = [scene.rooms for scene in self.scenes if scene.rooms is not None]
        return sum(counts) if counts and len(counts) == len(self.scenes) else None

    @property
    def distinct_cells(self) -> int | None:
        """Number of distinct occupied cells in the images of all worlds, or None if not counted."""
        counts = [scene.distinct_cells for scene in self.scenes]
        known = [count for count in counts if count is not None]
        return sum(known) if len(known) == len(counts) else None

    @property
    def voxels_per_scene(self) -> float:
        """Mean number of semantic voxels per scene."""
        return self.voxels / len(self.scenes) if self.scenes else 0.0

    @property
    def fine_classes(self) -> int | None:
        """Number of fine classes that are seen often enough, or None if unknown."""
        return None if self.fine is None else sum(one.is_seen_enough for one in self.fine)

    @property
    def classes_present(self) -> tuple[str, ...]:
        """Names of the occupied classes that have at least one voxel."""
        named = zip(CLASS_NAMES, self.class_voxels, strict=True)
        return tuple(name for name, count in list(named)[1:] if count)

    @property
    def resolution(self) -> str:
        """The most frequent image size."""
        return max(sorted(self.sizes_px), key=lambda size: self.sizes_px[size], default="-")
