"""Turned models against a slow reference: points are turned, and looked up between corners."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pack_making import look_up

from world2minecraft.rendering.block_elements import FACE_NAMES, Element, ElementFace, face_uv
from world2minecraft.rendering.resource_packs.elements import (
    apply_quarter_turn,
    element_of,
    free_turn,
    is_quarter,
    quarter_turn,
    side_after,
)

# The corners of each face, upper left first, then counter-clockwise, as one looks at the face.
# Indices into (low, high) for x, y, z.
CORNERS = {
    "down": ((0, 0, 1), (0, 0, 0), (1, 0, 0), (1, 0, 1)),
    "up": ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)),
    "north": ((1, 1, 0), (1, 0, 0), (0, 0, 0), (0, 1, 0)),
    "south": ((0, 1, 1), (0, 0, 1), (1, 0, 1), (1, 1, 1)),
    "west": ((0, 1, 0), (0, 0, 0), (0, 0, 1), (0, 1, 1)),
    "east": ((1, 1, 1), (1, 0, 1), (1, 0, 0), (1, 1, 0)),
}
TURNS = list(itertools.product((0, 90, 180, 270), repeat=2))
QUARTERS = st.sampled_from((0, 90, 180, 270))
BOX = ([2, 0, 5], [12, 7, 16])


def default_rect(name: str, low, high) -> tuple[float, float, float, float]:
    """The published law of the texture rectangle that a face has where none is stated."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return {
        "down": (x0, 16 - z1, x1, 16 - z0),
        "up": (x0, z0, x1, z1),
        "north": (16 - x1, 16 - y1, 16 - x0, 16 - y0),
        "south": (x0, 16 - y1, x1, 16 - y0),
        "west": (z0, 16 - y1, z1, 16 - y0),
        "east": (16 - z1, 16 - y1, 16 - z0, 16 - y0),
    }[name]


def slow_uv(name: str, low, high, rect, rotation: int, points: np.ndarray) -> np.ndarray:
    """Texture points, float64 [N, 2], of points (sixteenths) of a face, between its corners."""
    ends = np.array([low, high], np.float64)
    corners = np.array([[ends[pick, axis] for axis, pick in enumerate(c)] for c in CORNERS[name]])
    u0, v0, u1, v1 = rect
    held = [(u0, v0), (u0, v1), (u1, v1), (u1, v0)]
    uv = np.array([held[(at + rotation // 90) % 4] for at in range(4)]) / 16
    down, across = corners[1] - corners[0], corners[3] - corners[0]
    t = (points - corners[0]) @ down / (down @ down)
    s = (points - corners[0]) @ across / (across @ across)
    return uv[0] + np.outer(t, uv[1] - uv[0]) + np.outer(s, uv[3] - uv[0])


def turn_once(points: np.ndarray, axis: str) -> np.ndarray:
    """Points (sixteenths) after a quarter turn of a blockstates file about the middle."""
    x, y, z = (points - 8).T
    turned = {"x": (x, z, -y), "y": (-z, y, x), "z": (y, -x, z)}[axis]
    return np.stack(turned, axis=1) + 8


def points_on(name: str, low, high, rng: np.random.Generator) -> np.ndarray:
    axis = {"west": 0, "east": 0, "down": 1, "up": 1, "north": 2, "south": 2}[name]
    points = rng.uniform(low, high, (60, 3))
    points[:, axis] = (high if name in ("east", "up", "south") else low)[axis]
    return points


def raw_element(low, high, **face) -> dict:
    return {
        "from": low,
        "to": high,
        "faces": {name: {"texture": f"#{name}", **face} for name in FACE_NAMES},
    }


def made(raw: dict) -> Element:
    return element_of(raw, lambda name: name, lambda index: None)


def textures_of_faces(rng: np.random.Generator) -> dict[str, np.ndarray]:
    return {f"#{name}": rng.integers(0, 256, (16, 16, 4)).astype(np.uint8) for name in FACE_NAMES}


def face_at(element: Element, point: np.ndarray) -> ElementFace:
    """The face of an aligned element that a point on its surface, but no edge, belongs to."""
    sides = [
        2 * axis + end
        for axis in range(3)
        for end in range(2)
        if abs(point[axis] - (element.low, element.high)[end][axis]) < 1e-9
    ]
    (side,) = sides
    face = element.faces[side]
    assert face is not None
    return face


@pytest.mark.parametrize("name", FACE_NAMES)
@pytest.mark.parametrize("rotation", [0, 90, 180, 270])
@pytest.mark.parametrize("rect", [None, (3, 1, 11, 14), (16, 0, 0, 16)])
def test_a_face_lies_as_its_corners_say(name, rotation, rect):
    low, high = BOX
    face = {"rotation": rotation} | ({} if rect is None else {"uv": list(rect)})
    element = made(raw_element(low, high, **face))
    points = points_on(name, low, high, np.random.default_rng(1))
    wanted = slow_uv(name, low, high, rect or default_rect(name, low, high), rotation, points)
    look = element.faces[FACE_NAMES.index(name)]
    assert look is not None
    got = np.c_[points / 16, np.ones(len(points))] @ look.uv.T
    np.testing.assert_allclose(got, wanted, atol=1e-12)


@pytest.mark.parametrize(("x_deg", "y_deg"), TURNS)
def test_a_turned_block_shows_the_colours_of_the_slow_reference(x_deg, y_deg):
    rng = np.random.default_rng(x_deg * 7 + y_deg)
    low, high = BOX
    rect, rotation = (1, 2, 15, 13), 90
    element = apply_quarter_turn(
        made(raw_element(low, high, uv=list(rect), rotation=rotation)), quarter_turn(x_deg, y_deg)
    )
    textures = textures_of_faces(rng)
    for name in FACE_NAMES:
        points = points_on(name, low, high, rng)
        uv = slow_uv(name, low, high, rect, rotation, points)
        wanted = look_up(textures[f"#{name}"], uv)
        for _ in range(x_deg // 90):
            points = turn_once(points, "x")
        for _ in range(y_deg // 90):
            points = turn_once(points, "y")
        for point, colour in zip(points / 16, wanted, strict=True):
            face = face_at(element, point)
            got = look_up(textures[face.texture], (face.uv @ [*point, 1])[None])
            np.testing.assert_array_equal(got[0], colour)


@pytest.mark.parametrize(("x_deg", "y_deg"), TURNS)
def test_a_locked_texture_lies_as_on_a_box_made_in_the_new_place(x_deg, y_deg):
    """Each face keeps its texture, and has the texture points that its new side has by default."""
    matrix = quarter_turn(x_deg, y_deg)
    low, high = BOX
    locked = apply_quarter_turn(made(raw_element(low, high)), matrix, uv_lock=True)
    ends = np.array([locked.low, locked.high]) * 16
    for side, name in enumerate(FACE_NAMES):
        face = locked.faces[side]
        assert face is not None
        points = points_on(name, *ends, np.random.default_rng(2))
        wanted = slow_uv(name, *ends, default_rect(name, *ends), 0, points)
        np.testing.assert_allclose(np.c_[points / 16, np.ones(60)] @ face.uv.T, wanted, atol=1e-12)
        assert side_after(FACE_NAMES.index(face.texture[1:]), matrix) == side


@pytest.mark.parametrize("y_deg", [90, 180, 270])
def test_a_locked_part_of_a_texture_moves_with_its_place(y_deg):
    """A rectangle that is the face's place in the block stays it after the turn, stated or not."""
    stated = raw_element([8, 8, 0], [16, 16, 16])
    for name, face in stated["faces"].items():
        face["uv"] = list(default_rect(name, stated["from"], stated["to"]))
    turns = quarter_turn(0, y_deg)
    a = apply_quarter_turn(made(stated), turns, uv_lock=True)
    b = apply_quarter_turn(made(raw_element([8, 8, 0], [16, 16, 16])), turns, uv_lock=True)
    for one, other in zip(a.faces, b.faces, strict=True):
        assert one is not None and other is not None
        np.testing.assert_allclose(one.uv, other.uv, atol=1e-12)


def test_turns_go_the_way_that_blockstates_say():
    up, north, east, south = (FACE_NAMES.index(n) for n in ("up", "north", "east", "south"))
    down = FACE_NAMES.index("down")
    assert side_after(north, quarter_turn(90, 0)) == down
    assert side_after(north, quarter_turn(0, 90)) == east
    assert side_after(up, quarter_turn(0, 0, 90)) == east
    assert side_after(up, quarter_turn(90, 90)) == east  # First to the north, then to the east.
    assert side_after(north, quarter_turn(0, 180)) == south


@pytest.mark.parametrize(("angle", "same"), [(-90, 270), (-270, 90), (360, 0), (450, 90)])
def test_angles_are_counted_around(angle, same):
    np.testing.assert_array_equal(quarter_turn(angle, 0), quarter_turn(same, 0))
    np.testing.assert_array_equal(quarter_turn(0, angle, angle), quarter_turn(0, same, same))


@given(x=QUARTERS, y=QUARTERS, z=QUARTERS)
def test_a_turn_and_its_inverse_leave_an_element_as_it_was(x, y, z):
    element = made(raw_element(*BOX))
    matrix = quarter_turn(x, y, z)
    back = apply_quarter_turn(apply_quarter_turn(element, matrix), np.linalg.inv(matrix))
    assert back.low == pytest.approx(element.low) and back.high == pytest.approx(element.high)
    for one, other in zip(back.faces, element.faces, strict=True):
        assert one is not None and other is not None
        assert one.texture == other.texture
        np.testing.assert_allclose(one.uv, other.uv, atol=1e-12)


def test_four_quarter_turns_are_none_and_each_keeps_volume():
    for x, y in TURNS:
        turn = quarter_turn(x, y)
        assert is_quarter(turn)
        assert np.linalg.det(turn) == pytest.approx(1)
    once = quarter_turn(90, 90)
    np.testing.assert_allclose(np.linalg.matrix_power(once, 12), np.eye(4), atol=1e-12)


def test_a_rotated_element_keeps_its_box_and_multiplies_turns():
    raw = raw_element([0.8, 0, 8], [15.2, 16, 8])
    raw["rotation"] = {"origin": [8, 8, 8], "axis": "y", "angle": 45, "rescale": True}
    element = made(raw)
    assert element.turn is not None
    moved = apply_quarter_turn(element, quarter_turn(0, 90))
    assert (moved.low, moved.high) == (element.low, element.high)
    assert moved.turn is not None
    np.testing.assert_allclose(moved.turn, quarter_turn(0, 90) @ element.turn)
    corner = element.turn @ [0.05, 0.5, 0.5, 1]  # Rescaled: at 45 degrees it spans the block.
    np.testing.assert_allclose(corner[:3], [0.5 - 0.45, 0.5, 0.5 + 0.45], atol=1e-12)


def test_the_lock_of_a_turned_element_is_that_of_its_own_side():
    raw = raw_element([0, 0, 0], [16, 16, 16])
    raw["rotation"] = {"origin": [8, 8, 8], "axis": "y", "angle": 22.5}
    locked = apply_quarter_turn(made(raw), quarter_turn(0, 90), uv_lock=True)
    up = locked.faces[FACE_NAMES.index("up")]
    straight = apply_quarter_turn(
        made(raw_element([0, 0, 0], [16, 16, 16])), quarter_turn(0, 90), uv_lock=True
    )
    flat = straight.faces[FACE_NAMES.index("up")]
    assert up is not None and flat is not None
    np.testing.assert_allclose(up.uv, flat.uv @ quarter_turn(0, 90), atol=1e-12)


@pytest.mark.parametrize(
    ("rotation", "start", "end"),
    [
        ({"axis": "x", "angle": 30}, (0, 1, 0), (0, np.cos(np.pi / 6), 0.5)),
        ({"axis": "z", "angle": -45}, (1, 0, 0), (0.5**0.5, -(0.5**0.5), 0)),
        ({"x": 90, "y": 45}, (0, 1, 0), (0.5**0.5, 0, 0.5**0.5)),  # About x, then about y.
        ({"axis": "y", "angle": 22.5, "rescale": True}, (1, 0, 0), (1, 0, -np.tan(np.pi / 8))),
    ],
)
def test_free_turns_of_old_and_new_files(rotation, start, end):
    raw = raw_element([0, 0, 0], [16, 16, 16])
    raw["rotation"] = {"origin": [0, 0, 0], **rotation}
    turn = made(raw).turn
    assert turn is not None
    np.testing.assert_allclose(turn[:3, :3] @ start, end, atol=1e-12)


def test_a_free_turn_by_quarters_leaves_an_aligned_box():
    raw = raw_element([0, 0, 0], [16, 16, 8])
    raw["rotation"] = {"origin": [8, 8, 8], "axis": "y", "angle": 90}
    element = made(raw)
    assert element.turn is None
    assert (element.low, element.high) == ((0, 0, 0), (0.5, 1, 1))
    free = free_turn((0, -90, 0), [0.5] * 3, rescale=False)
    np.testing.assert_allclose(free, quarter_turn(0, 90), atol=1e-12)


def test_the_law_of_face_uv_is_the_table():
    for side, name in enumerate(FACE_NAMES):
        low, high = ([value / 16 for value in end] for end in BOX)
        stated = face_uv(side, low, high, default_rect(name, *BOX))
        np.testing.assert_allclose(face_uv(side, low, high), stated, atol=1e-12)
