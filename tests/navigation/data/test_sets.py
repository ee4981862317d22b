"""Items and sets: choices that differ, even answers, no leak, one small set from end to end."""

import hashlib
import json
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.navigation.data.blind_baselines import score_baselines
from world2minecraft.navigation.data.item_building import LetterBalancer, cut_to_quotas
from world2minecraft.navigation.data.keyframes import KeyframeMark
from world2minecraft.navigation.data.picture_store import show_different_views
from world2minecraft.navigation.data.scene_items import SceneRule
from world2minecraft.navigation.data.set_building import (
    BuildRule,
    build_navigation_set,
    composition_of,
)
from world2minecraft.navigation.data.splits import (
    find_leaks,
    scene_splits,
    without_shared_pictures,
)
from world2minecraft.navigation.data.statistics import (
    compute_statistics,
    lengths_of,
    statistics_json,
    statistics_text,
    write_histograms,
)
from world2minecraft.navigation.data.tasks import action_steps
from world2minecraft.navigation.language.instruction_parsing import parse_instruction
from world2minecraft.navigation.oracle import plan_expert_path
from world2minecraft.navigation.records import read_episodes, read_items, read_trajectories
from world2minecraft.navigation.types import Instruction, Item, Move, Option, Stance

ACTIONS = ("move forward", "turn left", "turn right", "stop")


def action(
    name, gold="stop", text="Go to the bed.", split="train", scene="s", letter="A", part="base"
):
    wrong = [one for one in ACTIONS if one != gold]
    wrong.insert("ABCD".index(letter), gold)
    options = tuple(Option("ABCD"[n], "action", one) for n, one in enumerate(wrong))
    sums = {f"{name}.jpg": hashlib.sha256(name.encode()).hexdigest()}
    return Item(
        name, "next_action", scene, f"{name}_t", 1, Instruction(text), (), f"{name}.jpg", options,
        letter, split, "base", 0.25, "v", sums,
        {"gold": gold, "previous": "turn left"},
    )  # fmt: skip


@given(st.lists(st.text("abcdef", min_size=1), unique=True, max_size=12), st.integers(0, 9))
@settings(max_examples=60, deadline=None)
def test_the_order_of_scenes_does_not_matter(names, seed):
    kinds = {name: ("base", "extend")[len(name) % 2] for name in names}
    splits = scene_splits(kinds, seed)
    assert splits == scene_splits(dict(reversed(kinds.items())), seed)
    for kind in set(kinds.values()):
        own = [splits[name] for name in names if kinds[name] == kind]
        assert 0 < own.count("val_unseen") < len(own) or len(own) < 3


def test_letters_come_as_often_as_each_other():
    deck = LetterBalancer(np.random.default_rng(3))
    dealt = Counter(deck.deal() for _ in range(402))
    assert sorted(dealt) == list("ABCD")
    assert max(dealt.values()) - min(dealt.values()) <= 1


def test_actions_are_asked_about_evenly_or_not_at_all():
    stance, rng = Stance(0, 0, 0), np.random.default_rng(0)
    moves = [Move.LEFT, Move.FORWARD, Move.FORWARD, Move.RIGHT, Move.FORWARD, Move.STOP]
    marks = [KeyframeMark(n, stance, move, 1, (move,)) for n, move in enumerate(moves)]
    steps = action_steps(marks, range(6), rng)
    assert sorted(marks[n].move for n in steps) == sorted(Move)
    assert action_steps(marks, range(1, 6), rng) == []
    assert action_steps(marks, range(1, 6), rng, balanced=False) == [1, 2, 3, 4, 5]


def test_a_cut_takes_from_every_scene():
    items = [action(f"{scene}{n}", scene=scene) for scene in "abc" for n in range(5)]
    kept = cut_to_quotas(items, {("next_action", "base"): 6})
    assert Counter(item.scene_id for item in kept) == {"a": 2, "b": 2, "c": 2}
    assert kept == [item for item in items if item in kept]


def test_leaks_are_found():
    clean = [action("a", scene="s1"), action("b", scene="s2", split="val_unseen", text="Go.")]
    assert find_leaks(clean).is_clean
    same_scene = [action("a", scene="s1"), action("b", scene="s1", split="val_unseen")]
    leaks = find_leaks(same_scene)
    assert leaks.scenes == ("s1",)
    assert leaks.instructions == ("Go to the bed.",)
    assert not leaks.is_clean
    assert find_leaks([clean[0], action("a", split="val_seen")]).images


def test_what_shows_a_picture_of_train_is_not_scored_on():
    same, other = action("a", split="val_seen"), action("c", split="val_seen")
    items = [action("a"), same, other, action("b")]
    assert without_shared_pictures(items) == [items[0], other, items[3]]
    assert find_leaks(without_shared_pictures(items)).images == ()


def test_words_that_give_the_answer_away_are_flagged(tmp_path):
    told = [("Leave left.", "turn left"), ("Leave right.", "turn right"), ("Halt.", "stop")]
    items = [
        action(f"i{n}", gold, text, ("train", "val_seen")[n % 2], letter="ABCD"[n % 4])
        for n, (text, gold) in enumerate(told * 20)
    ]
    rows = {row.name: row for row in score_baselines(items, tmp_path)}
    assert rows["blind"].accuracy.share == 1.0
    assert rows["blind"].is_flagged
    assert rows["oracle"].accuracy.share == 1.0
    assert not rows["oracle"].is_flagged


def test_balanced_items_leave_the_blind_at_chance(tmp_path):
    """Each walk asks for every action once, so its words say nothing."""
    items = [
        action(f"w{n}_{k}", gold, f"Pass thing {n % 7}.", split, letter="ABCD"[(n // 2 + k) % 4])
        for n, split in zip(range(80), ("train", "val_seen") * 40, strict=True)
        for k, gold in enumerate(ACTIONS)
    ]
    rows = {row.name: row for row in score_baselines(items, tmp_path)}
    assert rows["blind"].accuracy.share == 0.25
    assert not rows["blind"].is_flagged


def test_lengths_are_those_of_a_sample():
    lengths = lengths_of([15, 57, 78, 96, 187])
    assert (lengths.count, lengths.mean, lengths.median) == (5, 86.6, 78)
    assert lengths.std == pytest.approx(np.std([15, 57, 78, 96, 187], ddof=1))
    assert lengths_of([]).count == 0


def test_an_unknown_composition_is_refused(tmp_path):
    with pytest.raises(UsageError, match="must be base, extend or combined, got 'all'"):
        BuildRule("all")
    assert composition_of(tmp_path) == "extend"
    (tmp_path / "room.npz").touch()
    (tmp_path / "placements.json").touch()
    assert composition_of(tmp_path) == "base"
    with pytest.raises(UsageError, match="none of the 1 scenes has the composition 'extend'"):
        build_navigation_set([tmp_path], tmp_path / "out", BuildRule("extend"))


@pytest.fixture(scope="module")
def small_set(flat_path, tmp_path_factory):
    out = tmp_path_factory.mktemp("set")
    built = build_navigation_set([flat_path], out, small_rule())
    return out, built


def small_rule():
    return BuildRule(trajectories=4, work=SceneRule(size_px=(96, 54), balanced=False, seed=3))


def test_a_small_set_is_sound(small_set, flat):
    out, built = small_set
    items, walks = read_items(out), read_trajectories(out)
    assert items == built.items
    assert len(walks) == 4
    assert built.leaks.is_clean
    for item in items:
        for name in item.images:
            assert hashlib.sha256((out / name).read_bytes()).hexdigest() == item.sha256[name]
    about = json.loads((out / "dataset.json").read_text())
    assert about["items"] == len(items)
    assert {item.task for item in items} == {"next_view", "next_action"}


def test_the_right_picture_is_the_next_one_and_no_other_could_be(small_set):
    out, built = small_set
    walks = {one.trajectory_id: one for one in read_trajectories(out)}
    views = [item for item in built.items if item.task == "next_view"]
    assert views
    for item in views:
        frames = walks[item.trajectory_id].keyframes
        shown = {option.label: option for option in item.options}
        right = shown[item.answer]
        assert right.image == frames[item.step + 1].image
        assert item.current == frames[item.step].image
        assert item.history == tuple(one.image for one in frames[item.step - 2 : item.step])
        for option in item.options:
            if option.label != item.answer and option.kind != "other_scene":
                assert show_different_views(option.stance, right.stance, item.metres_per_block)
        assert len({option.image for option in item.options}) == 4


def test_the_right_action_is_the_walks(small_set):
    out, built = small_set
    walks = {one.trajectory_id: one for one in read_trajectories(out)}
    for item in built.items:
        if item.task == "next_action":
            texts = {option.label: option.text for option in item.options}
            frame = walks[item.trajectory_id].keyframes[item.step]
            assert texts[item.answer] == frame.move == item.extra["gold"]
            assert item.extra["gold_chunk"] == [int(move) for move in frame.chunk]


def test_what_is_told_leads_to_the_end(small_set, flat):
    """A reader who knows only the last thing that is named comes to where the walk ended."""
    out, _ = small_set
    walks = {one.trajectory_id: one for one in read_trajectories(out)}
    names = [one.name for one in flat.landmarks]
    told = 0
    for episode in read_episodes(out):
        if not episode.goal_name:
            continue
        walk = walks[episode.episode_id]
        for instruction in walk.instructions:
            if instruction.level == "route":
                continue
            last = parse_instruction(instruction.text, names).landmarks[-1]
            goals = flat.goals_at(flat.landmark(last))
            way = plan_expert_path(flat, episode.start, goals)
            assert way is not None
            assert flat.distance_m(way.stances[-1].feet, goals) <= 0.5
            assert flat.distance_m(episode.reference[-1].feet, goals) <= 1.0
            assert last == episode.goal_name
            told += 1
    assert told


def test_the_same_seed_gives_the_same_bytes(small_set, flat_path, tmp_path):
    out, _ = small_set
    build_navigation_set([flat_path], tmp_path, small_rule())
    for name in ("items.jsonl", "trajectories.jsonl", "episodes.jsonl", "dataset.json"):
        assert (tmp_path / name).read_bytes() == (out / name).read_bytes()


def test_figures_and_pictures_of_a_set(small_set, tmp_path):
    out, built = small_set
    statistics, leaks = compute_statistics(built.items), find_leaks(built.items)
    text = statistics_text(statistics, leaks)
    assert (
        "paper                       769   79.0   32.9     15     57     78     96    187" in text
    )
    rows = score_baselines(built.items, out)
    assert json.dumps(statistics_json(statistics, leaks, rows))
    assert {row.name for row in rows} >= {"uniform", "majority", "blind", "repeat", "nearest"}
    graded = {row.name: row.accuracy for row in rows if row.name.startswith("nearest ")}
    (nearest,) = [row.accuracy for row in rows if row.name == "nearest"]
    assert sum(one.total for one in graded.values()) == nearest.total
    assert sum(one.hits for one in graded.values()) == nearest.hits
    assert sum(statistics.ranks.values()) == statistics.grades.total()
    write_histograms(built.items, tmp_path / "h.png")
    with Image.open(tmp_path / "h.png") as image:
        assert image.size == (1076, 556)


def test_a_missing_or_damaged_picture_is_named(small_set, tmp_path):
    _, built = small_set
    views = [item for item in built.items if item.task == "next_view"][:1]
    with pytest.raises(InputError, match="image not found, but an item refers to it"):
        score_baselines(views, tmp_path)
    place = tmp_path / views[0].current
    place.parent.mkdir(parents=True)
    place.write_bytes(b"no picture")
    with pytest.raises(DamagedFileError, match="not a readable image"):
        score_baselines(views, tmp_path)
