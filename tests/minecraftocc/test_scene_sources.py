"""Scenes of every kind of place: their blocks, classes, designs and where they were built."""

import json
import pickle
from dataclasses import replace

import numpy as np
import pytest
from house_of_blocks import Blocks, cottage

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.formats.world_labels import scene_from_volume, write_scene
from world2minecraft.minecraft.file_format import WriteOptions
from world2minecraft.minecraft.formats import write_blocks
from world2minecraft.minecraftocc.scene_sources import (
    find_built_box,
    is_built,
    open_scene_source,
    scene_id_of,
)

SPAWN = (5.5, 62.0, 5.5)


def scene(volume, **more):
    facts = {"mc_version": "1.20.1", "data_version": 3465, "spawn": SPAWN, "spawn_yaw_deg": 90.0}
    return scene_from_volume(volume, **facts, **more)


@pytest.fixture
def house(tmp_path):
    """A generated world: its truth calls the bookshelf a sofa, so that one sees who is asked."""
    volume = cottage().volume(2.0)
    semantic = np.where(volume.states > 0, 3, 0).astype(np.uint8)
    semantic[9, 2:4, 6] = 7
    instance = np.where(semantic == 7, 5, 0).astype(np.uint16)
    volume = replace(volume, semantic=semantic, instance=instance)
    folder = tmp_path / "house_0001"
    write_blocks(volume, folder / "world", WriteOptions(spawn=SPAWN))
    design = np.where(semantic == 7, 2, 0).astype(np.uint16)
    write_scene(folder, scene(volume, design=design, designs=("", "armchair", "sofa")))
    return folder


@pytest.fixture
def foreign(tmp_path):
    """A world of somebody else: the cottage, far from the spawn."""
    folder = tmp_path / "theirs"
    write_blocks(cottage().volume(), folder, WriteOptions(spawn=(500.0, 64.0, 500.0)))
    return folder


def test_a_generated_world_brings_its_truth_scale_and_designs(house):
    source = open_scene_source(house)
    volume = source.volume()
    assert source.scene_id == "house_0001"
    assert source.has_truth()
    assert volume.blocks_per_metre == pytest.approx(2)
    design, names = source.designs()
    assert design.shape == volume.states.shape and design.dtype == np.uint16
    assert names == ("", "armchair", "sofa")
    at = volume.semantic == 7
    assert at.sum() == 2 and (design[at] == 2).all() and not design[~at].any()
    assert {volume.palette[n] for n in volume.states[at]} == {"minecraft:bookshelf"}
    assert (volume.semantic[volume.states > 0] > 0).all()


def test_blocks_that_a_player_adds_are_classified_by_the_map(house):
    volume = open_scene_source(house).volume()
    with_bed = cottage()
    with_bed.put((5, 2, 6), "minecraft:white_bed[facing=east,occupied=false,part=foot]")
    write_blocks(with_bed.volume(), house / "world", WriteOptions(spawn=SPAWN))
    added = open_scene_source(house).volume()
    new = (added.semantic > 0) & (volume.semantic == 0)
    assert [CLASS_NAMES[n] for n in added.semantic[new]] == ["bed"]
    assert added.instance[new] > 5


def test_another_map_maps_the_truth_too(house, tmp_path):
    mine = tmp_path / "mine.yaml"
    mine.write_text('{name: mine, extends: nyu, designs: {"sof*": furn}, kinds: {table: [glass]}}')
    volume = open_scene_source(house, block_map=mine).volume()
    shelf = volume.states == volume.palette.index("minecraft:bookshelf")
    assert set(volume.semantic[shelf]) == {10}
    glass = volume.states == volume.palette.index("minecraft:glass")
    assert set(volume.semantic[glass]) == {8}


def test_a_run_knows_designs_by_its_placements(house, tmp_path):
    run = tmp_path / "run"
    run.mkdir()
    house.rename(run / "build")
    (run / "build" / "designs.json").unlink()
    arrays = dict(np.load(run / "build" / "scene.npz"))
    del arrays["design"]
    np.savez(run / "build" / "scene.npz", **arrays)
    placement = {
        "object_id": 5, "class": "furn", "template": "bookcase", "parameters": {},
        "center_m": [1, 1, 1], "size_m": [1, 1, 1], "quarter_turns": 0, "iou": 0.5,
        "alternatives": [],
    }  # fmt: skip
    (run / "placements.json").write_text(json.dumps([placement]))
    for place in (run, run / "build"):
        source = open_scene_source(place)
        design, names = source.designs()
        assert source.scene_id == "run"
        assert names == ("", "bookcase")
        assert (design > 0).sum() == 2 and (source.volume().semantic[design > 0] == 7).all()


@pytest.mark.parametrize("suffix", [".schem", ".litematic", ".nbt"])
def test_schematics_are_classified_by_the_map(tmp_path, suffix):
    path = tmp_path / f"a house{suffix}"
    write_blocks(cottage().volume(), path)
    source = open_scene_source(path, blocks_per_metre=1)
    volume = source.volume()
    assert source.scene_id == "a_house" and not source.has_truth()
    names = {CLASS_NAMES[n] for n in np.unique(volume.semantic)}
    assert names >= {"floor", "ceiling", "wall", "window", "chair", "sofa", "table", "bed", "furn"}
    assert source.designs()[1] == ("",) and not source.designs()[0].any()
    assert source.volume() is volume


def test_the_scale_of_a_foreign_place_can_be_said(tmp_path):
    path = tmp_path / "a.schem"
    write_blocks(cottage().volume(), path)
    assert open_scene_source(path).volume().blocks_per_metre == pytest.approx(1)
    assert open_scene_source(path, blocks_per_metre=4).volume().blocks_per_metre == pytest.approx(4)


def test_a_foreign_world_is_looked_through_for_what_is_built(foreign):
    source = open_scene_source(foreign)
    volume = source.volume()
    assert volume.states.shape == (10, 5, 8) and volume.corner == (1, 61, 1)
    (note,) = source.notes()
    assert note == (
        "this world has no scene.json; using the detected buildings: --box -2 46 -2 18 82 18"
    )
    assert {CLASS_NAMES[n] for n in np.unique(volume.semantic)} >= {"floor", "wall", "bed"}


def test_a_box_is_taken_as_said(foreign):
    volume = open_scene_source(foreign, box=(1, 61, 1, 5, 66, 9)).volume()
    assert volume.states.shape == (4, 5, 8) and volume.corner == (1, 61, 1)


def test_the_build_near_the_spawn_is_meant_before_a_larger_one(tmp_path):
    made = Blocks(230, 8, 10)
    made.put(np.s_[0:5, 0:5, 0:5], "minecraft:bricks")
    made.put(np.s_[0:5, 1, 0:5], "minecraft:glass")
    made.put(np.s_[0:5, 2, 0:5], "minecraft:white_wool")
    made.put(np.s_[150:220, 0:5, 0:5], "minecraft:bricks")
    made.put(np.s_[150:220, 1, 0:5], "minecraft:glass")
    made.put(np.s_[150:220, 2, 0:5], "minecraft:white_wool")
    for spawn, low, high in (((2, 70, 2), -2, 18), ((900, 70, 900), 142, 226)):
        write_blocks(made.volume(), tmp_path / f"at{low}", WriteOptions(spawn=spawn))
        box, _ = find_built_box(tmp_path / f"at{low}")
        assert (box[0], box[3]) == (low, high)


def test_a_world_where_nothing_is_built_is_read_around_its_spawn(tmp_path):
    made = Blocks(20, 4, 20)
    made.put(np.s_[:, :3], "minecraft:dirt")
    write_blocks(made.volume(), tmp_path / "wild", WriteOptions(spawn=(8, 70, 8)))
    box, told = find_built_box(tmp_path / "wild")
    assert box == (-56, 38, -56, 72, 166, 72)
    assert told.startswith(
        "no buildings found in this world; using the blocks around the spawn point"
    )


@pytest.mark.parametrize(
    ("state", "built"),
    [
        ("minecraft:white_concrete", True),
        ("minecraft:oak_stairs[facing=east,half=bottom]", True),
        ("tmeo_ultra:yigui", True),
        ("minecraft:stone", False),
        ("minecraft:oak_planks", False),
        ("minecraft:oak_log[axis=y]", False),
        ("minecraft:air", False),
    ],
)
def test_what_players_build_of(state, built):
    assert is_built(state) == built


def test_a_source_can_be_sent_to_another_process(house):
    source = open_scene_source(house)
    before = source.volume()
    sent = pickle.loads(pickle.dumps(source))
    assert len(pickle.dumps(source)) < 2000
    assert sent == source
    np.testing.assert_array_equal(sent.volume().semantic, before.semantic)


def test_names_of_scenes(tmp_path):
    assert scene_id_of(tmp_path / "my-house v2.schem") == "my_house_v2"
    assert scene_id_of(tmp_path / "run" / "build") == "run"


def test_mistakes_are_told(tmp_path, foreign):
    with pytest.raises(InputError, match="not found"):
        open_scene_source(tmp_path / "none")
    with pytest.raises(UsageError, match="a box must be x0 y0 z0 x1 y1 z1 with x0 < x1"):
        open_scene_source(foreign, box=(1, 2, 3, 1, 5, 6))
    with pytest.raises(UsageError, match="above 0 and at most 64, got 0"):
        open_scene_source(foreign, blocks_per_metre=0)
    with pytest.raises(UnknownNameError, match="no block map is named 'nyv'"):
        open_scene_source(foreign, block_map="nyv")
    with pytest.raises(InputError, match="only air in this box"):
        open_scene_source(foreign, box=(300, 61, 1, 305, 66, 9)).volume()
