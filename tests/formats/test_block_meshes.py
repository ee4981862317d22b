"""The faces of boxes against a slow twin that looks at every unit of the surface."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.formats.block_meshes import Faces, visible_faces


def faces(boxes, owner=None, material=None, is_clear=(False, True)):
    count = len(boxes)
    owner = np.zeros(count, np.int32) if owner is None else np.array(owner, np.int32)
    material = np.zeros(count, np.int32) if material is None else np.array(material, np.int32)
    return visible_faces(
        np.array(boxes, np.int32).reshape(-1, 6), owner, material, np.array(is_clear)
    )


def unit_faces(found: Faces) -> dict:
    """Every unit square of the faces: (owner, axis, plane, side, u, v) to its material."""
    squares = {}
    for owner, axis, plane, side, (u0, u1), (v0, v1), material in zip(*found, strict=True):
        for u in range(u0, u1):
            for v in range(v0, v1):
                key = tuple(map(int, (owner, axis, plane, side, u, v)))
                assert key not in squares, "two faces cover one place"
                squares[key] = int(material)
    return squares


def slow_faces(cells: np.ndarray, is_clear) -> dict:
    """The same of a grid of materials + 1, 0 where there is nothing, of one owner."""
    squares = {}
    padded = np.pad(cells, 1)
    for cell in np.argwhere(cells):
        kind = cells[tuple(cell)] - 1
        for axis in range(3):
            for side in (0, 1):
                beside = cell + 1
                beside[axis] += 2 * side - 1
                other = padded[tuple(beside)]
                if other and not (is_clear[other - 1] and not is_clear[kind]):
                    continue
                u, v = cell[(axis + 1) % 3], cell[(axis + 2) % 3]
                squares[0, axis, int(cell[axis] + side), side, int(u), int(v)] = int(kind)
    return squares


@settings(max_examples=20)
@given(st.integers(0, 1000), st.integers(1, 4))
def test_faces_are_those_of_every_unit(seed, kinds):
    rng = np.random.default_rng(seed)
    cells = rng.integers(0, kinds + 1, (4, 3, 5))
    is_clear = rng.random(kinds) < 0.4
    places = np.argwhere(cells)
    found = faces(np.column_stack([places, places + 1]), None, cells[cells > 0] - 1, is_clear)
    assert unit_faces(found) == slow_faces(cells, is_clear)


def volume_of_mesh(found: Faces) -> float:
    corners = found.corners().astype(float)
    triangles = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    a, b, c = triangles.transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


@given(st.lists(st.tuples(*[st.integers(-9, 9)] * 3, *[st.integers(1, 4)] * 3), max_size=1))
def test_one_box_has_six_faces_and_its_volume(rows):
    boxes = [(x, y, z, x + a, y + b, z + c) for x, y, z, a, b, c in rows]
    found = faces(boxes)
    assert len(found.owner) == 6 * len(boxes)
    assert volume_of_mesh(found) == pytest.approx(sum(a * b * c for *_, a, b, c in rows))


def test_faces_look_outward():
    found = faces([(0, 0, 0, 2, 3, 4), (2, 0, 0, 3, 1, 1)])
    corners, normals = found.corners(), found.normals()
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.sign(across) == normals).all()
    assert volume_of_mesh(found) == 25


def test_neighbours_of_one_material_have_no_seam_and_others_one():
    pair = [(0, 0, 0, 1, 1, 1), (1, 0, 0, 2, 1, 1)]
    assert len(faces(pair).owner) == 6
    assert len(faces(pair, material=[0, 1], is_clear=(False, False)).owner) == 10


def test_owners_are_closed_each():
    found = faces([(0, 0, 0, 1, 1, 1), (1, 0, 0, 2, 1, 1)], owner=[3, 8])
    assert found.owner.tolist() == [3] * 6 + [8] * 6


def test_one_sees_through_glass_what_is_behind():
    found = faces([(0, 0, 0, 1, 1, 1), (1, 0, 0, 2, 1, 1)], material=[0, 1])
    assert (found.material == 0).sum() == 6
    assert (found.material == 1).sum() == 5


def test_no_boxes_have_no_faces():
    assert len(faces([]).owner) == 0


def test_a_part_of_a_face_is_cut_out():
    found = faces([(0, 0, 0, 4, 4, 4), (4, 1, 1, 5, 3, 3)])
    ring = (found.axis == 0) & (found.plane == 4)
    area = ((found.u[:, 1] - found.u[:, 0]) * (found.v[:, 1] - found.v[:, 0]))[ring].sum()
    assert area == 12
    assert volume_of_mesh(found) == 68
