"""Full furnishing: every kind of room has what belongs to it, and disorder hides parts of it."""

from functools import cache

import numpy as np
import pytest

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.vocabulary import read_vocabulary
from world2minecraft.furniture.layout_checks import collisions, out_of_bounds
from world2minecraft.procgen import KINDS, generate_room
from world2minecraft.procgen.houses.house import choose_style, house_gaps, plan_house
from world2minecraft.procgen.houses.room_furnishing import furnish_cells
from world2minecraft.procgen.rooms.disorder import (
    HIDDEN,
    LOOSE,
    MAX_RUG_DEG,
    MAX_TURN_DEG,
    disarrange,
    parts_intersect,
    turn_rugs,
)
from world2minecraft.procgen.rooms.full_furnishing import ADDITIONS
from world2minecraft.procgen.rooms.placement import Item, Rug, items_intersect, paths_are_clear
from world2minecraft.procgen.rooms.room import door_step_m, furnish_plan
from world2minecraft.procgen.rooms.seats_beds_tables import chair, table
from world2minecraft.procgen.rooms.voxelization import SHELL, Canvas, paint_rug

# Each entry is one name or several of which one must be there.
EXPECTED = {
    "bathroom": ("toilet", "washbasin", "bathtub|shower", "mirror", "towel|towel radiator"),
    "kitchen": ("counter", "sink", "stove|oven", "refrigerator", "wall cabinet", "microwave",
                "table", "chair", "dishwasher|range hood"),
    "bed": ("bed", "nightstand", "wardrobe", "mirror", "table lamp", "curtain"),
    "study": ("desk", "office chair", "monitor", "bookcase", "table lamp", "waste bin"),
    "living": ("sofa", "armchair", "coffee table", "television", "tv stand", "bookcase", "plant",
               "lamp", "curtain", "picture"),
    "dining": ("table", "chair", "sideboard", "pendant lamp", "picture", "tableware"),
    "children": ("single bed|bunk bed", "shelf", "toy", "ball|toy", "wardrobe", "blanket chest"),
    "hall": ("shoe rack", "clothes|coat stand", "mirror", "bench", "umbrella stand", "door"),
    "laundry": ("washing machine", "sink", "drying rack|ironing board", "shelf|cabinet"),
    "office": ("desk", "office chair", "monitor", "cabinet", "whiteboard", "printer", "waste bin"),
}  # fmt: skip
each_room = pytest.mark.parametrize(("kind", "seed"), [(k, s) for k in EXPECTED for s in (3, 6)])
plan_of = cache(lambda kind, seed: furnish_plan(seed, kind, "box", 0.0, full=True))


def entry_of(item):
    return read_vocabulary().find(item.model.name.replace("_", " "))


def place_of(item):
    return item.model.name, round(item.x_m, 3), round(item.y_m, 3), item.yaw_deg


def test_every_kind_has_a_full_furnishing():
    assert set(ADDITIONS) == set(KINDS) == set(EXPECTED)


@each_room
def test_a_room_has_what_belongs_to_its_kind(kind, seed):
    names = {entry_of(item).name for item in plan_of(kind, seed).items}
    missing = [wanted for wanted in EXPECTED[kind] if not names & set(wanted.split("|"))]
    assert not missing
    assert "ceiling lamp" in names or "pendant lamp" in names


@each_room
def test_every_object_has_the_class_of_its_name(kind, seed):
    for item in plan_of(kind, seed).items:
        assert entry_of(item).class_id == item.model.class_id, item.model.name


@each_room
def test_nothing_collides_and_the_ways_stay_clear(kind, seed):
    made = plan_of(kind, seed)
    layout = made.layout()
    held = [item for item in layout.objects if item.name != "door"]
    assert not collisions(held, 0.011)
    assert not out_of_bounds(held, layout.floor_polygon_m, layout.wall_height_m, 0.011)
    assert paths_are_clear(made.plan, door_step_m(made.plan, made.holes[0]))


@pytest.mark.parametrize("kind", ["living", "kitchen", "hall"])
def test_the_furniture_of_the_recipe_stays_where_it_was(kind):
    basic = furnish_plan(3, kind, "box", 0.0, full=False)
    full = plan_of(kind, 3)
    kept = {place_of(item) for item in basic.items if item.model.name != "curtain"}
    assert kept <= {place_of(item) for item in full.items}
    assert len(full.items) > len(basic.items) + 3
    assert full.rugs == basic.rugs


@pytest.mark.parametrize("kind", ["bathroom"])
def test_voxels_of_an_untidy_full_room_belong_to_its_objects(kind):
    room = generate_room(3, kind=kind, clutter=0.7, furnishing="full")
    for number, item in enumerate(room.objects, start=1):
        cells = np.argwhere(room.instance == number)
        assert len(cells) > 4, item.name
        assert (room.labels[tuple(cells.T)] == item.class_id).all()
        away = room.origin_m + (cells + 0.5) * room.voxel_m - item.center_m
        angle = np.radians(item.yaw_deg)
        front = away[:, 0] * np.cos(angle) + away[:, 1] * np.sin(angle)
        left = away[:, 1] * np.cos(angle) - away[:, 0] * np.sin(angle)
        own = np.column_stack([front, left, away[:, 2]])
        assert (np.abs(own) <= item.size_m / 2 + 0.011).all(), item.name


def disarranged(kind, seed):
    """A tidy room, and the same room after it was disarranged."""
    made, tidy = (furnish_plan(seed, kind, "box", 0.0, full=True) for _ in range(2))
    step = door_step_m(made.plan, made.holes[0])
    disarrange(made.plan, made.holes, 1.0, np.random.default_rng(seed), [step], 0.24)
    assert paths_are_clear(made.plan, step)
    return tidy.plan.items, made.plan.items


def test_chairs_are_pushed_under_their_table():
    _, items = disarranged("dining", 3)
    (board,) = [item for item in items if item.model.name == "dining_table"]
    chairs = [item for item in items if item.model.name == "chair"]
    under = [seat for seat in chairs if items_intersect(seat, board)]
    assert 1 <= len(under) < len(chairs)
    assert not any(parts_intersect(seat, board) for seat in chairs)


def test_a_curtain_covers_a_part_of_its_window():
    before, after = disarranged("dining", 3)
    widths = [
        [item.size_m[1] for item in items if item.model.name == "curtain"]
        for items in (before, after)
    ]
    assert len(widths[0]) == len(widths[1])
    assert max(widths[1]) > max(widths[0]) + 0.2


@pytest.mark.parametrize("kind", ["living", "bed"])
def test_furniture_is_askew_and_carries_what_stands_on_it(kind):
    before, after = disarranged(kind, 3)
    big = LOOSE - {"box", "laundry_basket"}  # Those are also left before cabinets.
    turned = [item for item in after if item.yaw_deg % 90 and item.model.name in big]
    assert turned
    assert all(abs((item.yaw_deg + 45) % 90 - 45) <= MAX_TURN_DEG for item in turned)
    assert len([item for item in before if item.z_m > 0.2]) == len(
        [item for item in after if item.z_m > 0.2]
    )
    for one in after:
        assert not any(
            items_intersect(one, other)
            for other in after
            if other is not one and "chair" not in (one.model.name, other.model.name)
        )


def test_things_are_left_right_before_cabinets():
    before, after = disarranged("living", 3)
    left = [
        item for item in after if item.model.name in ("box", "bag", "laundry", "laundry_basket")
    ]
    assert len(after) - len(before) == len(left) >= 1
    for item in left:
        gaps = []
        for cabinet in [one for one in after if one.model.name in HIDDEN]:
            x0, y0, _, x1, y1, _ = cabinet.box_m
            gaps.append(np.hypot(max(x0 - item.x_m, 0, item.x_m - x1),
                                 max(y0 - item.y_m, 0, item.y_m - y1)))  # fmt: skip
        assert min(gaps) < 0.6


def test_rugs_of_untidy_rooms_are_not_parallel():
    rugs = (Rug(0.0, 0.0, 1.0, 2.0, (1, 2, 3)),) * 5
    turned = turn_rugs(rugs, 0.5, np.random.default_rng(0))
    assert len({rug.turn_deg for rug in turned}) == 5
    assert max(abs(rug.turn_deg) for rug in turned) <= MAX_RUG_DEG / 2
    assert turn_rugs(rugs, 0.0, np.random.default_rng(0)) == rugs


def test_parts_tell_a_chair_under_a_table_from_one_in_its_leg():
    board = Item(table("dining_table", 0.9, 1.6, 0.74, (180, 140, 90)), 0.0, 0.0, 0.0, 0.0)
    seat = chair((180, 140, 90), (70, 90, 130))
    under = Item(seat, 0.5, 0.0, 0.0, 180.0)
    in_leg = Item(seat, 0.5, 0.62, 0.0, 180.0)
    assert items_intersect(under, board) and not parts_intersect(under, board)
    assert items_intersect(in_leg, board) and parts_intersect(in_leg, board)


def test_a_turned_rug_is_painted_about_its_middle():
    def painted(turn_deg):
        canvas = Canvas((3.0, 2.0, 2.4))
        canvas.labels[:, :, :SHELL] = 2
        paint_rug(canvas, Rug(0.8, 0.6, 2.2, 1.4, (200, 40, 40), turn_deg), (0, 0, 3.0, 2.0))
        return canvas.colour[:, :, SHELL - 1].any(axis=-1)

    straight, turned = painted(0.0), painted(12.0)
    assert turned.sum() == pytest.approx(straight.sum(), rel=0.03)
    assert np.argwhere(turned).mean(axis=0) == pytest.approx(
        np.argwhere(straight).mean(axis=0), abs=0.6
    )
    assert (straight & ~turned).any() and (turned & ~straight).any()


def test_the_rooms_of_a_house_are_furnished_fully():
    rng = np.random.default_rng(4)
    plan = plan_house(3, 1, rng)
    gaps = house_gaps(plan, rng)
    styles = [choose_style(rng) for _ in plan.cells]
    counts = []
    for full in (False, True):
        items, _ = furnish_cells(plan, gaps, styles, 0.0, (4,), full=full)
        counts.append([len(held) for held in items])
    assert all(more > fewer for fewer, more in zip(*counts, strict=True))


def test_an_unknown_furnishing_is_refused_by_name():
    with pytest.raises(UnknownNameError, match="no furnishing is named 'ful'; did you mean"):
        generate_room(0, furnishing="ful")
