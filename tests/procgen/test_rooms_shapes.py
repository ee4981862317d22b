"""Rooms that are no boxes, kinds of rooms, and clutter: nothing collides, ways stay clear."""

from functools import cache

import numpy as np
import pytest

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.furniture.layout_checks import collisions, out_of_bounds
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.procgen import KINDS, SHAPES, generate_room
from world2minecraft.procgen.rooms.clutter import MAX_ASKEW_DEG
from world2minecraft.procgen.rooms.floor_shapes import Cut, Ground, Roof
from world2minecraft.procgen.sensors.navmesh import build_navmesh

SHAPED = [(kind, shape, 0.0) for kind in ("living", "bed") for shape in SHAPES if shape != "box"]
CLUTTERED = [("dining", "box", 1.0), ("kitchen", "ell", 0.8), ("children", "sloped", 1.0),
             ("office", "cut", 0.6), ("bathroom", "columns", 1.0)]  # fmt: skip
each_room = pytest.mark.parametrize("which", SHAPED + CLUTTERED, ids=str)
room_of = cache(lambda which, seed=3: generate_room(seed, kind=which[0], shape=which[1],
                                                    clutter=which[2]))  # fmt: skip


def area(polygon):
    x, y = polygon.T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


@each_room
def test_things_do_not_collide_and_lie_in_the_room(which):
    layout = room_of(which).layout
    held = [item for item in layout.objects if item.name != "door"]
    # What lies on a bed or a sofa lies below its back: within the box around it.
    soft = [n for n, item in enumerate(held) if item.name in ("bed", "sofa")]
    for a, b in collisions(held, 0.011):
        low = held[b].center_m[2] - held[b].size_m[2] / 2
        assert a in soft and low in (pytest.approx(0.56), pytest.approx(0.46))
    assert not out_of_bounds(held, layout.floor_polygon_m, layout.wall_height_m, 0.011)


@each_room
def test_things_stand_in_air_where_the_shell_leaves_it(which):
    room = room_of(which)
    for number, item in enumerate(room.objects, start=1):
        cells = np.argwhere(room.instance == number)
        assert len(cells) > 4, item.name
        assert (room.labels[tuple(cells.T)] == item.class_id).all()
        places = room.origin_m + (cells + 0.5) * room.voxel_m - item.center_m
        angle = np.radians(item.yaw_deg)
        turned = places[:, :2] @ np.array([[np.cos(angle), -np.sin(angle)],
                                           [np.sin(angle), np.cos(angle)]])  # fmt: skip
        own = np.column_stack([turned, places[:, 2]])
        assert (np.abs(own) <= item.size_m / 2 + 0.011).all(), item.name
        if item.name not in ("door", "keyboard"):
            reached = np.abs(own).max(axis=0) + 0.021
            assert (reached >= item.size_m / 2 - 0.021).all(), item.name


@each_room
def test_a_person_walks_from_the_door_through_the_room(which):
    room = room_of(which)
    stands = build_navmesh(room)
    door = next(o for o in room.layout.openings if o.kind == "door")
    far = np.linalg.norm(stands.places_m[:, :2] - (door.start_m + door.end_m) / 2, axis=1)
    part = stands.part[far.argmin()]
    assert far.min() < 1.0
    assert (stands.easy & (stands.part == part)).sum() >= 0.6 * stands.easy.sum() > 40


@pytest.mark.parametrize("shape", SHAPES)
def test_the_polygon_is_the_outline_of_the_air(shape):
    room = generate_room(4, kind="bed", shape=shape)
    polygon = room.layout.floor_polygon_m
    level = round((0.01 - room.origin_m[2]) / room.voxel_m)
    built = np.isin(room.labels[6:-6, 6:-6, level], (1, 3))
    built |= room.labels[6:-6, 6:-6, 0] == 0  # Beyond the walls there is no slab.
    columns = 0.5 if shape == "columns" else 0.0
    assert area(polygon) == pytest.approx((~built).sum() * 0.0004, abs=0.03 + columns)
    assert len(polygon) > 4 or shape in ("box", "sloped", "columns")


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", [1, 6])
def test_the_shell_is_closed_so_that_no_ray_leaves(shape, seed):
    room = generate_room(seed, kind="living", shape=shape)
    parts, _ = label_components(room.labels == 0, corners=True)
    rim = np.concatenate([
        parts[[0, -1]].ravel(), parts[:, [0, -1]].ravel(), parts[:, :, [0, -1]].ravel()
    ])  # fmt: skip
    door = next(o for o in room.layout.openings if o.kind == "door")
    spots = build_navmesh(room).places_m
    step = spots[np.linalg.norm(spots[:, :2] - door.start_m, axis=1).argmin()] + [0, 0, 1.0]
    inside = parts[tuple(((step - room.origin_m) / room.voxel_m).astype(int))]
    assert inside > 0 and inside not in rim


@pytest.mark.parametrize("seed", range(6))
def test_a_sloped_room_has_a_ceiling_that_sinks_to_its_knee(seed):
    room = generate_room(seed, kind="study", shape="sloped")
    air = (room.labels[6:-6, 6:-6, 6:-6] != 1).sum(axis=2)
    heights = np.round(air.max(axis=0 if air.shape[0] >= air.shape[1] else 1) * 0.02, 2)
    assert heights.max() == pytest.approx(room.layout.wall_height_m)
    assert 0.88 <= heights.min() <= 1.42


@pytest.mark.parametrize("which", [("dining", "box", 1.0), ("dining", "ell", 0.6)])
@pytest.mark.parametrize("seed", [3, 5])
def test_cluttered_chairs_face_their_table_but_askew(which, seed):
    room = room_of(which, seed)
    (board,) = [item for item in room.objects if item.name == "dining_table"]
    chairs = [item for item in room.objects if item.name == "chair"]
    turns = [(chair.yaw_deg + 45) % 90 - 45 for chair in chairs]
    assert len(chairs) >= 4
    assert max(abs(turn) for turn in turns) <= MAX_ASKEW_DEG
    assert any(turns)
    for chair, turn in zip(chairs, turns, strict=True):
        angle = np.radians(chair.yaw_deg - turn)
        half = board.size_m[[1, 0]] / 2 if round(board.yaw_deg) % 180 else board.size_m[:2] / 2
        nearest = np.clip(chair.center_m[:2], board.center_m[:2] - half, board.center_m[:2] + half)
        way = nearest - chair.center_m[:2]
        assert np.array([np.cos(angle), np.sin(angle)]) @ way / np.linalg.norm(way) > 0.8
        assert np.linalg.norm(way) < 0.75


def test_clutter_adds_things_and_leaves_the_tidy_room_alone():
    counts = [len(generate_room(7, kind="study", clutter=c).objects) for c in (0.0, 0.4, 1.0)]
    assert counts[0] < counts[1] < counts[2]
    tidy = generate_room(7, kind="study", clutter=0.0)
    assert np.array_equal(tidy.labels, generate_room(7, kind="study").labels)


def test_clutter_brings_shapes_of_several_classes():
    cluttered = [room_of(which) for which in CLUTTERED]
    names = {item.name for room in cluttered for item in room.objects}
    odd = {"beanbag", "rocking_horse", "easel", "guitar", "bicycle", "spiral_shelf", "sculpture",
           "cat_tree", "gym_ball", "floor_vase"}  # fmt: skip
    assert len(names & odd) >= 3
    assert len(names & {"shoes", "bag", "box", "laundry", "ball", "bricks", "teddy", "cup"}) >= 4


@pytest.mark.parametrize("kind", ["bathroom", "hall", "office", "children"])
def test_a_new_kind_has_what_makes_it_one(kind):
    wanted = {"bathroom": {"toilet", "washstand", "mirror"}, "hall": {"coats", "shoe_cabinet"},
              "office": {"desk", "office_chair", "monitor"},
              "children": {"bed", "wardrobe"}}[kind]  # fmt: skip
    names = [{item.name for item in generate_room(s, kind=kind).objects} for s in range(3)]
    assert sum(wanted <= held for held in names) >= 2


def test_names_are_refused_with_a_suggestion():
    with pytest.raises(UnknownNameError, match="no room shape is named 'el'; did you mean 'ell'"):
        generate_room(0, shape="el")
    with pytest.raises(ValueError, match=r"^clutter must be from 0 to 1, got -0\.1$"):
        generate_room(0, clutter=-0.1)
    assert set(KINDS) >= {"bathroom", "hall", "office", "children"}


GROUNDS = [
    (Ground((4.0, 3.0, 2.5)), 4, 12.0),
    (Ground((4.0, 3.0, 2.5), ((2.5, 2.0, 4.0, 3.0),)), 6, 10.5),
    (Ground((4.0, 3.0, 2.5), ((0.0, 0.0, 1.0, 2.0),)), 6, 10.0),
    (Ground((4.0, 3.0, 2.5), ((1.0, 2.6, 2.0, 3.0),)), 8, 11.6),
    (Ground((4.0, 3.0, 2.5), ((0.0, 2.0, 1.0, 3.0), (3.0, 2.0, 4.0, 3.0))), 8, 10.0),
    (Ground((4.0, 3.0, 2.5), ((1.0, 1.0, 1.4, 1.4),)), 4, 12.0),
    (Ground((4.0, 3.0, 2.5), cuts=(Cut(True, True, 1.0),)), 5, 11.5),
    (Ground((4.0, 3.0, 2.5), cuts=(Cut(False, True, 1.0),)), 5, 11.5),
]


@pytest.mark.parametrize(("ground", "corners", "square_m"), GROUNDS)
def test_a_ground_has_its_corners_and_walls_along_them(ground, corners, square_m):
    polygon = ground.polygon_m
    assert len(polygon) == corners
    assert area(polygon) == pytest.approx(square_m)  # Counter-clockwise, else it is below 0.
    assert [wall.turn for wall in ground.walls[:4]] == [0, 1, 2, 3]
    assert len(ground.walls) == corners - len(ground.cuts)
    for wall in ground.walls:
        x, y = wall.point((wall.first_m + wall.last_m) / 2, 0.05)
        assert ground.holds((x - 0.01, y - 0.01, 0.0, x + 0.01, y + 0.01, 0.1))
        x, y = wall.point((wall.first_m + wall.last_m) / 2, -0.05)
        assert not ground.holds((x - 0.01, y - 0.01, 0.0, x + 0.01, y + 0.01, 0.1))


def test_a_roof_fits_low_things_at_its_knee_and_tall_ones_inside():
    ground = Ground((4.0, 3.0, 2.4), roofs=(Roof(0, 1.0, 1.4),))
    assert ground.holds((0.0, 0.0, 0.0, 1.0, 1.0, 0.9))
    assert not ground.holds((0.0, 0.0, 0.0, 1.0, 1.0, 1.1))
    assert ground.holds((1.4, 0.0, 0.0, 2.0, 1.0, 2.4))
    assert ground.ceiling_m(np.array([0.0, 0.7, 1.4, 3.0]), np.zeros(4)) == pytest.approx(
        [1.0, 1.7, 2.4, 2.4]
    )


@pytest.mark.parametrize(("kind", "shape"), [("hall", "sloped"), ("bathroom", "cut")])
@pytest.mark.parametrize("seed", [500, 502, 503])
def test_narrow_rooms_take_every_shape(kind, shape, seed):
    room = generate_room(seed, kind=kind, shape=shape)
    kinds = [opening.kind for opening in room.layout.openings]
    assert kinds.count("door") == 1 and "window" in kinds
