"""A scene of a small flat: names, rooms, doors, goals and distances on foot."""

import json
import shutil
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse.csgraph import dijkstra
from small_flat import flat_volume

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.minecraft.physics.any_angle_paths import build_lattice, straight_m
from world2minecraft.navigation.landmarks import colour_name, landmarks_of
from world2minecraft.navigation.running.sentence_goals import find_named_landmark
from world2minecraft.navigation.scene import (
    LEVEL_SIZES,
    REACH_SPACINGS,
    camera_of,
    distance_from_field,
    open_scene,
)
from world2minecraft.navigation.types import Stance


def test_things_have_names_that_tell_them_apart(flat):
    assert [one.name for one in flat.landmarks] == [
        "table",
        "chair beside the table",
        "upright piano",
        "chair beside the upright piano",
    ]
    assert [one.colour for one in flat.landmarks] == ["red", "brown", "black", "brown"]
    assert [flat.rooms[one.room].name for one in flat.landmarks] == [
        "living room", "living room", "kitchen", "kitchen",
    ]  # fmt: skip


def test_a_thing_lies_where_its_blocks_are(flat):
    piano = flat.landmark("the upright piano")
    np.testing.assert_allclose(piano.size_m, [1.5, 1.0, 1.0])
    np.testing.assert_allclose(piano.low_m, flat.to_room_m([14, 65, 9]))


def test_a_name_that_means_nothing_or_two_things_is_told(flat):
    with pytest.raises(
        UnknownNameError, match="no landmark is named 'tables'; did you mean 'table'"
    ):
        flat.landmark("tables")
    two = "2 landmarks are named 'chair'; use one of 'chair beside the table', 'chair beside the"
    with pytest.raises(UsageError, match=two):
        flat.landmark("chair")
    assert flat.landmark("piano").number == flat.landmark("The upright piano").number == 3


def test_rooms_know_the_door_between_them(flat):
    assert [room.name for room in flat.rooms] == ["living room", "kitchen"]
    (door,) = flat.rooms[0].doors
    assert door.to == 1
    assert door.feet[0] == pytest.approx(9.5, abs=0.6) and door.feet[2] == pytest.approx(5, abs=0.3)
    assert [back.to for back in flat.rooms[1].doors] == [0]
    assert flat.room_at((3, 65, 3)) == 0 and flat.room_at((14, 65, 3)) == 1


def test_goals_are_before_the_thing_and_in_its_room(flat):
    goals = flat.goals_at(flat.landmark("table"))
    assert goals and all(flat.room_at(goal) == 0 for goal in goals)
    # The table is z 7 to 9 of a body 1.2 wide: one stands at 6.4 or a little before.
    assert min(goal[2] for goal in goals) >= 5.5
    assert max(np.hypot(max(0, 3 - x, x - 6), max(0, 7 - z)) for x, _, z in goals) <= 2.0


def test_distance_field_is_dijkstra_over_visible_places(flat):
    goals = flat.goals_at(flat.landmark("upright piano"))
    graph, lattice = flat.corner_graph, build_lattice(flat.corner_graph)
    low = np.flatnonzero(graph.feet[:, 1] == 65)
    links = np.zeros((len(low), len(low)))
    for (a, here), (b, there) in combinations(enumerate(low.tolist()), 2):
        way = straight_m(lattice, here, there)
        links[a, b] = links[b, a] = way if np.isfinite(way) else 0
    places = [low.tolist().index(graph.nearest(goal)) for goal in goals]
    slow = dijkstra(links, indices=places).min(axis=0)
    np.testing.assert_allclose(flat.corner_distances_m(goals)[low], slow, rtol=0.005)
    own = flat.corner_distances_m(goals)[[graph.nearest(feet) for feet in flat.graph.feet]]
    np.testing.assert_array_equal(flat.distances_m(goals), own)


def test_distances_between_places_join_the_field(flat):
    goal = ((16.0, 65.0, 3.0),)
    straight = flat.distance_m((12.0, 65.0, 3.0), goal)
    assert straight == pytest.approx(2.0, abs=0.3)
    walked = [flat.distance_m((x, 65.0, 3.0), goal) for x in np.linspace(11, 15, 41)]
    assert (np.diff(walked) < 0.05).all() and walked[0] > walked[-1]


@given(x=st.floats(-1, 20), y=st.sampled_from([64.0, 65.0, 65.25, 66.0]), z=st.floats(-1, 11))
def test_floor_table_lookup_agrees_with_brute_force(flat, x, y, z):
    field = flat.corner_distances_m(flat.goals_at(flat.landmark("table")))
    apart = flat.corner_graph.feet - [x, y, z]
    level = np.abs(apart[:, 1]) <= LEVEL_SIZES * flat.scale
    near = level & (
        np.hypot(apart[:, 0], apart[:, 2]) <= REACH_SPACINGS * flat.corner_graph.spacing
    )
    ways = np.linalg.norm(apart, axis=1) * flat.metres_per_block + field
    slow = ways[near].min(initial=np.inf)
    assert distance_from_field(flat.floor, field, x, y, z) == pytest.approx(slow)


def test_a_picture_shows_what_is_ahead(flat):
    camera = camera_of(64, 48, 90.0)
    seen = flat.picture(Stance(15.5, 65, 3.0, 0.0), camera, outputs=("colour", "instance"))
    assert seen.instance is not None and (seen.instance == 3).mean() > 0.05
    behind = flat.picture(Stance(15.5, 65, 3.0, 180.0), camera, outputs=("instance",))
    assert behind.instance is not None and not (behind.instance == 3).any()


def test_a_body_out_of_range_is_told(flat_path):
    with pytest.raises(UsageError, match="body must be 0.1 to 2 times human size, got 9"):
        open_scene(flat_path, body=9)


@pytest.mark.parametrize(
    ("rgb", "name"),
    [((250, 250, 250), "white"), ((142, 32, 32), "red"), ((8, 10, 15), "black"),
     ((96, 59, 31), "brown"), ((53, 57, 157), "blue"), ((94, 124, 22), "green")],
)  # fmt: skip
def test_colours_have_their_plain_names(rgb, name):
    assert colour_name(np.array(rgb)) == name


def named_flat(flat_path, folder, names):
    """The flat with names of objects, as a run states them; ids from 1."""
    shutil.copytree(flat_path, folder)
    path = folder / "scene.json"
    rows = [
        {"id": number, "class": kind, "name": name, "name_confidence": confidence}
        for number, (kind, name, confidence) in enumerate(names, 1)
    ]
    path.write_text(json.dumps(json.loads(path.read_text()) | {"objects": rows}))
    return open_scene(folder)


def test_names_of_objects_are_landmarks(flat_path, tmp_path):
    scene = named_flat(
        flat_path,
        tmp_path / "flat",
        [
            ("table", "desk", 0.9),
            ("chair", "bar stool", 0.8),
            ("furn", "furniture", 0.3),
            ("chair", "Stop. Go away", 1.0),
        ],
    )
    assert [one.noun for one in scene.landmarks] == ["desk", "bar stool", "upright piano", "chair"]
    assert find_named_landmark(scene, "go to the writing desk") is scene.landmark("desk")
    assert scene.landmark("bar stool").is_unambiguous


def test_two_things_of_one_name_are_told_apart(flat_path, tmp_path):
    unnamed = ("furn", "", 0.0)
    two = [("table", "desk", 0.9), ("chair", "stool", 0.8), unnamed, ("chair", "stool", 0.9)]
    scene = named_flat(flat_path, tmp_path / "flat", two)
    names = [one.name for one in scene.landmarks if one.noun == "stool"]
    assert names == ["stool beside the desk", "stool beside the upright piano"]


def test_unnamed_furniture_is_no_goal():
    volume, _, _ = flat_volume()
    none = (np.zeros(volume.states.shape, np.uint16), ("",))
    found = landmarks_of(volume, none, {}, lambda _: 0)
    assert [one.noun for one in found] == ["table", "chair", "piece of furniture", "chair"]
    assert [one.is_unambiguous for one in found] == [True, True, False, True]
