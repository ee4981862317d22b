"""Houses: plans with shared walls, rooms that all can be walked to, stairs that are climbed."""

import hashlib
from functools import cache

import numpy as np
import pytest

from world2minecraft.furniture.layout_checks import collisions, out_of_bounds
from world2minecraft.procgen import generate_house
from world2minecraft.procgen.houses.plan import (
    HEADROOM_M,
    WALL_M,
    house_gaps,
    plan_house,
    stairwell,
)
from world2minecraft.procgen.sensors.navmesh import build_navmesh

HOUSES = [(0, 3, 1, 0.0), (1, 5, 1, 0.7), (2, 5, 2, 0.0)]
each_house = pytest.mark.parametrize("which", HOUSES, ids=str)
PLANS = [(seed, rooms, storeys) for seed in range(6) for rooms, storeys in
         ((3, 1), (7, 1), (14, 1), (4, 2), (9, 2), (12, 2), (14, 2))]  # fmt: skip
each_plan = pytest.mark.parametrize("which", PLANS, ids=str)
STAIRS_AND_DOORS = ("stairs", "door", "railing")


@cache
def house(which):
    seed, rooms, storeys, clutter = which
    return generate_house(seed, rooms=rooms, storeys=storeys, clutter=clutter)


def planned(which):
    seed, rooms, storeys = which
    return plan_house(rooms, storeys, np.random.default_rng([seed, rooms, storeys]))


def at(room, x, y, z):
    """The label at a place in the frame of the house."""
    cell = np.floor((np.array([x, y, z]) - room.origin_m) / room.voxel_m).astype(int)
    return int(room.labels[tuple(cell)])


@each_plan
def test_a_plan_has_the_rooms_asked_for_and_none_overlap(which):
    plan = planned(which)
    assert len(plan.cells) == which[1]
    assert {cell.storey for cell in plan.cells} == set(range(which[2]))
    for n, a in enumerate(plan.cells):
        for b in plan.cells[n + 1 :]:
            if a.storey == b.storey:
                taken = [cell_squares(cell) for cell in (a, b)]
                assert not (grow(taken[0], 5) & taken[1])  # 10 cm of wall at least between them.


def cell_squares(cell):
    """The 2 cm squares of a cell's floor that lie at its rim, as a set."""
    width, depth, _ = cell.ground.size_m
    x = np.arange(0.01, width, 0.02)[:, None]
    y = np.arange(0.01, depth, 0.02)[None]
    free = ~cell.ground.built(x, y)
    inner = free.copy()
    inner[1:-1, 1:-1] &= ~(free[2:, 1:-1] & free[:-2, 1:-1] & free[1:-1, 2:] & free[1:-1, :-2])
    i, j = np.nonzero(inner)
    return set(zip((i + round(cell.x_m / 0.02)).tolist(), (j + round(cell.y_m / 0.02)).tolist(),
                   strict=True))  # fmt: skip


def grow(squares, steps):
    ways = [(di, dj) for di in (-steps, 0, steps) for dj in (-steps, 0, steps)]
    return {(i + di, j + dj) for i, j in squares for di, dj in ways}


@each_plan
def test_a_plan_lies_on_the_grid_of_voxels(which):
    plan = planned(which)
    lengths = [value for cell in plan.cells for value in (*cell.rect, *cell.ground.size_m)]
    steps = np.array([*lengths, plan.pitch_m]) / 0.02
    assert np.abs(steps - np.round(steps)).max() < 1e-6


@each_plan
def test_rooms_have_hall_doors_and_halls_an_entrance(which):
    plan = planned(which)
    gaps = house_gaps(plan, np.random.default_rng(0))
    assert gaps[0].kind == "door" and gaps[0].cells == (0,)
    halls = {n for n, cell in enumerate(plan.cells) if cell.kind == "hall"}
    for n, cell in enumerate(plan.cells):
        doors = [gap for gap in gaps if gap.kind == "door" and n in gap.cells]
        assert doors
        if n not in halls:
            (hall,) = {other for gap in doors for other in gap.cells} & halls
            assert plan.cells[hall].storey == cell.storey


@each_plan
def test_a_gap_lies_in_the_wall_between_its_rooms(which):
    plan = planned(which)
    for gap in house_gaps(plan, np.random.default_rng(0)):
        holes = [gap.hole(n, plan.cells[n]) for n in gap.cells]
        walls = [plan.cells[n].ground.walls[h.wall] for n, h in zip(gap.cells, holes, strict=True)]
        for hole, wall in zip(holes, walls, strict=True):
            assert wall.first_m - 1e-6 <= hole.first_m < hole.last_m <= wall.last_m + 1e-6
        if len(gap.cells) == 2:
            a, b = (plan.cells[n] for n in gap.cells)
            assert (walls[0].turn - walls[1].turn) % 4 == 2
            across = walls[0].turn % 2
            faces = [
                wall.at_m + (cell.x_m, cell.y_m)[across]
                for wall, cell in zip(walls, (a, b), strict=True)
            ]
            assert abs(faces[0] - faces[1]) == pytest.approx(WALL_M)


@each_plan
def test_windows_look_outside(which):
    plan = planned(which)
    for gap in house_gaps(plan, np.random.default_rng(0)):
        if gap.kind != "window":
            continue
        x, y = gap.wall.point((gap.first_m + gap.last_m) / 2, -0.3)
        storey = plan.cells[gap.cells[0]].storey
        for cell in plan.cells:
            a, b, c, d = cell.rect
            if cell.storey == storey and a < x < c and b < y < d:
                assert cell.ground.built(np.array(x - a), np.array(y - b))


@pytest.mark.parametrize("seed", range(4))
def test_stairs_have_steps_and_headroom_for_people(seed):
    plan = plan_house(4, 2, np.random.default_rng(seed))
    flight = plan.flight
    assert flight.risers * flight.rise_m == pytest.approx(plan.pitch_m)
    assert flight.rise_m <= 0.2 and flight.tread_m >= 0.23
    assert 0.59 <= 2 * flight.rise_m + flight.tread_m <= 0.65
    x0, y0, x1, y1 = flight.rect
    assert x1 - x0 >= 0.8
    hole = stairwell(plan, flight)
    for n in range(flight.risers - 1):
        begin = y0 + n * flight.tread_m
        head = plan.height_m - flight.rise_m * (n + 1)
        assert head >= HEADROOM_M - 0.01 or hole[1] <= begin + 1e-6
    assert hole[4] == pytest.approx(y1)


@each_house
def test_every_room_is_reached_from_the_front_door(which):
    room = house(which)
    stands = build_navmesh(room)
    door = room.layouts[0].openings[0]
    assert door.kind == "door"
    step_in = (door.start_m + door.end_m) / 2
    near = stands.places_m[:, 2] < 0.1
    far = np.linalg.norm(stands.places_m[:, :2] - step_in, axis=1) + np.where(near, 0, 99)
    assert far.min() < 1.0
    part = stands.part[far.argmin()]
    for n, layout in enumerate(room.layouts):
        here = (stands.storey_room == n) & stands.easy
        reached = (here & (stands.part == part)).sum()
        assert reached > 0.6 * here.sum() > 30, layout.name


@each_house
def test_things_stand_in_their_rooms_and_do_not_collide(which):
    room = house(which)
    for layout in room.layouts:
        held = [item for item in layout.objects if item.name not in STAIRS_AND_DOORS]
        assert not out_of_bounds(held, layout.floor_polygon_m, tolerance_m=0.011)
        for item in held:
            low = item.center_m[2] - item.size_m[2] / 2 - layout.floor_z_m
            assert low > -1e-6 and low + item.size_m[2] < layout.wall_height_m + 1e-6
        stands = [item for item in layout.objects if item.name not in ("stairs", "bed", "sofa")]
        assert not collisions(stands, 0.011)


@each_house
def test_voxels_are_where_the_layouts_say(which):
    room = house(which)
    seen = np.bincount(room.instance.reshape(-1), minlength=len(room.objects) + 1)
    assert len(seen) == len(room.objects) + 1
    assert (seen[1:] > 4).all()
    for layout in room.layouts:
        inner = layout.floor_polygon_m.mean(axis=0)
        assert at(room, *layout.floor_polygon_m[0] + 0.05, layout.floor_z_m - 0.01) == 2
        assert at(room, *inner, layout.floor_z_m + layout.wall_height_m + 0.01) in (0, 1)
    classes = {n: item.class_id for n, item in enumerate(room.objects, start=1)}
    for n in range(1, len(seen), 7):
        assert (room.labels[room.instance == n] == classes[n]).all()


@each_house
def test_openings_without_leaf_are_open_and_windows_are_glazed(which):
    room = house(which)
    for layout in room.layouts:
        for opening in layout.openings[1:] if layout is room.layouts[0] else layout.openings:
            along = opening.end_m - opening.start_m
            across = np.array([-along[1], along[0]]) / np.linalg.norm(along)
            middle = (opening.start_m + opening.end_m) / 2 + 0.3 * along
            z = layout.floor_z_m + (opening.sill_m + opening.head_m) / 2
            labels = {at(room, *(middle + t * across), z) for t in (-0.09, -0.05, 0.05, 0.09)}
            assert labels & {0, 4}
            if opening.kind == "window":
                assert 4 in labels
            else:
                assert labels <= {0, 11}


def test_the_bytes_of_a_house_depend_on_the_seed_alone():
    def digest(room):
        held = (room.labels, room.instance, room.colour)
        return hashlib.sha256(b"".join(array.tobytes() for array in held)).hexdigest()

    assert digest(generate_house(0, rooms=3)) == digest(house(HOUSES[0]))
    assert digest(house(HOUSES[0])) != digest(house(HOUSES[2]))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"rooms": 2}, "rooms must be from 3 to 14 on 1 storey, got 2"),
        ({"rooms": 15}, "rooms must be from 3 to 14 on 1 storey, got 15"),
        ({"rooms": 3, "storeys": 2}, "rooms must be from 4 to 14 on 2 storeys, got 3"),
        ({"storeys": 3}, "storeys must be 1 or 2, got 3"),
        ({"clutter": 1.5}, "clutter must be from 0 to 1, got 1.5"),
    ],
)
def test_numbers_out_of_range_are_refused(words, message):
    with pytest.raises(ValueError, match=f"^{message}$"):
        generate_house(0, **words)
