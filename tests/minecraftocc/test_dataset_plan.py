"""Plans: exact numbers, splits by scene, the same for the same seed."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.minecraftocc.building.build import allocate_views
from world2minecraft.minecraftocc.building.recorded_views import MAX_TOUR_NAME as LONGEST_TOUR
from world2minecraft.minecraftocc.building.shard_rendering import shard_tasks
from world2minecraft.minecraftocc.plan import (
    MAX_SCENES,
    PRESETS,
    Recipe,
    SceneSpec,
    house_scenes,
    plan_dataset,
    source_scenes,
)
from world2minecraft.minecraftocc.store.shard import MAX_KEY_LENGTH


@pytest.mark.parametrize(
    ("name", "train", "test"),
    [("8k", 6_100, 2_024), ("50k", 39_914, 10_245), ("100k", 79_799, 20_366)],
)
def test_presets_have_exactly_the_papers_numbers(name, train, test):
    plan = plan_dataset(house_scenes(PRESETS[name].houses), preset=name)
    assert plan.images == {"train": train, "test": test}
    units = shard_tasks(Path("data"), plan)
    assert sum(unit.last - unit.first for unit in units) == train + test
    of_test = {unit.spec.scene_id for unit in units if unit.name.startswith("shards/test/")}
    assert not of_test & {u.spec.scene_id for u in units if u.spec.scene_id not in of_test}
    assert len({unit.name for unit in units}) == len(units)


def test_the_paper_has_as_many_scenes():
    assert PRESETS["100k"].houses == 156
    assert sum((79_799, 20_366)) == 100_165


@given(st.integers(1, 60), st.integers(0, 500), st.floats(0, 0.999), st.integers(0, 99))
def test_all_images_are_shared_out_and_no_scene_is_in_two_splits(scenes, more, share, seed):
    recipe = Recipe(seed=seed)
    plan = plan_dataset(house_scenes(scenes), scenes + more, recipe=recipe, test_share=share)
    assert sum(plan.images.values()) == scenes + more
    assert len({scene.scene_id for scene in plan.scenes}) == scenes
    assert any(scene.split == "train" for scene in plan.scenes)
    assert min(scene.images for scene in plan.scenes) >= 1
    for split in plan.images:
        counts = [scene.images for scene in plan.scenes if scene.split == split]
        assert max(counts) - min(counts) <= 1


def test_a_scene_more_moves_few_others():
    small = plan_dataset(house_scenes(40), 400)
    large = plan_dataset(house_scenes(41), 410)
    before = {scene.scene_id: scene.split for scene in small.scenes}
    moved = [s for s in large.scenes if before.get(s.scene_id, s.split) != s.split]
    assert len(moved) <= 1


def test_another_seed_splits_otherwise():
    def tests(seed):
        plan = plan_dataset(house_scenes(40), 400, recipe=Recipe(seed=seed))
        return {scene.scene_id for scene in plan.scenes if scene.split == "test"}

    assert tests(0) == tests(0) != tests(1)
    assert len(tests(0)) == len(tests(1)) == 8


def test_a_plan_is_json():
    facts = plan_dataset(house_scenes(2), 4).facts()
    assert json.loads(json.dumps(facts))["recipe"]["camera"]["width_px"] == 640


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ({"scenes": [], "images": 3}, "no scenes; add houses or worlds"),
        ({"images": 1}, r"images must be from 2 \(one per scene\)"),
        ({"images": None}, "got none"),
        ({"images": 9, "preset": "8k"}, "sets the number of images; omit images"),
        ({"scenes": house_scenes(1), "preset": "8k"}, "needs at least two scenes"),
        ({"images": 9, "test_share": 1.0}, "the test share must be at least 0 and below 1"),
    ],
)
def test_what_does_not_go_together_is_told(words, text):
    with pytest.raises(UsageError, match=text):
        plan_dataset(**{"scenes": house_scenes(2), **words})


def test_an_unknown_preset_is_told():
    with pytest.raises(UnknownNameError, match="did you mean '50k'"):
        plan_dataset(house_scenes(2), preset="50K")


def test_scenes_of_one_name_get_names_of_their_own():
    places = [Path("a/house/world"), Path("b/house.schem"), Path("c/house")]
    assert [one.scene_id for one in source_scenes(places)] == ["house", "house_2", "house_3"]


def test_a_world_that_is_given_twice_is_refused():
    """Under two names it would be trained on and tested on."""
    with pytest.raises(UsageError, match="a/../a/house is listed twice; list each world only once"):
        source_scenes([Path("a/house"), Path("b"), Path("a/../a/house")])


def test_the_keys_of_any_scene_can_be_stored():
    """The longest name, its number, the longest tour of one's own and a frame."""
    (spec,) = source_scenes([Path("x" * 200)])
    key = f"{spec.scene_id}_{MAX_SCENES - 1}-{'t' * LONGEST_TOUR}-999999"
    assert len(key) <= MAX_KEY_LENGTH
    assert len(f"{key}.depth.png") <= 100  # As long as a name in a ustar may be.


# Scenes that have fewer views than they are asked for.


@given(st.lists(st.integers(0, 30), min_size=1, max_size=9), st.integers(1, 20))
def test_what_some_scenes_lack_others_give(have, each):
    scenes = [SceneSpec(f"s{n}", "", 0, "train", each) for n in range(len(have))]
    asked = []

    def look(some):
        asked.extend(some)
        return [min(scene.images, have[int(scene.scene_id[1:])]) for scene in some]

    shared = allocate_views(scenes, look)
    wanted = each * len(have)
    assert sum(scene.images for scene in shared) <= min(wanted, sum(have))
    if sum(have) >= wanted + len(have) * 30:
        assert sum(scene.images for scene in shared) == wanted
    again = allocate_views(scenes, look)
    assert again == shared


def test_a_shortage_is_made_up_within_its_split():
    scenes = [SceneSpec(f"s{n}", "", 0, "test" if n > 2 else "train", 10) for n in range(5)]
    have = {"s0": 4, "s1": 99, "s2": 12, "s3": 10, "s4": 7}
    shared = allocate_views(scenes, lambda some: [min(s.images, have[s.scene_id]) for s in some])
    assert [scene.images for scene in shared] == [4, 14, 12, 10, 7]
    assert sum(scene.images for scene in shared[:3]) == 30


def test_enough_views_are_asked_for_once():
    scenes = [replace(scene, images=5, split="train") for scene in house_scenes(3)]
    calls = []
    allocate_views(scenes, lambda some: calls.append(some) or [5] * len(some))
    assert len(calls) == 1
