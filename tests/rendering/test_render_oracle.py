"""The oracle itself: it agrees with rays that one can do in the head, and with brute force."""

import numpy as np
import pytest
from oracle import NO_FACE, SIGNS, cast, has_face, meet, oracle_picture
from scenes import CAMERA, random_pose, random_volume, slow_picture, volume_of

from world2minecraft.rendering.block_elements import BlockModel, Element, ElementFace, face_uv
from world2minecraft.rendering.texture import Texture

SOLID = Texture(np.full((16, 16, 4), 255, np.uint8))
HALF = np.full((16, 16, 4), 255, np.uint8)
HALF[:, :8, 3] = 0  # The left half is a hole.
TEXTURES = {"solid": SOLID, "half": Texture(HALF), "tinted": Texture(HALF, translucent=True)}


def box(low=(0, 0, 0), high=(1, 1, 1), texture: str | None = "solid", turn=None) -> Element:
    looks = (
        None if texture is None else ElementFace(texture, face_uv(side, low, high, (0, 0, 16, 16)))
        for side in range(6)
    )
    return Element(low, high, tuple(looks), turn)


class Looks:
    """Models by the last word of a state's name."""

    def __init__(self, **models: tuple[Element, ...]):
        self.models = models

    def model(self, state: str) -> BlockModel | None:
        name = state.partition("[")[0].removeprefix("minecraft:")
        return BlockModel(self.models[name]) if name in self.models else None

    def texture(self, name: str) -> Texture | None:
        return TEXTURES.get(name)


class Boxes:
    """Looks that are the boxes which are drawn of each state."""

    def model(self, state: str) -> BlockModel | None:
        from world2minecraft.minecraft.visual_shapes import visual_boxes

        if state == "minecraft:air":
            return None
        rows = visual_boxes(state).tolist()
        return BlockModel(tuple(box(tuple(row[:3]), tuple(row[3:])) for row in rows))

    def texture(self, name: str) -> Texture | None:
        return SOLID


def one_block(element: Element, cell=(2, 2, 2)):
    states = np.zeros((5, 5, 5), np.int64)
    states[cell] = 1
    return volume_of(states, scale=1.0), Looks(white_concrete=(element,))


def first(element: Element, origin, ray):
    volume, looks = one_block(element)
    hits = cast(volume, looks, np.array(origin, float), np.array([ray], float))
    return float(hits.depth[0]), face_of(hits), int(hits.index[0])


def face_of(hits) -> int:
    """The one face that the first ray has met."""
    (face,) = (face for face in (*range(6), NO_FACE) if has_face(hits, np.array([face]))[0])
    return face


AHEAD = (0.5, 2.5, 2.25), (1.0, 0.0, 0.0)


def test_a_cube_is_met_at_its_face():
    assert first(box(), *AHEAD) == (1.5, 0, 62)


def test_a_ray_past_the_block_meets_nothing():
    assert first(box(), (0.5, 2.5, 3.5), (1, 0, 0)) == (np.inf, NO_FACE, -1)


def test_a_camera_within_a_box_does_not_see_it():
    assert first(box(), (2.5, 2.5, 2.5), (1, 0, 0))[1] == NO_FACE


def test_a_face_without_texture_is_not_there():
    assert first(box(texture=None), *AHEAD)[1] == NO_FACE


@pytest.mark.parametrize(("z", "face"), [(2.25, NO_FACE), (2.75, 0)])
def test_a_hole_lets_rays_through_and_its_frame_does_not(z, face):
    # The west face's u grows to the south, and the left half is the hole.
    assert first(box(texture="half"), (0.5, 2.5, z), (1, 0, 0))[1] == face


def test_tinted_glass_is_a_surface_wherever_it_is():
    assert first(box(texture="tinted"), *AHEAD)[1] == 0


def test_a_flat_box_is_seen_from_both_sides():
    sheet = box((0.5, 0, 0), (0.5, 1, 1))
    assert first(sheet, *AHEAD) == (2.0, 0, 62)
    assert first(sheet, (4.5, 2.5, 2.5), (-1, 0, 0)) == (2.0, 1, 62)


def test_a_turned_box_is_met_where_its_edge_comes_forward():
    half = np.sqrt(0.5)
    turn = np.eye(4)
    turn[:3, :3] = [[half, 0, half], [0, 1, 0], [-half, 0, half]]
    turn[:3, 3] = np.array([0.5, 0.5, 0.5]) - turn[:3, :3] @ np.array([0.5, 0.5, 0.5])
    low, high = (0.25, 0.0, 0.25), (0.75, 1.0, 0.75)
    volume, looks = one_block(box(low, high, turn=turn))
    origin, ray = np.array([0.5, 2.5, 2.5 + 1e-9]), np.array([[1.0, 0.0, 0.0]])
    hits = cast(volume, looks, origin, ray)
    depth = float(hits.depth[0])
    assert [face for face in range(6) if has_face(hits, np.array([face]))[0]] == [0, 5]
    assert depth == pytest.approx(2.0 - 0.25 * np.sqrt(2), abs=1e-6)


def test_what_reaches_beyond_its_block_is_met_there():
    depth, face, index = first(box((-1.0, 0, 0), (1, 1, 1)), *AHEAD)
    assert (depth, face, index) == (0.5, 0, 62)


def test_glass_side_by_side_is_one_body():
    states = np.zeros((5, 5, 5), np.int64)
    states[1:3, 2, 2] = 1
    looks = Looks(white_concrete=(box(texture="half"),))
    ray = np.array([[1.0, 0.0, 0.0]])
    through = cast(volume_of(states, scale=1.0), looks, np.array([0.5, 2.5, 2.25]), ray)
    assert face_of(through) == NO_FACE
    behind = cast(volume_of(states, scale=1.0), looks, np.array([1.5, 2.5, 2.75]), ray)
    assert face_of(behind) == NO_FACE  # The face between the two is not there.


def test_the_later_of_two_faces_at_one_place_counts():
    looks = Looks(white_concrete=(box(), box((0.0, 0.0, 0.0), (0.5, 1.0, 1.0))))
    volume, _ = one_block(box())
    depth, normal = meet(looks.model("minecraft:white_concrete").elements[1], looks,
                       np.array([-1.5, 0.5, 0.5]), np.array([[1.0, 0.0, 0.0]]))  # fmt: skip
    assert depth[0] == 1.5
    assert np.array_equal(normal[0], SIGNS[0])
    assert cast(volume, looks, np.array(AHEAD[0]), np.array([AHEAD[1]])).depth[0] == 1.5


def test_the_walk_agrees_with_testing_every_box():
    rng = np.random.default_rng(7)
    for _ in range(3):
        volume = random_volume(rng)
        pose = random_pose(rng, volume)
        depth, index = slow_picture(volume, CAMERA, pose)
        found = oracle_picture(volume, Boxes(), CAMERA, pose)
        assert np.array_equal(found.index, index)
        assert np.allclose(np.where(index >= 0, found.depth, 0), depth)
