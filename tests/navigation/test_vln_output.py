"""JSON output of navigation verbs, and the live view of a walk."""

import dataclasses
import io
import json

import pytest
from tests.navigation.vln_sets import small_set

from world2minecraft import cli
from world2minecraft.api.agents import ModelOptions, compare_runs, run_agent
from world2minecraft.api.navigation import build_navigation_set
from world2minecraft.cli import model_options
from world2minecraft.cli.vln.live_view import live_view
from world2minecraft.core.errors import UsageError
from world2minecraft.core.locks import Lock
from world2minecraft.navigation.agents.types import Decision
from world2minecraft.navigation.types import Move


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return small_set(tmp_path_factory.mktemp("set"))


def printed(words, capsys):
    """What a verb prints, which has to be one JSON document."""
    assert cli.run([str(word) for word in words]) == 0
    return json.loads(capsys.readouterr().out)


def test_stats_prints_json(folder, capsys):
    figures = printed(["vln", "stats", folder, "--no-baselines", "--json"], capsys)
    assert {"characters", "splits", "letters", "leaks"} <= figures.keys()
    assert figures["baselines"] == []


def test_evaluate_and_table_print_json(folder, tmp_path, capsys):
    out = tmp_path / "run"
    words = ["vln", "evaluate", folder, "--agent", "oracle", "-o", out, "--split", "all"]
    result = printed([*words, "--json"], capsys)
    assert result["agent"] == "oracle" and result["cost"] is None
    assert result["accuracy"]["next_view"]["combined"]["share"] == 1
    told = printed(["vln", "table", out, out, "--json"], capsys)
    assert [one["training"] for one in told["results"]] == ["baseline", "baseline"]
    assert told["paired"][0]["only_one_right"] == "0" and "right" not in told["results"][0]
    assert cli.run(["vln", "table", str(out), "--json", "--markdown"]) == 2


class Turner:
    """An agent of a user's own: it turns once and stops."""

    name, is_privileged, is_blind = "turner", False, True

    def __init__(self):
        self.step = 0

    def begin(self, task):
        self.step = 0

    def decide(self, sight):
        self.step += 1
        return Decision((Move.LEFT if self.step == 1 else Move.STOP,))


def test_an_agent_of_a_user_is_run_and_watched(flat_path, tmp_path):
    stream, notes = io.StringIO(), []
    with live_view(stream, on_begin=lambda: notes.append("once")) as shown:
        walked = run_agent(
            flat_path, "Go to the piano", agent=Turner(), out=tmp_path / "run", video=False,
            observers=[shown],
        )  # fmt: skip
    assert notes == ["once"] and "turner: Go to the piano" in stream.getvalue()
    assert walked.summary["steps"] == 2 and walked.cost == {} and walked.model == ""
    assert repr(walked).endswith("turner, 1 walks)")
    assert (walked.walk_folder() / "trace.jsonl").is_file()
    assert [row[0] for row in compare_runs([walked.folder]).walks][1:3] == ["turner", "stop"]


def test_a_display_starts_with_the_first_walk(flat_path, tmp_path):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    stream = Terminal()
    with live_view(stream) as shown:
        assert stream.getvalue() == ""
        run_agent(
            flat_path, "Go to the piano", agent="stop", out=tmp_path / "run", video=False,
            observers=[shown],
        )  # fmt: skip
    assert "Go to the piano" in stream.getvalue()


@pytest.mark.parametrize("start", [(1, 2), (1, 2, float("nan")), (1, 2, 3, 4, 5)])
def test_a_start_has_three_or_four_finite_numbers(flat_path, tmp_path, start):
    with pytest.raises(UsageError, match="start must be X,Y,Z or X,Y,Z,YAW"):
        run_agent(flat_path, "Go to the piano", start=start, out=tmp_path)


def test_a_size_is_checked_before_any_work(flat_path, tmp_path):
    with pytest.raises(
        UsageError, match="size must be WIDTHxHEIGHT, 16 to 4096 pixels each, got 8x8"
    ):
        build_navigation_set([flat_path], tmp_path / "set", size=(8, 8))
    assert not (tmp_path / "set").exists()


def test_the_command_has_the_defaults_of_the_api():
    assert model_options.DEFAULTS.value() == ModelOptions()
    cold = dataclasses.replace(model_options.DEFAULTS, temperature=-1.0)
    assert cold.value().temperature is None


@pytest.mark.parametrize("verb", ["run", "evaluate"])
def test_results_of_somebody_else_are_left_alone(verb, folder, flat_path, tmp_path, capsys):
    out, own = tmp_path / "mine", "answers.jsonl" if verb == "evaluate" else "trace.jsonl"
    out.mkdir()
    (out / own).write_text("mine")
    words = {
        "run": [str(flat_path), "Go to the piano", "--no-video"],
        "evaluate": [str(folder), "--agent", "oracle", "--split", "all"],
    }[verb]
    words = ["vln", verb, *words, "--out", str(out)]
    assert cli.run(words) == 2
    error = capsys.readouterr().err
    assert f"contains other files ({own}); choose another folder, or use --force" in error
    assert [path.name for path in out.iterdir()] == [own] and (out / own).read_text() == "mine"
    assert cli.run([*words, "--force"]) == 0
    assert (out / own).read_text() != "mine"
    assert cli.run(words) == 0  # It is the program's own now.
    lock = Lock(out / ".lock", "written")
    lock.acquire()
    assert cli.run(words) == 3 and "is being written by process" in capsys.readouterr().err
    lock.release()
