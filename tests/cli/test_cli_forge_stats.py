"""``w2m forge stats``: the paper's table, over scenes that were edited."""

import json

import numpy as np
import pytest

from world2minecraft.cli import run
from world2minecraft.sceneforge.document.effort_log import EffortLog, read_effort
from world2minecraft.sceneforge.editor import Editor


class Clock:
    now = 1000.0

    def __call__(self):
        return self.now


@pytest.fixture
def scene(tmp_path):
    labels = np.zeros((12, 10, 8), np.uint8)
    labels[:, :, 0] = 2
    np.save(tmp_path / "den.npy", labels)
    editor = Editor.open(tmp_path / "den.npy", clock=(clock := Clock()))
    for cell, class_id in ((80, 0), (80, 2), (160, 3)):
        clock.now += 2
        editor.do("set_cells", cells=[[cell, 1]], class_id=class_id, actor="a")
    clock.now += 2
    editor.undo()
    editor.close()
    return tmp_path / "den.npy"


TABLE = """\
mean of 1 scene, 1 from scratch
                                     from                        paper: from    paper:
                                  scratch      ours      less        scratch   refined
Total time (seconds)                 8.00      8.00      1.0x         482.00     70.38
  Automated process                    --        --        --             --      5.88
  Manual refinement                  8.00      8.00      1.0x         482.00     64.50
Total operations                     3.00      3.00      1.0x         340.00     24.50
  Addition actions                   1.00      1.00      1.0x         319.30      9.70
  Deletion actions                   1.00      1.00      1.0x             --      7.60
  Orientation adjustments            0.00      0.00        --          20.70      7.20
  Class changes                      1.00      1.00      1.0x             --        --
Undo steps (not counted)             1.00      1.00      1.0x             --        --
"""


def test_the_table_is_printed(scene, capsys):
    assert run(["forge", "stats", str(scene), "--scratch", f"{scene}.forge"]) == 0
    assert capsys.readouterr().out == TABLE


def test_a_line_for_each_scene_is_printed(scene, capsys):
    assert run(["forge", "stats", str(scene), str(scene), "--csv"]) == 0
    head, first, second = capsys.readouterr().out.splitlines()
    assert head.startswith("scene,operations,add,delete,orient,move,relabel,other,undone,redone")
    assert first == second == "den.npy,3,1,1,0,0,1,0,1,0,3,8.0,"


def test_everything_is_printed_as_json(scene, capsys):
    assert run(["forge", "stats", str(scene), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["scenes"][0]["by_kind"] == {"paint": 3} and told["mean"]["operations"] == 3
    assert told["scratch"] is None and told["paper"]["refined"]["operations"] == 24.5


def test_latex_is_that_of_the_paper(scene, capsys):
    assert run(["forge", "stats", str(scene), "--latex"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == r"\begin{tabular}{l c c c}" and lines[-1] == r"\end{tabular}"
    assert r"\textbf{Total operations$\downarrow$} & -- & 3.00 & -- \\" in lines
    assert all(line.count("&") in (0, 3) for line in lines)


def test_the_log_is_whole_after_its_lines_were_lost(scene, capsys):
    log = scene.with_name("den.npy.forge") / "effort.jsonl"
    lines = log.read_bytes().splitlines(keepends=True)
    log.write_bytes(b"".join(lines[:2]) + lines[2][:20])
    Editor.open(scene, clock=Clock()).close()
    run(["forge", "stats", str(scene), "--csv"])
    assert capsys.readouterr().out.splitlines()[1].startswith("den.npy,3,1,1,0,0,1,0,1,0,3,8.0")
    again = log.read_bytes().splitlines(keepends=True)
    assert again[:5] == lines[:5] and len(again) == 6


@pytest.mark.parametrize(
    ("words", "code", "reason"),
    [
        (["nowhere"], 3, "nowhere: no edits found; open the scene with w2m forge first"),
        (["nowhere", "--csv", "--json"], 2, "use only one of"),
    ],
)
def test_what_cannot_be_told_is_said(tmp_path, monkeypatch, capsys, words, code, reason):
    monkeypatch.chdir(tmp_path)
    assert run(["forge", "stats", *words]) == code
    assert reason in capsys.readouterr().err


def test_damaged_lines_of_a_log_are_skipped(tmp_path):
    good = {"step": "do", "time_s": 5.0, "cells": 2, "rev": 1, "kind": "paint", "counts_as": "add"}
    damaged = [{"class_id": [1]}, {"cells": "x"}, {"time_s": None}, {"step": []}, {"rev": {}}]
    lines = [good, good | {"class_id": 4}, *(good | one for one in damaged), 7]
    text = "\n".join(map(json.dumps, lines)) + "\n{"
    (tmp_path / "effort.jsonl").write_text(text)
    assert read_effort(tmp_path) == lines[:2]


def test_a_log_goes_on_after_a_damaged_line(tmp_path):
    good = {"step": "do", "time_s": 5.0, "cells": 2, "rev": 3, "kind": "paint", "counts_as": "add"}
    damaged = {"step": "active", "time_s": 6.0, "rev": "x"}
    (tmp_path / "effort.jsonl").write_text(f"{json.dumps(good)}\n{json.dumps(damaged)}\n")
    assert EffortLog(tmp_path).last_rev == 3
