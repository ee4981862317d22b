"""What display furniture makes of tops without depth, hanging fronts, walls and colours."""

import numpy as np
import pytest
from build_samples import DARK, FLOOR, FURN, RED, VOXEL_M, WALL, WHITE, Sketch
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction.block_lattice import lattice_over
from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.display.block_alignment import BlockAligner
from world2minecraft.construction.display.boxes import DisplayBox, Frame
from world2minecraft.construction.display.builder import (
    MAX_COLOURS,
    boxes_of_cells,
    frame_of_cells,
    remove_small_parts,
)
from world2minecraft.construction.display.colliders import MARK, cover_of, put_colliders
from world2minecraft.construction.display.part_materials import role_colours, states_of_parts
from world2minecraft.construction.display.worktops import as_counter, deepened, plate_pieces
from world2minecraft.construction.palettes import load_palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.surface_painting import BlockChoice
from world2minecraft.construction.worktops import Worktop
from world2minecraft.core.types import Placement
from world2minecraft.furniture import template
from world2minecraft.geometry.colour import srgb_to_oklab

BLOCKS = 4.0


def worktop(plan: np.ndarray, top_m: float = 0.96) -> Worktop:
    dark = srgb_to_oklab(np.array(DARK, np.uint8))
    return Worktop(np.zeros((3, 3), bool), 3, 1, dark, top_m, plan)


def row(height_m: float, template_name: str = "bookcase", depth_m: float = 0.4) -> Placement:
    size = [depth_m, 2.0, height_m]
    return Placement(4, FURN, template_name, [1.0, 1.0, height_m / 2], size, 0, 0.5)


def test_a_row_under_a_worktop_is_a_counter_up_to_it():
    tops = {4: worktop(np.ones((20, 20), bool))}
    counter = as_counter(row(0.88), tops)
    assert counter.template == "counter"
    assert counter.center_m[2] + counter.size_m[2] / 2 == pytest.approx(0.96)
    assert as_counter(row(1.8), tops).template == "bookcase"
    assert as_counter(row(0.88), {}).template == "bookcase"


def test_a_plate_covers_what_no_counter_does():
    grid = Sketch().grid()
    plan = np.zeros(grid.shape[:2], bool)
    plan[5:25, 5:12] = True
    found = plate_pieces(worktop(plan), np.zeros_like(plan), grid, "stone")
    assert found is not None
    pieces, frame = found
    assert len(pieces) == 1
    assert frame.size_m[:2] == pytest.approx([20 * VOXEL_M, 7 * VOXEL_M])
    assert frame.base_m[2] + frame.size_m[2] == pytest.approx(0.96)
    assert plate_pieces(worktop(plan), plan, grid, "stone") is None


def hanging(gap_cells: int, *, seen: bool) -> tuple[Sketch, Placement]:
    """A red panel a few cells before the wall at x = 0, and what is between."""
    sketch = Sketch(size=(30, 30, 30))
    low = gap_cells
    sketch.put((low, low + 1), (8, 24), (17, 21), FURN, RED, 4)
    if not seen:
        sketch.labels[sketch.at((0, low), (8, 24), (17, 21))] = 255
    middle = [(low + 0.5) * VOXEL_M, 16 * VOXEL_M, 19 * VOXEL_M]
    size = [VOXEL_M, 16 * VOXEL_M, 4 * VOXEL_M]
    return sketch, Placement(4, FURN, "box", middle, size, 0, 0.9)


def test_a_front_that_hangs_before_its_wall_is_as_deep_as_to_it():
    sketch, placement = hanging(4, seen=False)
    deep = deepened(placement, sketch.grid())
    assert deep.size_m[0] == pytest.approx(5 * VOXEL_M)
    assert deep.center_m[0] - deep.size_m[0] / 2 == pytest.approx(0.0)
    assert deep.center_m[0] + deep.size_m[0] / 2 == pytest.approx(5 * VOXEL_M)


@pytest.mark.parametrize(("gap", "seen"), [(4, True), (12, False)])
def test_a_front_before_seen_space_or_far_off_stays(gap, seen):
    sketch, placement = hanging(gap, seen=seen)
    assert deepened(placement, sketch.grid()) is placement


def shell(blocks_per_metre: float = BLOCKS) -> tuple[Canvas, Sketch]:
    """A floor and walls around a room of 4 x 2 m, whose walls stand on the lattice."""
    sketch = Sketch()
    canvas = Canvas(lattice_over(sketch.grid(), sketch.corner_m, blocks_per_metre))
    ground = canvas.lattice.ground
    low = np.floor(canvas.lattice.coordinates_of(np.zeros(3)) + 0.5).astype(int)
    high = np.floor(canvas.lattice.coordinates_of(np.array([4.0, 2.0, 2.0])) + 0.5).astype(int)
    inner = (slice(low[0], high[0]), slice(low[1], high[1]), slice(ground, high[2]))
    canvas.put(np.ones(canvas.states.shape, bool), canvas.id_of("stone"), WALL)
    canvas.states[inner] = canvas.semantic[inner] = 0
    canvas.semantic[:, :, ground - 1] = FLOOR
    return canvas, sketch


@given(
    st.floats(0.3, 3.6),
    st.floats(0.3, 1.6),
    st.floats(0.2, 0.6),
    st.sampled_from([0.0, 90.0, 25.0]),
)
def test_nothing_is_sunk_in_a_wall_and_moves_by_little(x, y, half, yaw_deg):
    canvas, sketch = shell()
    frame = Frame(np.array([x, y, 0.05]), np.array([2 * half, half, 0.7]), yaw_deg)
    moved = BlockAligner(canvas, sketch.grid()).settle(frame, "floor", carried=False)
    low, high = canvas.lattice.coordinates_of(moved.bounds_m)
    assert np.abs(moved.base_m[:2] - frame.base_m[:2]).max() <= 1.25 / BLOCKS + 1e-9
    assert low[2] == pytest.approx(canvas.lattice.ground)
    before = canvas.lattice.coordinates_of(frame.bounds_m)
    inside = canvas.lattice.coordinates_of(np.array([[0.0, 0, 0], [4.0, 2.0, 2.0]]))
    if (before[0, :2] >= inside[0, :2] - 1).all() and (before[1, :2] <= inside[1, :2] + 1).all():
        assert (low[:2] >= np.floor(inside[0, :2] + 0.5) - 1e-5).all()
        assert (high[:2] <= np.floor(inside[1, :2] + 0.5) + 1e-5).all()


def test_a_cupboard_at_a_wall_touches_its_blocks():
    canvas, sketch = shell(3.3)
    frame = Frame(np.array([0.2, 1.0, 0.0]), np.array([0.4, 0.8, 0.9]), 0.0)
    moved = BlockAligner(canvas, sketch.grid()).settle(frame, "floor", carried=False)
    back = canvas.lattice.coordinates_of(moved.bounds_m)[0, 0]
    wall = int(np.flatnonzero(canvas.states[:, 5, canvas.lattice.ground + 1] == 0)[0])
    assert back == pytest.approx(wall, abs=1e-6)


def test_what_lies_on_a_thing_goes_where_it_goes():
    canvas, sketch = shell()
    settler = BlockAligner(canvas, sketch.grid())
    table = Frame(np.array([0.3, 1.0, 0.04]), np.array([0.8, 0.8, 0.7]), 0.0)
    moved = settler.settle(table, "floor", carried=False)
    cup = settler.settle(
        Frame(np.array([0.4, 1.0, 0.82]), np.array([0.1, 0.1, 0.1]), 0.0), "any", carried=True
    )
    assert cup.base_m[2] == pytest.approx(moved.base_m[2] + 0.7)
    assert cup.base_m[0] - 0.4 == pytest.approx(moved.base_m[0] - 0.3)


def test_a_lamp_hangs_from_the_blocks_of_the_ceiling():
    canvas, sketch = shell()
    frame = Frame(np.array([2.0, 1.0, 1.5]), np.array([0.3, 0.3, 0.42]), 0.0)
    moved = BlockAligner(canvas, sketch.grid()).settle(frame, "ceiling", carried=False)
    top = canvas.lattice.coordinates_of(moved.bounds_m)[1, 2]
    assert top == pytest.approx(round(top), abs=1e-6)
    assert canvas.states[8, 8, round(top)] > 0


def test_colliders_are_barriers_only_in_filled_blocks():
    canvas, _ = shell()
    frame = Frame(np.array([2.0, 1.0, 0.0]), np.array([1.0, 1.0, 1.0]), 0.0)
    solid = DisplayBox(np.array([-0.5, -0.5, 0.0, 0.5, 0.5, 0.5]), "stone")
    pole = DisplayBox(np.array([-0.02, -0.02, 0.5, 0.02, 0.02, 1.0]), "stone")
    assert cover_of([solid], frame, canvas).volume.sum() == pytest.approx(4 * 4 * 2)
    count = put_colliders(canvas, [solid, pole], frame, FURN, 7)
    mine = canvas.instance == 7
    assert count == 32
    assert (canvas.states[mine] == canvas.id_of(MARK)).sum() == mine.sum() - 32 > 0
    assert set(canvas.semantic[mine]) == {FURN}


def test_a_rug_stops_nobody_and_a_shining_part_shines():
    canvas, _ = shell()
    frame = Frame(np.array([2.0, 1.0, 0.0]), np.array([1.0, 1.0, 1.0]), 0.0)
    rug = DisplayBox(np.array([-0.5, -0.5, 0.0, 0.5, 0.5, 0.02]), "stone")
    assert put_colliders(canvas, [rug], frame, FURN, 8) == 0
    shade = DisplayBox(np.array([-0.1, -0.1, 0.7, 0.1, 0.1, 1.0]), "minecraft:glowstone")
    put_colliders(canvas, [shade], frame, FURN, 9)
    lights = canvas.mask_of("minecraft:light[level=15,waterlogged=false]")
    assert (canvas.instance[lights] == 9).all()
    assert lights.any()


def test_a_red_front_is_red_and_its_top_dark():
    counter = template("counter")
    parts = counter.parts(np.array([0.6, 1.2, 0.9]))
    frame = Frame(np.zeros(3), np.array([0.6, 1.2, 0.9]), 0.0)
    rng = np.random.default_rng(0)
    front = np.column_stack(
        [np.full(200, 0.3), rng.uniform(-0.6, 0.6, 200), rng.uniform(0, 0.8, 200)]
    )
    top = np.column_stack(
        [rng.uniform(-0.3, 0.3, 80), rng.uniform(-0.6, 0.6, 80), np.full(80, 0.9)]
    )
    red, dark = (srgb_to_oklab(np.array(colour, np.uint8)) for colour in (RED, DARK))
    colours = np.concatenate([np.tile(red, (200, 1)), np.tile(dark, (80, 1))])
    kinds = {role: material.kind for role, material in counter.materials.items()}
    found = role_colours(parts, frame, np.concatenate([front, top]), colours, VOXEL_M, kinds)
    palette, parameters = load_palette("vanilla"), BuildParameters()
    states = states_of_parts(counter, parts, found, palette, parameters)
    by_role = {part.role: state for part, state in zip(parts, states, strict=True)}
    assert "red" in by_role["body"] or "nether" in by_role["body"]
    assert by_role["top"] != by_role["body"]
    assert "red" not in by_role["top"]


def test_a_heap_of_two_colours_is_two_boxes_in_its_own_frame():
    sketch = Sketch()
    sketch.put((10, 14), (5, 9), (0, 4), FURN, RED, 4).put((10, 14), (5, 9), (4, 8), FURN, WHITE, 4)
    grid = sketch.grid()
    cells = np.argwhere(grid.instance == 4)
    colours = srgb_to_oklab(grid.colour[tuple(cells.T)])
    choice = BlockChoice(FURN, load_palette("vanilla"), BuildParameters(), MAX_COLOURS)
    pieces = boxes_of_cells(cells, colours, np.ones(len(cells), bool), grid, choice)
    frame = frame_of_cells(cells, grid)
    assert len(pieces) == 2
    assert len({piece.state for piece in pieces}) == 2
    assert frame.size_m == pytest.approx([0.32, 0.32, 0.64])
    assert frame.base_m == pytest.approx([0.96, 0.56, 0.0])


def test_specks_are_left_out_but_not_all_of_a_thing():
    cells = np.array([[0, 0, 0], [0, 0, 1], [0, 1, 0], [0, 1, 1], [9, 9, 9]])
    assert len(remove_small_parts(cells, 4)) == 4
    assert len(remove_small_parts(cells[4:], 4)) == 1
