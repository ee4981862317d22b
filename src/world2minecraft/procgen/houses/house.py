"""Seeded houses: a plan with a corridor, doors and stairs, as layouts and as 2 cm voxels."""

import numpy as np

from world2minecraft.core.types import Layout, Opening
from world2minecraft.procgen.houses.house_gaps import Gap, house_gaps
from world2minecraft.procgen.houses.house_paint import paint_house
from world2minecraft.procgen.houses.house_plan import Cell, HousePlan, plan_house
from world2minecraft.procgen.houses.house_rooms import furnish_cells
from world2minecraft.procgen.rooms.colour_scheme import choose_style
from world2minecraft.procgen.rooms.place import Item
from world2minecraft.procgen.rooms.room import Room, layout_object
from world2minecraft.procgen.rooms.voxelization import VOXEL_M

ROOMS, STOREYS = (3, 14), (1, 2)


def generate_house(seed: int, *, rooms: int = 5, storeys: int = 1, clutter: float = 0.0) -> Room:
    """Return the house of a seed: the same seed and numbers give the same bytes.

    Args:
        seed: 0 or more.
        rooms: how many rooms in all, 3 to 14, the hall of each storey among them.
        storeys: 1 or 2; two need 4 rooms or more.
        clutter: 0 (tidy) to 1: how many things lie about, and how askew the chairs stand.

    Raises:
        ValueError: a number is out of its range.
    """
    check_house(seed, rooms, storeys, clutter)
    rng = np.random.default_rng([seed, rooms, storeys])
    plan = plan_house(rooms, storeys, rng)
    gaps = house_gaps(plan, rng)
    styles = [choose_style(rng) for _ in plan.cells]
    items, rugs = furnish_cells(plan, gaps, styles, clutter, (seed, rooms, storeys, 1))
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
    """Raise ``ValueError`` where a number of a house is out of its range."""
    if seed < 0:
        raise ValueError(f"seed must be 0 or more, not {seed}")
    if not STOREYS[0] <= storeys <= STOREYS[1]:
        raise ValueError(f"storeys must be 1 or 2, not {storeys}")
    least = max(ROOMS[0], 2 * storeys)
    if not least <= rooms <= ROOMS[1]:
        raise ValueError(
            f"rooms must be from {least} to {ROOMS[1]} on {storeys} "
            f"{'storey' if storeys == 1 else 'storeys'}, not {rooms}"
        )
    if not 0 <= clutter <= 1:
        raise ValueError(f"clutter must be from 0 to 1, not {clutter}")


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
