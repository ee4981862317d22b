"""Style display: exact in the object's own frame, few entities, colliders under them."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from build_samples import CHAIR, OBJS, RED, TABLE, WOOD, Sketch

from world2minecraft.construction import BuildParameters, build_volume, find_spawn, write_build
from world2minecraft.construction.canvas import BARRIER
from world2minecraft.construction.display.boxes import (
    DisplayBox,
    Frame,
    boxes_in_room,
    display_entities,
    template_boxes,
)
from world2minecraft.construction.display.builder import MAX_PIECES, MAX_PIECES_ELSE
from world2minecraft.core.coordinates import apply, block_to_room, invert
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import ObjectInstance, Placement
from world2minecraft.furniture import template
from world2minecraft.minecraft.entities import display_cubes
from world2minecraft.minecraft.worlds.world_writer import read_world
from world2minecraft.rendering import preview

CORNER_M = np.array([-1.0, 3.0])
DISPLAY = BuildParameters(style="display")
BOXY = ("chair", "armchair", "stool", "bench", "dining_table", "desk", "coffee_table", "sofa",
        "corner_sofa", "single_bed", "double_bed")  # fmt: skip
NAMES = (*BOXY, "office_chair", "bunk_bed", "round_table", "bookcase", "wardrobe", "counter",
         "cabinet", "wall_tv", "lamp", "plant")  # fmt: skip


def parts_of(name: str, share: float = 0.0):
    """A template's parts at its usual size, or nearer to its largest."""
    found = template(name)
    size = np.array([s.typical + share * (s.maximum - s.typical) for s in found.size_m])
    return found.parts(size), size


def placed(name: str, yaw_deg: float, share: float = 0.0, most: int = 1000):
    """The entities of a template that stands turned, its parts and its frame."""
    parts, size = parts_of(name, share)
    frame = Frame(np.array([1.3, 0.7, 0.1]), size, yaw_deg)
    pieces = template_boxes(parts, ["minecraft:stone"] * len(parts), most, 4.0)
    return display_entities(pieces, frame, CORNER_M, 4.0, 5, 3), parts, frame


def sampled(parts, entities, frame) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """At the middles of 2 cm cells around an object: which lie in its parts, which in entities.

    The first are those that lie a millimetre inside a part, the last those that do so nearly.
    """
    boxes = np.array([part.box_m for part in parts]).reshape(-1, 2, 3)
    low, high = boxes[:, 0].min(axis=0) - 0.04, boxes[:, 1].max(axis=0) + 0.04
    axes = [np.arange(a, b, 0.02) + 0.01 for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    inside, nearly = np.zeros((2, len(points)), bool)
    for start, end in boxes:
        inside |= ((points > start + 0.001) & (points < end - 0.001)).all(axis=1)
        nearly |= ((points > start - 0.001) & (points < end + 0.001)).all(axis=1)
    to_block = invert(block_to_room(CORNER_M, 4.0))
    world = apply(to_block, apply(frame.object_to_room, points))
    in_entities = np.zeros(len(points), bool)
    for cube in display_cubes(entities):
        local = apply(invert(cube.cube_to_world), world)
        in_entities |= ((local > -1e-5) & (local < 1 + 1e-5)).all(axis=1)
    return inside, in_entities, nearly


@pytest.mark.parametrize("name", NAMES)
def test_a_template_is_exact_at_2_cm_in_its_own_frame(name):
    entities, parts, frame = placed(name, 0.0)
    inside, in_entities, nearly = sampled(parts, entities, frame)
    assert not (inside & ~in_entities).any()
    assert not (in_entities & ~nearly).any()
    assert inside.any()


@pytest.mark.parametrize("yaw_deg", [90.0, 180.0, 20.0, -33.5])
@pytest.mark.parametrize("name", ["chair", "round_table", "corner_sofa"])
def test_it_stays_exact_when_it_is_turned(name, yaw_deg):
    entities, parts, frame = placed(name, yaw_deg)
    inside, in_entities, nearly = sampled(parts, entities, frame)
    assert not (inside & ~in_entities).any()
    assert not (in_entities & ~nearly).any()


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_furniture_takes_few_entities(share):
    counts = {name: len(placed(name, 20.0, share)[0]) for name in NAMES}
    assert all(counts[name] <= 8 for name in BOXY)
    assert counts["round_table"] <= 24
    assert counts["bookcase"] <= 15


def test_the_smaller_part_shows_where_two_overlap():
    big, small = (
        DisplayBox(np.array([0, 0, 0, 1, 1, 1.0]), "a"),
        DisplayBox(np.array([0, 0, 0, 1, 1, 0.2]), "b"),
    )
    parts = [part for part in template("box").parts(np.ones(3))] * 2
    parts = [parts[0]._replace(box_m=one.box_m) for one in (big, small)]
    pieces = template_boxes(parts, ["a", "b"], 8, 4.0)
    assert sorted((one.state, one.box_m.tolist()) for one in pieces) == [
        ("a", [0, 0, 0.2, 1, 1, 1]),
        ("b", [0, 0, 0, 1, 1, 0.2]),
    ]


def test_too_many_boxes_are_made_fewer_and_stay_nearly_the_shape():
    across = np.indices((20, 20)) - 9.5
    disc = np.argwhere((across**2).sum(axis=0) <= 100) * 0.02
    sample = template("box").parts(np.ones(3))[0]
    parts = [sample._replace(box_m=np.array([x, y, 0.0, x + 0.02, y + 0.02, 0.4])) for x, y in disc]
    fine = template_boxes(parts, ["a"] * len(parts), 100, 4.0)
    few = template_boxes(parts, ["a"] * len(parts), 4, 4.0)
    assert len(few) < len(fine)
    area = sum(np.prod(one.box_m[3:5] - one.box_m[:2]) for one in few)
    assert area == pytest.approx(len(disc) * 0.0004, rel=0.12)


def furnished() -> tuple[Sketch, list[Placement], list[ObjectInstance]]:
    """A table with two chairs, one of them askew, a red box of cells, and a cup on the table."""
    sketch = Sketch(size=(50, 40, 30))
    sketch.put((20, 35), (15, 25), (8, 9), TABLE, WOOD, 1)
    for number, x in ((2, 12), (3, 38)):
        sketch.put((x, x + 6), (17, 23), (5, 6), CHAIR, RED, number)
        sketch.put((x, x + 6), (17, 18), (6, 11), CHAIR, RED, number)
    sketch.put((0, 5), (30, 38), (0, 6), OBJS, RED, 4)
    sketch.put((26, 28), (19, 21), (9, 11), OBJS, RED, 5)
    placements = [
        Placement(1, TABLE, "dining_table", [2.2, 1.6, 0.36], [0.8, 1.2, 0.72], 1, 0.7),
        Placement(2, CHAIR, "chair", [1.2, 1.6, 0.44], [0.48, 0.48, 0.88], 1, 0.6),
        Placement(3, CHAIR, "chair", [3.28, 1.6, 0.44], [0.48, 0.48, 0.88], 1, 0.6),
        Placement(4, OBJS, "cells", [0.2, 2.72, 0.24], [0.4, 0.64, 0.48], 0, 0.1),
        Placement(5, OBJS, "cells", [2.16, 1.6, 0.8], [0.16, 0.16, 0.16], 0, 0.1),
    ]
    grid = sketch.grid()
    instances = [
        ObjectInstance(
            one.object_id, one.class_id, one.center_m, one.size_m,
            (110.0 if one.object_id == 3 else 90.0 * one.quarter_turns),
            np.argwhere(grid.instance == one.object_id).astype(np.int32), 0.9,
        )
        for one in placements
    ]  # fmt: skip
    return sketch, placements, instances


def built(blocks_per_metre: float = 4.0, parameters: BuildParameters = DISPLAY):
    sketch, placements, instances = furnished()
    return build_volume(
        sketch.grid(), placements, instances, corner_m=sketch.corner_m,
        blocks_per_metre=blocks_per_metre, parameters=parameters,
    )  # fmt: skip


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0])
def test_a_room_is_built_of_few_entities_at_any_scale(scale):
    volume = built(scale)
    counts = Counter(one.instance for one in volume.entities)
    assert {number: counts[number] for number in (1, 2, 3)} == {1: 5, 2: 6, 3: 6}
    assert counts[4] == counts[5] == 1
    assert all(one.class_id for one in volume.entities)
    assert find_spawn(volume).position[1] == 64.0


def test_every_object_has_its_colliders_and_nobody_sees_them():
    volume = built()
    names = np.array(volume.palette)[volume.states]
    for number in (1, 2, 3, 4):
        mine = volume.instance == number
        assert (names[mine] == BARRIER).any()
        unseen = [name.startswith(("minecraft:barrier", "minecraft:light")) for name in names[mine]]
        assert all(unseen)
    # The red box of 0.4 x 0.64 x 0.48 m at the wall: 2 x 4 x 2 blocks, where it falls badly.
    assert (volume.instance == 4).sum() <= 16
    assert (names[volume.instance == 4] == BARRIER).sum() >= 8


def test_the_room_without_displays_is_that_of_the_other_styles():
    plain, fine = built(parameters=BuildParameters()), built()
    shell = np.isin(plain.semantic, (1, 2, 3, 4))
    names = [np.array(one.palette)[one.states] for one in (plain, fine)]
    assert np.array_equal(names[0][shell], names[1][shell])
    assert not plain.entities


def test_an_askew_chair_keeps_its_yaw_and_equal_ones_are_equal():
    volume = built()
    own = {
        number: [
            one.nbt["transformation"]["left_rotation"]
            for one in volume.entities
            if one.instance == number
        ]
        for number in (2, 3)
    }
    assert all(turn == [0, 0, 0, 1] for turn in own[2])
    half = np.radians(20.0) / 2
    assert all(turn[1] == pytest.approx(np.sin(half), abs=1e-5) for turn in own[3])


def test_what_lies_on_a_table_lies_on_its_top():
    volume = built()
    cups = [cube for cube in display_cubes(volume.entities) if cube.instance == 5]
    tables = [cube for cube in display_cubes(volume.entities) if cube.instance == 1]
    top = max((cube.cube_to_world @ [0, 1, 0, 1])[1] for cube in tables)
    bottom = min(cube.cube_to_world[1, 3] for cube in cups)
    assert bottom == pytest.approx(top, abs=0.01)


@pytest.mark.parametrize("scale", [1.0, 2.0, 3.3, 4.0])
def test_nothing_stands_in_a_wall(scale):
    volume = built(scale)
    solid = np.isin(volume.semantic, (3, 4))
    for cube in display_cubes(volume.entities):
        for share in np.ndindex(3, 3, 3):
            point = cube.cube_to_world @ [*(0.02 + 0.48 * np.array(share)), 1.0]
            cell = np.floor(point[:3] - volume.corner).astype(int)
            assert not solid[tuple(cell)]


def test_building_twice_gives_the_same_bytes(tmp_path):
    for name in ("a", "b"):
        write_build(tmp_path / name, built())
    files = sorted(
        p.relative_to(tmp_path / "a") for p in (tmp_path / "a").rglob("*") if p.is_file()
    )
    assert any("entities" in str(path) for path in files)
    for path in files:
        assert (tmp_path / "a" / path).read_bytes() == (tmp_path / "b" / path).read_bytes()
    back = read_world(tmp_path / "a" / "world")
    assert len(back.entities) == len(built().entities)


def test_the_picture_shows_the_displays():
    volume = built()
    shown, bare = preview(volume, 320, 240), preview(replace(volume, entities=()), 320, 240)
    assert (shown != bare).any(axis=2).mean() > 0.03


def test_the_exact_scale_has_no_displays():
    volume = built(12.5)
    assert not volume.entities


def test_an_old_game_is_refused(tmp_path, monkeypatch):
    from world2minecraft.construction import build_files as outputs
    from world2minecraft.minecraft.versions import GameVersion

    monkeypatch.setattr(outputs, "game_version", lambda name: GameVersion(name, 2975, 9))
    with pytest.raises(UsageError, match=r"use build\.style=blocks"):
        write_build(tmp_path, built(), mc_version="1.18.2")
    assert not list(tmp_path.iterdir())


def test_the_most_pieces_are_those_of_the_docs():
    assert MAX_PIECES_ELSE == 8
    assert MAX_PIECES[10] == 15


def test_boxes_in_the_room_turn_with_their_frame():
    piece = DisplayBox(np.array([0.0, 0.0, 0.0, 1.0, 0.5, 0.25]), "a")
    middles, half = boxes_in_room([piece], Frame(np.zeros(3), np.ones(3), 90.0))
    assert middles[0].tolist() == pytest.approx([-0.25, 0.5, 0.125])
    assert half[0].tolist() == [0.5, 0.25, 0.125]
