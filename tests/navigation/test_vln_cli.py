"""``w2m vln run``, ``evaluate`` and ``table`` from end to end, in a small flat."""

import base64
import io
import json
from threading import Thread
from types import SimpleNamespace
from urllib.request import Request, urlopen

import numpy as np
import pytest
from PIL import Image
from tests.external_models.scripted_server import NO_SCHEMA, scripted
from vln_sets import next_action, next_view, write_pictures

from world2minecraft import cli
from world2minecraft.cli.vln.live_view import LineView, half_blocks, plain_text
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.landmarks import Landmark
from world2minecraft.navigation.records import read_episodes, write_items
from world2minecraft.navigation.running.item_evaluation import select_items
from world2minecraft.navigation.running.sentence_goals import find_named_landmark
from world2minecraft.navigation.running.trace import read_trace
from world2minecraft.navigation.scene import camera_of
from world2minecraft.navigation.types import Stance


def test_the_oracle_finds_the_piano_on_film(flat_path, tmp_path, capsys):
    out = tmp_path / "run"
    code = cli.run(["vln", "run", str(flat_path), "Go to the piano", "--out", str(out)])
    told = capsys.readouterr()
    assert code == 0 and f"w2m vln table {out}" in told.out
    result = json.loads((out / "result.json").read_text())
    assert result["summary"]["success_0.5m"]["share"] == 1 and result["summary"]["spl"] >= 0.95
    assert set(result["beside"]) == {"stop", "random", "oracle"}
    assert result["beside"]["oracle"]["spl"] == result["summary"]["spl"]
    assert result["beside"]["stop"]["success_0.5m"]["share"] == 0
    assert (out / "walk.mp4").read_bytes()[4:8] == b"ftyp"
    assert read_trace(out / "trace.jsonl")[-1]["end"] == "stopped"
    assert "oracle: Go to the piano" in told.err
    (episode,) = read_episodes(out)
    assert episode.goal_name == "upright piano"
    assert cli.run(["vln", "table", str(out)]) == 0
    assert capsys.readouterr().out.splitlines()[1].startswith("oracle")


def test_the_oracle_ends_with_its_eyes_on_the_goal(flat_path, flat, tmp_path):
    out = tmp_path / "run"
    words = ["vln", "run", str(flat_path), "Go to the piano", "--out", str(out), "--no-video"]
    assert cli.run(words) == 0
    (episode,) = read_episodes(out)
    last = Stance(**read_trace(out / "trace.jsonl")[-1]["stance"])
    x, _, z = episode.facing
    wanted = np.degrees(np.arctan2(-(x - last.x), z - last.z))
    assert abs((wanted - last.yaw_deg + 180) % 360 - 180) <= 7.5 + 1e-6
    seen = flat.picture(last, camera_of(64, 48, 79.0), outputs=("instance",)).instance
    assert (seen == flat.landmark("piano").number).mean() > 0.1


def test_a_person_walks_the_same_episode(flat_path, tmp_path, capsys, monkeypatch):
    """The keys of the oracle's moves, pressed on the page that the command opens."""
    first, second = tmp_path / "oracle", tmp_path / "human"
    words = ["vln", "run", str(flat_path), "Go to the piano", "--no-video", "--out"]
    assert cli.run([*words, str(first)]) == 0
    made = [move for one in read_trace(first / "trace.jsonl")[1:-1] for move, _ in one["made"]]
    keys = {"FORWARD": "w", "LEFT": "a", "RIGHT": "ArrowRight", "STOP": "%20"}

    def person(link):
        base, _, token = link.partition("/?token=")
        for move in made:
            asked = Request(f"{base}/key?token={token}&key={keys[move]}", method="POST")
            urlopen(asked, timeout=10).close()

    monkeypatch.setattr("webbrowser.open", lambda link: Thread(target=person, args=[link]).start())
    monkeypatch.setattr("webbrowser.get", lambda: None)  # Whatever this machine would open.
    assert cli.run([*words, str(second), "--agent", "human"]) == 0
    assert "walk here: http://127.0.0.1:" in capsys.readouterr().out
    one, other = (json.loads((run / "result.json").read_text()) for run in (first, second))
    assert other["agent"] == "human" and other["summary"] == one["summary"]
    assert len(list((second / "views").iterdir())) == len(made)


def test_a_model_is_shown_the_plan_and_small_pictures(flat_path, tmp_path):
    words = ["vln", "run", str(flat_path), "Go to the piano", "--no-video", "--model", "tiny"]
    with scripted(["Actions: FORWARD", "Actions: STOP"]) as server:
        more = ["--agent", server.url, "--map", "plan", "--max-pixels", "10000", "--history", "0"]
        assert cli.run([*words, *more, "--out", str(tmp_path / "run")]) == 0
        asked = list(server.requests)
    parts = asked[-1]["messages"][-1]["content"]
    urls = [part["image_url"]["url"] for part in parts if part["type"] == "image_url"]
    said = "".join(part.get("text", "") for part in parts)
    assert len(urls) == 2 and "A plan of the building" in said
    for url in urls:
        image = Image.open(io.BytesIO(base64.b64decode(url.partition(",")[2])))
        assert image.width * image.height <= 10_000


def test_a_model_is_recorded_and_replayed(flat_path, tmp_path, capsys):
    """A server that takes no schema, talks, and then stops: the same again without it."""

    def said(asked, number):
        if "response_format" in asked:
            return NO_SCHEMA
        return ["Hm, let me see.", "Actions: LEFT, FORWARD", "Actions: STOP"][min(number - 2, 2)]

    words = ["vln", "run", str(flat_path), "Go to the piano", "--no-video", "--model", "tiny"]
    with scripted(said) as server:
        first = tmp_path / "first"
        assert cli.run([*words, "--agent", server.url, "--out", str(first)]) == 0
        asked = len(server.requests)
        assert "5 requests and 0 recorded replies" in capsys.readouterr().out
        assert asked == 5  # Two refused forms, a bad reply, its repair, and STOP.
    result = json.loads((first / "result.json").read_text())
    assert result["agent"] == "tiny" and result["summary"]["invalid"] == 0
    again = tmp_path / "again"
    replay = ["--agent", "local", "--replay", str(first / "replies.jsonl"), "--out", str(again)]
    assert cli.run([*words, *replay]) == 0
    assert "0 requests and 3 recorded replies" in capsys.readouterr().out
    same = ("episodes.jsonl", "views/0001.jpg")
    assert all((first / name).read_bytes() == (again / name).read_bytes() for name in same)
    replayed = json.loads((again / "result.json").read_text())
    assert replayed["episodes"] == result["episodes"]
    assert replayed["cost"]["calls"] == 0
    other = [*words[:3], "Go to the red table", *words[4:], *replay]
    assert cli.run(other) == 3
    assert "no reply is recorded for question" in capsys.readouterr().err


def test_a_class_names_a_thing_that_no_noun_does():
    def landmark(noun, class_id):
        return Landmark(1, noun, noun, class_id, "", np.zeros(3), np.ones(3), "")

    desk, shelf = landmark("desk", SemanticClass.TABLE), landmark("bookcase", SemanticClass.FURN)
    scene = SimpleNamespace(landmarks=(desk, shelf), scene_id="study")
    assert find_named_landmark(scene, "Go to the table") is desk
    with pytest.raises(UsageError, match="no object of study matches"):
        find_named_landmark(scene, "Go to the furniture")
    table = landmark("table", SemanticClass.TABLE)
    scene.landmarks = (desk, shelf, table)
    assert find_named_landmark(scene, "Go to the table") is table


def test_words_of_the_vocabulary_name_what_a_design_shows():
    def landmark(noun, design):
        box = (np.zeros(3), np.ones(3))
        return Landmark(1, noun, noun, SemanticClass.CHAIR, "", *box, design)

    easy, seat = landmark("easy chair", "armchair_wing"), landmark("chair", "chair")
    scene = SimpleNamespace(landmarks=(easy, seat), scene_id="study")
    assert find_named_landmark(scene, "Go to the armchair") is easy
    assert find_named_landmark(scene, "Go to the recliner") is easy
    assert find_named_landmark(scene, "Go to the chair") is seat


def test_the_words_say_where_to_go(flat):
    for words in ("Walk past the red table to the PIANO.", "upright piano"):
        assert find_named_landmark(flat, words).name == "upright piano"
    assert find_named_landmark(flat, "Leave the piano and go to the table").noun == "table"
    with pytest.raises(
        UsageError, match=("no object of flat matches 'go home, pianos!'; known objects")
    ):
        find_named_landmark(flat, "Go home, pianos!")
    with pytest.raises(UsageError, match="'chair' matches 2 objects; use one of 'chair beside"):
        find_named_landmark(flat, "Go to the chair")


GOLDEN = [
    (["SCENE"], 2, 'error: INSTRUCTION is missing; for example: w2m vln run OUT "Go to the table"'),
    (["SCENE", "Go to the piano", "--agent", "oracl"], 2, "did you mean 'oracle'?"),
    (
        ["SCENE", "Go to the piano", "--start", "1,2"],
        2,
        "start must be X,Y,Z or X,Y,Z,YAW, got '1,2'",
    ),
    (
        ["SCENE", "Go to the piano", "--map", "globe"],
        2,
        "no map is named 'globe'; known: none, plan, text",
    ),
    (["SCENE", "Go to the piano", "--moves", "leap"], 2, "move set"),
    (["SCENE", "Go to the piano", "--agent", "gemini"], 2, "export GEMINI_API_KEY="),
    (["nowhere", "Go to the piano"], 3, "nowhere"),
]


@pytest.mark.parametrize(("words", "code", "text"), GOLDEN)
def test_what_is_wrong_is_told_in_a_line(
    words, code, text, flat_path, tmp_path, capsys, monkeypatch
):
    monkeypatch.delenv("GEMINI_API_KEY", raising=False)
    words = [str(flat_path) if word == "SCENE" else word for word in words]
    assert cli.run(["vln", "run", *words, "--out", str(tmp_path / "run")]) == code
    told = capsys.readouterr().err
    assert text in told and told.count("\n") == 1


def test_a_run_is_not_written_over_what_it_walks(tmp_path, capsys):
    kept = "not looked at"
    (tmp_path / "episodes.jsonl").write_text(kept)
    for scene in (tmp_path, tmp_path / "episodes.jsonl"):
        assert cli.run(["vln", "run", str(scene), "--out", str(tmp_path)]) == 2
        assert "would overwrite" in capsys.readouterr().err
    assert (tmp_path / "episodes.jsonl").read_text() == kept


def test_a_set_is_evaluated_and_told(tmp_path, capsys):
    items = [next_view("flat", step, "val_unseen") for step in (2, 3)]
    items += [next_action("flat", 7, "val_seen"), next_action("flat", 0, "train")]
    write_items(tmp_path / "items.jsonl", items)
    write_pictures(tmp_path, "flat")
    out = tmp_path / "run"
    with scripted(["A", "D", "D"]) as server:
        words = ["--agent", server.url, "--model", "tiny", "--out", str(out), "--training", "sft"]
        assert cli.run(["vln", "evaluate", str(tmp_path), *words]) == 0
        assert len(server.requests) == 3
        told = capsys.readouterr().out
        assert "50.0 [9, 91] n=2" not in told.splitlines()[0] and "tiny" in told
        assert cli.run(["vln", "evaluate", str(tmp_path), *words]) == 0  # From the record.
        assert len(server.requests) == 3
        assert "0 requests and 3 recorded replies" in capsys.readouterr().out
    result = json.loads((out / "result.json").read_text())
    rights = [item.answer == said for item, said in zip(items, "ADD", strict=False)]
    assert list(result["right"].values()) == [rights[i] for i in (2, 0, 1)]  # Sorted by name.
    assert cli.run(["vln", "table", str(out), str(out), "--markdown"]) == 0
    assert "| tiny | sft |" in capsys.readouterr().out


def test_baselines_are_evaluated_by_name(tmp_path, capsys):
    items = [next_view("flat", step, "val_unseen") for step in (2, 3)]
    items += [next_action("flat", step, "val_seen") for step in (0, 7)]
    items += [next_action("flat", step, "train") for step in (1, 2)]
    write_items(tmp_path / "items.jsonl", items)
    write_pictures(tmp_path, "flat")
    shares = {}
    for name, total in (("oracle", 4), ("majority", 4), ("repeat", 2), ("nearest", 2)):
        out = tmp_path / name
        words = ["vln", "evaluate", str(tmp_path), "--agent", name, "--out", str(out)]
        assert cli.run(words) == 0, name
        result = json.loads((out / "result.json").read_text())
        assert (len(result["right"]), result["training"]) == (total, "baseline")
        shares[name] = sum(result["right"].values()) / total
    assert shares["oracle"] == 1
    assert result["accuracy"].keys() == {"next_view"}
    capsys.readouterr()
    wrong = ["vln", "evaluate", str(tmp_path), "--agent", "majorty"]
    assert cli.run(wrong) == 2
    assert "no agent is named 'majorty'; did you mean 'majority'?" in capsys.readouterr().err
    wrong = ["vln", "evaluate", str(tmp_path), "--agent", "repeat", "--task", "next_view"]
    assert cli.run(wrong) == 2
    assert "cannot answer this task" in capsys.readouterr().err


def test_items_are_picked(tmp_path):
    items = [next_action("flat", step, "val_seen") for step in range(8)]
    assert select_items(items) == items
    drawn = select_items(items, count=3, seed=1)
    assert len(drawn) == 3 and drawn == select_items(items, count=3, seed=1)
    assert drawn == [item for item in items if item in drawn]
    with pytest.raises(UsageError, match="none of the 8 items has split train"):
        select_items(items, split="train")
    with pytest.raises(UsageError, match="no split is named 'tets'; did you mean 'test'"):
        select_items(items, split="tets")


def test_the_terminal_shows_no_commands_of_others():
    stream = io.StringIO()
    shown = LineView(stream)
    shown._say("a\x1b[2Jb\nc\u202ed")
    assert stream.getvalue() == "a [2Jb c d\n"
    assert plain_text("  12  LEFT") == "  12  LEFT"
    blocks = half_blocks(np.full((48, 64, 3), 200, np.uint8))
    assert blocks.plain.count("\u2580") == 64 * 24


def test_the_nearest_floor_is_where_one_begins(flat, flat_path, tmp_path):
    from world2minecraft.navigation.running.sentence_goals import GoalRequest, episode_of_sentence

    wish = GoalRequest("Go to the piano", start=Stance(3.1, 70.0, 3.2, 45.0))
    episode = episode_of_sentence(flat, wish)
    assert episode.start.yaw_deg == 45.0 and episode.start.y == pytest.approx(65.0)


def test_a_walk_does_not_begin_at_its_goal(flat):
    from world2minecraft.navigation.running.sentence_goals import (
        MIN_START_M,
        GoalRequest,
        episode_of_sentence,
    )

    for landmark in flat.landmarks:
        if not flat.goals_at(landmark):
            continue
        episode = episode_of_sentence(flat, GoalRequest("Go there", goal=landmark.name))
        away_m = flat.distance_m(episode.start.feet, episode.goals)
        farthest_m = max(d for d in flat.distances_m(episode.goals)[flat.main_places] if d < 1e9)
        assert away_m >= min(MIN_START_M, farthest_m) - 1e-6
