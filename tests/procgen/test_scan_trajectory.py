"""The walk of a scan: where one can stand, that every room is seen, and how a person looks."""

from functools import cache

import numpy as np
import pytest

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera, Layout, Opening
from world2minecraft.procgen import Room, generate_room
from world2minecraft.procgen.sensors.navmesh import BODY_M, HEAD_M, build_navmesh, is_inside
from world2minecraft.procgen.sensors.scan_frames import ScanSettings, room_shots
from world2minecraft.procgen.sensors.trajectory import plan_trajectory, plan_walk
from world2minecraft.rendering import cast_voxels, prepare_voxels

CAMERA = Camera(160, 120, 131.2, 131.2, 80.0, 60.0)
FRAMES = 40
WALL, FLOOR, CEILING, OBJS = 3, 2, 1, 11


@cache
def scene_of(room):
    return prepare_voxels(room.labels, room.voxel_m, room.origin_m)


@cache
def tour_of(room, frames=FRAMES, seed=0):
    return plan_trajectory(room, scene_of(room), CAMERA, frames, np.random.default_rng(seed))


living = cache(lambda: generate_room(1, kind="living"))
tour = cache(lambda: tour_of(living()))


class Shell:
    """A house that is carved: solid at first, rooms and ways are cut out of it."""

    def __init__(self, size_m):
        self.labels = np.full([round(side / 0.02) for side in size_m], WALL, np.uint8)
        self.layouts = []

    def box(self, low, high, label=0):
        cells = tuple(
            slice(round(a / 0.02), round(b / 0.02)) for a, b in zip(low, high, strict=True)
        )
        self.labels[cells] = label
        return self

    def room(self, x0, y0, x1, y1, z=0.2, height=2.4, openings=()):
        self.box((x0, y0, z), (x1, y1, z + height))
        polygon = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
        self.layouts.append(Layout(np.array(polygon, float), height, openings, floor_z_m=z))
        return self

    def made(self):
        shape = self.labels.shape
        return Room(
            "shell", 0, tuple(self.layouts), self.labels, np.zeros(shape, np.uint16),
            np.zeros((*shape, 3), np.uint8), 0.02, np.zeros(3),
        )  # fmt: skip


@cache
def two_rooms(doorway=True):
    shell = Shell((6.4, 3.4, 2.8)).room(0.2, 0.2, 3.0, 3.2).room(3.2, 0.2, 6.2, 3.2)
    return (shell.box((3.0, 1.2, 0.2), (3.2, 2.1, 2.2)) if doorway else shell).made()


@cache
def two_storeys():
    """Two rooms over each other, and steps of 18 cm from one to the other in a shaft."""
    shell = Shell((5.0, 6.2, 5.6)).room(0.2, 0.2, 4.8, 6.0).room(0.2, 0.2, 4.8, 6.0, z=3.08)
    shell.box((0.2, 1.0, 2.6), (1.2, 5.2, 3.08))
    for n in range(15):
        shell.box((0.2, 1.0 + 0.26 * n, 0.2), (1.2, 1.26 + 0.26 * n, 0.38 + 0.18 * n), OBJS)
    return shell.made()


def inside_of(room, points_m):
    """Which layout each point is over, -1 for none."""
    owner = np.full(len(points_m), -1)
    for n, layout in enumerate(room.layouts):
        up = points_m[:, 2] - layout.floor_z_m
        level = (up > 0) & (up < layout.wall_height_m)
        owner[level & is_inside(layout.floor_polygon_m, points_m[:, :2])] = n
    return owner


def test_standing_places_are_solid_below_and_free_around_a_body():
    room = living()
    stands = build_navmesh(room)
    solid = room.labels != 0
    spread = np.stack(np.meshgrid(*[np.arange(-0.24, 0.25, 0.06)] * 2), axis=-1).reshape(-1, 2)
    spread = spread[np.hypot(*spread.T) < BODY_M - 0.01]
    for place in stands.places_m[stands.easy][::40]:
        for x, y in place[:2] + spread:
            column = solid[
                tuple(np.floor((np.array([x, y]) - room.origin_m[:2]) / 0.02).astype(int))
            ]
            k = round((place[2] - room.origin_m[2]) / 0.02)
            assert not column[k + 5 : k + 88].any()
        i, j, k = np.round((place - room.origin_m) / 0.02).astype(int)
        assert solid[i, j, k - 1]
        assert not solid[i, j, k : k + round(HEAD_M / 0.02)].any()


def test_nobody_stands_on_a_table_or_under_it():
    shell = Shell((4.4, 4.4, 2.8)).room(0.2, 0.2, 4.2, 4.2)
    shell.box((1.6, 1.6, 0.88), (2.8, 2.8, 0.92), OBJS)
    stands = build_navmesh(shell.made())
    over = (np.abs(stands.places_m[:, :2] - 2.2) < 0.6 + BODY_M - 0.06).all(axis=1)
    walked = stands.part == stands.part[np.abs(stands.places_m[:, 2] - 0.2) < 0.01][0]
    assert stands.easy.any()
    assert not (stands.easy & over).any()
    assert not (walked & over).any()


def test_a_doorway_links_two_rooms_and_a_wall_parts_them():
    for doorway, parts in ((True, 1), (False, 2)):
        stands = build_navmesh(two_rooms(doorway))
        assert len(set(stands.part[stands.easy].tolist())) == parts
        assert set(stands.storey_room.tolist()) == ({-1, 0, 1} if doorway else {0, 1})


def test_stairs_link_two_storeys():
    stands = build_navmesh(two_storeys())
    floors = [stands.easy & (stands.storey_room == n) for n in (0, 1)]
    assert all(floor.any() for floor in floors)
    assert len(set(stands.part[floors[0] | floors[1]].tolist())) == 1
    heights = stands.places_m[:, 2]
    assert ((heights > 0.3) & (heights < 3.0)).any()


@pytest.mark.parametrize("make", [two_rooms, two_storeys, lambda: two_rooms(False)])
def test_the_walk_is_in_every_room(make):
    room = make()
    walk = plan_walk(room, 80, np.random.default_rng(0))
    owner = inside_of(room, walk.feet_m + np.array([0, 0, 1.0]))
    for n in range(len(room.layouts)):
        assert (owner == n).sum() > 10


@pytest.mark.parametrize("make", [living, two_rooms, two_storeys])
def test_the_walk_goes_on_without_a_jump(make):
    walk = plan_walk(make(), 200, np.random.default_rng(1))
    steps = np.linalg.norm(np.diff(walk.feet_m, axis=0), axis=1)
    assert steps.max() < 3 * walk.pace_m + 0.1
    assert steps.sum() <= 200 * walk.pace_m + 1e-6


@pytest.mark.parametrize("make", [living, two_rooms, two_storeys, lambda: two_rooms(False)])
def test_the_eye_is_in_free_space_at_a_person_s_height(make):
    room = make()
    walk = plan_walk(room, FRAMES, np.random.default_rng(0))
    poses = tour_of(room)
    assert poses.shape == (FRAMES, 4, 4)
    up = poses[:, 2, 3] - walk.feet_m[:, 2]
    assert (up >= 1.2 - 1e-9).all()
    assert (up <= 1.7 + 1e-9).all()
    cells = np.floor((poses[:, :3, 3] - room.origin_m) / room.voxel_m).astype(int)
    for i, j, k in cells:
        assert not room.labels[i - 4 : i + 5, j - 4 : j + 5, k - 4 : k + 5].any()


def test_the_camera_is_held_level_or_down_and_looks_all_around():
    assert np.allclose(tour()[:, 2, 0], 0, atol=1e-9)  # No roll.
    pitch = np.degrees(np.arcsin(tour()[:, 2, 2]))
    assert -30 < pitch.mean() < -3
    assert (pitch > 10).mean() <= 0.2
    ahead = np.degrees(np.arctan2(tour()[:, 1, 2], tour()[:, 0, 2]))
    assert len(set((ahead // 60).tolist())) == 6


def seen_by(room, poses, label=None):
    """The surface voxels that pictures show at 0.4 to 4.5 m, by patches of 8 cm."""
    scene, found = scene_of(room), []
    for pose in poses:
        hits = cast_voxels(scene, CAMERA, pose)
        good = (hits.depth_m > 0.4) & (hits.depth_m < 4.5)
        index = hits.voxel_index[good]
        if label is not None:
            index = index[np.isin(room.labels.reshape(-1)[index], label)]
        cells = np.unravel_index(index, room.labels.shape)
        shape = [side // 4 + 1 for side in room.labels.shape]
        found.append(np.unique(np.ravel_multi_index([axis // 4 for axis in cells], shape)))
    return found


def around(room, count=12):
    """Looks in all directions from places spread over the floor."""
    stands = build_navmesh(room)
    places = stands.places_m[stands.easy]
    for place in places[:: max(1, len(places) // count)]:
        eye = place + np.array([0, 0, 1.45])
        for n in range(6):
            yaw = np.pi * n / 3
            yield look_at(eye, eye + np.array([np.cos(yaw), np.sin(yaw), -0.2]))


def test_walls_floor_and_furniture_are_seen_and_most_of_it_twice():
    labels = list(range(2, 12))
    possible = np.unique(np.concatenate(seen_by(living(), around(living()), labels)))
    shown, times = np.unique(np.concatenate(seen_by(living(), tour(), labels)), return_counts=True)
    assert np.isin(possible, shown).mean() > 0.93
    assert np.isin(possible, shown[times >= 2]).mean() > 0.8


def test_more_coverage_sees_more():
    pictures = seen_by(living(), tour())
    shares = [len(np.unique(np.concatenate(pictures[:n]))) for n in (4, 12, 24, 40)]
    assert sorted(shares) == shares
    assert shares[2] < 0.97 * shares[3]  # Six tenths of the walk leave some corners unseen.


@pytest.mark.parametrize("make", [two_rooms, two_storeys])
def test_every_room_of_a_house_is_seen(make):
    room = make()
    poses = tour_of(room, frames=60)
    owner = inside_of(room, poses[:, :3, 3])
    for n, layout in enumerate(room.layouts):
        hits = np.concatenate(seen_by(room, poses[owner == n], [WALL]))
        shape = [side // 4 + 1 for side in room.labels.shape]
        points = np.stack(np.unravel_index(hits, shape), axis=1) * 0.08
        for axis in (0, 1):  # All four walls.
            for side in (layout.floor_polygon_m.min(axis=0), layout.floor_polygon_m.max(axis=0)):
                assert (np.abs(points[:, axis] - side[axis]) < 0.2).sum() > 40


def test_a_door_is_where_the_walk_begins():
    door = Opening("door", np.array([0.2, 2.4]), np.array([0.2, 3.2]), 0.0, 2.0)
    room = Shell((5.4, 4.4, 2.8)).room(0.2, 0.2, 5.2, 4.2, openings=(door,)).made()
    walk = plan_walk(room, 30, np.random.default_rng(0))
    assert np.linalg.norm(walk.feet_m[0, :2] - [0.2, 2.8]) < 0.8


def test_a_room_without_standing_room_is_scanned_from_its_middle():
    shell = Shell((2.4, 2.4, 1.6)).room(0.2, 0.2, 2.2, 2.2, height=1.2)
    walk = plan_walk(shell.made(), 5, np.random.default_rng(0))
    assert np.allclose(walk.feet_m, [1.2, 1.2, 0.2])


def test_the_same_seed_walks_the_same_way_and_another_does_not():
    again = plan_trajectory(living(), scene_of(living()), CAMERA, FRAMES, np.random.default_rng(0))
    assert np.array_equal(tour(), again)
    assert not np.array_equal(tour(), tour_of(living(), seed=1))


def test_points_are_inside_an_l_where_they_are():
    polygon = np.array([[0, 0], [4, 0], [4, 2], [2, 2], [2, 4], [0, 4]], float)
    points = np.array([[1, 1], [3, 1], [1, 3], [3, 3], [-1, 1], [5, 1]], float)
    assert is_inside(polygon, points).tolist() == [True, True, True, False, False, False]


@pytest.mark.parametrize("voxel_m", [0.02, 0.1, 0.5])
def test_a_room_from_a_foreign_file_is_scanned_without_a_crash(voxel_m):
    polygons = ([[0, 0], [9e3, 0], [9e3, 9e3], [0, 9e3]], [[-5, -5], [9e3, -5], [-4, -4]])
    layouts = tuple(
        Layout(np.array(one, float), 2.4, floor_z_m=n) for n, one in enumerate(polygons)
    )
    labels = np.full((12, 10, 9), WALL, np.uint8)
    labels[2:-2, 2:-2, 2:-2] = 0
    room = Room(
        "odd", 0, layouts, labels, np.zeros(labels.shape, np.uint16),
        np.zeros((*labels.shape, 3), np.uint8), voxel_m, np.zeros(3),
    )  # fmt: skip
    shots = list(room_shots(room, ScanSettings(frames=3, width=32, height=24)))
    assert len(shots) == 3
