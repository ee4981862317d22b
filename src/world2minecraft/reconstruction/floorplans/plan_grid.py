"""Convert a plan to a grid with walls, floor, ceiling, openings, furniture and placements.

Cells whose centre is inside the outline of a room are air; cells around them are walls. All cells
that the plan describes count as observed, the outside as unseen. A plan object fills the cells of
its template. RoomPlan measures shapes only, so the colours are plausible defaults.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import (
    OBSERVED,
    OWN_CELLS,
    UNSEEN,
    ObjectInstance,
    OccupancyGrid,
    Placement,
)
from world2minecraft.formats.roomplan import CapturedPlan, PlanObject, PlanSurface
from world2minecraft.furniture import size_in_cells, template, template_cells
from world2minecraft.geometry.morphology import dilate
from world2minecraft.reconstruction.floorplans.furniture_categories import (
    class_of,
    front_of,
    template_of,
)
from world2minecraft.reconstruction.floorplans.room_outlines import PlacedRoom, place_plan_rooms

Colour = tuple[int, int, int]
# Different colours, so that furniture stands out from floor and walls.
STRUCTURE: dict[int, Colour] = {
    int(SemanticClass.FLOOR): (188, 166, 134),
    int(SemanticClass.WALL): (236, 233, 226),
    int(SemanticClass.CEILING): (246, 245, 242),
    int(SemanticClass.WINDOW): (176, 205, 224),
}
DOOR: Colour = (150, 112, 74)
OTHER: Colour = (150, 146, 140)
THINGS: dict[str, Colour] = {
    "storage": (120, 84, 56),
    "refrigerator": (226, 228, 230),
    "stove": (206, 207, 208),
    "bed": (206, 212, 222),
    "sink": (232, 234, 236),
    "washerDryer": (232, 233, 235),
    "toilet": (240, 240, 240),
    "bathtub": (240, 240, 240),
    "oven": (60, 60, 64),
    "dishwasher": (214, 216, 218),
    "table": (128, 82, 48),
    "sofa": (84, 104, 124),
    "chair": (78, 54, 38),
    "fireplace": (140, 78, 62),
    "television": (24, 24, 27),
    "stairs": (146, 108, 74),
    # RoomPlan knows none of these; other plans do.
    "curtain": (196, 186, 172),
    "lamp": (238, 226, 196),
    "mirror": (190, 208, 214),
    "picture": (170, 140, 100),
    "plant": (76, 122, 62),
    "rug": (146, 92, 84),
}

MAX_CELLS = 400_000_000
PAD = 3  # Cells around all rooms: a wall, and nothing known behind it.

PUSH = 2  # Maximum number of cells by which a box inside a wall is moved out of it.

REACH_M = 0.20  # Maximum distance of a wall's cells from the line of an opening in it.
BEYOND_M = 0.35  # Distance beyond the wall of an opening at which the next room has begun.
ASIDE_M = 0.25  # Distance on both sides of an inner wall at which its room must continue.
WALL, OBJS, EMPTY = int(SemanticClass.WALL), int(SemanticClass.OBJS), int(SemanticClass.EMPTY)


def colour_of(category: str) -> Colour:
    """Return the default colour of an object by its RoomPlan category."""
    return THINGS.get(category, OTHER)


class Canvas:
    """A cell grid that contains all rooms of a plan, into which the rooms are drawn.

    ``labels``, ``instance`` and ``colour`` are arrays over the same cells [X, Y, Z]. ``first`` is
    the offset of their cell (0, 0, 0) from the plan's origin, in cells.
    """

    def __init__(self, rooms: Sequence[PlacedRoom], voxel_m: float):
        """Create an empty canvas for the rooms.

        Raises:
            UsageError: If the rooms are too large for the cell size.
        """
        low = np.min([[*r.outline_m.min(axis=0), r.floor_z_m] for r in rooms], axis=0)
        high = np.max([[*r.outline_m.max(axis=0), r.floor_z_m + r.height_m] for r in rooms], axis=0)
        first = np.floor(low / voxel_m).astype(int) - PAD
        shape = np.ceil(high / voxel_m).astype(int) + PAD - first
        if np.prod(shape, dtype=np.float64) > MAX_CELLS:
            metres = " x ".join(f"{side * voxel_m:.0f}" for side in shape)
            raise UsageError(
                f"the plan measures {metres} m, too large for the grid; use larger cells, such "
                "as 0.16 m (--voxel 0.16)"
            )
        self.voxel_m, self.first = voxel_m, first
        self.labels = np.full(shape, UNKNOWN, np.uint8)
        self.instance = np.zeros(shape, np.uint16)
        self.colour = np.zeros((*shape, 3), np.uint8)
        self.instances: list[ObjectInstance] = []
        self.placements: list[Placement] = []

    def middles_m(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the x [X, 1] and y [1, Y] coordinates of the cell centres in metres."""
        x, y = (
            (self.first[axis] + np.arange(self.labels.shape[axis]) + 0.5) * self.voxel_m
            for axis in (0, 1)
        )
        return x[:, None], y[None, :]

    def layers(self, low_m: float, high_m: float) -> slice:
        """Return the layers between two heights, at least one."""
        low, high = (round(value / self.voxel_m) - int(self.first[2]) for value in (low_m, high_m))
        return slice(max(low, 0), max(high, low + 1))

    def columns(self, points_m: np.ndarray) -> np.ndarray:
        """Return the columns, int [N, 2], of points [N, 2]."""
        cells = np.floor(points_m / self.voxel_m).astype(int) - self.first[:2]
        return np.clip(cells, 0, np.array(self.labels.shape[:2]) - 1)

    def add(
        self,
        cells: np.ndarray,
        class_id: int,
        template: str,
        turns: int,
        colour: Colour,
        box: tuple[np.ndarray, np.ndarray] | None = None,
        confidence: float = 1.0,
    ) -> None:
        """Add an object to the grid.

        Args:
            cells: Cells of the object, int [N, 3].
            class_id: Class of the object.
            template: Name of its template.
            turns: Quarter turns of its front.
            colour: sRGB colour.
            box: First cell and size in cells of the object; the default is the box of its cells.
            confidence: Confidence from 0 to 1.
        """
        number = len(self.instances) + 1
        at = tuple(cells.T)
        self.labels[at], self.instance[at], self.colour[at] = class_id, number, colour
        low, sides = box or (cells.min(axis=0), np.ptp(cells, axis=0) + 1)
        own = sides[[1, 0, 2]] if turns % 2 else sides
        middle = np.round((low + sides / 2 + self.first) * self.voxel_m, 4)
        size, yaw = np.round(own * self.voxel_m, 4), 90.0 * turns
        found = ObjectInstance(
            number, class_id, middle, size, yaw, cells.astype(np.int32), confidence
        )
        iou = 0.0 if template == OWN_CELLS else 1.0
        self.instances.append(found)
        self.placements.append(Placement(number, class_id, template, middle, size, turns, iou))

    def grid(self) -> OccupancyGrid:
        """Return the finished grid, with default colours for structure."""
        known = self.labels != UNKNOWN
        for class_id, colour in STRUCTURE.items():
            self.colour[self.labels == class_id] = colour
        return OccupancyGrid(
            labels=self.labels,
            confidence=known.astype(np.float16),
            colour=self.colour,
            source=np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
            instance=self.instance,
            voxel_m=self.voxel_m,
            origin_m=np.round(self.first * self.voxel_m, 9),
        )


def place_thing(canvas: Canvas, item: PlanObject, room: PlacedRoom, inside: np.ndarray) -> None:
    """Fill the free air in an object's box with the cells of its template.

    Args:
        canvas: Canvas, modified in place.
        item: Object of the plan.
        room: Room of the object.
        inside: Bool [X, Y] mask of the columns of that room.
    """
    name = template_of(item, room.floor_z_m)
    turns = front_of(item, [(wall.start_m, wall.end_m) for wall in room.room.walls])
    counts = np.array(size_in_cells(item.size_m, canvas.voxel_m))
    sides = counts[[1, 0, 2]] if turns % 2 else counts
    corner = np.round(item.center_m / canvas.voxel_m - sides / 2).astype(int) - canvas.first
    ground = canvas.layers(room.floor_z_m, room.floor_z_m).start
    corner[2] = ground if corner[2] - ground <= 1 else corner[2]
    corner[:2] = _pushed_in(corner[:2], sides[:2], inside)
    if name == OWN_CELLS:
        cells = np.argwhere(np.ones(sides, bool)) + corner
    else:
        size = counts * canvas.voxel_m
        cells = template_cells(template(name), size, None, turns, corner.tolist(), canvas.voxel_m)
    cells = cells[((cells >= 0) & (cells < canvas.labels.shape)).all(axis=1)]
    cells = cells[canvas.labels[tuple(cells.T)] == SemanticClass.EMPTY]
    if len(cells):
        box = None if name == OWN_CELLS else (corner, sides)
        look = colour_of(item.category)
        canvas.add(cells, class_of(item), name, turns, look, box, item.confidence)


def _pushed_in(corner: np.ndarray, sides: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Return the corner of a box [2] shifted as little as required to be mostly inside the room."""
    steps = sorted(
        ((a, b) for a in range(-PUSH, PUSH + 1) for b in range(-PUSH, PUSH + 1)),
        key=lambda step: (abs(step[0]) + abs(step[1]), step),
    )
    best, most = corner, -1
    for step in steps:
        low, high = np.maximum(corner + step, 0), np.maximum(corner + step + sides, 0)
        held = int(inside[low[0] : high[0], low[1] : high[1]].sum())
        if held > most:
            best, most = corner + step, held
    return best


@dataclass(frozen=True, eq=False)
class PlanCells:
    """A plan as a grid, with its objects and their placements."""

    grid: OccupancyGrid
    instances: tuple[ObjectInstance, ...]
    placements: tuple[Placement, ...]


def rasterize_plan(plan: CapturedPlan, voxel_m: float = 0.08) -> PlanCells:
    """Convert a straightened plan to cells.

    Args:
        plan: Plan in a frame with z up and walls along x and y.
        voxel_m: Cell size in metres.

    Raises:
        UsageError: If the plan is too large for this cell size.
    """
    rooms = sorted(place_plan_rooms(plan), key=lambda room: room.floor_z_m)
    canvas = Canvas(rooms, voxel_m)
    columns = _columns_of_rooms(canvas, rooms)
    for room, inside in zip(rooms, columns, strict=True):
        _paint_shell(canvas, room, inside)
    for room, inside in zip(rooms, columns, strict=True):
        _paint_partitions(canvas, room, inside)
    anywhere = np.any(columns, axis=0)
    for room in rooms:
        for opening in room.room.openings:
            _paint_opening(canvas, room, opening, _leads_on(canvas, opening, anywhere))
    for room, inside in zip(rooms, columns, strict=True):
        for item in sorted(room.room.objects, key=lambda item: -float(np.prod(item.size_m))):
            place_thing(canvas, item, room, inside)
    return PlanCells(canvas.grid(), tuple(canvas.instances), tuple(canvas.placements))


def _columns_of_rooms(canvas: Canvas, rooms: Sequence[PlacedRoom]) -> list[np.ndarray]:
    """Return the columns of each room, bool [X, Y], at least one cell from earlier rooms."""
    columns: list[np.ndarray] = []
    for room in rooms:
        inside = _inside(canvas, room.outline_m)
        for other, taken in zip(rooms, columns, strict=False):
            low = max(other.floor_z_m, room.floor_z_m)
            if low < min(other.floor_z_m + other.height_m, room.floor_z_m + room.height_m) - 0.5:
                inside &= ~dilate(taken)
        columns.append(inside)
    return columns


def _inside(canvas: Canvas, outline_m: np.ndarray) -> np.ndarray:
    """Return the mask of cells whose centre is inside an outline, bool [X, Y]."""
    x, y = canvas.middles_m()
    inside = np.zeros(canvas.labels.shape[:2], bool)
    for (x0, y0), (x1, y1) in zip(outline_m, np.roll(outline_m, -1, axis=0), strict=True):
        if y0 != y1:
            crosses = (y0 > y) != (y1 > y)
            inside ^= crosses & (x < x0 + (y - y0) / (y1 - y0) * (x1 - x0))
    return inside


def _paint_shell(canvas: Canvas, room: PlacedRoom, inside: np.ndarray) -> None:
    """Paint the floor, air and ceiling of a room, and walls around it in cells still unknown."""
    air = canvas.layers(room.floor_z_m, room.floor_z_m + room.height_m)
    part = canvas.labels[:, :, air.start - 1 : air.stop + 1]
    part[(dilate(inside) & ~inside)[:, :, None] & (part == UNKNOWN)] = WALL
    part[inside] = EMPTY
    canvas.labels[inside, air.start - 1] = int(SemanticClass.FLOOR)
    canvas.labels[inside, air.stop] = int(SemanticClass.CEILING)


def _paint_partitions(canvas: Canvas, room: PlacedRoom, inside: np.ndarray) -> None:
    """Paint the walls inside a room, with its floor on both sides."""
    for wall in room.room.walls:
        count = max(2, int(np.ceil(3 * wall.length_m / canvas.voxel_m)))
        along = wall.end_m - wall.start_m
        points = wall.start_m + (np.arange(count) + 0.5)[:, None] / count * along
        aside = np.array([-along[1], along[0]]) / max(wall.length_m, 1e-9) * ASIDE_M
        within = np.ones(count, bool)
        for step in (-1, 0, 1):
            within &= inside[tuple(canvas.columns(points + step * aside).T)]
        if within.mean() >= 0.5:
            x, y = np.unique(canvas.columns(points[within]), axis=0).T
            canvas.labels[x, y, canvas.layers(wall.bottom_m, wall.top_m)] = WALL


def _leads_on(canvas: Canvas, opening: PlanSurface, anywhere: np.ndarray) -> bool:
    """Return whether there is a room on both sides of an opening."""
    along = (opening.end_m - opening.start_m) / max(opening.length_m, 1e-9)
    middle, aside = (opening.start_m + opening.end_m) / 2, np.array([-along[1], along[0]])
    sides = np.array([middle + sign * BEYOND_M * aside for sign in (1, -1)])
    return bool(anywhere[tuple(canvas.columns(sides).T)].all())


def _paint_opening(canvas: Canvas, room: PlacedRoom, opening: PlanSurface, leads_on: bool) -> None:
    """Cut a window, door or doorway into its walls; the leaf of a closed door is an object.

    Doors between two rooms are open, so that players can walk through the house.
    """
    columns = _columns_of(canvas, opening)
    low = opening.bottom_m if opening.kind == "window" else room.floor_z_m
    layers = canvas.layers(low, opening.top_m)
    part = canvas.labels[:, :, layers]
    walls = columns[:, :, None] & (part == WALL)
    if opening.kind == "window":
        part[walls] = int(SemanticClass.WINDOW)
    elif opening.kind == "doorway" or leads_on:
        part[walls] = EMPTY
    elif walls.any():
        cells = np.argwhere(walls) + np.array([0, 0, layers.start])
        across = int(abs(opening.end_m - opening.start_m).argmax() == 0)
        canvas.add(cells, OBJS, OWN_CELLS, across, DOOR)


def _columns_of(canvas: Canvas, opening: PlanSurface) -> np.ndarray:
    """Return the columns between the ends of an opening and close to its line, bool [X, Y]."""
    x, y = canvas.middles_m()
    along = (opening.end_m - opening.start_m) / max(opening.length_m, 1e-9)
    dx, dy = x - opening.start_m[0], y - opening.start_m[1]
    place, off = dx * along[0] + dy * along[1], dx * along[1] - dy * along[0]
    return (place > 0) & (place < opening.length_m) & (np.abs(off) < REACH_M)
