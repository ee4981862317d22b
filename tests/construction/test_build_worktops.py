import numpy as np
from build_samples import DARK, FURN, RED, WHITE, Sketch

from world2minecraft.construction import build_volume
from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.cell_colours import unify_paints
from world2minecraft.construction.fitted_objects import LOWER
from world2minecraft.construction.palettes import parse_palette
from world2minecraft.construction.worktops import PlateBuilder, Worktop, join_worktops
from world2minecraft.core.coordinates import apply
from world2minecraft.geometry.colour import linear_to_oklab, srgb_to_linear, srgb_to_oklab
from world2minecraft.minecraft.block_colours import colour_of


def state_at(volume, *point_m):
    """The state of the block at a point of the room."""
    place = apply(np.linalg.inv(volume.block_to_room), np.array(point_m)) - volume.corner
    return volume.palette[volume.states[tuple(np.floor(place).astype(int))]]


def kitchen(lying=WHITE):
    """A red front under a rim of dark cells; the top itself was never measured."""
    sketch = Sketch((50, 25, 30))
    sketch.put((0, 7), (0, 25), (0, 11), 255, 0)
    sketch.put((7, 8), (0, 25), (0, 10), FURN, RED, 2)
    sketch.put((7, 8), (0, 25), (10, 11), FURN, DARK, 2)
    for y in (4, 12, 18):
        sketch.put((2, 5), (y, y + 3), (10, 12), FURN, lying, 2)
    return sketch


def chroma_of(state):
    return float(np.hypot(*srgb_to_oklab(np.array(colour_of(state), np.uint8))[1:]))


def lightness_of(state):
    return float(srgb_to_oklab(np.array(colour_of(state), np.uint8))[0])


def test_a_glossy_counter_is_one_dark_plate_over_a_red_front():
    sketch = kitchen()
    volume = build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m)
    tops, fronts = set(), set()
    for y in np.arange(0.1, 1.9, 0.2):
        fronts |= {state_at(volume, x, y, z) for x in (0.4, 0.6) for z in (0.1, 0.3, 0.6)}
        tops |= {state_at(volume, x, y, 0.8) for x in (0.1, 0.4, 0.6)}
    fronts = {
        state for state in fronts if not state.startswith(("minecraft:air", "minecraft:light["))
    }
    assert len(tops) == 1 and len(fronts) == 1
    top, front = tops.pop(), fronts.pop()
    assert lightness_of(top) < 0.4 and chroma_of(top) < 0.05
    assert "red" in front and "slab" not in front


def plates_over(numbers, scale, names):
    """Red counters side by side with a dark worktop each, and the palette of some blocks."""
    canvas = Canvas(Lattice((0, 63, 0), (12, 4, 5), np.zeros(2), scale))
    plates = PlateBuilder(canvas, parse_palette({"name": "few", "blocks": names}))
    for place, number in enumerate(numbers):
        columns = np.zeros((12, 4), bool)
        columns[1 + 3 * place : 3 + 3 * place, 1:3] = True
        dark = srgb_to_oklab(np.array(DARK, np.uint8))
        plates.worktops[number] = Worktop(columns, 1, LOWER, dark)
        at = (*np.nonzero(columns), np.full(4, 1))
        if scale < 1.5:
            canvas.put(at, canvas.id_of("minecraft:red_concrete"), FURN, number)
    return canvas, plates


def test_each_counter_at_a_block_a_metre_wears_a_carpet():
    names = ["red_concrete", "glass", "black_carpet", "white_carpet"]
    canvas, plates = plates_over((2, 3), 1.0, names)
    plates.put_carpets()
    assert (canvas.states[:, :, 2] == canvas.id_of("minecraft:black_carpet")).sum() == 8
    assert set(canvas.instance[:, :, 2][canvas.states[:, :, 2] > 0].tolist()) == {2, 3}
    canvas, plates = plates_over((2,), 1.0, names[:2])
    plates.put_carpets()
    assert not canvas.states[:, :, 2].any(), "a palette without carpets lays none"


def test_a_palette_without_slabs_lays_a_full_plate():
    canvas, plates = plates_over((2,), 4.0, ["white_concrete", "black_concrete", "glass"])
    plates._put_plate(plates.worktops[2], plates.worktops[2].columns, 2)
    assert (canvas.states == canvas.id_of("minecraft:black_concrete")).sum() == 4


def test_a_counter_that_was_measured_takes_no_plate():
    sketch = Sketch((50, 25, 30))
    sketch.put((0, 8), (0, 25), (0, 11), FURN, RED, 2)
    volume = build_volume(sketch.grid(), (), (), corner_m=sketch.corner_m)
    assert "red" in state_at(volume, 0.4, 1.0, 0.8)


def test_the_shades_and_hazes_of_a_strong_paint_are_one_colour():
    rng = np.random.default_rng(4)
    light = srgb_to_linear(np.array(RED, np.uint8)) * rng.uniform(0.5, 1.3, (400, 1))
    haze = rng.uniform(0, 0.12, (400, 1))
    reds = linear_to_oklab(np.clip(light * (1 - haze) + 0.4 * haze, 0, 1))
    wood = np.tile(srgb_to_oklab(np.array([162, 131, 79], np.uint8)), (300, 1))
    grey = np.tile(srgb_to_oklab(np.array([120, 120, 124], np.uint8)), (300, 1))
    found = unify_paints(np.concatenate([reds, wood, grey]).astype(np.float32))
    assert np.array_equal(found[400:], np.concatenate([wood, grey]).astype(np.float32))
    assert len(np.unique(found[:400], axis=0)) < 0.2 * 400
    few = unify_paints(reds[:100])
    assert np.array_equal(few, reds[:100].astype(np.float32))


def plate(x, layer, colour):
    columns = np.zeros((12, 4), bool)
    columns[x] = True
    return Worktop(columns, layer, 1, np.array(colour, np.float32))


def test_the_arms_of_an_l_wear_one_plate_as_the_larger_says():
    arms = {3: plate(slice(0, 2), 4, (0.2, 0, 0)), 8: plate(slice(2, 8), 3, (0.1, 0, 0))}
    found = join_worktops(arms)
    assert set(found) == {3, 8}
    assert found[3].layer == found[8].layer == 3
    np.testing.assert_array_equal(found[3].colour, arms[8].colour)
    np.testing.assert_array_equal(found[3].columns, arms[3].columns)


def test_plates_apart_or_at_other_heights_stay_as_they_are():
    tops = {1: plate(slice(0, 2), 3, (0.2, 0, 0)), 2: plate(slice(4, 8), 3, (0.1, 0, 0))}
    higher = {1: tops[1], 2: plate(slice(2, 8), 5, (0.1, 0, 0))}
    for given in (tops, higher):
        found = join_worktops(given)
        assert all(found[number] is given[number] for number in given)
