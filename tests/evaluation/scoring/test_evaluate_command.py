"""``w2m evaluate reconstruction``: its tables, its file, its errors."""

import json
import shutil

import numpy as np
import pytest

from world2minecraft.cli import run as w2m
from world2minecraft.cli.evaluate.reconstruction import next_step, score_rows, stage_table
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.files import read_json, write_json
from world2minecraft.evaluation.scoring import evaluate_reconstruction
from world2minecraft.reconstruction.run_folder import hash_capture


def test_the_table_and_the_file_hold_the_scores(perfect, capture, tmp_path, capsys):
    file = tmp_path / "scores.json"
    words = ["evaluate", "reconstruction", str(perfect), str(capture), "--json", str(file)]
    assert w2m(words) == 0
    text = capsys.readouterr().out
    for line in ("IoU, exact", "object F1 (precision, recall)", "1.000 (1.000, 1.000)", "0.9 to 1"):
        assert line in text
    assert text.rstrip().endswith(f"next: w2m evaluate reconstruction {perfect} {capture} --stages")
    assert json.loads(file.read_text()) == json.loads(
        json.dumps(evaluate_reconstruction(perfect, capture))
    )


def test_known_openings_and_placements_are_in_the_table(perfect, capture):
    facts = evaluate_reconstruction(perfect, capture)
    names = dict(score_rows(facts))
    assert "collisions" not in names and "poses, stated" in names
    rates = {"f1": 0.5, "precision": 1.0, "recall": 0.333}
    layout = {"collisions": 2, "out_of_bounds": 1, "semantic_integrity": 0.5}
    names = dict(score_rows(facts | {"openings": rates, "layout": layout}))
    assert names["openings F1 (precision, recall)"] == "0.500 (1.000, 0.333)"
    assert names["collisions"] == "2"


def test_objects_are_not_scored_against_a_truth_without_any(perfect, capture):
    facts = evaluate_reconstruction(perfect, capture)
    names = dict(score_rows(facts | {"objects": facts["objects"] | {"true": 0}}))
    assert names["objects"] == "not scored: the ground truth has none in view"
    assert not [name for name in names if "object F1" in name or name == "  Chair"]


def test_another_methods_labels_are_scored_by_the_same_verb(capture, tmp_path, capsys):
    np.savez(tmp_path / "labels.npz", labels=np.zeros((2, 2, 2), np.uint8))
    words = ["evaluate", "reconstruction", str(tmp_path), str(capture)]
    assert w2m(words) == 0
    text = capsys.readouterr().out
    assert "IoU, exact" in text and "0 of 1, 0 found" in text
    assert "confidence" not in text and "next:" not in text
    assert w2m([*words, "--stages"]) == 2
    assert "was not created by w2m reconstruct" in capsys.readouterr().err


def test_the_stages_are_rows_after_the_run_itself(perfect, capture):
    facts = evaluate_reconstruction(perfect, capture)
    table = stage_table(facts | {"stages": {"fusion": facts}})
    assert list(table.columns[0].cells) == ["none", "fusion"]
    last = f"next: open {perfect / 'report.html'} in a browser"
    assert next_step(perfect, capture, True) == last


def test_the_truth_of_another_room_is_refused(perfect, capture, tmp_path, capsys):
    other = tmp_path / "other"
    shutil.copytree(capture, other)
    arrays = dict(np.load(other / "truth.npz"))
    arrays["truth_room_to_scan"] = arrays["truth_room_to_scan"] @ rotation_about_z(60.0)
    np.savez(other / "truth.npz", **arrays)
    assert w2m(["evaluate", "reconstruction", str(perfect), str(other)]) == 3
    text = " ".join(capsys.readouterr().err.split())
    assert "is the ground truth of another room" in text
    assert "use the capture that the run was made from" in text
    # The run states that it was made from this capture: it is bad, and is scored.
    manifest = read_json(perfect / "manifest.json") | {"capture": hash_capture(other)}
    run = tmp_path / "run"
    shutil.copytree(perfect, run)
    write_json(run / "manifest.json", manifest)
    assert w2m(["evaluate", "reconstruction", str(run), str(other)]) == 0


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ("nothing", "folder not found; create it with w2m reconstruct CAPTURE --out OUT"),
        ("empty", "does not contain scan.json; finish the run: w2m reconstruct CAPTURE --out "),
        ("no truth", "truth.npz: ground truth not found; w2m rooms scan writes it"),
    ],
)
def test_what_is_missing_is_named_with_what_to_do(what, message, perfect, tmp_path, capsys):
    out = {"nothing": tmp_path / "none", "empty": tmp_path, "no truth": perfect}[what]
    assert w2m(["evaluate", "reconstruction", str(out), str(tmp_path)]) == 3
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
