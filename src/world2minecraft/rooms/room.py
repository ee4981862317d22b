"""Seeded furnished rooms: a layout in metres and the same room as 2 cm voxels."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.errors import UnknownNameError, World2MinecraftError
from world2minecraft.rooms import voxels
from world2minecraft.rooms.kinds import KINDS, random_size
from world2minecraft.rooms.openings import (
    Hole,
    choose_openings,
    door_item,
    door_step_m,
    hang_curtains,
)
from world2minecraft.rooms.place import Item, Plan, ways_are_clear
from world2minecraft.rooms.style import WHITE, choose_style
from world2minecraft.types import Layout, LayoutObject

ATTEMPTS = 80  # A recipe fits on its first tries as a rule; the worst of 500 seeds is far below.


@dataclass(frozen=True, eq=False)
class Room:
    """A furnished room. ``instance`` n is ``layout.objects[n - 1]``.

    ``labels`` are class ids, 0 air; the inner box is from (0, 0, 0) to its size, the shell of
    walls, floor slab and ceiling lies around it.
    """

    kind: str
    seed: int
    layout: Layout
    labels: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    colour: np.ndarray  # uint8 [X, Y, Z, 3]
    voxel_m: float
    origin_m: np.ndarray  # float64 [3]

    @property
    def size_m(self) -> np.ndarray:
        """The inner sides and the height, float64 [3]."""
        return np.array([*self.layout.floor_polygon_m.max(axis=0), self.layout.wall_height_m])


def generate_room(seed: int, *, kind: str | None = None) -> Room:
    """Return the room of a seed: the same seed gives the same bytes.

    Args:
        seed: 0 or more.
        kind: one of ``KINDS``; None draws one.

    Raises:
        UnknownNameError: no kind has this name.
    """
    if seed < 0:
        raise ValueError(f"seed must be 0 or more, not {seed}")
    kind = kind_of_seed(seed) if kind is None else kind
    if kind not in KINDS:
        raise UnknownNameError("room kind", kind, KINDS)
    for attempt in range(ATTEMPTS):
        room = _try_room(seed, kind, np.random.default_rng([seed, attempt]))
        if room is not None:
            return room
    raise World2MinecraftError(f"seed {seed} gives no {kind} room; try another seed")


def kind_of_seed(seed: int) -> str:
    """Return the kind of room that a seed draws where none is asked for."""
    return sorted(KINDS)[int(np.random.default_rng(seed).integers(len(KINDS)))]


def _try_room(seed: int, kind: str, rng: np.random.Generator) -> Room | None:
    recipe = KINDS[kind]
    plan = Plan(random_size(recipe, rng), rng)
    style = choose_style(rng)
    holes = choose_openings(plan, walls=(2, 3) if kind == "kitchen" else (0, 1, 2, 3))
    rugs = recipe.furnish(plan, style)
    if rugs is None or not ways_are_clear(plan, door_step_m(plan, holes[0])):
        return None
    hang_curtains(plan, holes, style.curtain)
    items = [*plan.items, door_item(plan, holes[0], WHITE)]
    canvas = voxels.Canvas(plan.size_m)
    voxels.paint_shell(canvas, style, recipe.floor, rng)
    for hole in holes:
        voxels.paint_hole(canvas, hole)
    for rug in rugs:
        voxels.paint_rug(canvas, rug)
    for number, item in enumerate(items, start=1):
        voxels.paint_item(canvas, item, number, rng)
    return Room(
        kind=kind,
        seed=seed,
        layout=_layout(plan, holes, items),
        labels=canvas.labels,
        instance=canvas.instance,
        colour=canvas.colour,
        voxel_m=voxels.VOXEL_M,
        origin_m=canvas.origin_m,
    )


def _layout(plan: Plan, holes: tuple[Hole, ...], items: list[Item]) -> Layout:
    width, depth, height = plan.size_m
    return Layout(
        floor_polygon_m=np.array([[0, 0], [width, 0], [width, depth], [0, depth]], np.float64),
        wall_height_m=height,
        openings=tuple(hole.opening(plan) for hole in holes),
        objects=tuple(_layout_object(item) for item in items),
    )


def _layout_object(item: Item) -> LayoutObject:
    _, _, z0, _, _, z1 = item.box_m
    return LayoutObject(
        class_id=item.model.class_id,
        center_m=np.array([item.x_m, item.y_m, (z0 + z1) / 2]),
        size_m=np.array(item.model.size_m),
        yaw_deg=item.yaw_deg % 360,
        name=item.model.name,
    )
