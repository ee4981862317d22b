"""The benchmark is fixed: names, seeds, settings, and that tuning and testing share nothing."""

import json
from collections import Counter

import numpy as np
import pytest

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.files import read_npz
from world2minecraft.procgen import benchmark_trials as module
from world2minecraft.procgen.benchmark_trials import (
    DIFFICULTIES,
    Trial,
    find_trial,
    list_trials,
    write_trial,
)


def test_there_are_ten_trials_of_each_difficulty_in_each_split():
    assert DIFFICULTIES == ("noise", "coverage", "clutter", "scale", "all")
    for split in ("tune", "test"):
        counts = Counter(trial.difficulty for trial in list_trials(split))
        assert counts == dict.fromkeys(DIFFICULTIES, 10)
        for difficulty in DIFFICULTIES:
            assert {trial.difficulty for trial in list_trials(split, difficulty)} == {difficulty}


def test_names_and_seeds_are_fixed():
    assert [trial.seed for trial in list_trials("tune")] == list(range(500, 550))
    assert [trial.seed for trial in list_trials("test")] == list(range(1000, 1050))
    for split in ("tune", "test"):
        assert [t.name for t in list_trials(split)] == [
            f"{t.difficulty}-{t.seed}" for t in list_trials(split)
        ]


def test_tuning_and_testing_share_no_seed_and_no_name():
    tune, test = list_trials("tune"), list_trials("test")
    assert not {t.seed for t in tune} & {t.seed for t in test}
    assert not {t.name for t in tune} & {t.name for t in test}
    for a, b in zip(tune, test, strict=True):  # But are alike in all else.
        assert a == Trial(**{**vars(b), "name": a.name, "seed": a.seed})


def test_each_difficulty_is_hard_in_its_own_way():
    by_name = {name: list_trials("tune", name) for name in DIFFICULTIES}
    for name in ("noise", "coverage", "clutter", "scale"):
        assert all(trial.rooms == 1 and trial.frames == 40 for trial in by_name[name])
    assert {t.depth_scale_sigma for t in by_name["scale"]} == {0.03}
    assert {t.coverage for t in by_name["coverage"]} == {0.55}
    assert {t.clutter for t in by_name["clutter"]} == {1.0}
    assert {t.shape for t in by_name["clutter"]} == {"ell", "cut", "sloped"}
    assert {t.rooms for t in by_name["all"]} == {3, 4, 5}
    assert {t.storeys for t in by_name["all"]} == {1, 2}
    assert {(t.frames, t.depth_scale_sigma) for t in by_name["all"]} == {(120, 0.02)}
    plain = [t for name in ("noise", "coverage", "scale") for t in by_name[name]]
    assert {(t.shape, t.clutter) for t in plain} == {("box", 0.0)}
    assert {t.kind for t in plain} == {"bed", "dining", "kitchen", "living", "study"}
    for split in ("tune", "test"):
        assert {(t.sensor, t.label_error) for t in list_trials(split)} == {("rgbd", 0.1)}


def test_a_clean_trial_walks_through_the_same_room_without_noise():
    trial = find_trial("scale-533")
    clean = trial.clean()
    assert clean.name == "scale-533-clean"
    assert (clean.sensor, clean.depth_scale_sigma) == ("clean", 0.0)
    same = ("seed", "kind", "rooms", "shape", "clutter", "frames", "coverage", "label_error")
    assert all(getattr(clean, name) == getattr(trial, name) for name in same)
    assert find_trial("scale-533-clean") == clean


def test_a_wrong_name_is_refused_with_the_nearest():
    with pytest.raises(UnknownNameError, match="no trial is named 'noise-50'; did you mean"):
        find_trial("noise-50")
    with pytest.raises(UnknownNameError, match="no split is named 'train'"):
        list_trials("train")  # type: ignore[arg-type]
    with pytest.raises(
        UnknownNameError, match="no difficulty is named 'nois'; did you mean 'noise'"
    ):
        list_trials("tune", "nois")


@pytest.mark.parametrize("name", ["noise-503", "clutter-520", "all-540"])
def test_a_trial_is_what_its_fields_say(name, monkeypatch):
    trial, calls = find_trial(name), []
    for maker in ("generate_room", "generate_house"):
        monkeypatch.setattr(module, maker, lambda *a, _m=maker, **k: calls.append((_m, a, k)))
    trial.room()
    if trial.rooms == 1:
        expected = {"kind": trial.kind, "clutter": trial.clutter, "shape": trial.shape}
        assert calls == [("generate_room", (trial.seed,), expected)]
    else:
        expected = {"rooms": trial.rooms, "storeys": trial.storeys, "clutter": trial.clutter}
        assert calls == [("generate_house", (trial.seed,), expected)]


def test_a_trial_is_written_with_labels_truth_and_progress(tmp_path, monkeypatch):
    trial, calls = find_trial("coverage-511"), []
    small = {"width": 48, "height": 36}
    scan = module.scan_room
    monkeypatch.setattr(module, "scan_room", lambda *a, **k: scan(*a, **{**k, **small}))
    write_trial(trial, tmp_path, lambda *said: calls.append(said[:3]))
    assert len(list((tmp_path / "labels").iterdir())) == 22
    truth = read_npz(tmp_path / "truth.npz", ("frame_names", "depth_scale", "camera_to_truth"))
    assert truth["camera_to_truth"].shape == (22, 4, 4)
    assert np.array_equal(truth["depth_scale"], np.ones(22))
    assert json.loads((tmp_path / "truth.json").read_text())["kind"] == trial.kind
    assert calls[-1] == ("capture", 22, 22)
