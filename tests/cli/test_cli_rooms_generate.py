"""``w2m rooms generate``: what it writes, and words that do not go together."""

import pytest

from world2minecraft import cli
from world2minecraft.core.files import read_json
from world2minecraft.procgen import read_generated


def test_a_room_is_written_and_can_be_read_back(tmp_path, capsys):
    out = tmp_path / "made"
    words = ["rooms", "generate", "--seed", "3", "--kind", "bathroom", "--out", str(out)]
    assert cli.run(words) == 0
    assert {path.name for path in out.iterdir()} == {"layout.json", "preview.png", "truth.npz"}
    assert read_generated(out).kind == "bathroom"
    shown = capsys.readouterr()
    assert f"next   w2m rooms scan {out} --out capture" in shown.out
    assert "Writing files: done" in shown.err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--kind", "kitchn"], "no room kind is named 'kitchn'; did you mean 'kitchen'?"),
        (["--shape", "round"], "no room shape is named 'round'; known: box, columns, cut, ell"),
        (["--rooms", "5"], "--rooms and --storeys apply to a house; add --house"),
        (
            ["--house", "--kind", "bed"],
            "--kind and --shape apply to a single room; omit them or --house",
        ),
        (["--house", "--rooms", "2"], "rooms must be from 3 to 14 on 1 storey, got 2"),
        (["--house", "--storeys", "0"], "storeys must be 1 or 2, got 0"),
        (["--seed", "-1"], "seed must be 0 or more, got -1"),
        (["--furnishing", "fll"], "no furnishing is named 'fll'; did you mean 'full'?"),
        (["--clutter", "2"], "clutter must be from 0 to 1, got 2.0"),
    ],
)
def test_words_that_cannot_be_are_refused_in_one_line(tmp_path, capsys, words, message):
    out = tmp_path / "made"
    assert cli.run(["rooms", "generate", *words, "--out", str(out)]) == 2
    assert message in capsys.readouterr().err


def test_houses_become_worlds(tmp_path, capsys):
    out = tmp_path / "worlds"
    words = ["rooms", "generate", "--houses", "1", "--seed", "3", "--style", "polar"]
    assert cli.run([*words, "--worlds", str(out)]) == 0
    assert {path.name for path in (out / "house_0001").iterdir()} == {
        "world", "scene.json", "scene.npz", "designs.json", "layout.json", "house.json",
    }  # fmt: skip
    assert read_json(out / "house_0001" / "house.json")["style"] == "polar"
    assert f"play   w2m install {out / 'house_0001'}" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--houses", "2"], "--houses N and --worlds DIR must be used together"),
        (["--houses", "1", "--worlds", "W", "--furnishing", "full"], "--furnishing; omit it"),
        (["--houses", "0", "--worlds", "W"], "houses must be 1 or more, got 0"),
        (
            ["--houses", "1", "--worlds", "W", "--rooms", "5"],
            "--houses cannot be combined with --kind",
        ),
        (["--houses", "1", "--worlds", "W", "--style", "retrro"], "did you mean 'retro'?"),
        (["--houses", "1", "--worlds", "W", "--seed", "-1"], "seed must be 0 or more, got -1"),
    ],
)
def test_words_of_worlds_are_checked(tmp_path, monkeypatch, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    assert cli.run(["rooms", "generate", *words]) == 2
    assert message in capsys.readouterr().err
    assert not list(tmp_path.rglob("level.dat"))
