import numpy as np
import pytest
from build_samples import CHAIR, FURN, RED, TABLE, WOOD, Sketch, placement
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction import BuildParameters, build_volume
from world2minecraft.construction.block_lattice import (
    center_weights,
    face_shares,
    lattice_over,
    overlap_weights,
)
from world2minecraft.construction.objects_from_cells import resample_cells
from world2minecraft.construction.template_blocks import half_block_design
from world2minecraft.construction.worktops import missing_top_cells
from world2minecraft.furniture import TEMPLATES, template

ANY = BuildParameters(lights=False, edge="none", most_contradicted=1.0)


@given(st.floats(-5, 5), st.floats(0.05, 3), st.integers(1, 20))
def test_blocks_and_cells_share_what_overlaps(start, step, count):
    edges = start + step * np.arange(count + 1)
    shares = overlap_weights(edges, 8)
    inside = max(0.0, min(edges[-1], 8) - max(edges[0], 0))
    assert shares.sum() == pytest.approx(inside, abs=1e-4)
    assert (shares >= 0).all() and (shares <= 1 + 1e-6).all()
    assert (center_weights(edges, 8).sum(0) <= max(1, int(step) + 1)).all()


def slow_face_shares(mask, edges, shape):
    """The slow reading: the covered area of each block's face, cell by cell."""
    best = np.zeros(shape)
    for axis in range(3):
        across = [other for other in range(3) if other != axis]
        for block in np.ndindex(*shape):
            area = {}
            for cell in np.argwhere(mask):
                middle = (edges[axis][cell[axis]] + edges[axis][cell[axis] + 1]) / 2
                if not block[axis] <= middle < block[axis] + 1:
                    continue
                sides = []
                for other in across:
                    low, high = edges[other][cell[other]], edges[other][cell[other] + 1]
                    sides.append(max(0, min(high, block[other] + 1) - max(low, block[other])))
                area[tuple(cell[across])] = sides[0] * sides[1]
            best[block] = max(best[block], sum(area.values()))
    return best


@pytest.mark.parametrize("seed", range(4))
def test_face_shares_are_those_of_the_slow_reading(seed):
    rng = np.random.default_rng(seed)
    mask = rng.random((6, 5, 7)) < 0.3
    edges = [rng.uniform(0, 0.3) + rng.uniform(0.25, 0.5) * np.arange(n + 1) for n in mask.shape]
    fast = face_shares(mask, edges, (3, 3, 3))
    assert fast == pytest.approx(slow_face_shares(mask, edges, (3, 3, 3)), abs=1e-5)


def lattice(scale):
    return lattice_over(Sketch().grid(), np.array([0.0, 2.0]), scale)


def shape_of(sketch, number, scale, shift=True):
    grid = sketch.grid()
    return resample_cells(np.argwhere(grid.instance == number), grid, lattice(scale), 0.25, shift)


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0, 6.25])
def test_thin_things_survive(scale):
    """A table of one cell's thickness on legs of one cell keeps its top, in one layer."""
    sketch = Sketch().put((10, 24), (6, 18), (8, 9), TABLE, WOOD, 1)
    halves = shape_of(sketch, 1, scale).halves
    top = halves[:, :, -1] > 0
    assert top.sum() >= 0.6 * 1.12 * 0.96 * scale**2
    assert (halves[:, :, :-1] > 0).sum() == 0


def test_a_leg_of_one_cell_stands_at_four_blocks_a_metre():
    sketch = Sketch().put((10, 11), (10, 11), (0, 9), CHAIR, WOOD, 1)
    halves = shape_of(sketch, 1, 4.0).halves
    columns = halves.max((0, 1))
    assert (columns > 0).all()


def test_an_object_moves_to_fall_on_the_lattice():
    """A 6 x 6 cell box fills 2 x 2 blocks at 4 a metre wherever it stands."""
    counts = set()
    for x in range(10, 16):
        sketch = Sketch().put((x, x + 6), (8, 14), (0, 6), TABLE, WOOD, 1)
        counts.add(int((shape_of(sketch, 1, 4.0).halves[:, :, 0] > 0).sum()))
    assert counts == {4}


def design(name, turns=0, center=(2.0, 1.0), scale=4.0):
    found = template(name)
    size = np.array(found.typical_m)
    place = placement(name, found.class_id, (*center, size[2] / 2), size, turns)
    return half_block_design(place, found.parts(size), lattice(scale))


@pytest.mark.parametrize("name", TEMPLATES.names())
@pytest.mark.parametrize("scale", [3.0, 4.0, 6.25])
def test_every_template_gives_blocks_and_turns_as_a_whole(name, scale):
    center = (2.0, 1.0)
    if template(name).class_id == FURN:  # Its sides are rounded each by itself.
        frame = lattice(scale)
        block = np.floor(frame.coordinates_of(np.array([2.0, 1.0, 0.0]))) + 0.5
        center = tuple(((block - frame.offset) / scale)[:2].tolist())
    straight = design(name, center=center, scale=scale)
    assert (straight.halves > 0).any()
    for turns in range(4):
        turned = design(name, turns, center, scale=scale)
        assert np.array_equal(turned.halves, np.rot90(straight.halves, turns, axes=(0, 1)))
        assert np.array_equal(turned.part, np.rot90(straight.part, turns, axes=(0, 1)))


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("away_m", [0.0, 0.06, 0.1, 0.17])
def test_the_front_of_a_counter_moves_by_half_a_block_at_most(turns, away_m):
    found = template("counter")
    size = np.array(found.typical_m)
    place = placement("counter", FURN, (2.0 + away_m, 1.0 + away_m, size[2] / 2), size, turns)
    made = half_block_design(place, found.parts(size), lattice(4.0))
    turned = size[[1, 0]] if turns % 2 else size[:2]
    low = lattice(4.0).coordinates_of(np.array([2.0 + away_m, 1.0 + away_m, 0.0]))[:2] - turned * 2
    assert np.abs(made.low[:2] - low).max() <= 0.5 + 1e-5
    assert np.abs(made.low[:2] + made.halves.shape[:2] - low - turned * 4).max() <= 0.5 + 1e-5


@pytest.mark.parametrize("name", ["chair", "dining_table", "single_bed", "sofa"])
def test_symmetric_furniture_stays_symmetric(name):
    halves = design(name).halves
    assert np.array_equal(halves, halves[:, ::-1])


@given(st.floats(0.6, 3.4), st.floats(0.6, 1.4))
def test_equal_chairs_come_out_equal_wherever_they_stand(x, y):
    assert np.array_equal(design("chair", 0, (x, y)).halves, design("chair").halves)


def test_a_table_is_a_plate_on_posts_with_air_under_it():
    shown = design("dining_table")
    middle = shown.halves[shown.halves.shape[0] // 2, shown.halves.shape[1] // 2]
    assert middle[-1] > 0 and not middle[:-1].any()
    assert shown.halves[0, 0].all() and not shown.halves[1, 1, 0]


def test_a_glossy_top_is_closed_where_space_shows_it():
    """The front of a cupboard was seen, its top only by the free space above it."""
    sketch = Sketch().put((8, 9), (2, 20), (0, 10), 10, RED, 1)
    sketch.labels[sketch.at((0, 8), (2, 20), (0, 10))] = 255
    grid = sketch.grid()
    cells = np.argwhere(grid.instance == 1)
    added, alike = missing_top_cells(grid, cells)
    wanted = {(x + 2, y + 2, 10) for x in range(8) for y in range(2, 20)}
    assert {tuple(cell) for cell in added.tolist()} == wanted
    assert (grid.instance[tuple(alike.T)] == 1).all()
    seen, _ = missing_top_cells(Sketch().put((8, 9), (2, 20), (0, 10), 10, RED, 1).grid(), cells)
    assert len(seen) == 0


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0])
def test_placements_take_the_colours_of_their_cells(scale):
    sketch = Sketch().put((18, 30), (0, 8), (0, 11), 10, RED, 1)
    cabinet = placement("cabinet", 10, (1.92, 0.32, 0.44), (0.64, 0.96, 0.88), 1)
    volume = build_volume(
        sketch.grid(),
        [cabinet],
        (),
        corner_m=sketch.corner_m,
        blocks_per_metre=scale,
        parameters=ANY,
    )
    held = volume.states[volume.instance == 1]
    names = [volume.palette[i] for i in held]
    assert names and sum("red" in name for name in names) >= 0.75 * len(names)
