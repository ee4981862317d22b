"""Houses as worlds: the same seed gives the same blocks, and every block knows what it is of."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.check_furnishing import loose_designs
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.files import read_json
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.world_labels import read_scene
from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.minecraft.physics.shortest_paths import reachable, shortest_path
from world2minecraft.minecraft.physics.walk_graph import walk_graph
from world2minecraft.minecraft.rules.stability import find_unstable
from world2minecraft.minecraft.worlds.world_reader import read_level
from world2minecraft.minecraft.worlds.world_writer import read_world
from world2minecraft.procgen.worlds import generate_world, write_worlds
from world2minecraft.procgen.worlds.furniture_choice import MOST_A_ROOM
from world2minecraft.procgen.worlds.house_world import LEVEL, floor_places
from world2minecraft.procgen.worlds.world_files import house_layouts

GONE = ("falls", "pops off", "breaks", "flows")  # What a block does that cannot stay.


@pytest.fixture(scope="module")
def house():
    return generate_world(5, rooms=6, storeys=1)


@pytest.fixture(scope="module")
def tall():
    return generate_world(9, rooms=7, storeys=2)


@pytest.fixture(scope="module")
def game_scale():
    return generate_world(2, rooms=6, storeys=2, blocks_per_metre=4.0)


def test_the_same_seed_gives_the_same_world(house):
    again = generate_world(5, rooms=6, storeys=1)
    assert again.volume.palette == house.volume.palette
    assert np.array_equal(again.volume.states, house.volume.states)
    assert np.array_equal(again.volume.instance, house.volume.instance)
    assert np.array_equal(again.design, house.design)
    other = generate_world(6, rooms=6, storeys=1).volume
    assert other.palette != house.volume.palette


def test_designs_are_of_the_library_and_of_their_class(house):
    assert house.designs[0] == ""
    assert set(house.designs[1:]) <= set(TEMPLATES.names())
    for number, name in enumerate(house.designs[1:], 1):
        own = house.design == number
        assert own.any()
        assert (house.volume.semantic[own] == template(name).class_id).all()
        assert (house.volume.instance[own] > 0).all()
    assert not house.design[house.volume.states == 0].any()


@pytest.mark.parametrize("which", ["house", "tall"])
def test_a_wall_holds_at_most_one_picture(which, request):
    things = request.getfixturevalue(which).things
    walls = [(t.room, t.quarter_turns) for t in things if template(t.design).family == "framed"]
    assert len(walls) == len(set(walls))


def test_a_house_has_structure_and_furniture(house):
    classes = set(np.unique(house.volume.semantic).tolist())
    wanted = (SemanticClass.FLOOR, SemanticClass.WALL, SemanticClass.CEILING, SemanticClass.WINDOW)
    assert {int(one) for one in wanted} <= classes
    assert len(classes) >= 9
    assert len(house.things) >= 6 * 5


def count_reachable_floor(volume, house, spawn):
    """The places on the floor of each room that are reached from a spawn, and all of them."""
    graph = walk_graph(volume)
    found = reachable(graph, graph.nearest(spawn))
    floors = [floor_places(graph, house, room) for room in house.rooms]
    return [(int((found & floor).sum()), int(floor.sum())) for floor in floors]


@pytest.mark.parametrize("which", ["house", "tall", "game_scale"])
def test_every_room_is_reached_on_foot_from_the_spawn(which, request):
    made = request.getfixturevalue(which)
    counts = count_reachable_floor(made.volume, made.house, made.spawn.position)
    assert len(counts) == len(made.house.rooms)
    for there, places in counts:
        assert there >= 0.7 * places > 0
    assert sum(a for a, _ in counts) > 0.95 * sum(b for _, b in counts)


def test_a_room_whose_door_is_walled_up_is_not_reached(tall):
    room = tall.house.rooms[1]
    states, corner = tall.volume.states.copy(), tall.volume.corner
    stone = states[tall.volume.semantic == SemanticClass.FLOOR][0]
    for gap in tall.house.gaps:
        if gap.kind != "window" and room.number in gap.rooms:
            x = slice(gap.low[0] - corner[0], gap.high[0] - corner[0])
            north = tall.house.size[1]
            z = slice(north - gap.high[1] - corner[2], north - gap.low[1] - corner[2])
            y = slice(gap.bottom + 64 - corner[1], gap.top + 64 - corner[1])
            states[x, y, z] = stone
    shut = replace(tall.volume, states=states)
    counts = count_reachable_floor(shut, tall.house, tall.spawn.position)
    before = count_reachable_floor(tall.volume, tall.house, tall.spawn.position)
    assert counts[room.number][0] == 0 < before[room.number][0]
    assert counts[0][0] > 0.9 * before[0][0]


def test_stairs_have_headroom_under_the_upper_floor(tall):
    house, graph = tall.house, walk_graph(tall.volume)
    flight = house.flight
    assert flight is not None
    column = (flight.x0 + 1.5, house.size[1] - flight.y0 + 0.5)
    foot = graph.nearest((column[0], 64.0, column[1] + 1))
    head = graph.nearest((column[0], 64.0 + house.grounds[1], house.size[1] - flight.end - 0.5))
    way = shortest_path(graph, foot, head)
    assert way is not None
    assert way.length_m < 2.2 * flight.steps / house.blocks_per_metre
    assert (graph.headroom[way.places] >= 1.8 * house.blocks_per_metre).all()


def test_one_begins_on_the_lowest_storey_where_a_person_fits(tall):
    graph = walk_graph(tall.volume)
    start = np.array(tall.spawn.position)
    assert np.abs(graph.feet[graph.nearest(tall.spawn.position)] - start).max() == 0
    assert 64 <= start[1] < 64 + LEVEL


def test_nothing_falls_or_breaks(tall):
    assert not [one for one in find_unstable(tall.volume) if one.reason.startswith(GONE)]


def test_other_scales_are_made(house):
    small = generate_world(5, rooms=6, storeys=1, blocks_per_metre=2.0)
    assert small.volume.blocks_per_metre == pytest.approx(2.0)
    assert small.volume.states.size < house.volume.states.size / 4
    assert len(small.things) > 20


def test_a_room_too_low_for_a_rack_goes_without():
    assert generate_world(44, rooms=5, blocks_per_metre=2.0).volume.states.any()


def test_rooms_stand_where_the_room_frame_says(house):
    to_room, corner = house.volume.block_to_room, np.array(house.volume.corner)
    floor = np.argwhere(house.volume.semantic == SemanticClass.FLOOR) + corner
    middle = (to_room[:3, :3] @ (floor + 0.5).T).T + to_room[:3, 3]
    assert middle[:, 2].max() < 0
    assert middle[:, :2].min() > -0.3
    high = np.array(house.house.size) / house.house.blocks_per_metre
    assert (middle[:, :2].max(axis=0) <= high + 0.3).all()


def test_layouts_say_where_the_blocks_are(tall):
    volume, to_block = tall.volume, np.linalg.inv(tall.volume.block_to_room)
    layouts = house_layouts(tall.house, tall.things)

    def semantic(points_m):
        at = (points_m @ to_block[:3, :3].T + to_block[:3, 3] - volume.corner).astype(int)
        return volume.semantic[tuple(at.T)], volume.instance[tuple(at.T)]

    assert sum(len(layout.objects) for layout in layouts) == len(tall.things)
    for layout in layouts:
        for item in layout.objects:
            low, high = item.center_m - 1e-9, item.center_m + 1e-9
            assert (low[:2] > layout.floor_polygon_m.min(axis=0)).all()
            assert (high[:2] < layout.floor_polygon_m.max(axis=0)).all()
        for opening in layout.openings:
            middle = (opening.start_m + opening.end_m) / 2
            inner = layout.floor_polygon_m.mean(axis=0)
            along = opening.end_m - opening.start_m
            off = np.array([-along[1], along[0]]) / np.hypot(*along)
            off *= np.sign(off @ (middle - inner)) * 0.1
            high = layout.floor_z_m + (opening.sill_m + opening.head_m) / 2
            found, _ = semantic(np.array([[*(middle + off), high]]))
            if opening.kind == "window":
                assert found == SemanticClass.WINDOW
            else:
                assert found in (0, SemanticClass.OBJS)


@pytest.mark.parametrize("which", ["house", "tall", "game_scale"])
def test_rooms_hold_nothing_of_the_garden_and_roof(which, request):
    made = request.getfixturevalue(which)
    volume, house = made.volume, made.house
    outside = volume.semantic == UNKNOWN
    assert outside.any()
    x, y, z = (-value for value in volume.corner)
    for room in house.rooms:
        low = 64 + room.ground - 1 + y
        layers = outside[x : x + house.size[0], low : low + room.height + 2, z : z + house.size[1]]
        floor = room.floor(house.size)[:, ::-1]
        assert not layers[np.broadcast_to(floor[:, None], layers.shape)].any()


@pytest.mark.parametrize("which", ["house", "tall", "game_scale"])
def test_roofs_cover_all_walls_and_hang_over(which, request):
    made = request.getfixturevalue(which)
    volume, house = made.volume, made.house
    top = 64 + house.height - volume.corner[1]  # Of the lowest ceiling.
    covered = (volume.states[:, top:] > 0).any(axis=1)
    x, _, z = (-value for value in volume.corner)
    rooms = np.any([room.floor(house.size)[:, ::-1] for room in house.rooms], axis=0)
    inside = np.zeros(covered.shape, bool)
    inside[x : x + house.size[0], z : z + house.size[1]] = rooms
    hang = round(0.4 * house.blocks_per_metre)
    wide = ndimage.binary_dilation(inside, np.ones((3, 3)), iterations=2 + hang)
    assert covered[wide].all()
    # Above the rooms there is a roof, not only their ceiling.
    assert (volume.semantic[:, top + 1 :] == UNKNOWN).any(axis=1)[inside].all()


@pytest.mark.parametrize("which", ["house", "tall", "game_scale"])
def test_nothing_floats_or_is_gone(which, request):
    made = request.getfixturevalue(which)
    assert made.things
    assert not loose_designs(made)


@pytest.mark.parametrize("which", ["house", "tall", "game_scale"])
def test_a_room_holds_one_picture_or_mirror(which, request):
    made = request.getfixturevalue(which)
    for room in made.house.rooms:
        own = Counter(thing.design for thing in made.things if thing.room == room.number)
        assert sum(own[name] for name in ("picture", "portrait", "wall_mirror")) <= 1
        assert all(count <= MOST_A_ROOM.get(name, 1) for name, count in own.items())


def test_the_five_commonest_designs_are_few(house, tall, game_scale):
    counts = Counter(thing.design for made in (house, tall, game_scale) for thing in made.things)
    assert sum(count for _, count in counts.most_common(5)) <= 0.18 * counts.total()


def test_the_path_leads_from_the_door_to_the_gate(house):
    volume = house.volume
    doors = [g for g in house.house.gaps if g.kind != "window" and len(g.rooms) == 1]
    assert doors
    for gap in doors:
        across, step = gap.turn % 2, -1 if gap.turn < 2 else 1
        cell = [gap.low[0], gap.low[1]]
        found = set()
        for _ in range(2, 100):
            cell[across] += step
            x, z = cell[0] - volume.corner[0], house.house.size[1] - 1 - cell[1] - volume.corner[2]
            if not (0 <= x < volume.states.shape[0] and 0 <= z < volume.states.shape[2]):
                break
            level = 64 - volume.corner[1]
            assert not volume.states[x, level : level + 8, z].any()
            found.add(volume.palette[volume.states[x, level - 1, z]])
        assert 1 <= len(found) <= 2  # The path, and the threshold in the outer wall.


def test_written_worlds_are_read_back(tmp_path):
    (folder,) = write_worlds(tmp_path, 1, 3)
    scene = read_scene(folder)
    assert scene.design is not None
    assert scene.design.shape == scene.semantic.shape
    assert scene.designs[0] == ""
    assert int(scene.design.max()) == len(scene.designs) - 1
    assert set(scene.light) == {"hour", "lamps"}
    stated = read_json(folder / "house.json")
    assert len(stated["rooms"]) == len(read_layouts(folder / "layout.json"))
    assert read_world(folder / "world").states.any()
    assert (
        read_level(folder / "world")["DayTime"] == round((scene.light["hour"] - 6) * 1000) % 24000
    )
    with np.load(folder / "scene.npz") as arrays:
        kept = {name: arrays[name] for name in ("semantic", "instance")}
    np.savez(folder / "scene.npz", **kept)
    assert read_scene(folder).design is None


@pytest.mark.parametrize(
    ("given", "error", "text"),
    [
        ({"seed": -1}, ValueError, "seed must be 0 or more, got -1"),
        ({"rooms": 2}, ValueError, "rooms must be from 3 to 14 on 1 storey, got 2"),
        ({"blocks_per_metre": 12.5}, ValueError, "blocks_per_metre must be from 2 to below 6"),
        ({"style": "modrn"}, UnknownNameError, "did you mean 'modern'?"),
    ],
)
def test_wrong_numbers_are_refused(given, error, text):
    with pytest.raises(error, match=text.replace("?", r"\?")):
        generate_world(**{"seed": 1, **given})
