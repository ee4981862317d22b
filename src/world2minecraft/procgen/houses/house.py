"""Generation of houses from a seed, as layouts and 2 cm voxels."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Layout, Opening
from world2minecraft.procgen.houses.plan import (
    WALL_M,
    Cell,
    Gap,
    HousePlan,
    house_gaps,
    plan_house,
    stairwell,
)
from world2minecraft.procgen.houses.room_furnishing import furnish_cells
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style, choose_style
from world2minecraft.procgen.rooms.floor_shapes import dilate_mask
from world2minecraft.procgen.rooms.full_furnishing import check_furnishing
from world2minecraft.procgen.rooms.furniture_model import shade
from world2minecraft.procgen.rooms.openings import Hole
from world2minecraft.procgen.rooms.placement import Item, Rug
from world2minecraft.procgen.rooms.room import Room, layout_object
from world2minecraft.procgen.rooms.voxelization import (
    SHELL,
    VOXEL_M,
    Canvas,
    floor_colours,
    paint_hole,
    paint_item,
    paint_rug,
)

CEILING_COLOUR = (244, 243, 239)
FLOORS = {"kitchen": "tiles", "bathroom": "tiles", "hall": "tiles"}
ROOMS, STOREYS = (3, 14), (1, 2)


def paint_house(
    plan: HousePlan,
    gaps: tuple[Gap, ...],
    styles: list[Style],
    items: list[list[Item]],
    rugs: list[tuple[Rug, ...]],
    rng: np.random.Generator,
) -> Canvas:
    """Voxelize a house with its furniture.

    Args:
        plan: The plan with the rooms of the house.
        gaps: The openings in the walls.
        styles: The colour scheme of each room.
        items: The objects in each room, in the frame of the house.
        rugs: The rugs in each room, in the frame of the house.
        rng: Random generator for the grain of floors and furniture.
    """
    canvas = Canvas(plan.size_m)
    for cell, style in zip(plan.cells, styles, strict=True):
        _paint_cell(canvas, plan, cell, style, rng)
    for gap in gaps:
        _paint_gap(canvas, plan, gap)
    if plan.flight:
        canvas.fill(canvas.cells(stairwell(plan, plan.flight)), 0, 0, 0)
    for cell, flat in zip(plan.cells, rugs, strict=True):
        for rug in flat:
            paint_rug(canvas, rug, cell.rect, cell.storey * plan.pitch_m)
    number = 0
    for held in items:
        for item in held:
            number += 1
            paint_item(canvas, item, number, rng)
    return canvas


def _paint_cell(
    canvas: Canvas, plan: HousePlan, cell: Cell, style: Style, rng: np.random.Generator
) -> None:
    """Fill in the walls, slabs and air of one room. Adjacent rooms share a wall."""
    air = _air(canvas, cell)
    near, half = dilate_mask(air, SHELL), dilate_mask(air, SHELL // 2)
    floor = SHELL + round(cell.storey * plan.pitch_m / VOXEL_M)
    top = floor + round(plan.height_m / VOXEL_M)
    labels, colour = canvas.labels, canvas.colour
    walls = near & (labels[:, :, floor] == 0)
    column = labels[:, :, floor - SHELL : top + SHELL]
    column[walls] = int(SemanticClass.WALL)
    colour[walls, floor - SHELL : top + SHELL] = style.wall
    colour[half, floor:top] = style.wall
    colour[half, floor : floor + 4] = shade(WHITE, 0.96)
    labels[near, floor - SHELL : floor] = int(SemanticClass.FLOOR)
    tones = floor_colours(FLOORS.get(cell.kind, "planks"), air.shape, style.floor_wood, rng)
    colour[half, floor - SHELL : floor] = tones[half][:, None]
    labels[near, top : top + SHELL] = int(SemanticClass.CEILING)
    colour[near, top : top + SHELL] = CEILING_COLOUR
    labels[air, floor:top] = 0
    colour[air, floor:top] = 0


def _air(canvas: Canvas, cell: Cell) -> np.ndarray:
    """Return the floor columns of a room as bool [X, Y]."""
    x, y = canvas.middles_m()
    x, y = x - cell.x_m, y - cell.y_m
    width, depth, _ = cell.ground.size_m
    inside = (x > 0) & (x < width) & (y > 0) & (y < depth)
    return inside & ~cell.ground.built(x, y)


def _paint_gap(canvas: Canvas, plan: HousePlan, gap: Gap) -> None:
    """Cut a gap through a wall, or only its recess for a window or front door."""
    floor_z = plan.cells[gap.cells[0]].storey * plan.pitch_m
    if len(gap.cells) == 1:
        hole = Hole(gap.kind, 0, gap.first_m, gap.last_m, gap.sill_m, gap.head_m)
        paint_hole(canvas, hole, gap.wall, floor_z)
        return
    x0, y0, x1, y1 = gap.wall.rect(gap.first_m, gap.last_m, -WALL_M, 0.0)
    a, b, c = canvas.cells((x0, y0, floor_z + gap.sill_m, x1, y1, floor_z + gap.head_m))
    frame = _grown_slices(a, b, c, gap.wall.turn % 2)
    canvas.colour[frame][canvas.labels[frame] == int(SemanticClass.WALL)] = WHITE
    canvas.fill((a, b, c), 0, 0, 0)


def _grown_slices(a: slice, b: slice, c: slice, across: int) -> tuple[slice, slice, slice]:
    """Return the voxels of a gap with a frame of 6 cm, except at the floor."""
    sides = [a, b]
    run = sides[1 - across]
    sides[1 - across] = slice(run.start - 3, run.stop + 3)
    return sides[0], sides[1], slice(c.start, c.stop + 3)


def generate_house(
    seed: int,
    *,
    rooms: int = 5,
    storeys: int = 1,
    clutter: float = 0.0,
    furnishing: str = "basic",
) -> Room:
    """Generate a house from a seed. The same arguments always give the same bytes.

    Args:
        seed: The random seed, at least 0.
        rooms: Number of rooms, 3 to 14, including one hall per storey.
        storeys: Number of storeys, 1 or 2. Two storeys need at least 4 rooms.
        clutter: Amount of loose objects and displaced chairs, from 0 (tidy) to 1.
        furnishing: ``basic`` for the main furniture, or ``full`` for all that people expect.

    Raises:
        UnknownNameError: If the furnishing is unknown.
        ValueError: If an argument is out of range.
    """
    check_house(seed, rooms, storeys, clutter)
    check_furnishing(furnishing)
    rng = np.random.default_rng([seed, rooms, storeys])
    plan = plan_house(rooms, storeys, rng)
    gaps = house_gaps(plan, rng)
    styles = [choose_style(rng) for _ in plan.cells]
    full = furnishing == "full"
    items, rugs = furnish_cells(plan, gaps, styles, clutter, (seed, rooms, storeys, 1), full=full)
    canvas = paint_house(plan, gaps, styles, items, rugs, rng)
    return Room(
        kind="house",
        seed=seed,
        layouts=tuple(
            _layout(plan, gaps, number, cell, items[number])
            for number, cell in enumerate(plan.cells)
        ),
        labels=canvas.labels,
        instance=canvas.instance,
        colour=canvas.colour,
        voxel_m=VOXEL_M,
        origin_m=canvas.origin_m,
    )


def check_house(seed: int, rooms: int, storeys: int, clutter: float) -> None:
    """Check the arguments of ``generate_house``.

    Raises:
        ValueError: If an argument is out of range.
    """
    if seed < 0:
        raise ValueError(f"seed must be 0 or more, got {seed}")
    if not STOREYS[0] <= storeys <= STOREYS[1]:
        raise ValueError(f"storeys must be 1 or 2, got {storeys}")
    least = max(ROOMS[0], 2 * storeys)
    if not least <= rooms <= ROOMS[1]:
        raise ValueError(
            f"rooms must be from {least} to {ROOMS[1]} on {storeys} "
            f"{'storey' if storeys == 1 else 'storeys'}, got {rooms}"
        )
    if not 0 <= clutter <= 1:
        raise ValueError(f"clutter must be from 0 to 1, got {clutter}")


def _layout(
    plan: HousePlan, gaps: tuple[Gap, ...], number: int, cell: Cell, items: list[Item]
) -> Layout:
    off = np.array([cell.x_m, cell.y_m])
    openings = []
    for gap in gaps:
        if number in gap.cells:
            own = gap.hole(number, cell).opening(cell.ground)
            moved = (own.start_m + off, own.end_m + off)
            openings.append(Opening(own.kind, *moved, own.sill_m, own.head_m))
    return Layout(
        floor_polygon_m=cell.ground.polygon_m + off,
        wall_height_m=plan.height_m,
        openings=tuple(openings),
        objects=tuple(layout_object(item) for item in items),
        floor_z_m=cell.storey * plan.pitch_m,
        name=f"{cell.kind} {number + 1}",
    )
