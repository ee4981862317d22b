"""``w2m compare``: what it prints, and how it fails."""

import json

import pytest
from made_layouts import gpt_record, placed, shell, write

from world2minecraft import cli


@pytest.fixture
def layouts(tmp_path):
    """Two of LayoutGPT, one of which has a wardrobe in a bed, and one of I-Design."""
    bed = ("double_bed", 1.2, 2.0, 0.25, 1.6, 2.0, 0.5, 180.0)
    gpt = [
        gpt_record([bed], name="good"),
        gpt_record([bed, ("wardrobe", 1.2, 2.9, 1.0, 1.2, 0.6, 2.0, 0.0)], name="bad"),
    ]
    idesign = [*shell(), placed("bed_1", (1.2, 1.0, 0.25), (1.6, 2.0, 0.5))]
    lost = placed("lamp_1", (0, 0, 0), (1, 1, 1))
    del lost["position"]
    return (
        write(tmp_path / "gpt.json", gpt),
        write(tmp_path / "scene_graph.json", [*idesign, lost]),
    )


def test_layouts_are_scored_side_by_side(layouts, tmp_path, capsys):
    gpt, idesign = map(str, layouts)
    target = tmp_path / "out.json"
    assert cli.run(["compare", "layouts", gpt, idesign, "--truth", idesign, "--json",
                    str(target)]) == 0  # fmt: skip
    text = capsys.readouterr().out
    first = next(line.split() for line in text.splitlines() if line.startswith("LayoutGPT"))
    assert first[1:3] == ["2", "3"]
    assert f"next: w2m compare build {gpt} --out BUILT" in text
    told = json.loads(target.read_text())
    assert told["LayoutGPT"]["out_of_bounds"] == pytest.approx(1 / 3, abs=1e-4)
    assert told["LayoutGPT"]["collisions"] == 0.5
    assert told["I-Design"]["unplaced"] == 1
    assert told["I-Design"]["semantic_integrity"] == 1.0


def test_scenes_can_be_told_one_by_one(layouts, capsys):
    assert cli.run(["compare", "layouts", str(layouts[0]), "--scenes", "--markdown"]) == 0
    text = capsys.readouterr().out
    assert "| good | 1 | 1 | 0.000" in text and "| bad | 1 | 2 | 0.500" in text


def test_what_cannot_be_scored_is_said(layouts, tmp_path, capsys):
    assert cli.run(["compare", "layouts", str(tmp_path / "none.json")]) == 3
    assert capsys.readouterr().err.strip().endswith("none.json: is not there")
    assert cli.run(["compare", "layouts", str(layouts[0]), "--px-m", "0"]) == 2
    assert "--px-m is metres of a pixel" in capsys.readouterr().err
    assert cli.run(["compare", "layouts", str(layouts[0]), "--truth", str(layouts[0])]) == 3
    assert "holds 2 scenes; one is true" in capsys.readouterr().err


def test_what_is_left_out_is_told(tmp_path, capsys):
    record = gpt_record([("bed", 1, 1, 0.25, 1.6, 2, 0.5, 0)])
    record["object_list"] += [[f"thing {n}", {}] for n in range(7)]
    assert cli.run(["compare", "layouts", str(write(tmp_path / "a.json", [record]))]) == 0
    text = capsys.readouterr().out
    assert "note: left out: room-1: thing 0: 'length'" in text
    assert "note: ... and 2 more" in text
