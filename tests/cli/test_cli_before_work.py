"""What can be known to be wrong is said at once, in one line with its exit code."""

from pathlib import Path

import pytest

from world2minecraft import cli
from world2minecraft.core.errors import UnknownNameError

WORDS = [
    ("demo --seed -1", 2, "seed must be 0 or more, got -1"),
    ("demo --frames 1", 2, "frames must be 3 or more, got 1; try 40"),
    ("demo --palette nordc", 2, "no palette is named 'nordc'; known: "),
    ("demo --palette no.yaml", 3, "no.yaml: "),
    ("reconstruct scan --out OUT --palette vanila", 2, "did you mean 'vanilla'?"),
    ("reconstruct scan --out OUT --from reprt", 2, "did you mean 'report'?"),
    ("build room.npz --out OUT --air some", 2, "air must be one of room, box, none, got 'some'"),
    ("build room.npz --out OUT --air none", 2, "--air requires --into WORLD or --rcon"),
    ("build room.npz --out OUT --new-chunks", 2, "--new-chunks requires --into WORLD"),
    ("build room.npz --into W --at 1 2", 2, "requires 3 arguments; see w2m build --help"),
    ("clean OUT --undo 0", 2, "see w2m clean --help"),
    ("undo nowhere --list", 3, "nowhere: is not a world folder: level.dat not found"),
    ("dataset build D --houses 1 --hour 99", 2, "hour must be 0 to 24, got 99"),
    ("dataset build D --houses 1 --seed -1", 2, "seed must be 0 or more, got -1"),
    ("dataset build D --houses 2 --preset 9k", 2, "no preset is named '9k'"),
    ("dataset tour W --seed -1", 2, "seed must be 0 or more, got -1"),
    ("dataset sheet tour.jsonl --world W", 3, "tour.jsonl: not found"),
    ("dataset sheet tour.jsonl --world W --hour nan", 2, "hour must be 0 to 24, got nan"),
    ("vln run OUT Go --chunk 9", 2, "see w2m vln run --help"),
]


@pytest.mark.parametrize(("words", "code", "line"), WORDS)
def test_wrong_options_are_refused_before_any_work(
    words, code, line, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert cli.run(words.split()) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert line in err
    assert err.count("\n") == 1
    assert not list(Path().iterdir())


def test_a_world_without_steps_says_so_when_they_are_listed(tmp_path, capsys):
    (tmp_path / "level.dat").write_bytes(b"")
    assert cli.run(["undo", str(tmp_path), "--list"]) == 0
    told = f"{tmp_path}: no build by World2Minecraft to undo.\n"
    assert capsys.readouterr().out == told


def test_of_very_many_names_an_error_tells_the_first():
    names = [f"name{number:03}" for number in range(170)]
    told = str(UnknownNameError("thing", "other", names))
    assert told.endswith("name018, name019 and 150 more")
    assert len(told) < 300
