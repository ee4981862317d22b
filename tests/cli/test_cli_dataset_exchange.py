"""``w2m dataset export``, ``import`` and ``show``: from one format to another by command."""

import numpy as np
import pytest
from PIL import Image
from tests.minecraftocc.exchange import page_loader, synthetic

from world2minecraft.cli import run as w2m
from world2minecraft.minecraftocc.exporters import export_samples
from world2minecraft.minecraftocc.importers import open_occupancy

KEY = "house_0001-t0-00000"


@pytest.fixture(scope="module")
def made():
    sample = synthetic.sample()
    sample.facts.clear()
    return sample


@pytest.fixture(scope="module")
def npz(made, tmp_path_factory):
    out = tmp_path_factory.mktemp("npz")
    export_samples([made], "npz", out)
    return out


@pytest.fixture(scope="module")
def store(npz, tmp_path_factory):
    out = tmp_path_factory.mktemp("store") / "DATA"
    assert w2m(["dataset", "import", str(npz), "--out", str(out)]) == 0
    return out


def test_a_data_set_is_imported_and_exported(made, store, tmp_path, capsys):
    found = open_occupancy(store)
    assert found.describe() == "store, 1 samples (1 train)"
    out = tmp_path / "NYU"
    words = ["dataset", "export", str(store), "--format", "nyu", "--out", str(out)]
    assert w2m(words) == 0
    said = capsys.readouterr().out
    assert said == (
        f"1 samples written to {out}\n"
        f"use:  NYU_root={out} NYU_preprocess_root={out} for MonoScene\n"
        f"next: w2m dataset show {out}\n"
    )
    loaded = page_loader.load_nyu(out, "train", KEY)
    assert np.array_equal(loaded.target, made.occ.labels)
    assert w2m(words) == 0
    assert "0 samples written to" in capsys.readouterr().out


def test_the_store_keeps_what_was_imported(made, store):
    found = open_occupancy(store)[KEY]
    assert np.array_equal(found.occ.labels, made.occ.labels)
    assert np.array_equal(found.occ.hits, made.occ.hits)
    assert found.camera == made.camera
    assert np.allclose(found.camera_to_room, made.camera_to_room)


def test_nyu_is_imported_from_its_files(made, tmp_path, capsys):
    export_samples([made], "nyu", tmp_path / "NYU")
    out = tmp_path / "DATA"
    assert w2m(["dataset", "import", str(tmp_path / "NYU"), "--out", str(out)]) == 0
    assert "nyu, 1 samples (1 train)" in capsys.readouterr().out
    assert np.array_equal(open_occupancy(out)[KEY].occ.labels, made.occ.labels)


def test_a_sample_is_shown(store, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert w2m(["dataset", "show", str(store)]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == f"{store}: store, 1 samples (1 train)"
    assert said[1] == "100.0% of the depth pixels within the region are in labelled cells"
    assert said[2] == f"image: {KEY}.png"
    assert Image.open(tmp_path / f"{KEY}.png").width > 1000


def test_a_sheet_shows_pictures_with_their_labels_beside(store, tmp_path, capsys):
    plain, both = tmp_path / "plain.png", tmp_path / "both.png"
    assert w2m(["dataset", "sheet", str(store), "--width", "100", "--out", str(plain)]) == 0
    assert w2m(["dataset", "sheet", str(store), "--width", "100", "--labels", "-o", str(both)]) == 0
    capsys.readouterr()
    one, two = np.asarray(Image.open(plain)), np.asarray(Image.open(both))
    assert (one.shape[1], two.shape[1]) == (112, 218)
    left, right = two[6:60, 6:106].astype(int), two[6:60, 112:212].astype(int)
    assert np.abs(left - one[6:60, 6:106]).max() == 0
    assert np.abs(left - right).mean() > 2


def test_wrong_axes_are_seen_in_the_figure(made):
    from dataclasses import replace

    from world2minecraft.minecraftocc.sample_figure import share_of_depth_in_cells

    turned = np.ascontiguousarray(made.occ.labels.transpose(1, 0, 2))
    wrong = replace(made, occ=replace(made.occ, labels=turned))
    assert share_of_depth_in_cells(made) > 0.999
    assert share_of_depth_in_cells(wrong) < 0.9


def test_samples_without_pictures_are_shown_too(made):
    from dataclasses import replace

    from world2minecraft.minecraftocc.sample_figure import draw_sample

    assert draw_sample(replace(made, colour=None, depth_m=None)).shape[2] == 3


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (["show", "{npz}", "house"], 2, "no sample is named 'house'"),
        (["show", "{npz}/none"], 3, "not found"),
        (["export", "{npz}", "--format", "nyuv2", "--out", "{out}"], 2, "did you mean 'nyu'?"),
        (["export", "{npz}", "--format", "npz"], 2, "missing option '--out'"),
        (
            ["export", "{npz}", "--format", "npz", "--out", "{out}", "--split", "test"],
            2,
            "no samples to export in split test",
        ),
        (["import", "{npz}", "--out", "{out}", "--split", "val"], 2, "has no sample in val"),
        (["import", "{out}", "--out", "{out}"], 3, "not found"),
    ],
)
def test_wrong_words_are_answered_in_one_line(words, code, text, npz, tmp_path, capsys):
    places = {"npz": npz, "out": tmp_path / "new"}
    assert w2m(["dataset", *(word.format(**places) for word in words)]) == code
    said = capsys.readouterr().err
    assert said.startswith("error: ") or "error: " in said
    assert text in said
