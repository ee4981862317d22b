"""Generation of furnished rooms from a seed, as layouts in metres and 2 cm voxels."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.errors import UnknownNameError, World2MinecraftError
from world2minecraft.core.types import Layout, LayoutObject
from world2minecraft.procgen.rooms import voxelization as voxels
from world2minecraft.procgen.rooms.clutter import NARROW_BODY_M, WIDE_BODY_M, scatter
from world2minecraft.procgen.rooms.colour_scheme import WHITE, Style, choose_style
from world2minecraft.procgen.rooms.floor_shapes import SHAPES, draw_shape, open_walls, shaped_ground
from world2minecraft.procgen.rooms.full_furnishing import (
    Completion,
    check_furnishing,
    furnish_fully,
)
from world2minecraft.procgen.rooms.openings import (
    Hole,
    choose_openings,
    door_item,
    door_step_m,
    hang_curtains,
)
from world2minecraft.procgen.rooms.placement import Item, Plan, Rug, paths_are_clear
from world2minecraft.procgen.rooms.recipes import (
    BASE_KINDS,
    KINDS,
    find_kind,
    random_size,
    room_title,
)

ATTEMPTS = 80  # A recipe fits on its first tries as a rule; the worst of 500 seeds is far below.


@dataclass(frozen=True, eq=False)
class Room:
    """A generated furnished room, or a house of several rooms.

    Instance n is the n-th object of all layouts in order, ``objects[n - 1]``. ``labels`` contains
    class IDs, with 0 for air. The inner box of a room extends from (0, 0, 0) to its size and is
    surrounded by the shell of walls, floor slab and ceiling. In a house, this applies to the box
    around all rooms.

    Attributes:
        kind: Room type, such as ``kitchen``.
        seed: Random seed.
        layouts: Layout of each room: floor, openings and objects, in metres.
        labels: Class of each voxel as uint8 [X, Y, Z].
        instance: Instance of each voxel as uint16 [X, Y, Z], or 0.
        colour: Colour of each voxel as uint8 [X, Y, Z, 3].
        voxel_m: Side length of a voxel in metres.
        origin_m: Minimum corner of voxel (0, 0, 0) in metres, float64 [3].
    """

    kind: str
    seed: int
    layouts: tuple[Layout, ...]
    labels: np.ndarray  # uint8 [X, Y, Z]
    instance: np.ndarray  # uint16 [X, Y, Z]
    colour: np.ndarray  # uint8 [X, Y, Z, 3]
    voxel_m: float
    origin_m: np.ndarray  # float64 [3]

    @property
    def layout(self) -> Layout:
        """The first layout, which is the only layout of a single room."""
        return self.layouts[0]

    @property
    def objects(self) -> tuple[LayoutObject, ...]:
        """The objects of all layouts, in the order of their instances."""
        return tuple(item for layout in self.layouts for item in layout.objects)

    @property
    def title(self) -> str:
        """What people call the room, such as ``A bedroom``."""
        return room_title(self.kind)

    @property
    def size_m(self) -> np.ndarray:
        """The inner width, depth and height of the box around all rooms, float64 [3]."""
        sides = np.max([layout.floor_polygon_m.max(axis=0) for layout in self.layouts], axis=0)
        top = max(layout.floor_z_m + layout.wall_height_m for layout in self.layouts)
        return np.array([*sides, top])

    def __repr__(self) -> str:
        size = " x ".join(f"{side:.1f}" for side in self.size_m)
        return f"Room({self.kind!r}, seed {self.seed}, {size} m, {len(self.objects)} objects)"


def generate_room(
    seed: int,
    *,
    kind: str | None = None,
    clutter: float = 0.0,
    shape: str | None = "box",
    furnishing: str = "basic",
) -> Room:
    """Generate a room from a seed. The same arguments always give the same bytes.

    Args:
        seed: The random seed, at least 0.
        kind: One of ``KINDS``, or its title, such as ``bedroom``. The default is a random kind from
            ``BASE_KINDS``.
        clutter: Amount of loose objects and displaced chairs, from 0 (tidy) to 1.
        shape: One of ``SHAPES``, or None for a random shape.
        furnishing: ``basic`` for the main furniture, or ``full`` for all that people expect in a
            room of its kind. Clutter in full rooms also sets furniture askew and hides parts of it.

    Raises:
        UnknownNameError: If the kind, the shape or the furnishing is unknown.
        ValueError: If the seed or the clutter is out of range.
        World2MinecraftError: If no room can be furnished with this seed.
    """
    if seed < 0:
        raise ValueError(f"seed must be 0 or more, got {seed}")
    if not 0 <= clutter <= 1:
        raise ValueError(f"clutter must be from 0 to 1, got {clutter}")
    kind = draw_kind(seed) if kind is None else find_kind(kind)
    shape = draw_shape(seed) if shape is None else shape
    if shape not in SHAPES:
        raise UnknownNameError("room shape", shape, SHAPES)
    check_furnishing(furnishing)
    made = furnish_plan(seed, kind, shape, clutter, full=furnishing == "full")
    if made is None:
        raise World2MinecraftError(
            f"cannot generate a {kind} room from seed {seed}; try another seed"
        )
    canvas = _paint(made)
    return Room(
        kind=kind,
        seed=seed,
        layouts=(made.layout(),),
        labels=canvas.labels,
        instance=canvas.instance,
        colour=canvas.colour,
        voxel_m=voxels.VOXEL_M,
        origin_m=canvas.origin_m,
    )


def draw_kind(seed: int) -> str:
    """Return the random kind of room of a seed, used if no kind is given."""
    return sorted(BASE_KINDS)[int(np.random.default_rng(seed).integers(len(BASE_KINDS)))]


@dataclass(frozen=True)
class FurnishedPlan:
    """A furnished room that is not yet voxelized, with its openings, rugs and items."""

    kind: str
    plan: Plan
    style: Style
    holes: tuple[Hole, ...]
    rugs: tuple[Rug, ...]
    items: list[Item]

    def layout(self) -> Layout:
        """Return the room as a layout."""
        ground = self.plan.ground
        return Layout(
            floor_polygon_m=ground.polygon_m,
            wall_height_m=ground.size_m[2],
            openings=tuple(hole.opening(ground) for hole in self.holes),
            objects=tuple(layout_object(item) for item in self.items),
            name=self.kind,
        )


def furnish_plan(
    seed: int, kind: str, shape: str, clutter: float, *, full: bool
) -> FurnishedPlan | None:
    """Furnish a room without voxelizing it, with the arguments of ``generate_room``.

    Returns None if all attempts fail.
    """
    for attempt in range(ATTEMPTS):
        rng = np.random.default_rng([seed, attempt])
        made = _try_plan(seed, kind, shape, clutter, rng, full=full)
        if made is not None:
            return made
    return None


def _try_plan(
    seed: int, kind: str, shape: str, clutter: float, rng: np.random.Generator, *, full: bool
) -> FurnishedPlan | None:
    recipe = KINDS[kind]
    plan = Plan(shaped_ground(shape, random_size(recipe, rng), rng), rng)
    style = choose_style(rng)
    holes = choose_openings(plan, walls=open_walls(plan.ground, kind))
    rugs = recipe.furnish(plan, style)
    # Box rooms keep the narrower way that old seeds were drawn with.
    body_m = NARROW_BODY_M if shape == "box" and kind in BASE_KINDS else WIDE_BODY_M
    doors = [door_step_m(plan, holes[0])]
    if rugs is None or not paths_are_clear(plan, *doors, body_m=body_m):
        return None
    if full:
        room = Completion(plan, style, np.random.default_rng([seed, 1 << 22]), doors, body_m)
        rugs = furnish_fully(room, kind, holes, rugs, clutter)
    else:
        hang_curtains(plan, holes, style.curtain)
        scatter(plan, clutter, np.random.default_rng([seed, 1 << 21]), doors)
    items = [*plan.items, door_item(plan, holes[0], WHITE)]
    return FurnishedPlan(kind, plan, style, holes, rugs, items)


def _paint(made: FurnishedPlan) -> voxels.Canvas:
    """Voxelize a furnished room."""
    plan = made.plan
    canvas = voxels.Canvas(plan.size_m)
    voxels.paint_shell(canvas, made.style, KINDS[made.kind].floor, plan.rng)
    voxels.paint_built(canvas, plan.ground, made.style)
    for hole in made.holes:
        voxels.paint_hole(canvas, hole, plan.ground.walls[hole.wall])
    for rug in made.rugs:
        voxels.paint_rug(canvas, rug, (0.0, 0.0, *plan.size_m[:2]))
    for number, item in enumerate(made.items, start=1):
        voxels.paint_item(canvas, item, number, plan.rng)
    return canvas


def layout_object(item: Item) -> LayoutObject:
    """Return an item in the form of a layout object."""
    _, _, z0, _, _, z1 = item.box_m
    return LayoutObject(
        class_id=item.model.class_id,
        center_m=np.array([item.x_m, item.y_m, (z0 + z1) / 2]),
        size_m=np.array(item.model.size_m),
        yaw_deg=item.yaw_deg % 360,
        name=item.model.name,
    )
