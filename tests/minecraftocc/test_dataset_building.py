"""A whole data set of small worlds: the same bytes whoever makes it and however often it stops."""

import errno
import io
import json
import os
import pickle
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from house_of_blocks import cottage
from PIL import Image

from world2minecraft import cli
from world2minecraft.core.classes import display_name
from world2minecraft.core.errors import ConflictError, OutputError, UnknownNameError, UsageError
from world2minecraft.core.locks import Lock
from world2minecraft.minecraft.formats import write_blocks
from world2minecraft.minecraftocc.building import build as build_module
from world2minecraft.minecraftocc.building import build_dataset
from world2minecraft.minecraftocc.building import scene_survey as scenes_module
from world2minecraft.minecraftocc.building.process_registry import wait_for_others
from world2minecraft.minecraftocc.building.shard_rendering import shard_tasks
from world2minecraft.minecraftocc.engine import open_engine
from world2minecraft.minecraftocc.labels.camera_region import RegionRule, region_in
from world2minecraft.minecraftocc.labels.image_labels import label_image
from world2minecraft.minecraftocc.labels.voxelization import voxelize_scene
from world2minecraft.minecraftocc.plan import (
    DatasetPlan,
    GivenViews,
    Recipe,
    plan_dataset,
    source_scenes,
)
from world2minecraft.minecraftocc.scene_sources import open_scene_source
from world2minecraft.minecraftocc.store import open_store, verify_store
from world2minecraft.minecraftocc.store.sample_files import SampleFiles
from world2minecraft.minecraftocc.store.shard import member_at
from world2minecraft.rendering import LightSettings, prepare_scene, render_volume
from world2minecraft.rendering.presentation.shot_rendering import with_common_exposure
from world2minecraft.rendering.views import Shot, camera_of

REGION = RegionRule("paper", (20, 20, 12), 0.25)
RECIPE = Recipe(camera=camera_of(64, 48, vertical_fov_deg=70), region=REGION)


@pytest.fixture(scope="module")
def worlds(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worlds")
    other = cottage()
    other.put((6, 2, 6), "minecraft:yellow_bed[facing=east,occupied=false,part=foot]")
    for name, blocks in (("first", cottage()), ("second", other)):
        write_blocks(blocks.volume(), folder / f"{name}.schem")
    return folder


@pytest.fixture(scope="module")
def plan(worlds):
    return plan_of(worlds)


def plan_of(worlds, images=7, recipe=RECIPE, **words) -> DatasetPlan:
    return plan_dataset(source_scenes(sorted(worlds.iterdir())), images, recipe=recipe, **words)


def build(folder, plan, jobs=1, engine="pool", progress=lambda *_: None):
    with open_engine(engine, jobs) as workers:
        return build_dataset(folder, plan, workers, progress)


@pytest.fixture(scope="module")
def made(tmp_path_factory, plan):
    folder = tmp_path_factory.mktemp("made") / "data"
    calls = []
    build(folder, plan, progress=lambda *words: calls.append(words))
    return folder, calls


def files_of(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_the_folder_holds_what_the_docs_say(made):
    assert sorted(files_of(made[0])) == [
        "README.md",
        "checksums.json",
        "classes.json",
        "dataset.json",
        "index.parquet",
        "scenes/first.json",
        "scenes/first.objects.json",
        "scenes/first.poses.jsonl",
        "scenes/second.json",
        "scenes/second.objects.json",
        "scenes/second.poses.jsonl",
        "shards/test/first-000.tar",
        "shards/train/second-000.tar",
    ]
    assert not verify_store(made[0]).faults


def test_a_sample_is_what_the_renderer_and_the_labeller_say(made, worlds):
    """The whole way again, by hand."""
    store = open_store(made[0])
    sample = store[store.keys()[2]]
    source = open_scene_source(worlds / f"{sample.scene_id}.schem")
    volume = source.volume()
    scene = prepare_scene(volume)
    mine = [one for one in store.samples() if one.scene_id == sample.scene_id]
    light = LightSettings(hour=sample.facts["hour"])
    lit = with_common_exposure(scene, light, [Shot(one.camera, one.camera_to_room) for one in mine])
    picture = render_volume(
        lit, sample.camera, sample.camera_to_room, outputs=("colour", "depth"), light=light
    )
    packed = io.BytesIO()
    Image.fromarray(picture.colour).save(packed, "JPEG", quality=95, subsampling=0)
    np.testing.assert_array_equal(sample.colour, np.asarray(Image.open(packed)))
    assert np.abs(sample.depth_m - picture.depth_m).max() <= 0.0005 + 1e-6
    voxels = voxelize_scene(volume, source.designs(), voxel_m=0.25)
    region = region_in(voxels, sample.camera_to_room, REGION)
    occ = label_image(voxels, region, sample.camera, sample.camera_to_room, picture.depth_m)
    for name in ("labels", "instance", "in_frustum", "hits", "free"):
        np.testing.assert_array_equal(getattr(occ, name), getattr(sample.occ, name))
    names = [voxels.fine_classes[n] for n in occ.fine.flat]
    assert names == [sample.fine_classes[n] for n in sample.occ.fine.flat]
    assert len(np.unique(occ.labels)) > 3


def test_objects_of_scenes_are_listed_by_instance(made):
    store = open_store(made[0])
    with pytest.raises(UnknownNameError, match="no scene is named .third."):
        store.objects("third")
    for scene_id in ("first", "second"):
        mine = [one for one in store.samples(pictures=False) if one.scene_id == scene_id]
        objects = store.objects(scene_id)
        seen = {number for one in mine for number in np.unique(one.occ.instance).tolist()} - {0}
        assert seen and seen <= objects.keys()
        for occ in (one.occ for one in mine):
            for number in np.unique(occ.instance[occ.instance > 0]).tolist():
                labels = occ.labels[occ.instance == number]
                assert objects[number].class_id == np.bincount(labels).argmax()
                assert objects[number].name == display_name(objects[number].class_id)


def test_one_world_in_both_splits_is_refused(plan):
    """However it is called: a copy of a world is the same world."""
    facts = {scene.scene_id: SimpleNamespace(digest="same") for scene in plan.scenes}
    with pytest.raises(
        UsageError, match=r"first.schem \(for test\) and .*second.schem \(for train"
    ):
        build_module._refuse_duplicate_worlds(plan.scenes, facts)
    build_module._refuse_duplicate_worlds(plan.scenes[:1] * 2, facts)


def test_progress_goes_through_every_stage_to_its_end(made):
    stages = list(dict.fromkeys(stage for stage, *_ in made[1] if stage != "compile"))
    assert stages == ["scenes", "images", "index"]
    for stage in stages:
        steps = [(done, total) for name, done, total, *_ in made[1] if name == stage]
        assert steps[0][0] == 0 and steps[-1][0] == steps[-1][1]
        assert steps == sorted(steps)


@pytest.mark.parametrize("engine", ["pool", "ray"])
def test_processes_make_the_same_bytes(made, plan, tmp_path, engine):
    if engine == "ray":
        pytest.importorskip("ray")
    report = build(tmp_path / "data", plan, 2, engine)
    assert report.made == 7
    assert files_of(tmp_path / "data") == files_of(made[0])


def test_a_finished_set_stays_and_a_lost_shard_is_rebuilt(made, plan, tmp_path):
    copy = shutil.copytree(made[0], tmp_path / "copy")
    assert build(copy, plan).made == 0
    (copy / "shards/test/first-000.tar").unlink()
    assert build(copy, plan).made == 1
    assert files_of(copy) == files_of(made[0])


def stops(folder):
    """States of a folder that a kill may leave, each made of the finished one."""

    def unfinished(copy):
        (copy / "README.md").unlink()
        meta = copy / "dataset.json"
        told = build_module.read_meta(copy)
        build_module.write_json(meta, {**plan_only(told), "complete": False})

    def no_index(copy):
        unfinished(copy)
        (copy / "index.parquet").rename(copy / ".index.parquet.part")

    def part_of_a_shard(copy):
        no_index(copy)
        shard = copy / "shards/train/second-000.tar"
        data = shard.read_bytes()
        first = member_at(io.BytesIO(data), 0, len(data))
        shard.with_name(shard.name + ".part").write_bytes(data[: first.end + 700])
        shard.unlink()
        (copy / ".dataset.json.abcdef_1").write_text("{")

    def scenes_half_looked_at(copy):
        part_of_a_shard(copy)
        (copy / "scenes/first.json").unlink()
        (copy / "scenes/.first.json.xyz12345").write_text("{")

    return [unfinished, no_index, part_of_a_shard, scenes_half_looked_at]


def test_foreign_files_are_left_alone(made, plan, tmp_path):
    copy = shutil.copytree(made[0], tmp_path / "copy")
    (copy / ".git").mkdir()
    (copy / ".git/config").write_text("mine")
    stops(copy)[2](copy)
    build(copy, plan)
    assert (copy / ".git/config").read_text() == "mine"
    assert not verify_store(copy).faults


def plan_only(meta):
    return {key: meta[key] for key in ("kind", "format", "plan")}


@pytest.mark.parametrize("number", range(4))
def test_an_interrupted_build_resumes_to_the_same_bytes(made, plan, tmp_path, number):
    copy = shutil.copytree(made[0], tmp_path / "copy")
    stops(copy)[number](copy)
    build(copy, plan)
    assert files_of(copy) == files_of(made[0])


def test_a_full_disk_is_one_line_and_the_same_command_goes_on(made, plan, tmp_path, monkeypatch):
    real, calls = os.fsync, []

    def full(handle):
        calls.append(handle)
        if len(calls) > 9:
            raise OSError(errno.ENOSPC, "No space left on device")
        real(handle)

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(OutputError, match="the disk is full; free some space and run the same"):
            build(tmp_path / "data", plan)
    assert build(tmp_path / "data", plan).made < 7
    assert files_of(tmp_path / "data") == files_of(made[0])


def test_a_second_run_on_the_same_folder_is_refused(plan, tmp_path):
    lock = Lock(tmp_path / ".lock", "built")
    lock.acquire()
    with pytest.raises(ConflictError, match="is being built by process"):
        build(tmp_path, plan)
    lock.release()


PARENT = """
import pickle, sys
from pathlib import Path
from world2minecraft.minecraftocc.building import build_dataset
from world2minecraft.minecraftocc.engine import open_engine
if __name__ == "__main__":
    with open_engine("pool", 2) as engine:
        build_dataset(sys.argv[1], pickle.loads(Path(sys.argv[2]).read_bytes()), engine)
"""


def is_at_work(folder):
    """Whether a worker has begun: the crew's file is there before that."""
    try:
        wait_for_others(folder, patience_s=0)
    except ConflictError:
        return True
    except OutputError:
        pass
    return False


def test_a_run_may_begin_the_moment_a_pool_lost_its_parent(made, plan, tmp_path):
    (tmp_path / "plan").write_bytes(pickle.dumps(plan))
    (tmp_path / "parent.py").write_text(PARENT)
    words = [sys.executable, *(str(tmp_path / name) for name in ("parent.py", "data", "plan"))]
    process = subprocess.Popen(words)
    while not is_at_work(tmp_path / "data"):
        assert process.poll() is None
        time.sleep(0.01)
    process.kill()
    process.wait()
    build(tmp_path / "data", plan)
    assert files_of(tmp_path / "data") == files_of(made[0])


def test_another_plan_in_the_same_folder_is_refused(made, worlds):
    for plan, what in (
        (plan_of(worlds, 9), "set of scenes or number of images"),
        (plan_of(worlds, recipe=replace(RECIPE, pictures=False)), "pictures"),
    ):
        with pytest.raises(ConflictError, match=f"contains a data set with a different .*{what}"):
            build(made[0], plan)


def test_a_scene_that_changed_meanwhile_is_reported(worlds, plan, tmp_path):
    folder = tmp_path / "data"
    mine = shutil.copytree(worlds, tmp_path / "worlds")
    changing = plan_of(mine)
    build(folder, changing)
    write_blocks(cottage().volume(2.0), mine / "second.schem")
    shutil.rmtree(folder / "shards")
    with pytest.raises(ConflictError, match=r"second\.schem: has changed since"):
        build(folder, changing)


def test_labels_alone_have_the_cells_of_pictures(made, worlds, tmp_path):
    build(tmp_path / "bare", plan_of(worlds, recipe=replace(RECIPE, pictures=False)))
    store, bare = open_store(made[0]), open_store(tmp_path / "bare")
    assert store.keys() == bare.keys()
    for ours, theirs in zip(store.samples(), bare.samples(), strict=True):
        assert theirs.colour is None and theirs.depth_m is None
        np.testing.assert_array_equal(ours.occ.labels, theirs.occ.labels)
        np.testing.assert_array_equal(ours.occ.in_frustum, theirs.occ.in_frustum)


def test_cells_may_be_blocks(worlds, tmp_path):
    build(tmp_path / "data", plan_of(worlds, 2, replace(RECIPE, is_block_cells=True)))
    sample = next(open_store(tmp_path / "data").samples())
    assert sample.occ.region.voxel_m == 1.0


def test_views_of_a_tour_file_are_taken_as_they_are(made, worlds, tmp_path, capsys):
    poses = made[0] / "scenes/second.poses.jsonl"
    words = ["--world", str(worlds / "second.schem"), "--tour", str(poses), "--voxel", "0.25"]
    words += ["--size", "64x48", "--jobs", "1"]
    assert cli.run(["dataset", "build", str(tmp_path / "data"), *words]) == 0
    ours, theirs = open_store(made[0]), open_store(tmp_path / "data")
    assert theirs.keys() == ours.keys("train")
    for key in theirs:
        np.testing.assert_array_equal(ours[key].colour, theirs[key].colour)


def test_screenshots_are_labelled_as_what_they_show(made, worlds, tmp_path):
    ours, lines = open_store(made[0]), []
    shots = tmp_path / "shots"
    shots.mkdir()
    for number, sample in enumerate(ours.samples("train")):
        Image.fromarray(sample.colour).save(shots / f"{number}.png")
        pose = sample.facts["game_pose"]
        lines.append({"image": f"{number}.png", "vertical_fov_deg": 70, **pose})
    (shots / "poses.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    scenes = [
        replace(one, given=GivenViews(str(shots), is_screenshots=True))
        for one in source_scenes([worlds / "second.schem"])
    ]
    recipe = replace(RECIPE, files=SampleFiles("png"), paper_compat=True)
    build(tmp_path / "data", plan_dataset(scenes, len(lines), recipe=recipe))
    for ours_, theirs in zip(
        ours.samples("train"), open_store(tmp_path / "data").samples(), strict=True
    ):
        np.testing.assert_array_equal(ours_.colour, theirs.colour)
        np.testing.assert_array_equal(ours_.occ.labels, theirs.occ.labels)
        assert np.abs(ours_.depth_m - theirs.depth_m).max() < 0.002
        focal_px = theirs.facts["paper_compat"]["K"][0][0]
        assert focal_px == pytest.approx(32 / np.tan(np.radians(35)))


def test_too_few_views_are_reported_and_refused_for_a_preset(worlds, tmp_path, monkeypatch):
    real = scenes_module.plan_views
    monkeypatch.setattr(
        scenes_module, "plan_views", lambda v, count, *a, **k: real(v, min(count, 2), *a, **k)
    )
    report = build(tmp_path / "data", plan_of(worlds, 9))
    assert report.images == {"train": 2, "test": 2}
    assert report.notes[0].startswith("The train scenes have only 2 usable views for 7 images; add")
    with pytest.raises(
        UsageError, match="the train scenes have only 2 usable views for 6,100 images"
    ):
        build(tmp_path / "more", plan_of(worlds, None, preset="8k"))


def test_shard_tasks_are_in_the_order_of_the_set(plan, tmp_path):
    names = [unit.name for unit in shard_tasks(tmp_path, plan)]
    assert names == ["shards/train/second-000.tar", "shards/test/first-000.tar"]


# The command line.


def test_the_command_builds_goes_on_and_verifies(worlds, tmp_path, capsys):
    data = str(tmp_path / "data")
    words = ["dataset", "build", data, "--worlds", str(worlds), "--images", "3", "--jobs", "1"]
    words += ["--size", "64x48", "--voxel", "0.25", "--labels-only"]
    assert cli.run(words) == 0
    out = capsys.readouterr().out
    assert f"{data}: 3 images (2 train, 1 test) in 2 shards" in out
    assert "ms of CPU each: render" in out
    assert cli.run(words) == 0
    assert "made   nothing; the data set is already complete" in capsys.readouterr().out
    assert cli.run(["dataset", "verify", data]) == 0
    assert "3 samples in 2 shards, 0 MB: ok" in capsys.readouterr().out
    (tmp_path / "data/shards/stray.txt").write_text("x")
    assert cli.run(["dataset", "verify", data]) == 3
    out, err = capsys.readouterr()
    assert "fault: shards/stray.txt: unexpected file" in out
    assert "has 1 fault; repair it with w2m dataset verify " in err


@pytest.mark.parametrize(
    ("words", "line", "code"),
    [
        ([], "no scenes; add houses", 2),
        (["--houses", "0", "--images", "5"], "houses must be 1 or more, got 0", 2),
        (["--houses", "2", "--world", "x"], "houses cannot be combined with worlds", 2),
        (["--tour", "t.jsonl", "--screenshots", "d"], "cannot be combined; use only one", 2),
        (
            ["--houses", "2", "--screenshots", "gone", "--at", "eye"],
            "gone: not a folder; expected a folder of screenshots",
            3,
        ),
        (["--world", "gone"], "gone: not found", 3),
        (["--worlds", "gone"], "gone: not a folder; expected a folder", 3),
        (["--houses", "2", "--camera", "nyuu"], "no camera is named 'nyuu'; did you mean 'nyu'", 2),
        (["--houses", "2", "--size", "big"], "--size must be WIDTHxHEIGHT in pixels", 2),
        (["--houses", "2", "--voxel", "big"], "--voxel must be a size in metres or 'block'", 2),
        (["--houses", "2", "--region", "cube"], "no region kind is named 'cube'", 2),
        (
            ["--houses", "2", "--image-format", "gif"],
            "one of jpg, png, webp, got 'gif'",
            2,
        ),
        (["--houses", "2", "--engine", "dask"], "no engine is named 'dask'; known: pool, ray", 2),
        (["--houses", "2", "--jobs", "0"], "jobs must be from 1 to 1024, got 0", 2),
        (["--preset", "9k"], "no preset is named '9k'", 2),
    ],
)
def test_invalid_options_are_one_line(tmp_path, monkeypatch, capsys, words, line, code):
    monkeypatch.chdir(tmp_path)
    assert cli.run(["dataset", "build", "DATA", *words]) == code
    err = capsys.readouterr().err
    assert line in err
    assert err.count("\n") == 1
    assert not (tmp_path / "DATA").exists()
