import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction.cell_colours import (
    MAX_GAIN,
    MIN_CELLS,
    coloured_cells,
    exposure_gain,
    fill_colours,
    group_medians,
)
from world2minecraft.construction.design_placement import DYES
from world2minecraft.construction.palettes import load_palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.surface_painting import (
    BlockChoice,
    choose_blocks,
    neighbour_table,
    paint,
    paint_surface,
    smooth_blocks,
)
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import COMPLETED, OBSERVED, UNSEEN, OccupancyGrid
from world2minecraft.geometry.colour import (
    linear_to_lab,
    linear_to_oklab,
    linear_to_srgb,
    oklab_to_linear,
    srgb_to_linear,
    srgb_to_oklab,
)
from world2minecraft.minecraft.block_colours import colour_of, colours_of, nearest_block
from world2minecraft.minecraft.collision_shapes import is_full_cube

WOOLS = [f"minecraft:{dye}_wool" for dye in DYES]
TERMS = dict(most=3, lightness_weight=0.4, calm_step=0.04, noticed=0.1)


def test_oklab_of_known_colours():
    # The values that the definition's author prints for the corners of sRGB.
    known = {
        (255, 255, 255): (1.0, 0.0, 0.0),
        (255, 0, 0): (0.6279, 0.2249, 0.1258),
        (0, 255, 0): (0.8664, -0.2339, 0.1795),
        (0, 0, 255): (0.4520, -0.0324, -0.3115),
        (0, 0, 0): (0.0, 0.0, 0.0),
    }
    for rgb, oklab in known.items():
        assert srgb_to_oklab(np.array(rgb, np.uint8)) == pytest.approx(oklab, abs=2e-4)


@given(st.tuples(*[st.integers(0, 255)] * 3))
def test_oklab_there_and_back(rgb):
    oklab = srgb_to_oklab(np.array(rgb, np.uint8))
    assert np.abs(linear_to_srgb(oklab_to_linear(oklab)).astype(int) - rgb).max() <= 1
    linear = srgb_to_linear(np.array(rgb, np.uint8))
    assert oklab_to_linear(linear_to_oklab(linear)) == pytest.approx(linear, abs=1e-5)


def test_each_wool_is_nearest_to_itself():
    assert nearest_block(colours_of(WOOLS), WOOLS).tolist() == list(range(16))


@given(st.lists(st.tuples(*[st.integers(0, 255)] * 3), min_size=1, max_size=20))
def test_the_nearest_block_is_the_nearest(colours):
    rgb = np.array(colours, np.uint8)
    offered = srgb_to_oklab(colours_of(WOOLS))
    chosen = nearest_block(rgb, WOOLS)
    for colour, index in zip(srgb_to_oklab(rgb), chosen, strict=True):
        apart = np.linalg.norm(offered - colour, axis=1)
        assert apart[index] == pytest.approx(apart.min(), abs=1e-6)


def test_no_candidates_is_an_error():
    with pytest.raises(ValueError, match="needs at least one candidate block"):
        nearest_block(np.zeros((1, 3), np.uint8), [])


@pytest.mark.parametrize(
    "shape,material",
    [
        ("red_carpet", "red_wool"),
        ("minecraft:oak_slab[type=top,waterlogged=false]", "oak_planks"),
        ("stone_brick_wall", "stone_bricks"),
        ("quartz_stairs", "quartz_block"),
        ("dark_oak_fence_gate", "dark_oak_planks"),
        ("waxed_cut_copper_slab", "cut_copper"),
        ("red_stained_glass_pane", "red_stained_glass"),
        ("spruce_wood", "spruce_log"),
        ("crimson_hyphae", "crimson_stem"),
        ("lime_bed", "lime_wool"),
    ],
)
def test_shapes_have_the_colour_of_their_material(shape, material):
    assert colour_of(shape) == colour_of(material)


def test_a_mod_s_block_has_a_colour_of_its_own_that_stays():
    first = colour_of("tmeo_ultra:shafazhuanjiao")
    assert first == colour_of("tmeo_ultra:shafazhuanjiao[facing=east]") == (183, 152, 150)
    assert first != colour_of("tmeo_ultra:yigui")


def test_a_noisy_surface_becomes_one_block():
    rng = np.random.default_rng(0)
    positions = np.argwhere(np.ones((12, 1, 12), bool))
    base = srgb_to_oklab(np.array([170, 45, 40], np.uint8))
    colours = (base + rng.normal(0, 0.03, (len(positions), 3))).astype(np.float32)
    index = paint(colours, positions, WOOLS, **TERMS)
    assert {WOOLS[i] for i in index} == {"minecraft:red_wool"}


def test_an_edge_between_colours_stays_where_it_is():
    positions = np.argwhere(np.ones((10, 1, 6), bool))
    rgb = np.where((positions[:, 2] < 4)[:, None], (161, 39, 35), (30, 30, 34)).astype(np.uint8)
    chosen = np.array(WOOLS)[paint(srgb_to_oklab(rgb), positions, WOOLS, **TERMS)]
    assert set(chosen[positions[:, 2] < 4]) == {"minecraft:red_wool"}
    assert set(chosen[positions[:, 2] >= 4]) == {"minecraft:black_wool"}


def test_the_number_of_blocks_is_limited():
    rng = np.random.default_rng(2)
    rgb = rng.integers(0, 256, (300, 3)).astype(np.uint8)
    positions = np.argwhere(np.ones((300, 1, 1), bool))
    index = paint(srgb_to_oklab(rgb), positions, WOOLS, **TERMS)
    assert 1 < len(set(index.tolist())) <= 3
    costs = np.array([[0.0, 1.0, 1.0], [1.0, 0.0, 0.99]] * 20)
    assert choose_blocks(costs, 3, 0.1).tolist() == [0, 1]


@given(st.integers(0, 10_000))
def test_neighbours_are_those_one_step_away(seed):
    rng = np.random.default_rng(seed)
    positions = np.argwhere(rng.random((4, 3, 5)) < 0.5)
    if not len(positions):
        return
    table = neighbour_table(positions)
    for row, place in zip(table, positions, strict=True):
        found = {tuple(positions[i]) for i in row if i < len(positions)}
        apart = np.abs(positions - place).sum(1)
        assert found == {tuple(other) for other in positions[apart == 1]}


def test_calm_without_a_step_is_the_nearest():
    costs = np.random.default_rng(5).random((50, 4))
    positions = np.argwhere(np.ones((50, 1, 1), bool))
    assert np.array_equal(smooth_blocks(costs, positions, 0.0), costs.argmin(1))


def test_medians_are_those_of_each_group():
    rng = np.random.default_rng(6)
    groups = rng.integers(0, 7, 60)
    colours = rng.random((60, 3)).astype(np.float32)
    medians, sizes = group_medians(groups, colours, 9)
    for group in range(9):
        mine = colours[groups == group]
        assert sizes[group] == len(mine)
        wanted = np.median(mine, axis=0) if len(mine) else np.zeros(3)
        assert medians[group] == pytest.approx(wanted, abs=1e-6)


def test_unseen_blocks_take_near_colours_or_the_median():
    colours = np.zeros((9, 1, 1, 3), np.float32)
    colours[0], colours[1] = 0.2, 0.6
    known = np.zeros((9, 1, 1), bool)
    known[:2] = True
    found = fill_colours(colours, known, np.ones_like(known), np.full(3, 0.9))
    assert found[:, 0] == pytest.approx([0.2, 0.6, 0.6, 0.6, *[0.4] * 5])
    nothing = fill_colours(colours, known & False, np.ones_like(known), np.full(3, 0.9))
    assert nothing[:, 0] == pytest.approx([0.9] * 9)


@given(st.floats(0.02, 1.0), st.floats(0.3, 1.0))
def test_a_dim_room_is_lifted_and_a_bright_one_left(light, factor):
    walls = np.full((MIN_CELLS, 3), light)
    labels = np.full(MIN_CELLS, int(SemanticClass.WALL), np.uint8)
    gain = exposure_gain(walls, labels)
    assert 1.0 <= gain <= exposure_gain(walls * factor, labels) <= MAX_GAIN
    assert light < 0.6 or gain == 1.0
    assert light > 0.2 or gain > 1.05


def test_few_cells_say_nothing_of_the_exposure():
    labels = np.full(MIN_CELLS - 1, int(SemanticClass.WALL), np.uint8)
    assert exposure_gain(np.full((MIN_CELLS - 1, 3), 0.01), labels) == 1.0


@pytest.mark.parametrize(
    "paint", [(208, 195, 178), (226, 220, 204), (234, 220, 200), (213, 184, 169)]
)
@pytest.mark.parametrize("share", [0.7, 0.85, 1.0])
def test_a_pale_wall_is_built_pale_and_not_grey(paint, share):
    palette, parameters = load_palette("vanilla"), BuildParameters()
    dimmed = linear_to_oklab(srgb_to_linear(np.array(paint, np.uint8)) * share)
    mask = np.ones((4, 1, 4), bool)
    colours = np.broadcast_to(dimmed, (4, 1, 4, 3)).astype(np.float32)
    choice = BlockChoice(int(SemanticClass.WALL), palette, parameters, 3)
    built = set(paint_surface(mask, colours, mask, choice).tolist())
    assert len(built) == 1
    lab = linear_to_lab(srgb_to_linear(np.array(colour_of(built.pop()), np.uint8)))
    assert np.hypot(lab[1], lab[2]) > 3.5
    assert lab[0] > 70


def test_walls_and_ceilings_are_of_smooth_blocks():
    relief = ("bricks", "_tiles", "polished_", "diorite", "andesite", "granite", "smooth_stone")
    palette = load_palette("vanilla")
    for class_id in (SemanticClass.WALL, SemanticClass.CEILING):
        assert not [b for b in palette.blocks[int(class_id)] if any(word in b for word in relief)]


def test_completed_structure_lends_no_colour():
    labels = np.full((4, 4, 4), 255, np.uint8)
    labels[:, :, 0] = int(SemanticClass.FLOOR)
    labels[0, 0, 1:] = int(SemanticClass.WALL)
    source = np.where(labels < 255, COMPLETED, UNSEEN).astype(np.uint8)
    source[:2, :, 0] = OBSERVED
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.ones(labels.shape, np.float16),
        source=source,
        instance=np.zeros(labels.shape, np.uint16),
        colour=np.full((*labels.shape, 3), 90, np.uint8),
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )
    coloured = coloured_cells(grid)
    assert (coloured[:, :, 0] == (source[:, :, 0] == OBSERVED)).all()
    assert coloured[0, 0, 1:].all()  # Of the wall nothing else was seen.


def test_the_palette_allows_only_blocks_that_stay_as_they_are():
    palette = load_palette("vanilla")
    falling = ("sand", "gravel", "concrete_powder", "red_sand")
    glowing = ("lantern", "froglight", "glowstone", "shroomlight", "magma", "lamp")
    for blocks in palette.blocks.values():
        assert len(set(blocks)) == len(blocks) > 10
        for block in blocks:
            name = block.partition("[")[0].removeprefix("minecraft:")
            assert is_full_cube(block)
            assert name not in falling
            assert not any(word in name for word in (*glowing, "leaves", "glazed", "log", "ice"))
            assert not name.startswith(("exposed_", "weathered_", "copper", "cut_copper"))
    for class_id, default in palette.defaults.items():
        assert default in palette.blocks[class_id]
