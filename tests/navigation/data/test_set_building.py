"""How a set is put together: workers, splits as the paper has them, scenes that are made for it."""

import json
import shutil
from collections import Counter
from functools import partial

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from world2minecraft import cli
from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.data import generated_scenes as made_scenes
from world2minecraft.navigation.data.item_building import PAPER_HELD, PAPER_SIZE, cut_to_paper_size
from world2minecraft.navigation.data.scene_items import SceneRule
from world2minecraft.navigation.data.set_building import (
    BuildRule,
    _WalkCounter,
    build_navigation_set,
    composition_of,
)
from world2minecraft.navigation.data.splits import PAPER_SHARE, paper_splits, seen_splits, tour_of
from world2minecraft.navigation.records import read_episodes, read_items, read_trajectories
from world2minecraft.navigation.types import (
    Instruction,
    Item,
    Keyframe,
    Option,
    Stance,
    Trajectory,
)

RECORDS = ("items.jsonl", "trajectories.jsonl", "episodes.jsonl", "dataset.json")


def a_walk(name, split="train"):
    frame = Keyframe(f"{name}.jpg", Stance(0, 0, 0), "stop", ())
    scene = name.partition("_")[0]
    return Trajectory(name, scene, (frame,), (Instruction("Go."),), 2.0, split, 0.25)


@given(
    st.lists(st.lists(st.integers(1, 4), min_size=1, max_size=30), max_size=8), st.integers(0, 5)
)
@settings(max_examples=60, deadline=None)
def test_one_tour_in_ten_is_seen_and_each_scene_is_trained(scenes, seed):
    walks = [
        a_walk(f"s{s}_t{t:02d}_{n:03d}")
        for s, sizes in enumerate(scenes)
        for t, size in enumerate(sizes)
        for n in range(size)
    ]
    unseen = [a_walk(f"u_t{t:02d}_000", "val_unseen") for t in range(20)]
    splits = seen_splits(walks + unseen, seed)
    assert splits == seen_splits(unseen + walks[::-1], seed)
    assert {splits.pop(one.trajectory_id) for one in unseen} == {"val_unseen"}
    by_tour = {(tour_of(name), split) for name, split in splits.items()}
    total = sum(len(sizes) for sizes in scenes)
    assert len(by_tour) == total
    held = sum(split == "val_seen" for _, split in by_tour)
    assert held == min(max(1, round(total / 10)), total - len(scenes))
    trained = {tour.partition("_")[0] for tour, split in by_tour if split == "train"}
    assert len(trained) == len(scenes)


@given(st.lists(st.integers(1, 6), min_size=1, max_size=40), st.integers(0, 5))
@settings(max_examples=60, deadline=None)
def test_the_papers_split_keeps_tours_whole_and_meets_its_share(sizes, seed):
    walks = [a_walk(f"s_t{t:02d}_{n:03d}") for t, size in enumerate(sizes) for n in range(size)]
    splits = paper_splits(walks, seed)
    assert splits == paper_splits(walks[::-1], seed)
    by_tour = Counter((tour_of(name), split) for name, split in splits.items())
    assert len(by_tour) == len(sizes)
    held = sum(split == "val_seen" for split in splits.values())
    assert 0 <= held - PAPER_SHARE * len(walks) < max(sizes)


def test_the_papers_counts_are_met_on_both_sides():
    choices = (Option("A", "positive", "stop"), Option("B", "action", "turn left"))
    items = [
        Item(
            f"{task}{part}{n}", task, f"s{n % 20}", f"t{n}", 0, Instruction("Go."), (), "a.jpg",
            choices, "A", "val_seen" if n % 3 == 0 else "train", part, 0.25, "v", {}, {},
        )
        for task, part in PAPER_SIZE
        for n in range(2100)
    ]  # fmt: skip
    kept = cut_to_paper_size(items, splits_too=True)
    held = Counter((item.task, item.composition) for item in kept if item.split != "train")
    assert held == PAPER_HELD
    assert Counter((item.task, item.composition) for item in kept) == PAPER_SIZE
    assert len(kept) == 3542 == len(cut_to_paper_size(items))


def test_a_rule_shares_the_papers_walks_among_the_scenes():
    kinds = {"a": "base", "b": "base", "c": "extend"}
    assert BuildRule(paper_size=True).walks_of(kinds) == {"a": 180, "b": 180, "c": 600}
    assert BuildRule().walks_of(kinds) == {"a": 30, "b": 30, "c": 110}
    assert BuildRule(trajectories=7, paper_size=True).walks_of(kinds) == {"a": 7, "b": 7, "c": 7}
    with pytest.raises(UsageError, match="omit the unseen share"):
        BuildRule(paper_split=True, unseen_share=0.5)


@given(st.lists(st.tuples(st.integers(0, 5), st.integers(1, 5)), min_size=1, max_size=6))
@settings(max_examples=60, deadline=None)
def test_progress_ends_once_and_never_falls(scenes):
    told = []
    given_of = [(min(given, asked), asked) for given, asked in scenes]
    total = sum(asked for _, asked in given_of)
    count = _WalkCounter(total, len(scenes), told_to(told))
    for given_, asked in given_of:
        for _ in range(given_):
            count.add(1)
        count.scene_done("s", given_, asked)
    done = [words[1] for words in told]
    assert done == sorted(done)
    assert [words[2] for words in told] == [total] * len(told)
    assert done[-1] == total
    assert done.count(total) == 1


@pytest.fixture(scope="module")
def two_flats(flat_path, tmp_path_factory):
    folder = tmp_path_factory.mktemp("flats")
    return [shutil.copytree(flat_path, folder / name) for name in ("east", "west")]


def told_to(told):
    """Progress that keeps what it is told."""

    def progress(stage: str, done: int, total: int, note: str = "") -> None:
        told.append((stage, done, total, note))

    return progress


def small(**more):
    return BuildRule(
        trajectories=3, work=SceneRule(size_px=(64, 36), balanced=False, seed=2), **more
    )


@pytest.fixture(scope="module")
def one_worker(two_flats, tmp_path_factory):
    out = tmp_path_factory.mktemp("one")
    return out, build_navigation_set(two_flats, out, small(paper_split=True))


def test_workers_change_nothing(two_flats, one_worker, tmp_path):
    out, built = one_worker
    told = []
    again = build_navigation_set(
        two_flats, tmp_path, small(paper_split=True), told_to(told), workers=2
    )
    assert again.items == built.items
    for name in RECORDS:
        assert (tmp_path / name).read_bytes() == (out / name).read_bytes()
    pictures = sorted(path.relative_to(out) for path in out.rglob("*.jpg"))
    assert pictures == sorted(path.relative_to(tmp_path) for path in tmp_path.rglob("*.jpg"))
    assert told[0][:3] == ("walks", 0, 6) and told[-1][:3] == ("walks", 6, 6)


def test_a_set_split_as_the_paper_has_no_unseen_scene(one_worker):
    out, built = one_worker
    splits = {one.trajectory_id: one.split for one in read_trajectories(out)}
    assert Counter(splits.values()).keys() == {"train", "val_seen"}
    assert {one.trajectory_id: one.split for one in read_episodes(out)} == splits
    assert all(item.split == splits[item.trajectory_id] for item in read_items(out))
    assert not built.leaks.images and not built.leaks.trajectories


def test_a_set_is_counted_by_the_command(one_worker, tmp_path, capsys):
    out, built = one_worker
    words = ["vln", "stats", str(out), "--json", str(tmp_path / "s.json")]
    assert cli.run([*words, "--plot", str(tmp_path / "lengths.png")]) == 0
    told = capsys.readouterr().out
    figures = json.loads((tmp_path / "s.json").read_text())
    by_task = Counter(item.task for item in built.items)
    assert {task: sum(own.values()) for task, own in figures["letters"].items()} == by_task
    assert figures["scenes"] == {"base": 0, "extend": 2, "combined": 2}
    assert figures["leaks"]["images"] == figures["leaks"]["trajectories"] == 0
    held = Counter(item.task for item in built.items if item.split != "train")
    for row in figures["baselines"]:
        whole = held[row["task"]] or by_task[row["task"]]
        assert 0 <= row["hits"] <= row["total"] <= whole
        assert row["total"] == whole or row["name"].startswith("nearest ")  # Of one grade.
        assert f"{row['hits'] / row['total']:.3f}" in told
    assert {row["task"] for row in figures["baselines"]} == set(by_task)
    assert min(Image.open(tmp_path / "lengths.png").size) > 200
    trained = sorted(set(by_task) - set(held))
    where = f"; {', '.join(trained)} on train, because none of it is held out" if trained else ""
    assert f"Baselines on the held-out splits{where} (95 % interval)" in told
    assert f"w2m vln evaluate {out} --agent oracle" in told


def test_a_set_is_counted_without_its_pictures(one_worker, tmp_path, capsys):
    items = shutil.copy(one_worker[0] / "items.jsonl", tmp_path)
    assert cli.run(["vln", "stats", str(items), "--no-baselines"]) == 0
    assert "Baselines on" not in capsys.readouterr().out
    assert cli.run(["vln", "stats", str(items)]) == 3
    assert "Traceback" not in capsys.readouterr().err
    assert cli.run(["vln", "stats", str(tmp_path / "none")]) == 3
    assert "none" in capsys.readouterr().err


def test_scenes_are_made_once(tmp_path, monkeypatch):
    few = partial(made_scenes.scan_room, frames=6, width=160, height=120)
    monkeypatch.setattr(made_scenes, "scan_room", few)
    monkeypatch.setattr(made_scenes, "TRIES", 1)
    told = []
    room, house = made_scenes.make_scenes(tmp_path, 1, 1, 3, 1, told_to(told))
    assert (composition_of(room), composition_of(house)) == ("base", "extend")
    assert (room.name, house.name) == ("bed_01_s3", "house_01_s3")
    assert not (room / "capture").exists()
    assert [words[:3] for words in told] == [("scenes", n, 2) for n in range(3)]
    del told[:]
    assert made_scenes.make_scenes(tmp_path, 1, 1, 3, 1, told_to(told)) == [
        room,
        house,
    ]
    assert told == []
    with pytest.raises(UsageError, match="got -1 and 0"):
        made_scenes.make_scenes(tmp_path, -1, 0)


def test_a_room_without_a_way_is_made_again(tmp_path, monkeypatch):
    made, ways = [], iter([False, False, True])

    def make(out, kind, chance):
        out.mkdir()
        (out / "report.json").touch()
        made.append((kind, chance))

    class Guide:
        has_goals = property(lambda _: next(ways))

    monkeypatch.setattr(made_scenes, "_make_room", make)
    monkeypatch.setattr(made_scenes, "open_scene", lambda out: out)
    monkeypatch.setattr(made_scenes, "TourPlanner", lambda scene: Guide())
    assert [one.name for one in made_scenes.make_scenes(tmp_path, 1, 0, 2)] == ["bed_01_s2"]
    assert [one.name for one in made_scenes.make_scenes(tmp_path, 0, 0)] == []
    assert made == [("bed", 2_001), ("bed", 1_002_001), ("bed", 2_002_001)]


def test_a_build_without_a_scene_says_what_to_do(tmp_path, capsys):
    assert cli.run(["vln", "build", "--out", str(tmp_path / "set")]) == 2
    told = capsys.readouterr().err
    assert told == "error: no scenes given; add scenes, or generate some (--rooms 3)\n"
