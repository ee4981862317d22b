"""The light lattice, against a slow twin that looks at four cells for each corner."""

import numpy as np
import pytest
from tests.rendering.light_worlds import PALETTE, random_world

from world2minecraft.core.jit import njit
from world2minecraft.rendering.light import lattice_light, light_field

SOLIDS = (1, 9)


def slow_corner(field, states, axis, layer, p, q) -> int:
    """The entry of the corner (p, q) of a layer of cells, by looking at the four cells."""
    cells = []
    for dp, dq in ((-1, -1), (-1, 0), (0, -1), (0, 0)):
        cell = [p + dp, q + dq]
        cell.insert(axis, layer)
        inside = all(0 <= c < n for c, n in zip(cell, states.shape, strict=True))
        if not inside:
            cells.append((False, 15 * field.reach, 0))
        else:
            at = tuple(cell)
            cells.append((states[at] in SOLIDS, field.sky_light[at], field.block_light[at]))
    free = [cell for cell in cells if not cell[0]]
    solid = 4 - len(free)
    if solid == 2 and cells[0][0] == cells[3][0]:
        solid = 3
    sky, block = (
        int(np.floor(4 * sum(int(cell[n]) for cell in free) / (field.reach * len(free)) + 0.5))
        if free
        else 0
        for n in (1, 2)
    )
    return sky | block << 6 | min(solid, 3) << 12


@pytest.mark.parametrize("reach", [1.0, 1.5, 4.0])
@pytest.mark.parametrize("seed", range(3))
def test_the_lattice_equals_its_slow_twin(seed, reach):
    states = random_world(seed, 6)
    field = light_field(states, PALETTE, reach)
    for axis in range(3):
        sizes = [states.shape[n] for n in range(3) if n != axis]
        for layer in range(-1, states.shape[axis] + 1):
            for p in range(sizes[0] + 1):
                for q in range(sizes[1] + 1):
                    index = [p, q]
                    index.insert(axis, layer + 1)
                    expected = slow_corner(field, states, axis, layer, p, q)
                    assert field.lattice[(axis, *index)] == expected


@njit
def look_up(light, side, cell, step, p, q):
    return lattice_light(light, side, cell[0], cell[1], cell[2], step, p, q)


@pytest.mark.parametrize("side", range(6))
def test_a_face_reads_its_four_corners(side):
    states = random_world(3, 6)
    field = light_field(states, PALETTE)
    rng = np.random.default_rng(side)
    axis = side // 2
    for _ in range(20):
        cell = tuple(int(rng.integers(n)) for n in states.shape)
        step = int(rng.choice([0, 1 if side % 2 else -1]))
        p, q = rng.random(2)
        expected = np.zeros(3)
        for a, b, weight in (
            (0, 0, (1 - p) * (1 - q)), (0, 1, (1 - p) * q), (1, 0, p * (1 - q)), (1, 1, p * q),
        ):  # fmt: skip
            corner = [c for n, c in enumerate(cell) if n != axis]
            value = slow_corner(
                field, states, axis, cell[axis] + step, corner[0] + a, corner[1] + b
            )
            expected += weight * np.array([value & 63, value >> 6 & 63, value >> 12])
        expected[:2] /= 4
        assert look_up(field.lattice, side, cell, step, p, q) == pytest.approx(tuple(expected))


def test_open_faces_are_fully_lit_and_corners_dimmed():
    states = np.zeros((3, 3, 3), np.uint16)
    states[:, 0] = 1
    field = light_field(states, PALETTE)
    assert look_up(field.lattice, 3, (1, 0, 1), 1, 0.3, 0.6) == pytest.approx((15, 0, 0))
    states[0], states[:, :, 0] = 1, 1
    field = light_field(states, PALETTE)
    assert look_up(field.lattice, 3, (1, 0, 1), 1, 0.0, 0.0)[2] == 3
    assert look_up(field.lattice, 3, (1, 0, 1), 1, 1.0, 1.0)[2] == 0
    assert look_up(field.lattice, 3, (1, 0, 1), 1, 0.5, 0.0)[2] == pytest.approx(2.5)
