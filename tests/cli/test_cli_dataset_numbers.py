"""``w2m dataset stats`` and ``w2m dataset quality``."""

import json

import numpy as np
import pytest
from PIL import Image
from tests.minecraftocc.samples import random_labels, sample

from world2minecraft.cli import run
from world2minecraft.minecraftocc.store import write_store


@pytest.fixture
def data(tmp_path):
    samples = [sample(n, f"house_{n % 2}", random_labels(n)) for n in range(4)]
    samples.sort(key=lambda one: one.key)
    write_store(tmp_path / "data", samples)
    return tmp_path / "data"


def test_stats_print_the_table_and_write_all_that_is_asked_for(data, tmp_path, capsys):
    words = ["dataset", "stats", str(data), "--jobs", "1", "--json", str(tmp_path / "s.json")]
    words += ["--latex", str(tmp_path / "s.tex"), "--plots", str(tmp_path / "plots")]
    assert run(words) == 0
    text = capsys.readouterr().out
    assert "MinecraftOcc (paper)  100,165     156  ~1,000    1,452      733,280,256" in text
    assert "next   w2m dataset quality" in text
    assert json.loads((tmp_path / "s.json").read_text())["pictures"] == 4
    assert r"\toprule" in (tmp_path / "s.tex").read_text()
    assert (tmp_path / "plots" / "classes.png").is_file()


def test_quality_prints_the_papers_rows_and_writes_json(tmp_path, capsys):
    rng = np.random.default_rng(0)
    for n in range(3):
        picture = rng.integers(0, 256, (200, 200, 3)).astype(np.uint8)
        Image.fromarray(picture).save(tmp_path / f"{n}.png")
    words = ["dataset", "quality", str(tmp_path), "--sample", "2", "--variant", "own"]
    assert run([*words, "--resize", "none", "--json", str(tmp_path / "q.json")]) == 0
    text = capsys.readouterr().out
    assert "9.97" in text and "274,305" in text and "note: LV changes by hundreds" in text
    assert "from   2 of 3 images" in text
    assert json.loads((tmp_path / "q.json").read_text())["rows"][0]["pictures"] == 2


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (
            ["stats", "{tmp}"],
            3,
            "not a data set: dataset.json not found; create a data set",
        ),
        (["stats", "{data}", "--split", "val"], 2, "has no split 'val'; known splits"),
        (["quality", "{tmp}/none"], 3, "not a data set and not a folder of images"),
        (["quality", "{data}"], 3, "has labels but no image"),
        *(
            (["quality", "{tmp}", "--resize", text], 2, "--resize must be WIDTHxHEIGHT")
            for text in ("640", "x480", "axb", "640x480x2", "")
        ),
        (["quality", "{tmp}", "--variant", "matlab"], 2, "no NIQE variant is named 'matlab'"),
        (["quality", "{tmp}", "--variant", "no.mat"], 3, "no.mat: cannot be read"),
    ],
)
def test_what_goes_wrong_is_one_line(data, tmp_path, capsys, words, code, said):
    filled = [word.format(tmp=tmp_path, data=data) for word in words]
    assert run(["dataset", *filled]) == code
    lines = capsys.readouterr().err.strip().splitlines()
    assert lines[-1].startswith("error: ") and said in lines[-1]


@pytest.mark.parametrize("verb", ["stats", "quality"])
def test_help_shows_examples(verb, capsys):
    assert run(["dataset", verb, "--help"]) == 0
    assert f"w2m dataset {verb} DATA" in capsys.readouterr().out
