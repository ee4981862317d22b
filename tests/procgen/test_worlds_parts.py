"""The parts of a world: plans in blocks, ways, wares and looks, each by what it promises."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from world2minecraft.core.types import BlockVolume
from world2minecraft.furniture.materials import kinds
from world2minecraft.minecraft.block_states import complete, known_blocks, parse_state
from world2minecraft.minecraft.physics.walk_graph import walk_graph
from world2minecraft.procgen.worlds.block_house import person_size_blocks, plan_block_house
from world2minecraft.procgen.worlds.canvas import WorldCanvas
from world2minecraft.procgen.worlds.clear_paths import ClearPaths
from world2minecraft.procgen.worlds.exterior import (
    draw_exterior,
    full_block,
    put_facade,
    put_roof,
    roof_layers,
)
from world2minecraft.procgen.worlds.furniture_choice import DESIGNS
from world2minecraft.procgen.worlds.garden import garden_blocks
from world2minecraft.procgen.worlds.recipes import BLOCK_RECIPES, BOARDS, PILLARS, RIMS
from world2minecraft.procgen.worlds.shell import rails
from world2minecraft.procgen.worlds.styles import NEUTRALS, colour_of, draw_look, styles
from world2minecraft.procgen.worlds.wares_and_stands import (
    HOME,
    MOUNTS,
    WareDeck,
    load_wares,
    mount_table,
)

PLANS = [(seed, rooms, storeys) for seed, (rooms, storeys) in enumerate([(4, 1), (9, 1), (8, 2)])]


def is_block(state):
    return str(complete(parse_state(f"minecraft:{state}")))


@pytest.mark.parametrize(("seed", "rooms", "storeys"), PLANS)
@pytest.mark.parametrize("scale", [2.0, 4.0])
def test_rooms_in_blocks_are_apart_and_near_their_metres(seed, rooms, storeys, scale):
    house = plan_block_house((seed,), rooms, storeys, scale)
    for room, cell in zip(house.rooms, house.plan.cells, strict=True):
        sides = np.array(cell.ground.size_m[:2]) * scale
        assert (np.abs(np.array(room.size) - sides) < 2).all()
    for one, other in itertools.combinations(house.rooms, 2):
        if one.storey == other.storey:
            wide = np.pad(one.floor(house.size), 1)
            near = [
                wide[1 + dx : wide.shape[0] - 1 + dx, 1 + dy : wide.shape[1] - 1 + dy]
                for dx in (-1, 0, 1)
                for dy in (-1, 0, 1)
            ]
            assert not (np.any(near, axis=0) & other.floor(house.size)).any()


@pytest.mark.parametrize(("seed", "rooms", "storeys"), PLANS)
def test_gaps_lie_in_walls_between_their_rooms(seed, rooms, storeys):
    house = plan_block_house((seed,), rooms, storeys, 4.0)
    for gap in house.gaps:
        across = gap.turn % 2
        assert gap.high[across] - gap.low[across] == 1
        for number in gap.rooms:
            room = house.rooms[number]
            inside = np.pad(room.floor(house.size), 2)
            low, high = np.array(gap.low) + 2, np.array(gap.high) + 2
            assert not inside[low[0] : high[0], low[1] : high[1]].any()
            low[across] -= 1
            high[across] += 1
            beside = inside[low[0] : high[0], low[1] : high[1]]
            assert beside.any(axis=across).all()


def test_clear_paths_refuse_what_blocks_a_door():
    house = plan_block_house((1,), 5, 1, 4.0)
    ways, room = ClearPaths(house), house.rooms[1]
    x, y = ways.ends[1][0]
    before = {(x + dx, y + dy) for dx in range(ways.body) for dy in range(ways.body)}
    assert all(room.floor(house.size)[column] for column in before)
    for column in before:
        assert not ways.stay(room, np.array([column]))
    everything = np.argwhere(room.floor(house.size))
    assert not ways.stay(room, everything)
    assert ways.stay(room, np.zeros((0, 2), int))
    corner = [
        (x, y)
        for x in (room.low[0], room.high[0] - 1)
        for y in (room.low[1], room.high[1] - 1)
        if (x, y) not in before
    ]
    assert ways.stay(room, np.array(corner[:1]))


def test_clear_paths_refuse_what_divides_a_room():
    house = plan_block_house((1,), 5, 1, 4.0)
    ways, room = ClearPaths(house), house.rooms[0]  # The hall, with doors on all of its length.
    middle = (room.low[0] + room.high[0]) // 2
    across = np.array([(middle, y) for y in range(room.low[1], room.high[1])])
    assert not ways.stay(room, across)
    assert ways.stay(room, across[:1])
    ways.take(room, across[:1])
    assert not ways.free(room)[tuple(across[0])]


@pytest.mark.parametrize("scale", [2.0, 2.5, 3.0, 4.0, 25 / 6, 4.5, 5.0, 5.9])
def test_a_person_is_as_wide_as_the_walk_graph_requires(scale):
    wide, high = person_size_blocks(scale)
    free = []
    for width in range(1, wide + 2):  # A passage between walls, as high as a person.
        states = np.ones((8, high + 2, width + 2), np.uint16)
        states[:, 1 : high + 1, 1:-1] = 0
        palette = ("minecraft:air", "minecraft:stone")
        nothing = np.zeros(states.shape, np.uint8)
        volume = BlockVolume(
            states, palette, nothing, nothing.astype(np.uint16), (0, 0, 0),
            np.diag([1 / scale, 1 / scale, 1 / scale, 1.0])[[0, 2, 1, 3]] * [[1], [-1], [1], [1]],
        )  # fmt: skip
        free.append(bool((walk_graph(volume).feet[:, 1] < high).any()))
    assert free == [width >= wide for width in range(1, wide + 2)]


@pytest.mark.parametrize("scale", [4.0, 25 / 6])
@pytest.mark.parametrize("seed", range(6))
def test_stairs_leave_room_for_a_person(seed, scale):
    house = plan_block_house((seed, 2), 8, 2, scale)
    flight, (wide, _) = house.flight, person_size_blocks(scale)
    assert flight is not None
    upper = next(room for room in house.rooms if room.storey == 1)
    bay, corridor_end = upper.blocked[0][:2]
    assert flight.x1 - flight.x0 >= wide
    assert bay - flight.x1 > wide  # A rail, and the way beside it.
    assert flight.hole > corridor_end  # The rail before it is not in the corridor.
    assert upper.high[1] - (flight.end - 1) >= wide
    assert {low for low, _ in rails(house)} == {
        (flight.x0, flight.hole - 1), (flight.x1, flight.hole),
    }  # fmt: skip


def test_every_ware_is_of_blocks_and_named_once():
    names = [ware.name for ware in load_wares()]
    assert len(set(names)) == len(names) > 900
    for ware in load_wares():
        assert ware.mount in MOUNTS
        for state in ware.turned("west"):
            complete(parse_state(state))
    skipped = {name for group in mount_table()["skipped"].values() for name in group}
    known = {block.removeprefix("minecraft:") for block in known_blocks()}
    assert skipped | set(names) == known


def test_a_deck_deals_all_before_it_begins_again():
    deck, other = WareDeck(3, 10), WareDeck(3, 10)
    for mount in (*MOUNTS, HOME):
        first = deck.deal(mount)
        dealt = [first]
        while (ware := deck.deal(mount)) != first:
            dealt.append(ware)
        assert len({one.name for one in dealt}) == len(dealt)
        assert other.deal(mount) == first
    assert {one.name for one in load_wares() if one.mount == "water"} >= {"kelp", "fire_coral"}


def test_styles_are_of_blocks_and_of_materials_of_the_library():
    for style in styles().values():
        lists = (style.walls, style.wet_walls, style.ceilings, style.skirtings, style.facades)
        for state in [*itertools.chain(*lists, *style.floors, *style.wet_floors)]:
            is_block(state)
        for state in (
            *style.plinths,
            *itertools.chain(*((f"{n}_slab", full_block(n)) for n in style.roofs)),
        ):
            is_block(state)
        assert set(style.cloths) <= set(kinds()["cloth"].blocks)
        assert set(style.stones) <= set(kinds()["stone"].blocks)
        for wood in style.woods:
            is_block(f"{wood}_stairs")
            is_block(f"{wood}_trapdoor")
            is_block(f"{wood}_slab")
            look = replace(
                draw_look(style, "living", style.woods[0], np.random.default_rng(0)), wood=wood
            )
            is_block(look.frame.removeprefix("minecraft:"))
        assert all(0 <= hour < 24 for hour in style.hours)
        look = draw_look(style, "living", style.woods[0], np.random.default_rng(0))
        assert look.wall in look.accents


def test_racks_pillars_and_rims_are_blocks():
    for board in BOARDS:
        is_block(f"{board}_slab")
    for state in (*PILLARS, *RIMS):
        is_block(state)
    assert len(BLOCK_RECIPES) == 10


def test_things_of_layouts_have_designs_of_the_library():
    from world2minecraft.furniture import TEMPLATES

    assert set(itertools.chain(*DESIGNS.values())) <= set(TEMPLATES.names())


def test_homes_have_one_wood_and_calm_walls():
    for style in styles().values():
        for seed in range(8):
            rng = np.random.default_rng(seed)
            wood = style.woods[seed % len(style.woods)]
            look = draw_look(style, ("living", "bathroom")[seed % 2], wood, rng)
            assert look.wood == wood != look.second_wood
            assert look.second_cloth in NEUTRALS
            bold = {state for state in look.accents if state != look.wall}
            assert len(bold) <= 1
            for state in bold:
                name = state.removeprefix("minecraft:")
                assert colour_of(name) == look.cloth or wood in name


@pytest.mark.parametrize("scale", [2.0, 25 / 6, 5.9])
def test_roofs_fit_below_the_top_of_the_canvas(scale):
    looks = [style for style in styles().values()][:4]
    for seed, style in enumerate(looks):
        rng = np.random.default_rng(seed)
        house = plan_block_house((seed,), 8, 1 + seed % 2, scale)
        look = draw_look(style, "hall", style.woods[0], rng)
        for pitch, form in itertools.product((1.0, 1.5), ("gable", "hip")):
            exterior = replace(draw_exterior(style, look, rng), pitch=pitch, form=form)
            canvas = WorldCanvas(house, garden_blocks(scale), roof_layers(house, exterior))
            put_facade(canvas, house, exterior)
            put_roof(canvas, house, exterior)
            filled = np.asarray(canvas.states.any(axis=(0, 1)))
            assert filled[: canvas.at(0, 0, house.grounds[-1] + house.height)[2]].sum() > 3
            assert not filled[-1]
