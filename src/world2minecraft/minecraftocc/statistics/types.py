"""The types of statistics: counts of fine classes, of scenes and of a data set."""

from collections.abc import Mapping
from dataclasses import dataclass

from world2minecraft.core.classes import CLASS_NAMES

# A fine class counts once it is seen by so many pixels of so many pictures.
MIN_PIXELS, MIN_PICTURES = 100, 3


@dataclass(frozen=True, order=True)
class FineCount:
    """How often one fine class is seen."""

    name: str  # a block's id, or "design:NAME" for a piece of furniture, whatever it is made of
    pixels: int  # over all pictures
    pictures: int  # that see it at all
    clear_pictures: int  # that see it by MIN_PIXELS or more

    @property
    def is_furniture(self) -> bool:
        """Whether it is a piece of furniture, not a block."""
        return self.name.startswith("design:")

    @property
    def is_seen_enough(self) -> bool:
        """Whether it counts as a class of the data set."""
        return self.clear_pictures >= MIN_PICTURES


@dataclass(frozen=True)
class SceneCount:
    """What one scene gives."""

    scene_id: str
    pictures: int
    voxels: int  # as the paper counts
    distinct_cells: int | None = None  # None where they were not counted
    rooms: int | None = None  # None where it is not known


@dataclass(frozen=True)
class DatasetStatistics:
    """What a data set holds.

    ``class_voxels`` counts as the paper does: over all pictures, the occupied cells of the region
    whose centres fall into the picture, [0] the empty ones among them. A cell that ten pictures
    hold counts ten times; ``distinct_cells`` counts it once.
    """

    name: str
    pictures: int
    scenes: tuple[SceneCount, ...]  # by id
    class_voxels: tuple[int, ...]  # of the 12 classes
    uncut_voxels: int  # occupied cells of the whole regions, in the frustum or not
    fine: tuple[FineCount, ...] | None  # most pixels first; None where pixels are not known
    sizes_px: Mapping[str, int]  # "640x480" to its number of pictures
    splits: Mapping[str, int]
    region: str = ""  # "60x60x36 cells of 0.08 m"

    @property
    def voxels(self) -> int:
        """Semantic voxels as the paper counts them."""
        return sum(self.class_voxels[1:])

    @property
    def rooms(self) -> int | None:
        """Rooms of all scenes; None where a scene does not tell."""
        counts = [scene.rooms for scene in self.scenes if scene.rooms is not None]
        return sum(counts) if counts and len(counts) == len(self.scenes) else None

    @property
    def distinct_cells(self) -> int | None:
        """Distinct occupied cells of all worlds that pictures hold; None if not counted."""
        counts = [scene.distinct_cells for scene in self.scenes]
        known = [count for count in counts if count is not None]
        return sum(known) if len(known) == len(counts) else None

    @property
    def voxels_per_scene(self) -> float:
        """The mean over scenes."""
        return self.voxels / len(self.scenes) if self.scenes else 0.0

    @property
    def fine_classes(self) -> int | None:
        """How many fine classes are seen enough."""
        return None if self.fine is None else sum(one.is_seen_enough for one in self.fine)

    @property
    def classes_present(self) -> tuple[str, ...]:
        """Which of the 11 classes that are not empty have a voxel."""
        named = zip(CLASS_NAMES, self.class_voxels, strict=True)
        return tuple(name for name, count in list(named)[1:] if count)

    @property
    def resolution(self) -> str:
        """The commonest size of a picture."""
        return max(sorted(self.sizes_px), key=lambda size: self.sizes_px[size], default="-")
