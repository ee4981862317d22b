"""Furnishing of the rooms of a house, each in a separate frame rotated by quarter turns.

A recipe identifies walls by number (for example, kitchen counters are along walls 0 and 1), so
rotations of a room are tried until the recipe's walls have no doors. Kitchens of houses have their
own recipe: one row of counters along any wall without doors.
"""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.procgen.houses.plan import Cell, Gap, HousePlan, stair_items, stairwell
from world2minecraft.procgen.rooms import decor
from world2minecraft.procgen.rooms import seats_beds_tables as seating
from world2minecraft.procgen.rooms import storage_furniture as storage
from world2minecraft.procgen.rooms.clutter import WIDE_BODY_M, scatter
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style
from world2minecraft.procgen.rooms.decor import door
from world2minecraft.procgen.rooms.floor_shapes import Ground
from world2minecraft.procgen.rooms.full_furnishing import Completion, furnish_fully
from world2minecraft.procgen.rooms.furniture_model import Model
from world2minecraft.procgen.rooms.openings import Hole, door_item, hang_curtains, reserve_before
from world2minecraft.procgen.rooms.placement import (
    Item,
    Plan,
    Rug,
    boxes_intersect,
    chairs_around,
    paths_are_clear,
    pendant_over,
    picture_anywhere,
    snap_to_voxels,
)
from world2minecraft.procgen.rooms.recipes import KINDS, shuffled_walls

LOW_M = 0.5  # What is kept free from below this height is a way; above it, a window's air.
WIDTHS_M = ((1.0, 1.6), (0.8, 1.2), (0.6, 0.8))  # Of the counters beside and under the sink.
TABLE_TRIES = 24
ATTEMPTS = 40
STEP_IN_M = 0.5  # Where one stands who has come in by a door.
STEP_OFF_M = 0.9  # The floor before the first step and behind the last stays free.
LEAF_M = (0.88, 2.0)


def furnish_galley(plan: Plan, style: Style) -> tuple[Rug, ...] | None:
    """Furnish a kitchen with a row of fridge, counter, cooker with hood and sink, and a table."""
    placed = None
    for wall in sorted(shuffled_walls(plan), key=lambda n: -plan.ground.walls[n].length_m):
        for counters in WIDTHS_M:
            for backwards in (False, True):
                placed = placed or _run(plan, style, wall, counters, backwards)
    if placed is None:
        return None
    _, corner, cooker, sink = placed
    _hang(plan, style, corner, cooker, sink)
    plan.add_upon(decor.microwave(), corner, -0.1, 0.0, top_m=0.9)
    for item in placed:
        plan.reserved.append(plan.front_box(item, 0.8))
    _table(plan, style)
    plan.add_at_walls(decor.crate((0.3, 0.4, 0.3), (190, 150, 104)))
    plan.add_in_corner(decor.plant(plan.rng.uniform(0.8, 1.1), plan.rng))
    picture_anywhere(plan)
    return ()


def _run(
    plan: Plan, style: Style, wall: int, counters: tuple[float, float], backwards: bool
) -> list[Item] | None:
    """Place the row along a wall from its start or end, if all items fit."""
    cool = storage.fridge(WHITE if style.front != WHITE else (190, 192, 196))
    models: list[Model] = [
        cool,
        storage.counter(counters[0], style.front, style.worktop),
        storage.oven(style.front, style.worktop),
        storage.counter(counters[1], style.front, style.worktop, sink=True),
    ]
    side = plan.ground.walls[wall]
    at, items = (side.last_m if backwards else side.first_m), []
    for model in models:
        half = model.size_m[1] / 2 * (-1 if backwards else 1)
        items.append(plan.at_wall(model, wall, at + half))
        at += 2 * half
    if not all(_stands(plan, item) for item in items):
        return None
    plan.items += items
    return items


def _stands(plan: Plan, item: Item) -> bool:
    """Return whether an item fits. A sink can be under a window, but a fridge cannot."""
    box = item.box_m
    tall = item.model.name == "fridge"
    reserved = [other for other in plan.reserved if tall or other[2] < LOW_M]
    return plan.fits(item, may_block=True) and not any(
        boxes_intersect(box, other) for other in reserved
    )


def _hang(plan: Plan, style: Style, corner: Item, cooker: Item, sink: Item) -> None:
    """Add the hood and the wall cabinets where there is no window."""
    hung = [(decor.hood(), cooker, 1.56)]
    for base in (corner, sink):
        hung.append((storage.wall_cabinet(base.model.size_m[1], style.front), base, 1.44))
    for model, base, z_m in hung:
        back = (model.size_m[0] - base.model.size_m[0]) / 2
        plan.add(snap_to_voxels(Item(model, *base.point(back, 0.0), z_m, base.yaw_deg)))


def _table(plan: Plan, style: Style) -> None:
    """Place a table with chairs if there is space."""
    rng = plan.rng
    model = seating.table("kitchen_table", 0.8, float(rng.choice([0.9, 1.2])), 0.74, style.wood)
    for _ in range(TABLE_TRIES):
        x, y = (side * rng.uniform(0.25, 0.75) for side in plan.size_m[:2])
        item = snap_to_voxels(Item(model, x, y, 0.0, 90.0 * int(rng.integers(2))))
        chair = seating.chair(style.wood, style.cloth)
        before = len(plan.items)
        board = plan.add(item)
        if board is None:
            continue
        chairs_around(plan, board, chair, ends=False)
        if len(plan.items) - before >= 3:  # A table with two chairs at least.
            plan.add_upon(decor.bowl(), board, 0.0, 0.0)
            pendant_over(plan, board, (60, 64, 66))
            return
        del plan.items[before:]


@dataclass(frozen=True)
class RoomFrame:
    """The local frame of a room, rotated by ``turns`` quarter turns against the house."""

    cell: Cell
    turns: int

    @property
    def ground(self) -> Ground:
        """The shape of the room in its local frame. Only rectangular rooms are rotated."""
        width, depth, height = self.cell.ground.size_m
        if self.turns == 0:
            return self.cell.ground
        return Ground((width, depth, height) if self.turns == 2 else (depth, width, height))

    def to_house(self, x_m: float, y_m: float) -> tuple[float, float]:
        """Transform a position from the local frame to the frame of the house."""
        width, depth, _ = self.ground.size_m
        x, y = (
            (x_m, y_m), (depth - y_m, x_m), (width - x_m, depth - y_m), (y_m, width - x_m)
        )[self.turns]  # fmt: skip
        return x + self.cell.x_m, y + self.cell.y_m

    def hole(self, hole: Hole) -> Hole:
        """Transform a hole from the unrotated room to the local frame."""
        if self.turns == 0:
            return hole
        side = self.cell.ground.walls[hole.wall]
        width, depth, _ = self.ground.size_m
        number, alongs = (side.turn - self.turns) % 4, []
        for along in (hole.first_m, hole.last_m):
            x, y = side.point(along)
            own = ((x, y), (y, depth - x), (width - x, depth - y), (width - y, x))[self.turns]
            alongs.append(own[1 - number % 2])
        return replace(hole, wall=number, first_m=min(alongs), last_m=max(alongs))

    def item(self, item: Item, floor_z_m: float) -> Item:
        """Transform an item from the local frame to the frame of the house."""
        x, y = self.to_house(item.x_m, item.y_m)
        yaw = (item.yaw_deg + 90.0 * self.turns) % 360
        return Item(item.model, x, y, item.z_m + floor_z_m, yaw)

    def rug(self, rug: Rug) -> Rug:
        """Transform a rug from the local frame to the frame of the house."""
        ax, ay = self.to_house(rug[0], rug[1])
        bx, by = self.to_house(rug[2], rug[3])
        return Rug(min(ax, bx), min(ay, by), max(ax, bx), max(ay, by), rug.colour, rug.turn_deg)


def furnish_cells(
    plan: HousePlan,
    gaps: tuple[Gap, ...],
    styles: list[Style],
    clutter: float,
    seed: tuple[int, ...],
    left_out: Collection[int] = (),
    *,
    full: bool = False,
) -> tuple[list[list[Item]], list[tuple[Rug, ...]]]:
    """Generate the items and rugs of each room, in the frame of the house.

    Rooms whose number is in ``left_out`` stay empty. This does not change the other rooms.
    ``full`` adds what people expect in each room beyond the main furniture.
    """
    items, rugs = [], []
    for number, cell in enumerate(plan.cells):
        if number in left_out:
            items.append([])
            rugs.append(())
            continue
        own = [(gap, gap.hole(number, cell)) for gap in gaps if number in gap.cells]
        leaves = [len(gap.cells) == 2 and gap.cells[0] == number for gap, _ in own]
        leaves = [leaf and gap.kind == "door" for leaf, (gap, _) in zip(leaves, own, strict=True)]
        holes = [hole for _, hole in own]
        held, flat = _furnish(
            plan, cell, holes, leaves, styles[number], clutter, (*seed, number), full=full
        )
        front = [hole for gap, hole in own if gap.kind == "door" and len(gap.cells) == 1]
        bare = RoomFrame(cell, 0)
        held += [
            bare.item(door_item(Plan(bare.ground, np.random.default_rng(0)), hole, WHITE), 0.0)
            for hole in front
        ]
        items.append(held)
        rugs.append(flat)
    return items, rugs


def _furnish(
    plan: HousePlan,
    cell: Cell,
    holes: list[Hole],
    leaves: list[bool],
    style: Style,
    clutter: float,
    seed: tuple[int, ...],
    *,
    full: bool,
) -> tuple[list[Item], tuple[Rug, ...]]:
    """Return the items and rugs of a room, or a nearly empty room if all attempts fail."""
    floor_z = cell.storey * plan.pitch_m
    for attempt in range(ATTEMPTS):
        rng = np.random.default_rng([*seed, attempt])
        tried = _try_cell(plan, cell, holes, leaves, style, clutter, rng, full=full)
        if tried is not None:
            frame, room, rugs = tried
            held = [frame.item(item, floor_z) for item in room.items]
            return held, tuple(frame.rug(rug) for rug in rugs)
    frame, room = _prepare_room(plan, cell, holes, leaves, style, np.random.default_rng(seed))
    return [frame.item(item, floor_z) for item in room.items], ()


def _try_cell(
    plan: HousePlan,
    cell: Cell,
    holes: list[Hole],
    leaves: list[bool],
    style: Style,
    clutter: float,
    rng: np.random.Generator,
    *,
    full: bool,
) -> tuple[RoomFrame, Plan, tuple[Rug, ...]] | None:
    """Try to furnish a room, and return None if the recipe does not fit or blocks a path."""
    frame, room = _prepare_room(plan, cell, holes, leaves, style, rng)
    recipe = furnish_galley if cell.kind == "kitchen" else KINDS[cell.kind].furnish
    rugs = recipe(room, style)
    inner = [frame.hole(hole) for hole in holes]
    steps = [_step_in(room, hole) for hole in inner if hole.kind != "window"]
    if rugs is None or not paths_are_clear(room, *steps, body_m=WIDE_BODY_M):
        return None
    if full:
        completion = Completion(room, style, rng, steps, WIDE_BODY_M)
        return frame, room, furnish_fully(completion, cell.kind, tuple(inner), rugs, clutter)
    hang_curtains(room, tuple(inner), style.curtain)
    scatter(room, clutter, rng, steps)
    return frame, room, rugs


def _prepare_room(
    plan: HousePlan,
    cell: Cell,
    holes: list[Hole],
    leaves: list[bool],
    style: Style,
    rng: np.random.Generator,
) -> tuple[RoomFrame, Plan]:
    """Return a room with only stairs and door leaves, and with their space reserved."""
    frame = RoomFrame(cell, int(rng.integers(4)) if not cell.ground.blocks else 0)
    room = Plan(frame.ground, rng)
    _take_stairs(room, plan, cell, style)
    for hole, has_leaf in zip(holes, leaves, strict=True):
        own = frame.hole(hole)
        reserve_before(room, own)
        room.items += [_leaf(room, own)] if has_leaf else []
    return frame, room


def _take_stairs(room: Plan, plan: HousePlan, cell: Cell, style: Style) -> None:
    """Place the stairs, or the railing of the stairwell, in a hall and reserve their space."""
    if cell.kind != "hall" or plan.flight is None:
        return
    floor_z = cell.storey * plan.pitch_m
    for item in stair_items(plan, plan.flight, style.wood)[cell.storey]:
        own = (item.x_m - cell.x_m, item.y_m - cell.y_m, item.z_m - floor_z)
        room.items.append(Item(item.model, *own, item.yaw_deg))
    x0, y0, x1, y1 = (
        value - off for value, off in zip(plan.flight.rect, (cell.x_m, cell.y_m) * 2, strict=True)
    )
    room.reserved.append((x0, y0 - STEP_OFF_M, 0.0, x1, y1 + STEP_OFF_M, 2.2))
    if cell.storey:
        a, b, _, c, d, _ = stairwell(plan, plan.flight)
        room.pits.append((a - cell.x_m, b - cell.y_m, c - cell.x_m, d - cell.y_m))


def _leaf(room: Plan, hole: Hole) -> Item:
    """Return the leaf of a door, opened by a quarter turn at the nearer corner."""
    wall = room.ground.walls[hole.wall]
    model = door(*LEAF_M, WHITE)
    at_start = hole.first_m - wall.first_m < wall.last_m - hole.last_m
    half = model.size_m[0] / 2
    along = hole.first_m - half if at_start else hole.last_m + half
    x, y = wall.point(along, model.size_m[1] / 2)
    # Its handle, on the model's left, is at the end that swings.
    return Item(model, x, y, 0.0, (270.0, 0.0, 90.0, 180.0)[wall.turn])


def _step_in(room: Plan, hole: Hole) -> tuple[float, float]:
    wall = room.ground.walls[hole.wall]
    return wall.point((hole.first_m + hole.last_m) / 2, STEP_IN_M)
