"""``w2m compare``: what it prints, and how it fails."""

import json

import pytest
from made_layouts import gpt_record, placed, shell, write
from tests.external_models.scripted_server import scripted

from world2minecraft import cli
from world2minecraft.api import comparison
from world2minecraft.cli.compare import options as option
from world2minecraft.paper.layouts.importers import PX_M


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


def test_scores_are_printed_as_json(layouts, capsys):
    assert cli.run(["compare", "layouts", *map(str, layouts), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told.keys() == {"LayoutGPT", "I-Design"}


def test_json_output_does_not_overwrite_a_layout(layouts, capsys):
    gpt, idesign = layouts
    before = gpt.read_bytes()
    assert cli.run(["compare", "layouts", "--json", str(gpt), str(idesign)]) == 2
    assert "--json would overwrite the layout" in capsys.readouterr().err
    assert gpt.read_bytes() == before


def test_the_default_pixel_is_that_of_layoutgpt():
    assert option.DEFAULT_PX_M == comparison.DEFAULT_PX_M == PX_M


def test_scenes_can_be_told_one_by_one(layouts, capsys):
    assert cli.run(["compare", "layouts", str(layouts[0]), "--scenes", "--markdown"]) == 0
    text = capsys.readouterr().out
    assert "| good | 1 | 1 | 0.000" in text and "| bad | 1 | 2 | 0.500" in text


def test_what_cannot_be_scored_is_said(layouts, tmp_path, capsys):
    assert cli.run(["compare", "layouts", str(tmp_path / "none.json")]) == 3
    assert capsys.readouterr().err.strip().endswith("none.json: not found")
    assert cli.run(["compare", "layouts", str(layouts[0]), "--px-m", "0"]) == 2
    assert "--px-m must be metres per pixel" in capsys.readouterr().err
    assert cli.run(["compare", "layouts", str(layouts[0]), "--truth", str(layouts[0])]) == 3
    assert "found 2 scenes, expected exactly one ground-truth scene" in capsys.readouterr().err


def test_what_is_left_out_is_told(tmp_path, capsys):
    record = gpt_record([("bed", 1, 1, 0.25, 1.6, 2, 0.5, 0)])
    record["object_list"] += [[f"thing {n}", {}] for n in range(7)]
    assert cli.run(["compare", "layouts", str(write(tmp_path / "a.json", [record]))]) == 0
    text = capsys.readouterr().out
    assert "note: skipped: room-1: thing 0: 'length' is missing" in text
    assert "note: ... and 2 more" in text


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A small bedroom of LayoutGPT as a world."""
    folder = tmp_path_factory.mktemp("built")
    bed = ("single_bed", 0.7, 1.1, 0.25, 1.0, 2.0, 0.5, 0.0)
    record = gpt_record([bed], unit="m", length=2.4, width=2.4, name="small room")
    path = write(folder / "gpt.json", [record, record])
    out = folder / "ROOM"
    assert cli.run(["compare", "build", str(path), "--out", str(out)]) == 0
    return out


def test_a_built_layout_is_a_world_and_keeps_its_boxes(built, capsys):
    assert (built / "build" / "world" / "level.dat").is_file()
    assert (built / "preview.png").is_file()
    assert cli.run(["compare", "layouts", str(built)]) == 0
    assert "LayoutGPT       1        1  0.000" in capsys.readouterr().out


def test_a_judge_sees_a_world_and_its_grades_are_kept(built, tmp_path, capsys):
    told = '{"why": "tidy", "realism": 7, "completeness": 4, "atmosphere": 6}'
    out = tmp_path / "JUDGED"
    with scripted([told, told, "no"]) as server:
        words = ["compare", "judge", str(built), "--agent", server.url, "--out", str(out)]
        assert cli.run([*words, "--repeats", "2"]) == 0
        assert len(server.requests) == 2
    text = capsys.readouterr().out
    assert "LayoutGPT       1  7.000 +- 0.000  4.000 +- 0.000  6.000 +- 0.000" in text
    kept = json.loads((out / "judged.json").read_text())
    assert kept["scenes"][0]["mean"]["realism"] == 7.0 and kept["scenes"][0]["unread"] == 0
    assert len(list((out / "pictures").glob("*.jpg"))) == 2


def test_a_layout_is_described(built, tmp_path, capsys):
    assert cli.run(["compare", "describe", str(built)]) == 0
    assert capsys.readouterr().out.startswith("A bedroom of 2.4 m from west to east")
    target = tmp_path / "room.json"
    words = ["compare", "describe", str(built), "--for", "layoutvlm", "--out", str(target)]
    assert cli.run(words) == 0
    assert json.loads(target.read_text())["boundary"]["wall_height"] == 2.6
    assert cli.run(["compare", "describe", str(built), "--for", "layoutvml"]) == 2
    assert cli.run([*words, "--agent", "gemini"]) == 2
    assert "photos, which contain no sizes" in capsys.readouterr().err
