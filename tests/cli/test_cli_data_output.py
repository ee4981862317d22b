"""``--json`` on the screen, and output folders by position or with ``-o``, of the data verbs."""

import json

import pytest
from tests.minecraftocc.samples import random_labels, sample

from world2minecraft import cli
from world2minecraft.cli.json_output import complete_json_option
from world2minecraft.cli.verbs import load
from world2minecraft.minecraftocc.store import write_store


@pytest.fixture
def data(tmp_path):
    samples = sorted(
        (sample(n, "house_0", random_labels(n)) for n in range(2)), key=lambda s: s.key
    )
    write_store(tmp_path / "data", samples)
    return str(tmp_path / "data")


def test_stats_print_one_json_document(data, capsys):
    assert cli.run(["dataset", "stats", data, "--json", "-j", "1"]) == 0
    assert json.loads(capsys.readouterr().out)["pictures"] == 2


def test_verify_prints_one_json_document(data, tmp_path, capsys):
    assert cli.run(["dataset", "verify", data, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["samples"] == 2 and found["faults"] == []
    (tmp_path / "data" / "stray.txt").write_text("x")
    assert cli.run(["dataset", "verify", data, "--json"]) == 3
    assert json.loads(capsys.readouterr().out)["faults"] == ["stray.txt: unexpected file"]


def test_json_takes_the_file_that_follows_it():
    options = load("dataset stats").params
    for words, wanted in (
        (["D", "--json"], ["D", "--json=-"]),
        (["--json", "--split", "train", "D"], ["--json=-", "--split", "train", "D"]),
        (["D", "--json", "a.json"], ["D", "--json", "a.json"]),
        (["D", "--json", "-"], ["D", "--json", "-"]),
        ([], []),
    ):
        assert complete_json_option(words, options) == wanted
    plain = load("dataset verify").params
    assert complete_json_option(["D", "--json"], plain) == ["D", "--json"]


@pytest.mark.parametrize("verb", ["build", "rooms"])
def test_the_output_is_given_once(verb, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.run(["dataset", verb]) == 2
    assert "the output is missing; add DIR or --out DIR" in capsys.readouterr().err
    assert cli.run(["dataset", verb, "A", "-o", "B"]) == 2
    assert "the output is given twice; omit DIR or --out" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_data_set_is_built_with_out(tmp_path):
    words = ["dataset", "rooms", "-o", str(tmp_path / "P"), "--rooms", "2", "--images", "2"]
    assert cli.run([*words, "--size", "64x48"]) == 0
    assert (tmp_path / "P" / "dataset.json").is_file()
