"""Voxelization of a furnished plan into labels, instances and colours at 2 cm."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style
from world2minecraft.procgen.rooms.floor_shapes import Ground, Rect, Wall, dilate_mask
from world2minecraft.procgen.rooms.furniture_model import STEP_M, Bar, Colour, Part, shade
from world2minecraft.procgen.rooms.openings import RECESS_M, Hole
from world2minecraft.procgen.rooms.placement import Item, Rug
from world2minecraft.procgen.rooms.supersampled_voxelization import is_plain, solid_cells

VOXEL_M = STEP_M
SHELL_M = 0.12  # Walls, floor slab and ceiling; the truth needs 0.1 m or more.
SHELL = round(SHELL_M / VOXEL_M)
WINDOW = int(SemanticClass.WINDOW)


class Canvas:
    """The voxel arrays of a room, whose indices start at the outer corner of the shell."""

    def __init__(self, size_m: tuple[float, float, float]):
        inner = [round(side / VOXEL_M) for side in size_m]
        shape = tuple(side + 2 * SHELL for side in inner)
        self.inner = inner
        self.labels = np.zeros(shape, np.uint8)
        self.instance = np.zeros(shape, np.uint16)
        self.colour = np.zeros((*shape, 3), np.uint8)

    @property
    def origin_m(self) -> np.ndarray:
        """The position of the minimum corner of voxel (0, 0, 0) in the room frame."""
        return np.full(3, -SHELL * VOXEL_M)

    def cells(self, box_m: tuple[float, ...]) -> tuple[slice, slice, slice]:
        """Return the voxels of a box as slices, at least one voxel along each axis."""
        low = [round(value / VOXEL_M) + SHELL for value in box_m[:3]]
        high = [round(value / VOXEL_M) + SHELL for value in box_m[3:]]
        a, b, c = (slice(x, max(x + 1, y)) for x, y in zip(low, high, strict=True))
        return a, b, c

    def middles_m(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the x coordinates [X, 1] and y coordinates [1, Y] of all voxel centres."""
        x, y = ((np.arange(side) - SHELL + 0.5) * VOXEL_M for side in self.labels.shape[:2])
        return x[:, None], y[None, :]

    def fill(self, cells: tuple[slice, ...], label: int, instance: int, colour: Any) -> None:
        """Set the label, instance and colour of a box of voxels.

        ``colour`` is a single colour or broadcasts to the box.
        """
        self.labels[cells] = label
        self.instance[cells] = instance
        self.colour[cells] = colour


def paint_shell(canvas: Canvas, style: Style, floor: str, rng: np.random.Generator) -> None:
    """Fill in the walls, ceiling, skirting boards and floor."""
    everywhere = (slice(None),) * 3
    canvas.fill(everywhere, int(SemanticClass.WALL), 0, style.wall)
    accent = int(rng.integers(4))
    side = [slice(None), slice(None), slice(None)]
    side[accent % 2] = slice(0, SHELL) if accent < 2 else slice(-SHELL, None)
    canvas.colour[tuple(side)] = style.accent_wall
    canvas.colour[:, :, SHELL : SHELL + 4] = shade(WHITE, 0.96)
    canvas.fill(
        (*everywhere[:2], slice(-SHELL, None)), int(SemanticClass.CEILING), 0, (244, 243, 239)
    )
    colours = floor_colours(floor, canvas.labels.shape[:2], style.floor_wood, rng)
    canvas.fill(
        (*everywhere[:2], slice(0, SHELL)), int(SemanticClass.FLOOR), 0, colours[:, :, None]
    )
    air = tuple(slice(SHELL, -SHELL) for _ in range(3))
    canvas.fill(air, 0, 0, 0)


def floor_colours(
    floor: str, shape: tuple[int, ...], wood: Colour, rng: np.random.Generator
) -> np.ndarray:
    """Return the colours of a floor of ``planks`` or ``tiles`` as uint8 [X, Y, 3]."""
    return (_planks if floor == "planks" else _tiles)(shape, wood, rng)


def paint_built(canvas: Canvas, ground: Ground, style: Style) -> None:
    """Fill in built-in blocks and cut corners as wall, and roofs as ceiling."""
    x, y = canvas.middles_m()
    inner = tuple(slice(SHELL, -SHELL) for _ in range(3))
    built = ground.built(x, y)[inner[:2]]
    walls = (canvas.labels[inner], canvas.colour[inner])
    walls[0][built] = int(SemanticClass.WALL)
    walls[1][built] = style.wall
    walls[1][built, :4] = shade(WHITE, 0.96)
    z = (np.arange(canvas.inner[2]) + 0.5) * VOXEL_M
    above = ~built[..., None] & (z > ground.ceiling_m(x, y)[inner[:2]][..., None])
    walls[0][above] = int(SemanticClass.CEILING)
    walls[1][above] = (244, 243, 239)
    outside = _outside(canvas.labels)
    canvas.labels[outside] = 0
    canvas.colour[outside] = 0


def _outside(labels: np.ndarray) -> np.ndarray:
    """Return the columns farther from the floor than a wall's thickness, as bool [X, Y].

    Thick columns inside the room are excluded.
    """
    floor = np.zeros(labels.shape[:2], bool)
    floor[SHELL:-SHELL, SHELL:-SHELL] = labels[SHELL:-SHELL, SHELL:-SHELL, SHELL] == 0
    parts, _ = label_components(~dilate_mask(floor, SHELL), corners=False)
    rim = np.concatenate([parts[0], parts[-1], parts[:, 0], parts[:, -1]])
    return np.isin(parts, np.unique(rim[rim > 0]))


def _planks(shape: tuple[int, ...], wood: Colour, rng: np.random.Generator) -> np.ndarray:
    """Return the colours of boards of 14 cm x 1.4 m in different tones, uint8 [X, Y, 3]."""
    x, y = np.meshgrid(np.arange(shape[0]), np.arange(shape[1]), indexing="ij")
    row = y // 7
    offset = rng.integers(0, 70, row.max() + 1)[row]
    column = (x + offset) // 70
    tones = rng.uniform(0.9, 1.08, (row.max() + 1, column.max() + 1))[row, column]
    streaks = rng.uniform(0.97, 1.03, (shape[1],))[None, :]
    seam = np.where((y % 7 == 0) | ((x + offset) % 70 == 0), 0.86, 1.0)
    return _tint(wood, tones * streaks * seam)


def _tiles(shape: tuple[int, ...], wood: Colour, rng: np.random.Generator) -> np.ndarray:
    """Return the colours of tiles of 40 cm with light joints, uint8 [X, Y, 3]."""
    x, y = np.meshgrid(np.arange(shape[0]), np.arange(shape[1]), indexing="ij")
    checker = np.where((x // 20 + y // 20) % 2 == 0, 1.0, 0.84)
    tones = rng.uniform(0.97, 1.03, (shape[0] // 20 + 1, shape[1] // 20 + 1))[x // 20, y // 20]
    joint = np.where((x % 20 == 0) | (y % 20 == 0), 0.9, 1.0)
    return _tint((212, 206, 196), checker * tones * joint)


def paint_rug(canvas: Canvas, rug: Rug, within: Rect, floor_z_m: float = 0.0) -> None:
    """Colour the floor under a flat rug, at least 10 cm from the sides of ``within``.

    The voxels keep the class floor.
    """
    x0, y0, x1, y1, colour, turn_deg = rug
    if turn_deg:
        _paint_turned_rug(canvas, rug, within, floor_z_m)
        return
    low = (max(x0, within[0] + 0.1), max(y0, within[1] + 0.1))
    high = (min(x1, within[2] - 0.1), min(y1, within[3] - 0.1))
    a, b, c = canvas.cells((*low, floor_z_m - VOXEL_M, *high, floor_z_m))
    light = shade(colour, 1.25)
    canvas.colour[a, b, c] = colour
    canvas.colour[a.start + 4 : a.stop - 4, b.start + 4 : b.stop - 4, c] = light
    canvas.colour[a.start + 6 : a.stop - 6, b.start + 6 : b.stop - 6, c] = shade(colour, 1.05)


def _paint_turned_rug(canvas: Canvas, rug: Rug, within: Rect, floor_z_m: float) -> None:
    """Colour the floor under a rug that is not parallel to the walls."""
    x, y = canvas.middles_m()
    angle = np.radians(rug.turn_deg)
    dx, dy = x - (rug.x0 + rug.x1) / 2, y - (rug.y0 + rug.y1) / 2
    along = np.abs(dx * np.cos(angle) + dy * np.sin(angle))
    across = np.abs(dy * np.cos(angle) - dx * np.sin(angle))
    inside = np.minimum((rug.x1 - rug.x0) / 2 - along, (rug.y1 - rug.y0) / 2 - across)
    held = (x > within[0] + 0.1) & (x < within[2] - 0.1)
    held = held & (y > within[1] + 0.1) & (y < within[3] - 0.1)
    level = round(floor_z_m / VOXEL_M) + SHELL - 1
    held &= canvas.labels[:, :, level] == int(SemanticClass.FLOOR)
    for rim_m, factor in ((0.0, 1.0), (0.08, 1.25), (0.12, 1.05)):
        canvas.colour[held & (inside > rim_m), level] = shade(rug.colour, factor)


def paint_item(canvas: Canvas, item: Item, instance: int, rng: np.random.Generator) -> None:
    """Fill in the voxels of an item."""
    for part in item.model.parts:
        if not is_plain(item, part):
            _paint_solid(canvas, item, part, instance, rng)
            continue
        cells = canvas.cells(_turned_box(item, part))
        shape = tuple(side.stop - side.start for side in cells)
        tone = _grain(part, shape, rng)
        canvas.fill(cells, item.model.class_id, instance, _tint(part.colour, tone))


def _paint_solid(
    canvas: Canvas, item: Item, part: Part | Bar, instance: int, rng: np.random.Generator
) -> None:
    first, filled = solid_cells(item, part)
    start = first + SHELL
    cells = tuple(slice(a, a + n) for a, n in zip(start.tolist(), filled.shape, strict=True))
    canvas.labels[cells][filled] = item.model.class_id
    canvas.instance[cells][filled] = instance
    canvas.colour[cells][filled] = _tint(part.colour, _grain(part, filled.shape, rng))[filled]


def _turned_box(item: Item, part: Part | Bar) -> tuple[float, ...]:
    x0, y0, z0, x1, y1, z1 = part.box_m
    ax, ay = item.point(x0, y0)
    bx, by = item.point(x1, y1)
    return (
        min(ax, bx), min(ay, by), item.z_m + z0, max(ax, bx), max(ay, by), item.z_m + z1,
    )  # fmt: skip


def _grain(part: Part | Bar, shape: tuple[int, ...], rng: np.random.Generator) -> np.ndarray:
    """Return the tone of each voxel of a part, with streaks for wood and specks for fabric."""
    if part.grain == "wood" and _is_bare_wood(part.colour):
        along = int(np.argmax(shape))
        cross = tuple(1 if axis == along else side for axis, side in enumerate(shape))
        return np.broadcast_to(rng.uniform(0.93, 1.05, cross), shape)
    spread = 0.035 if part.grain == "fabric" else 0.008
    return rng.uniform(1 - spread, 1 + spread, shape)


def _is_bare_wood(colour: Colour) -> bool:
    """Return whether a colour is that of unpainted wood, which has streaks."""
    red, green, blue = colour
    return red - blue > 30 and 0.5 < green / max(red, 1) < 0.88


def _tint(colour: Colour, tone: np.ndarray) -> np.ndarray:
    return np.clip(np.array(colour) * tone[..., None] + 0.5, 0, 255).astype(np.uint8)


def paint_hole(canvas: Canvas, hole: Hole, wall: Wall, floor_z_m: float = 0.0) -> None:
    """Cut a recess for a window or door into its wall, and fill in the window pane."""
    deep = round(RECESS_M / VOXEL_M)
    recess = _in_wall(canvas, hole, wall, 0, deep, floor_z_m)
    canvas.fill(recess, 0, 0, 0)
    if hole.kind == "door":
        return
    pane = _in_wall(canvas, hole, wall, deep, SHELL, floor_z_m)
    heights = np.linspace(0, 1, pane[2].stop - pane[2].start)[:, None]
    sky = np.array([196, 214, 224]) * (1 - heights) + np.array([146, 192, 232]) * heights
    view = np.where(heights < 0.22, np.array([128, 158, 112]), sky).astype(np.uint8)
    canvas.fill(pane, WINDOW, 0, view)
    for bar in _frame(canvas, hole, wall, deep, floor_z_m):
        canvas.fill(bar, WINDOW, 0, WHITE)


def _frame(
    canvas: Canvas, hole: Hole, wall: Wall, deep: int, floor_z_m: float
) -> Iterator[tuple[slice, ...]]:
    """Yield the bars of a window frame, 6 cm wide, including its middle post."""
    x, y, z = _in_wall(canvas, hole, wall, deep - 2, deep, floor_z_m)
    along = 1 - wall.turn % 2
    run = (x, y)[along]
    middle = (run.start + run.stop) // 2
    for low, high in (
        (run.start, run.start + 3),
        (run.stop - 3, run.stop),
        (middle - 1, middle + 2),
    ):
        bar = [x, y]
        bar[along] = slice(low, high)
        yield bar[0], bar[1], z
    yield x, y, slice(z.start, z.start + 3)
    yield x, y, slice(z.stop - 3, z.stop)


def _in_wall(
    canvas: Canvas, hole: Hole, wall: Wall, near: int, far: int, floor_z_m: float = 0.0
) -> tuple[slice, slice, slice]:
    """Return the voxels of a hole between two depths behind the inner face of the wall."""
    first, last = (round(value / VOXEL_M) + SHELL for value in (hole.first_m, hole.last_m))
    low, high = (
        round((floor_z_m + value) / VOXEL_M) + SHELL for value in (hole.sill_m, hole.head_m)
    )
    face = SHELL + round(wall.at_m / VOXEL_M)
    across = slice(face - far, face - near) if wall.turn < 2 else slice(face + near, face + far)
    run, up = slice(first, last), slice(low, high)
    return (across, run, up) if wall.turn % 2 == 0 else (run, across, up)
