"""What follows a finished room: its report, and its world in a game that was found or chosen."""

import json
import shutil

import pytest
from forge_serving import client, served
from starlette.datastructures import Address
from starlette.requests import Request

from world2minecraft.core.errors import UsageError
from world2minecraft.sceneforge import game_folders
from world2minecraft.sceneforge.game_folders import GameFolders, list_folder, saves_folder


@pytest.fixture
def user(tmp_path, monkeypatch):
    """A user's folder without a game."""
    folder = tmp_path / "user"
    folder.mkdir()
    monkeypatch.setenv("HOME", str(folder))
    monkeypatch.setattr(game_folders, "games_here", dict)
    return folder


@pytest.fixture
def finished(small_run, tmp_path, user):
    """A server whose first recent room is finished."""
    shutil.copytree(small_run, tmp_path / "OUT")
    with served(home=tmp_path / "home") as server, client(server) as script:
        server.workspace.add_recent(tmp_path / "OUT")
        script.jobs = server.session.jobs
        yield script


def test_a_report_runs_apart_from_the_editor(finished, tmp_path):
    (tmp_path / "OUT" / "report.html").write_text("<p>a report</p>")
    answer = finished.get("/api/start/rooms/recent-0/report")
    assert answer.text == "<p>a report</p>"
    policy = answer.headers["content-security-policy"]
    assert policy.startswith("sandbox allow-scripts; default-src 'none'")
    assert "connect-src" not in policy and "allow-same-origin" not in policy
    page = finished.get("/")
    assert page.headers["content-security-policy"].startswith("default-src 'self'")


def test_a_world_goes_into_a_chosen_game_and_never_over_another(finished, user):
    game = user / "games" / ".minecraft"
    (game / "saves").mkdir(parents=True)
    assert finished.get("/api/exports").json()["games"] == []
    refused = finished.post("/api/start/rooms/recent-0/install", json={"game": "x"})
    assert "choose one of the listed" in refused.json()["error"]
    number = finished.post("/api/games", json={"folder": str(game)}).json()["id"]
    (offered,) = finished.get("/api/exports").json()["games"]
    assert offered["id"] == number and str(user) not in json.dumps(offered)
    for _ in range(2):
        answer = finished.post("/api/start/rooms/recent-0/install", json={"game": number})
        state = finished.jobs.wait(answer.json()["job"], 60)
        assert state.state == "done", state.note
    worlds = sorted(one.name for one in (game / "saves").iterdir())
    assert len(worlds) == 2 and worlds[0] in worlds[1]
    assert all((game / "saves" / name / "level.dat").is_file() for name in worlds)


def test_the_picker_walks_through_folders(finished, user):
    (user / "b" / "saves").mkdir(parents=True)
    (user / "a").mkdir()
    (user / "file").write_text("")
    home = finished.get("/api/folders").json()
    assert home["folder"] == str(user) and home["parent"] == str(user.parent)
    assert [one["name"] for one in home["folders"]] == ["a", "b"] and not home["is_game"]
    inner = finished.get("/api/folders", params={"in": home["folders"][1]["path"]}).json()
    assert inner["is_game"]
    missing = finished.get("/api/folders", params={"in": str(user / "file")})
    assert missing.status_code == 400 and "cannot read the folder" in missing.json()["error"]


def test_folders_are_for_the_user_of_this_machine_alone(finished, monkeypatch):
    monkeypatch.setattr(Request, "client", Address("10.0.0.7", 5000))
    for answer in (finished.get("/api/folders"), finished.post("/api/games", json={"folder": "/"})):
        assert answer.status_code == 400
        assert "on the computer that runs w2m" in answer.json()["error"]


@pytest.mark.parametrize("text", ["\0", "~none such", "/none such/x", "a" * 5000])
def test_paths_that_are_no_folders_are_refused(text):
    with pytest.raises(UsageError, match="cannot read the folder"):
        list_folder(text)


def test_the_folder_of_a_game_is_recognised(tmp_path):
    (tmp_path / "mc" / "saves" / "den").mkdir(parents=True)
    (tmp_path / "mc" / "saves" / "den" / "level.dat").write_bytes(b"")
    assert saves_folder(tmp_path / "mc") == tmp_path / "mc" / "saves"
    assert saves_folder(tmp_path / "mc" / "saves") == tmp_path / "mc" / "saves"
    (tmp_path / "worlds" / "den").mkdir(parents=True)
    assert saves_folder(tmp_path / "worlds") is None
    (tmp_path / "worlds" / "den" / "level.dat").write_bytes(b"")
    assert saves_folder(tmp_path / "worlds") == tmp_path / "worlds"
    assert saves_folder(tmp_path / "none") is None


def test_other_folders_are_refused_with_the_advice(tmp_path, user):
    folders = GameFolders(tmp_path / "home")
    (tmp_path / "home").mkdir()
    with pytest.raises(UsageError, match=r"choose the folder named \.minecraft"):
        folders.add(str(tmp_path))
    (tmp_path / "home" / "games.json").write_text('["/none such", 7]')
    assert folders.games() == {}


def test_a_room_is_shared_as_one_page(finished):
    answer = finished.post("/api/start/rooms/recent-0/share", json={"title": "Den & kitchen"})
    state = finished.jobs.wait(answer.json()["job"], 300)
    assert state.state == "done", state.note
    page = finished.get(f"/api/exports/files/{state.result['id']}")
    assert len(page.content) == state.result["bytes"] < 5_000_000
    assert 'filename="room.html"' in page.headers["content-disposition"]
    assert page.text.startswith("<!doctype html>") and "connect-src" in page.text
    assert "<title>Den &amp; kitchen" in page.text
