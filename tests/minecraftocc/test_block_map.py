"""Block maps: what names mean, where blocks stand, and what a user is told of a bad file."""

import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from house_of_blocks import PLANKS, STAIR, Blocks, cottage

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import InputError, LimitError, UnknownNameError, UsageError
from world2minecraft.core.types import Entity
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraftocc.block_map import (
    block_map_json,
    class_of_fine,
    classify,
    load_block_map,
    parse_block_map,
    read_block_map,
    remap_labels,
)
from world2minecraft.minecraftocc.block_map.block_conditions import (
    CONDITIONS,
    MEASURES,
    block_columns,
    connected_parts,
)
from world2minecraft.minecraftocc.block_map.room_detection import NO_BLOCK, next_above
from world2minecraft.minecraftocc.block_map.rules import Rule
from world2minecraft.minecraftocc.types import FineClass

NYU, PAPER = load_block_map("nyu"), load_block_map("paper")
# Table "Semantic Class Mapping" of the paper's appendix; "..." stands for any end of a name.
PAPERS_EXAMPLES = {
    "empty": ["tmeo_ultra:chuanglian...", "tmeo_ultra:diaodeng..."],
    "ceiling": ["tmeo_ultra:shigaoxian...", "minecraft:birch_planks"],
    "floor": ["tmeo_ultra:yitishilouti...", "minecraft:stone_brick_slab"],
    "wall": ["tmeov:diantimen"],
    "window": ["tmeov:baiyechuang"],
    "chair": ["tmeo_ultra:changdeng_1x_3", "tmeo_ultra:bataiyizi"],
    "bed": ["tmeo_ultra:dachuangban..."],
    "sofa": ["tmeo_ultra:shafa_1x_2"],
    "table": ["tmeo_ultra:canzhuoyuanxing"],
    "tvs": ["tmeo_ultra:diaoguadianshi"],
    "furn": ["tmeo_ultra:yigui...", "tmeov:shujia..."],
    "objs": ["tmeov:penzai", "tmeo_ultra:yinxiang..."],
}
ENDS = ("", "_1x_2", "_baisezuo", "kai")


@pytest.mark.parametrize(
    ("name", "block"), [(n, b) for n, blocks in PAPERS_EXAMPLES.items() for b in blocks]
)
def test_the_papers_examples_are_of_its_classes(name, block):
    ends = ENDS if block.endswith("...") else ("",)
    for end in ends:
        assert PAPER.classes_of(block.removesuffix("...") + end) == (name,)


@pytest.mark.parametrize(
    ("block", "nyu", "paper"),
    [
        ("tmeo_ultra:chuanglian_hong", "objs", "empty"),
        ("mcwfurnitures:oak_chandelier", "objs", "empty"),
        ("tmeov:baiyechuang", "objs", "window"),
        ("mcwwindows:oak_blinds", "objs", "window"),
        ("minecraft:oak_door", "objs", "wall"),
        ("tmeo_ultra:woshimenjijian_2baisezuo", "objs", "wall"),
        ("refurbished_furniture:oak_kitchen_sink", "furn", "furn"),
        ("minecraft:water_cauldron", "furn", "furn"),
        ("handcrafted:oak_nightstand", "furn", "furn"),
        ("another_furniture:oak_bench", "chair", "chair"),
        ("refurbished_furniture:red_sofa", "sofa", "sofa"),
        ("pfm:oak_classic_chair", "chair", "chair"),
        ("minecraft:bookshelf", "furn", "furn"),
        ("minecraft:red_bed", "bed", "bed"),
        ("minecraft:barrier", "empty", "empty"),
        ("minecraft:light", "empty", "empty"),
    ],
)
def test_names_decide_classes(block, nyu, paper):
    assert NYU.classes_of(block) == (nyu,)
    assert PAPER.classes_of(block) == (paper,)


def test_properties_and_full_shapes_decide_kinds():
    assert NYU.meaning("minecraft:white_concrete") == "surface"
    assert NYU.meaning("mod:strange_thing") == NYU.meaning("minecraft:bricks") == "surface"
    assert NYU.meaning("minecraft:oak_slab[type=bottom,waterlogged=false]") == "slab"
    assert NYU.meaning("minecraft:black_stained_glass_pane[east=true]") == NYU.meaning(
        "black_stained_glass_pane"
    )


@pytest.mark.parametrize("rules", [NYU, PAPER], ids=["nyu", "paper"])
def test_every_block_of_the_game_has_a_class(rules):
    for block in known_blocks():
        assert set(rules.classes_of(block)) <= set(CLASS_NAMES)


def test_planks_are_floor_ceiling_and_wall_by_where_they_are():
    made = classify(cottage().volume(), NYU)
    told = made.semantic
    assert set(np.unique(told[2:10, 1, 2:8])) == {2}
    assert set(np.unique(told[2:10, 5, 2:8])) == {1}
    walls = cottage().states[:, 2:5] == 1
    walls[2:10, :, 2:8] = False
    assert set(np.unique(told[:, 2:5][walls])) == {3}
    assert set(np.unique(told[4:6, 3, 1])) == {4}


def test_furniture_of_players_is_known():
    told = classify(cottage().volume(), NYU).semantic
    names = {
        "chair": [(2, 2, 2)],
        "sofa": [(2, 2, 5), (2, 2, 6)],
        "table": [(5, 2, 4), (5, 3, 4)],
        "bed": [(8, 2, 3), (9, 2, 3)],
        "furn": [(9, 2, 6), (9, 3, 6), (4, 2, 2)],
        "objs": [(3, 2, 7), (9, 4, 2), (8, 2, 8), (8, 3, 8)],
    }
    for name, places in names.items():
        assert [CLASS_NAMES[told[place]] for place in places] == [name] * len(places)


def test_air_is_empty_and_objects_are_numbered():
    volume = cottage().volume()
    made = classify(volume, NYU)
    assert (made.semantic[volume.states == 0] == 0).all()
    assert ((made.instance > 0) == (made.semantic > 4)).all()
    assert made.instance[2, 2, 5] == made.instance[2, 2, 6] != made.instance[2, 2, 2]


@pytest.mark.parametrize("axes", [(2, 1, 0), (0, 1, 2)])
@pytest.mark.parametrize("flip", [1, -1])
def test_turning_a_build_turns_its_classes(axes, flip):
    made = cottage()
    told = classify(made.volume(), NYU).semantic
    made.states = np.ascontiguousarray(made.states.transpose(axes)[::flip])
    turned = classify(made.volume(), NYU).semantic
    np.testing.assert_array_equal(turned, told.transpose(axes)[::flip])


def test_a_build_without_a_roof_has_floors_and_walls():
    made = cottage()
    made.states[:, 5] = 0
    told = classify(made.volume(), NYU).semantic
    assert (told[2:10, 1, 2:8] == 2).mean() > 0.9
    assert (told[1, 2:5, 2:8] == 3).all()


def test_two_storeys_have_a_ceiling_and_a_floor_each():
    made = Blocks(12, 12, 10)
    made.put(np.s_[1:11, 1:11, 1:9], PLANKS)
    made.states[2:10, 2:5, 2:8] = 0
    made.states[2:10, 7:10, 2:8] = 0
    told = classify(made.volume(), NYU).semantic
    assert [int(told[5, y, 5]) for y in (1, 5, 6, 10)] == [2, 1, 2, 1]
    made.put(np.s_[1:11, 1:11, 1:9], PLANKS)
    made.states[2:10, 2:5, 2:8] = 0
    made.states[2:10, 6:9, 2:8] = 0
    assert classify(made.volume(), NYU).semantic[5, 5, 5] == 2  # One walks on a thin slab.


def test_the_papers_map_finds_rooms_behind_glass():
    told = classify(cottage().volume(), PAPER).semantic
    assert (told[2:10, 1, 2:8] == 2).all() and (told[2:10, 5, 2:8] == 1).all()
    assert not told[4:6, 3, 1].any() and told[8, 2, 8] == 3
    assert told[2, 2, 2] == 2  # A stair is floor, as the table has it.


def test_a_terrace_is_floor_and_a_garden_wall_is_wall():
    made = Blocks(24, 8, 10)
    made.states[:12], made.palette = cottage().states, cottage().palette
    made.put(np.s_[12:23, 1, 1:9], "minecraft:polished_andesite")
    made.put(np.s_[22, 2:4, 1:9], "minecraft:stone_bricks")
    told = classify(made.volume(), NYU).semantic
    assert (told[13:21, 1, 2:8] == 2).all()
    assert (told[22, 3, 1:9] == 3).all()


def test_hanging_blocks_are_no_seats():
    made = cottage()
    made.put((5, 4, 6), STAIR)
    assert CLASS_NAMES[classify(made.volume(), NYU).semantic[5, 4, 6]] == "objs"


@pytest.mark.parametrize(
    ("blocks", "name"),
    [
        ([(np.s_[0:8, 0, 0:4], "oak_slab"), (np.s_[0:8, 1, 0:4], "red_wool")], "bed"),
        ([(np.s_[0:3, 0:2, 0:8], "gray_wool"), (np.s_[3, 0:4, 0:8], "gray_wool")], "sofa"),
        ([(np.s_[0:3, 0:2, 0:3], "cyan_wool"), (np.s_[2, 2:4, 0:3], "cyan_wool")], "chair"),
        ([(np.s_[0:6:5, 0:2, 0:4:3], "oak_fence"), (np.s_[0:6, 2, 0:4], "oak_slab")], "table"),
        ([(np.s_[0, 2:5, 0:4], "black_concrete")], "tvs"),
        ([(np.s_[0:3, :8, 0:2], "oak_planks"), (np.s_[0:3, :8, 2:4], "spruce_planks")], "furn"),
        ([(np.s_[0, 0:9, 0:4], "red_wool")], "objs"),
    ],
)  # fmt: skip
def test_furniture_of_blocks_is_classified_by_its_measures(blocks, name):
    """At four blocks a metre, in a room of 5 x 4.5 x 2.5 m; placed at its wall x = 0."""
    made = Blocks(24, 14, 22)
    made.put(np.s_[1:23, 1:13, 1:21], "minecraft:white_concrete")
    made.states[2:22, 2:12, 2:20] = 0
    before = made.states.copy()
    for place, state in blocks:
        inner = made.states[2:22, 2:12, 4:20]
        made.palette.append(f"minecraft:{state}")
        inner[place] = len(made.palette) - 1
    told = classify(made.volume(4.0), NYU).semantic
    at = made.states != before
    assert {CLASS_NAMES[n] for n in told[at]} == {name}


@pytest.mark.parametrize(
    ("condition", "place", "holds"),
    [
        ("floor", (5, 1, 5), True),
        ("ceiling", (5, 5, 5), True),
        ("wall", (1, 3, 5), True),
        ("inside", (5, 3, 6), True),
        ("outside", (5, 6, 5), True),
        ("outside", (5, 3, 6), False),
        ("over_ceiling", (5, 6, 5), True),
        ("over_ceiling", (5, 3, 6), False),
        ("under_floor", (5, 0, 5), True),
        ("wall_line", (1, 5, 5), True),
        ("wall_line", (5, 5, 5), False),
        ("open_floor", (5, 1, 5), False),
        ("air_above", (5, 3, 6), True),
        ("air_above", (5, 4, 6), False),
        ("air_below", (5, 3, 6), True),
        ("air_below", (5, 2, 6), False),
        ("on_floor", (5, 2, 6), True),
        ("on_floor", (5, 3, 6), False),
        ("at_wall", (2, 3, 4), True),
        ("at_wall", (5, 3, 6), False),
        ("under_ceiling", (5, 4, 6), True),
        ("under_ceiling", (5, 3, 6), False),
        ("coarse", (5, 3, 6), True),
        ("over fence", (5, 3, 4), True),
        ("over fence", (5, 3, 6), False),
        ("under chest", (5, 3, 6), False),
    ],
)
def test_conditions_hold_where_they_say(condition, place, holds):
    """A gold block put somewhere into the cottage is a screen where the condition holds."""
    rules = {"probe": [{"class": "tvs", "where": [condition]}, "objs"]}
    probe = {"name": "m", "extends": "nyu", "kinds": {"probe": ["gold_block"]}, "rules": rules}
    mine = parse_block_map(probe | {"structure": ["probe"]})
    made = cottage()
    made.put(place, "minecraft:gold_block")
    told = CLASS_NAMES[classify(made.volume(), mine).semantic[place]]
    assert told == ("tvs" if holds else "objs")


def test_blocks_beside_their_like_are_in_a_row_and_steps_climb():
    rules = {"step": [{"class": "tvs", "where": ["climbs"]}, {"class": "bed", "where": ["in_row"]},
                      "objs"]}  # fmt: skip
    own = {"name": "m", "extends": "nyu", "kinds": {"step": ["gold_block"]}, "rules": rules}
    made = cottage()
    for place in ((3, 2, 4), (4, 3, 4), (6, 2, 6), (7, 2, 6), (4, 2, 7)):
        made.put(place, "minecraft:gold_block")
    told = classify(made.volume(), parse_block_map(own)).semantic
    places = ((3, 2, 4), (4, 3, 4), (6, 2, 6), (7, 2, 6), (4, 2, 7))
    names = [CLASS_NAMES[told[place]] for place in places]
    assert names == ["tvs", "tvs", "bed", "bed", "objs"]


def test_entities_get_classes_too():
    volume = cottage().volume()
    picture = Entity((3.0, 63.0, 2.0), "minecraft:painting")
    made = classify(type(volume)(**{**volume.__dict__, "entities": (picture,)}), NYU)
    assert CLASS_NAMES[made.entities[0].class_id] == "objs"


def test_an_empty_volume_stays_empty():
    assert not classify(Blocks(3, 3, 3).volume(), NYU).semantic.any()


def test_next_above_matches_a_loop():
    filled = np.random.default_rng(3).random((4, 9, 5)) < 0.3
    found = next_above(filled)
    for x, y, z in np.ndindex(filled.shape):
        over = [h for h in range(y + 1, 9) if filled[x, h, z]]
        assert found[x, y, z] == (over[0] if over else NO_BLOCK)


def test_block_columns_match_a_loop():
    blocks = np.random.default_rng(4).integers(0, 2, (3, 8, 4))
    found, first = block_columns(blocks)
    for x, y, z in np.ndindex(blocks.shape):
        low = high = y
        while low > 0 and blocks[x, low - 1, z] == blocks[x, y, z]:
            low -= 1
        while high < 7 and blocks[x, high + 1, z] == blocks[x, y, z]:
            high += 1
        assert (found[x, y, z], first[x, y, z]) == (high - low + 1, low)


def test_connected_parts_match_a_graph_walk():
    rng = np.random.default_rng(5)
    held, blocks = rng.random((5, 4, 5)) < 0.6, rng.integers(0, 2, (5, 4, 5))
    alone = rng.random(held.shape) < 0.2
    parts, count = connected_parts(held, blocks, alone)
    assert ((parts > 0) == held).all() and parts.max() == count
    for place in zip(*np.nonzero(held), strict=True):
        seen, queue = {place}, [place]
        while queue:
            here = queue.pop()
            for axis, step in ((a, s) for a in range(3) for s in (1, -1)):
                there = tuple(v + step * (a == axis) for a, v in enumerate(here))
                if any(v < 0 or v >= n for v, n in zip(there, held.shape, strict=True)):
                    continue
                same = blocks[here] == blocks[there]
                same |= axis == 1 and not (alone[here] or alone[there])
                if held[there] and same and there not in seen:
                    seen.add(there)
                    queue.append(there)
        assert seen == set(zip(*np.nonzero(parts == parts[place]), strict=True))


# Our own fine classes.

FINE = (
    FineClass("minecraft:air"),
    FineClass("minecraft:red_banner", "curtain_single"),
    FineClass("minecraft:oak_stairs", "chair_cafe"),
    FineClass("minecraft:oak_stairs"),
    FineClass("minecraft:oak_door"),
    FineClass("minecraft:birch_planks"),
    FineClass("minecraft:water_cauldron", "sink_unit"),
)


def test_the_papers_map_applies_to_our_own_fine_classes():
    told = [class_of_fine(one, PAPER) for one in FINE[1:]]
    assert told == [0, None, 2, 3, None, 10]


def test_remapping_changes_only_what_the_map_decides():
    labels = np.array([[0, 11, 5, 11], [11, 2, 10, 255]], np.uint8)
    fine = np.array([[0, 1, 2, 3], [4, 5, 6, 0]], np.uint16)
    found = remap_labels(labels, fine, FINE, PAPER)
    assert found.tolist() == [[0, 0, 5, 2], [3, 2, 10, 255]]
    assert remap_labels(labels[:0], fine[:0], FINE, PAPER).shape == (0, 4)


def test_remapping_by_nyu_keeps_what_is_by_nyu():
    labels = np.array([0, 11, 5, 11, 11, 2, 10], np.uint8)
    assert (
        remap_labels(labels, np.arange(7, dtype=np.uint16), FINE, NYU).tolist() == labels.tolist()
    )


def test_remapping_refuses_what_does_not_fit():
    with pytest.raises(UsageError, match="the same shape"):
        remap_labels(np.zeros(3, np.uint8), np.zeros(2, np.uint16), FINE, PAPER)
    with pytest.raises(UsageError, match="indices below 7, the number of classes; got 9"):
        remap_labels(np.zeros(1, np.uint8), np.full(1, 9, np.uint16), FINE, PAPER)


# Files.

MINE = """
name: mine
extends: nyu
blocks: {gold_block: table}
words: [{namespaces: [tmeo], words: {yigui: sofa}}]
kinds: {warm: ["red_*"]}
rules: {warm: [{class: floor, where: [floor]}, thing]}
"""


def test_a_map_overrides_the_map_it_extends(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(MINE)
    mine = load_block_map(path)
    assert mine.classes_of("gold_block") == ("table",)
    assert mine.classes_of("tmeo_ultra:yigui_1x_2") == ("sofa",)
    assert mine.classes_of("tmeo_ultra:chuanglian") == ("objs",)
    assert mine.meaning("red_wool") == "warm" and mine.meaning("blue_wool") == "cloth"
    assert mine.rules["warm"] == (Rule("floor", ("floor",)), *mine.rules["thing"])


def test_json_holds_every_block_and_rule(tmp_path):
    tree = json.loads(json.dumps(block_map_json(PAPER)))
    assert set(known_blocks()) <= set(tree["blocks"])
    assert tree["kinds"][tree["blocks"]["minecraft:birch_planks"]] == [{"class": "ceiling"}]
    known = {*CLASS_NAMES, *tree["kinds"]}
    assert set(tree["blocks"].values()) <= known


BAD = {
    "[]": "a block map must be a mapping with text keys, got []",
    "a: 1": "a block map contains the unknown key 'a'; known keys: name, about, extends, blocks, "
    "words, kinds, whole, other, structure, apart, sheets, plates, rules, designs, unless_known, "
    "entities",
    "about: x": "the block map has no name; add a line such as name: mine",
    "{name: m, extends: lyu}": "extends must be one of nyu, paper, got 'lyu'",
    "{name: m, extends: [nyu]}": "extends must be one of nyu, paper, got ['nyu']",
    "{name: m, blocks: {stone: rock}}": "block stone must be one of empty, ceiling, "
    "floor, wall, window, chair, bed, sofa, table, tvs, furn, objs; got 'rock'",
    "{name: m, kinds: {k: [a]}}": "kind k has no rules; add an entry for k under rules",
    "{name: m, rules: {k: [wall]}}": "rules has an entry for the unknown kind k; known kinds: ",
    "{name: m, rules: {wall: [wall]}}": "rules has an entry for wall, which is the "
    "name of a class; rename the kind",
    "{name: m, kinds: {k: [a]}, rules: {k: [{class: wall, where: [floor]}]}}": "the last rule of "
    "k must be unconditional: give only a class, without where",
    "{name: m, kinds: {k: [a]}, rules: {k: [k]}}": "the rules of k include the rules of k "
    "twice; remove one of the references",
    "{name: m, kinds: {k: [a]}, rules: {k: [{class: wall, top_m: 3}, wall]}}": "top_m of k must "
    "be a minimum and a maximum, such as [0.3, 0.6], got 3",
    "{name: m, extends: nyu, kinds: {k: [a]}, rules: {k: [{class: wall, where: [up]}, wall]}}":
    "where of k must be one of floor, ceiling, wall, inside, outside, under_floor, "
    "wall_line, over_ceiling, open_floor, air_above, air_below, on_floor, at_wall, "
    "under_ceiling, turned, coarse, in_row, climbs; got 'up'",
    "{name: m, words: [{words: {a: wall}}]}":
    "words must have namespaces, such as namespaces: [my_mod]",
    "{name: m, kinds: {k: a}}": "kind k must be a list with at most 8192 items, got 'a'",
}  # fmt: skip


@pytest.mark.parametrize(("text", "told"), BAD.items(), ids=range(len(BAD)))
def test_a_bad_map_is_reported_in_one_line(tmp_path, text, told):
    path = tmp_path / "bad.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_block_map(path)
    assert str(caught.value) == f"{path}: {told}"


def test_invalid_large_or_aliased_yaml_is_refused(tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text("a: [1\n")
    with pytest.raises(InputError, match="not valid YAML"):
        read_block_map(path)
    path.write_text("name: &n m\nabout: *n\n")
    with pytest.raises(
        InputError, match=r"not valid YAML \(aliases \(\*name\) are not supported\)"
    ):
        read_block_map(path)
    path.write_text("name: !!python/object:os.system x")
    with pytest.raises(InputError, match="not valid YAML"):
        read_block_map(path)
    path.write_text("[" * 5000)
    with pytest.raises(InputError, match="not valid YAML"):
        read_block_map(path)
    path.write_text("#" * (300 << 10))
    with pytest.raises(LimitError):
        read_block_map(path)
    with pytest.raises(UnknownNameError, match="did you mean 'paper'"):
        load_block_map("papers")
    with pytest.raises(InputError):
        load_block_map(tmp_path / "none.yaml")


DOCS = Path(__file__).resolve().parents[2] / "docs" / "reference" / "block-maps.md"


@pytest.mark.skipif(not DOCS.is_file(), reason="the docs are not in this checkout")
def test_the_docs_list_all_conditions_and_their_example_is_a_map():
    text = DOCS.read_text()
    for name, what in (CONDITIONS | MEASURES).items():
        assert f"| `{name}` | {what} |" in text
    example = text.partition("```yaml\n")[2].partition("```")[0]
    mine = parse_block_map(yaml.safe_load(example))
    assert mine.classes_of("gold_block") == ("table",)
    assert mine.meaning("red_sandstone") == "loud"


def test_glowing_blocks_are_floors_and_lamps():
    made = cottage()
    made.put(np.s_[2:10, 1, 2:8], "minecraft:sea_lantern")
    made.put((5, 5, 5), "minecraft:sea_lantern")
    told = classify(made.volume(), NYU).semantic
    assert (told[2:10, 1, 2:8] == 2).all() and CLASS_NAMES[told[5, 5, 5]] == "objs"


def test_a_tree_without_extends_needs_nothing_else():
    assert parse_block_map({"name": "m"}).classes_of("minecraft:stone") == ("wall",)
