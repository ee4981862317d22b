"""Objects of shapes on the lattice: in their colours, equal where equal, and stable."""

import numpy as np
import pytest
from build_samples import CHAIR, FURN, RED, TABLE, WOOD, Sketch, placement

from world2minecraft.construction import BuildParameters, build_volume
from world2minecraft.construction.block_lattice import lattice_over
from world2minecraft.construction.fitted_objects import design_of_parts
from world2minecraft.construction.fitting import CALM, Shape, shape_set
from world2minecraft.construction.objects_from_cells import (
    Solid,
    enclosed_cells,
    kinds_for_sheet,
    make_solid,
    share_solids,
)
from world2minecraft.construction.palettes import load_palette
from world2minecraft.construction.shape_materials import materials_of
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.furniture import template
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_states import check_state, parse_state
from world2minecraft.minecraft.rules.stability import find_unstable

BARE = BuildParameters(lights="off", edge="none", ceiling="off", plaque="off")
KINDS = frozenset(("full", "slab", "stairs", "trapdoor", "post"))
VANILLA = load_palette("vanilla")
MATERIALS = materials_of(VANILLA)


def build(sketch, scale=4.0, placements=(), **changed):
    chosen = BuildParameters(**{**vars(BARE), **changed})
    return build_volume(
        sketch.grid(), placements, (), corner_m=sketch.corner_m, blocks_per_metre=scale,
        parameters=chosen,
    )  # fmt: skip


def names_of(volume, number):
    states = [volume.palette[n] for n in volume.states[volume.instance == number]]
    return [state.partition("[")[0].partition(":")[2] for state in states]


SPRUCE = (114, 84, 48)


def chair_cells(sketch, x, y, number, colour=SPRUCE):
    """Four legs, a seat and a back that looks to +x, of cells of 8 cm."""
    for i in (0, 5):
        for j in (0, 5):
            sketch.put((x + i, x + i + 1), (y + j, y + j + 1), (0, 5), CHAIR, colour, number)
    sketch.put((x, x + 6), (y, y + 6), (5, 6), CHAIR, colour, number)
    sketch.put((x, x + 1), (y, y + 6), (6, 12), CHAIR, colour, number)


def kinds_in(rgb, class_id=int(SemanticClass.FURN)):
    full = VANILLA.blocks[class_id]
    colours = srgb_to_oklab(np.array([rgb], np.uint8))
    return MATERIALS.kinds_for(colours, full, np.zeros(len(full)), class_id, 0.4)


def test_wood_comes_in_every_shape_and_red_in_none():
    assert {"slab", "stairs", "trapdoor", "post"} <= kinds_in((192, 175, 121))
    assert not {"slab", "stairs", "trapdoor"} & kinds_in((160, 20, 25))


def test_a_screen_has_no_wooden_panels():
    assert "trapdoor" not in kinds_in((30, 30, 34), int(SemanticClass.TVS))


def test_every_material_is_a_block_of_the_game_in_every_shape():
    shapes = shape_set(CALM | {"carpet", "post"}).shapes
    for shape in shapes:
        for block in MATERIALS.blocks.get(shape.kind, ()):
            check_state(parse_state(shape.of(block)))


def test_a_shape_is_of_its_own_wood_or_missing():
    slab = Shape("slab", (("type", "top"),))
    assert MATERIALS.shaped_state(slab, "minecraft:birch_planks") == (
        "minecraft:birch_slab[type=top,waterlogged=false]"
    )
    assert MATERIALS.shaped_state(slab, "minecraft:red_concrete") is None
    assert (
        MATERIALS.shaped_state(Shape("full"), "minecraft:red_concrete") == "minecraft:red_concrete"
    )


def test_a_red_object_is_of_full_blocks():
    sketch = Sketch().put((10, 12), (4, 14), (0, 9), FURN, RED, 1)
    assert set(names_of(build(sketch), 1)) == {"red_concrete"}


def test_cubes_are_cubes():
    sketch = Sketch()
    chair_cells(sketch, 10, 8, 1)
    names = names_of(build(sketch, shapes="cubes"), 1)
    assert names
    assert not [name for name in names if name.endswith(("slab", "stairs", "trapdoor", "fence"))]


def test_a_chair_of_cells_stands_on_legs_with_a_back():
    sketch = Sketch()
    chair_cells(sketch, 10, 8, 1)
    names = names_of(build(sketch), 1)
    assert any(name.endswith("fence") for name in names)
    assert any(name.endswith("trapdoor") for name in names)


@pytest.mark.parametrize("places", [((4, 4), (15, 5), (27, 6)), ((38, 9), (16, 7), (5, 12))])
def test_chairs_of_cells_come_out_equal(places):
    sketch = Sketch()
    own = []
    for number, (x, y) in enumerate(places, 1):
        chair_cells(sketch, x, y, number)
        centre = ((x + 3) * 0.08, (y + 3) * 0.08, 0.48)
        own.append(placement("cells", CHAIR, centre, (0.48, 0.48, 0.96), 0, number))
    volume = build(sketch, placements=own)
    shown = []
    for number in (1, 2, 3):
        at = np.argwhere(volume.instance == number)
        states = [volume.palette[volume.states[tuple(one)]] for one in at]
        shown.append(sorted(zip((at - at.min(0)).tolist(), states, strict=True)))
    assert shown[0] == shown[1] == shown[2]


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0, 6.0])
@pytest.mark.parametrize("style", ["blocks", "voxels"])
def test_nothing_that_is_built_falls(scale, style):
    sketch = Sketch()
    chair_cells(sketch, 10, 8, 1)
    sketch.put((20, 38), (8, 18), (8, 9), TABLE, WOOD, 2)
    sketch.put((20, 21), (8, 9), (0, 8), TABLE, WOOD, 2)
    sketch.put((37, 38), (17, 18), (0, 8), TABLE, WOOD, 2)
    sketch.put((0, 6), (0, 12), (0, 11), FURN, (120, 120, 122), 3)
    volume = build(sketch, scale, style=style)
    assert find_unstable(volume) == []


@pytest.mark.parametrize("whole", [True, False])
def test_the_guard_sends_what_fits_badly_to_the_library(whole):
    """A cupboard of all its cells is shown by them; three specks of one are built as a design."""
    sketch = Sketch()
    if whole:
        sketch.put((10, 16), (4, 16), (0, 12), FURN, SPRUCE, 1)
    else:
        for x, y, z in ((10, 4, 0), (15, 15, 11), (12, 9, 5)):
            sketch.put((x, x + 1), (y, y + 1), (z, z + 1), FURN, SPRUCE, 1)
    held = placement("cabinet", FURN, (1.04, 0.8, 0.48), (0.48, 0.96, 0.96))
    voxels, blocks = (build(sketch, 4.0, [held], style=style) for style in ("voxels", "blocks"))
    same = names_of(voxels, 1) == names_of(blocks, 1)
    assert same is not whole
    assert names_of(voxels, 1)


def test_what_lies_within_a_cupboard_belongs_to_it():
    sketch = Sketch()
    sketch.put((10, 16), (4, 12), (8, 9), FURN, WOOD, 1)
    sketch.put((15, 16), (4, 12), (0, 9), FURN, WOOD, 1)
    hidden = sketch.at((10, 15), (4, 12), (0, 8))
    sketch.labels[hidden] = 255
    grid = sketch.grid()
    cells = np.argwhere(grid.instance == 1)
    inner = enclosed_cells(cells, grid, FURN)
    assert len(inner) == 5 * 8 * 8
    assert len(enclosed_cells(cells, grid, TABLE)) == 0


def test_copies_share_what_most_of_them_have():
    whole = np.ones((4, 4, 6), bool)
    torn = whole.copy()
    torn[3, 3, :] = False
    solids = {1: Solid(whole, 0), 2: Solid(torn, 1), 3: Solid(whole, 2), 4: Solid(whole[:1], 0)}
    shared = share_solids(solids, {1: CHAIR, 2: CHAIR, 3: CHAIR, 4: CHAIR})
    assert shared[2].mask.all()
    assert [shared[number].turns for number in (1, 2, 3)] == [0, 1, 2]
    assert shared[4].mask.shape == (1, 4, 6)
    other = share_solids(solids, {1: CHAIR, 2: TABLE, 3: CHAIR, 4: CHAIR})
    assert not other[2].mask.all()


@pytest.mark.parametrize("turns", range(4))
def test_a_solid_is_turned_back_to_its_own_frame(turns):
    cells = np.argwhere(np.ones((2, 5, 3), bool))
    shape = make_solid(cells, np.zeros((0, 3), int), turns).mask.shape
    assert shape == ((5, 2, 3) if turns % 2 else (2, 5, 3))


def test_a_sheet_takes_no_stairs():
    sheet, block = (Solid(np.ones((n, 12, 20), bool), 0) for n in (1, 6))
    assert kinds_for_sheet(KINDS, sheet, 0.32) == KINDS - {"stairs"}
    assert kinds_for_sheet(KINDS - {"trapdoor"}, sheet, 0.32) == {"full", "post"}
    assert kinds_for_sheet(KINDS, block, 0.32) == KINDS


@pytest.mark.parametrize("turns", range(4))
def test_parts_turn_as_a_whole(turns):
    lattice = lattice_over(Sketch().grid(), np.array([0.0, 2.0]), 4.0)
    parts = template("chair").parts(np.array([0.48, 0.45, 0.88]))
    first, turned = (
        design_of_parts(
            placement("chair", CHAIR, (1, 1, 0.44), (0.48, 0.45, 0.88), one), parts, lattice, KINDS
        )
        for one in (0, turns)
    )
    shapes = shape_set(KINDS)
    assert np.array_equal(shapes.turns[turns][np.rot90(first.numbers, turns)], turned.numbers)
    assert np.array_equal(np.rot90(first.part, turns), turned.part)


def test_an_unknown_set_of_shapes_is_refused():
    with pytest.raises(UsageError, match="build.shapes must be calm or cubes, got 'round'"):
        BuildParameters(shapes="round")
