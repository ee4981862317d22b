import numpy as np
import pytest

from world2minecraft.construction.colour_sets import darken_screens, unify_sets
from world2minecraft.construction.plants import LEAVES, POT, is_green, is_plant, leafy_states
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OBSERVED, ObjectInstance, OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab

BIRCH, OAK, RED = (
    srgb_to_oklab(np.array(one, np.uint8))
    for one in ((200, 170, 120), (190, 160, 115), (150, 40, 40))
)
LEAF, CLAY = (srgb_to_oklab(np.array(one, np.uint8)) for one in ((70, 110, 40), (150, 90, 70)))


def room(boxes, class_id, names):
    """Return a grid with an object in each box of cells along x, and the objects."""
    labels, instance = np.zeros((40, 6, 6), np.uint8), np.zeros((40, 6, 6), np.uint16)
    for number, (start, stop) in enumerate(boxes, 1):
        labels[start:stop, :3, :4], instance[start:stop, :3, :4] = class_id, number
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        source=np.full(labels.shape, OBSERVED, np.uint8),
        instance=instance,
        colour=np.full((*labels.shape, 3), 90, np.uint8),
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )
    return grid, [thing(np.argwhere(instance == n), class_id, n, name) for n, name in names]


def thing(cells, class_id, number=1, name=""):
    low, high = cells.min(0), cells.max(0) + 1
    return ObjectInstance(
        id=number,
        class_id=class_id,
        size_m=(high - low) * 0.08,
        center_m=(low + high) * 0.04,
        yaw_deg=0.0,
        cells=cells.astype(np.int32),
        confidence=1.0,
        name=name,
    )


def united(boxes, class_id, names, paints):
    """Return the colours of each object after unification, float32 [N, 3] each."""
    grid, things = room(boxes, class_id, list(enumerate(names, 1)))
    colours = np.zeros((*grid.shape, 3), np.float32)
    for one, paint in zip(things, paints, strict=True):
        colours[tuple(one.cells.T)] = paint
    found = unify_sets(things, colours, grid.occupied)
    return [found[tuple(one.cells.T)] for one in things]


@pytest.mark.parametrize(
    ("gap", "names", "paints", "shared"),
    [
        (1, ("wall cabinet", "counter"), (BIRCH, OAK), True),
        (9, ("wall cabinet", "counter"), (BIRCH, OAK), False),
        (1, ("wall cabinet", "counter"), (BIRCH, RED), False),
        (1, ("wall cabinet", "refrigerator"), (BIRCH, OAK), False),
    ],
)
def test_cupboards_side_by_side_share_their_paint(gap, names, paints, shared):
    boxes = ((0, 8), (8 + gap, 16 + gap))
    first, second = united(boxes, int(SemanticClass.FURN), names, paints)
    assert (first == first[0]).all()
    assert (first[0] == second[0]).all() == shared
    if not shared:
        assert (first[0] == paints[0].astype(np.float32)).all()


def test_curtains_of_a_room_share_their_cloth():
    boxes, names = ((0, 8), (30, 38)), ("curtain", "curtain")
    first, second = united(boxes, int(SemanticClass.OBJS), names, (BIRCH, OAK))
    assert (first == second).all()


def test_a_worktop_keeps_its_colour_in_a_row():
    grid, things = room(((0, 8), (8, 16)), int(SemanticClass.FURN), [(1, "counter"), (2, "")])
    colours = np.where(grid.labels[..., None] > 0, BIRCH, 0).astype(np.float32)
    colours[8:16, :3] = OAK
    colours[:, :, 3] = RED
    found = unify_sets(things, colours, grid.occupied)
    assert (found[:16, :3, 3] == RED).all()
    assert (found[:16, :3, :3] == found[0, 0, 0]).all()


def test_a_plant_has_leaves_over_a_pot():
    layers = np.array([0, 1, 1, 2])
    states = np.array(["minecraft:green_wool"] * 4, object)
    built = leafy_states(states, layers, np.array([LEAF] * 4))
    assert built[0] == POT
    assert set(built[1:]) <= set(LEAVES)
    trunk = leafy_states(states, layers, np.array([CLAY, CLAY, LEAF, LEAF]))
    assert trunk[:2].tolist() == states[:2].tolist()
    assert set(trunk[2:]) <= set(LEAVES)


def test_only_green_and_loose_things_are_plants_without_a_name():
    rng = np.random.default_rng(0)
    box = np.argwhere(np.ones((6, 6, 6), bool))
    loose = box[rng.random(len(box)) < 0.3]
    objs = int(SemanticClass.OBJS)
    green, clay = np.array([LEAF] * 50), np.array([CLAY] * 50)
    assert is_green(green).all()
    assert not is_green(clay).any()
    assert is_plant(thing(loose, objs), green)
    assert not is_plant(thing(box, objs), green)
    assert not is_plant(thing(loose, objs), clay)
    assert not is_plant(thing(loose, int(SemanticClass.CHAIR)), green)
    assert is_plant(thing(box, objs, name="plant"), green)


@pytest.mark.parametrize(("light", "dark"), [(0.3, True), (0.7, True), (0.95, False)])
def test_a_screen_is_black_unless_it_is_lit(light, dark):
    tvs = int(SemanticClass.TVS)
    grid, things = room(((0, 8), (20, 28)), tvs, [(1, "television"), (2, "television")])
    colours = np.where(grid.labels[..., None] > 0, OAK, 0).astype(np.float32)
    colours[:8] = light, 0.04, 0.06
    found = darken_screens(grid, things, colours, grid.occupied)
    own = found[tuple(things[0].cells.T)]
    assert (own[:, 0] < 0.3).all() == dark
    assert (own == colours[tuple(things[0].cells.T)]).all() == (not dark)
    assert np.ptp(found[tuple(things[1].cells.T)], axis=0).max() == 0
    assert (found[~grid.occupied] == colours[~grid.occupied]).all()
