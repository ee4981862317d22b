"""Windows, doors and doorways in the walls.

Glass seldom has depth, and then appears some centimetres behind the wall, as does a door leaf. Such
a recess that begins above the floor is a window; one that reaches the floor is a door leaf, class
objs. Openings are also found where rays passed through the wall: a window without glass, or a
doorway down to the floor.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import binary_opening, dilate
from world2minecraft.reconstruction.layout.parameters import StructureParameters, within
from world2minecraft.reconstruction.layout.plane_residuals import PlaneResiduals, noise_of
from world2minecraft.reconstruction.layout.surface_cells import Surface

Kind = Literal["window", "door", "doorway"]
BEND_M = 0.32  # Bends are wider than this to both sides.
MAX_BEND_M = 0.1
STRAIGHT_M = 0.03  # A wall that bends by less is straight.
MAX_NOISE_M = 0.12  # A cell and a half.
BAR_M = 0.02  # The bars of a window lie before its glass.
STEP_M = 0.012  # Objects on a wall or recessed in it have an edge; a bend has none.
CLASS_OF_KIND = {"window": SemanticClass.WINDOW, "door": SemanticClass.OBJS}


@dataclass(frozen=True)
class Gap:
    """An opening of a wall, in metres along the wall and above the floor."""

    kind: Kind
    along_m: tuple[float, float]
    height_m: tuple[float, float]


@dataclass(frozen=True, eq=False)
class WallFace:
    """The class and depth of each position of a wall face, and the openings in it."""

    classes: np.ndarray  # uint8 [A, B]: wall, window, or objs for the leaf of a door
    depth_m: np.ndarray  # float [A, B]: how deep it lies, along the relief's axis 0
    cells: np.ndarray  # bool [N, A, B]: those of the relief's cells that lie there
    gaps: tuple[Gap, ...]


def read_wall(
    surface: Surface, relief: PlaneResiduals, parameters: StructureParameters
) -> WallFace:
    """Classify the positions of a wall face and find the openings in it."""
    face = _Face(surface, relief, parameters)
    outward_m = relief.sign * relief.of(surface.points_m[..., relief.axis])
    off_m = np.abs(outward_m - relief.plane_m - face.bend_m)
    noise_m = _noise_m(off_m[relief.cells], parameters)
    low, high = parameters.opening_depth_m
    # Noise is as deep before the wall as behind it, where openings are.
    raised_m = -relief.gap_m[relief.seen & (relief.gap_m < 0)]
    rough_m = _noise_m(raised_m, parameters)
    if rough_m <= high / 2:
        face.cut(relief.seen & _between(relief.gap_m, max(low, rough_m), high))
        if rough_m <= parameters.noise_m:
            face.cut_leaves()
            face.hang(relief.seen & _between(relief.gap_m, *parameters.hung_m))
    face.pass_through(_passed(surface, relief))
    near = (np.abs(outward_m - face.depth_m) <= noise_m) | (off_m <= noise_m)
    return WallFace(face.classes, face.depth_m, relief.cells & near, tuple(face.gaps))


def _noise_m(off_m: np.ndarray, parameters: StructureParameters) -> float:
    """Return how far the cells of a wall may be from it, given their distances, float [N].

    A wall seen from afar is a thick band of cells, of which all are the wall.
    """
    return float(np.clip(noise_of(off_m), parameters.noise_m, MAX_NOISE_M))


def _bend(surface: Surface, relief: PlaneResiduals) -> np.ndarray:
    """Return the distance of the wall around each position from its plane, float [A, B].

    Lens and sensor bend a long wall by some centimetres. A median follows this bend, but not the
    edge of a curtain or a shelf board.
    """
    gap_m = np.where(relief.seen, relief.gap_m, 0.0)
    bend = ndimage.median_filter(gap_m, 2 * surface.cells_of(BEND_M) + 1, mode="nearest")
    return np.clip(bend, -MAX_BEND_M, MAX_BEND_M)


class _Face:
    """A wall during classification; each step handles the positions not yet classified."""

    def __init__(self, surface: Surface, relief: PlaneResiduals, parameters: StructureParameters):
        self.surface, self.relief, self.parameters = surface, relief, parameters
        self.classes = np.full(relief.weight.shape, SemanticClass.WALL, np.uint8)
        self.bend_m = _bend(surface, relief)
        strong = np.abs(self.bend_m) >= STRAIGHT_M
        self.depth_m = relief.plane_m + np.where(strong, self.bend_m, 0.0)
        self.plane = relief.seen & (np.abs(relief.gap_m) < parameters.opening_depth_m[0])
        self.gaps: list[Gap] = []

    def cut(self, recessed: np.ndarray) -> None:
        """Classify windows and door leaves that are well behind the face of the wall."""
        for part in _parts(binary_opening(_bridged(recessed) & self.relief.seen)):
            kind = _kind(part, self._metres(part), self.surface.voxel_m, self.parameters)
            if kind is None or _framed(part, self.plane) < self.parameters.frame_share:
                continue
            depth = float(np.median(self.relief.gap_m[part]))
            # The rim of an opening is a mean of both depths.
            whole = part | (dilate(part) & self.relief.seen & (self.relief.gap_m >= depth / 2))
            self._claim(whole, CLASS_OF_KIND[kind], depth)
            self._add_gap(kind, whole)

    def cut_leaves(self) -> None:
        """Classify door leaves that are almost flush with the wall but differ in colour."""
        relief, parameters = self.relief, self.parameters
        gap = ndimage.median_filter(relief.gap_m, 3)
        inside = relief.seen & (self.classes == SemanticClass.WALL)
        leaf = inside & (gap >= parameters.leaf_depth_m) & (gap < parameters.opening_depth_m[0])
        for part in _parts(binary_opening(leaf)):
            along, height = self._metres(part)
            wide = within(along[1] - along[0], parameters.leaf_width_m)
            high = within(height[1], parameters.leaf_height_m) and height[0] <= 0.4
            flat = part.sum() >= 0.6 * _box_cells(part)
            if wide and high and flat and self._has_edge(part):
                self._claim(part, SemanticClass.OBJS, float(np.median(relief.gap_m[part])))
                self._add_gap("door", part)

    def hang(self, raised: np.ndarray) -> None:
        """Classify flat objects on the wall, such as pictures, boards and mirrors."""
        for part in _parts(binary_opening(raised & (self.classes == SemanticClass.WALL))):
            large = part.sum() * self.surface.voxel_m**2 >= self.parameters.hung_area_m2
            flat = part.sum() >= 0.6 * _box_cells(part)
            if large and flat and self._has_edge(part):
                depth = float(np.median(self.relief.gap_m[part]))
                rim = dilate(part) & self.relief.seen & (self.relief.gap_m <= depth / 2)
                self._claim(part | rim, SemanticClass.OBJS, depth)

    def pass_through(self, passed: np.ndarray) -> None:
        """Record the openings through which rays passed."""
        for part in _parts(binary_opening(passed)):
            kind = _kind(part, self._metres(part), self.surface.voxel_m, self.parameters)
            if kind is not None and _framed(part, self.plane) >= self.parameters.frame_share:
                self._add_gap("doorway" if kind == "door" else kind, part)

    def _has_edge(self, part: np.ndarray) -> bool:
        """Return whether the depth changes abruptly around most of the seen border of a part."""
        gap_m = self.relief.gap_m
        ring = dilate(part, 2) & ~dilate(part) & self.relief.seen
        depth = np.median(gap_m[part])
        step = np.sign(depth) * (depth - gap_m[ring]) >= STEP_M
        return bool(ring.sum() >= 0.4 * part.sum() ** 0.5 and step.mean() >= 0.6)

    def _claim(self, places: np.ndarray, kind: SemanticClass, gap_m: float) -> None:
        """Set the class and depth of positions, except for the bars of a window."""
        relief = self.relief
        depth_m = np.where(np.abs(relief.gap_m - gap_m) <= BAR_M, gap_m, relief.gap_m)
        self.classes[places] = kind
        self.depth_m[places] = (relief.plane_m + depth_m)[places]

    def _add_gap(self, kind: Kind, part: np.ndarray) -> None:
        along, height = self._metres(part)
        low = 0.0 if kind != "window" else height[0]
        self.gaps.append(Gap(kind, along, (low, height[1])))

    def _metres(self, part: np.ndarray) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the range of a part along the wall and above the floor."""
        relief, voxel_m = self.relief, self.surface.voxel_m
        corner = self.surface.origin_m[1 - relief.axis] + relief.box[1].start * voxel_m
        bottom = self.surface.origin_m[2] + relief.box[2].start * voxel_m
        a, b = np.nonzero(part)
        along = (float(corner + a.min() * voxel_m), float(corner + (a.max() + 1) * voxel_m))
        low, high = bottom + b.min() * voxel_m, bottom + (b.max() + 1) * voxel_m
        return along, (float(max(low, 0.0)), float(high))


def _parts(mask: np.ndarray) -> list[np.ndarray]:
    parts, count = label_components(mask)
    return [parts == number for number in range(1, count + 1)]


def _bridged(mask: np.ndarray) -> np.ndarray:
    """Return a mask with parts connected across the bars of a window."""
    result = mask
    for shape in ((4, 1), (1, 4)):
        padded = np.pad(mask, 4)
        closed = np.asarray(ndimage.binary_closing(padded, np.ones(shape, bool)), bool)
        result = result | closed[4:-4, 4:-4]
    return result


def _box_cells(part: np.ndarray) -> int:
    """Return the number of positions in the bounding box of a part."""
    a, b = np.nonzero(part)
    return int((np.ptp(a) + 1) * (np.ptp(b) + 1))


def _between(values: np.ndarray, low: float, high: float) -> np.ndarray:
    """Return the mask of values within bounds, inclusive."""
    return (values >= low) & (values <= high)


def _passed(surface: Surface, relief: PlaneResiduals) -> np.ndarray:
    """Return the mask of positions at which rays passed an unseen wall, bool [A, B]."""
    free = relief.of(surface.free)
    edge_m = relief.edge_m(surface)
    layer = np.floor((relief.plane_m - edge_m) / surface.voxel_m).astype(int)
    layers = np.arange(free.shape[0])[:, None, None]
    through = [(free & (layers == layer + step)).any(axis=0) for step in (0, 1)]
    return through[0] & through[1] & ~relief.seen


def _kind(
    part: np.ndarray,
    metres: tuple[tuple[float, float], tuple[float, float]],
    voxel_m: float,
    parameters: StructureParameters,
) -> Literal["window", "door"] | None:
    """Return the kind of an opening, or None if it is too small or irregular."""
    (left, right), (bottom, top) = metres
    width, height = right - left, top - bottom
    if part.sum() * voxel_m**2 < parameters.opening_area_m2:
        return None
    if part.sum() < 0.5 * _box_cells(part):
        return None
    sized = within(width, parameters.window_size_m) and height >= parameters.window_size_m[0]
    if sized and bottom >= parameters.window_sill_m:
        return "window"
    leaf = within(width, parameters.door_width_m) and height >= parameters.door_height_m
    return "door" if leaf else None


def _framed(part: np.ndarray, plane: np.ndarray) -> float:
    """Return the share of the ring around a part that is on the plane of the wall."""
    ring = dilate(part, 3) & ~dilate(part)
    return float(plane[ring].mean()) if ring.any() else 0.0
