"""Every form comes out of the scene as it is edited, and readers of others read it."""

import csv
import io
import json
import zipfile
from pathlib import Path

import nbtlib
import numpy as np
import pytest
from forge_serving import client, served
from PIL import Image

from world2minecraft.core.files import read_json
from world2minecraft.formats.paper_json import read_occ_json
from world2minecraft.formats.run_arrays import read_room
from world2minecraft.formats.volume_formats import read_volume, writable_format_names
from world2minecraft.minecraft.worlds.launchers import Game
from world2minecraft.minecraft.worlds.world_writer import read_world
from world2minecraft.reconstruction.file_stages import built_volume
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.export_options import (
    export_forms,
    stats_csv,
    worlds_of,
    write_data,
    write_snapshot,
)
from world2minecraft.sceneforge.jobs.worker import TASKS
from world2minecraft.sceneforge.server import export_routes


@pytest.fixture(scope="module")
def editor(small_run):
    """The small run with one edit that was never saved: a cell of the floor became a table."""
    editor = Editor.open(small_run)
    first = int(np.flatnonzero(editor.draft.labels.ravel() == 2)[0])
    editor.do("set_cells", cells=[[first, 1]], class_id=8)
    return editor


@pytest.fixture
def apart(editor, tmp_path, monkeypatch):
    """A script of a server whose work is done in processes of their own."""
    monkeypatch.setenv("HOME", str(tmp_path / "user"))
    (tmp_path / "user" / ".minecraft" / "saves").mkdir(parents=True)
    with served(editor, home=tmp_path / "home") as server, client(server) as script:
        script.jobs, script.workspace = server.session.jobs, server.workspace
        yield script


@pytest.fixture
def script(apart, monkeypatch):
    """The same, but the work is done here: a process takes seconds to begin."""

    def here(task, within=None, **needs):
        return lambda report: TASKS.load(task)(progress=report, **needs)

    monkeypatch.setattr(export_routes, "run_in_subprocess", here)
    return apart


def ended(script, path, **told):
    answer = script.post(path, json=told)
    assert answer.status_code == 200, answer.text
    state = script.jobs.wait(answer.json()["job"], 300)
    assert state.state == "done", state.note
    return state.result


def exported(script, form, **choice) -> tuple[str, bytes, list]:
    result = ended(script, "/api/exports", form=form, **choice)
    answer = script.get(f"/api/exports/files/{result['id']}")
    assert f'filename="{result["file"]}"' in answer.headers["content-disposition"]
    assert len(answer.content) == result["bytes"] > 0
    return result["file"], answer.content, result["lost"]


def test_every_form_that_is_written_is_offered():
    offered = {one.id for one in export_forms()}
    assert set(writable_format_names()) <= offered
    assert {"world", "png", "npz", "occ", "centers", "stats"} <= offered


def test_a_snapshot_is_the_scene_as_it_is_edited(editor, tmp_path):
    write_snapshot(editor, tmp_path)
    grid = read_room(tmp_path / "room.npz")[0]
    assert np.array_equal(grid.labels, editor.draft.labels)
    assert len(read_json(tmp_path / "objects.json")) == len(editor.draft.objects)
    assert not np.array_equal(grid.labels, read_room(editor.opened.folder / "room.npz")[0].labels)


def test_data_files_hold_the_edited_scene(editor, tmp_path):
    cells = read_occ_json(write_data(editor, "occ", tmp_path)).labels
    assert np.array_equal(cells, editor.draft.labels * (editor.draft.labels < 255))
    centres = json.loads(write_data(editor, "centers", tmp_path).read_text())["centers"]
    assert [row["id"] for row in centres] == sorted(editor.draft.objects)
    rows = list(csv.DictReader(io.StringIO(stats_csv(editor))))
    assert [int(row["cells"]) for row in rows] == editor.draft.counts[:12].tolist()
    assert sum(int(row["objects"]) for row in rows) == len(editor.draft.objects)


def test_a_schematic_is_read_by_another_program(apart, editor, tmp_path):
    name, data, lost = exported(apart, "schem", blocks_per_metre=2)
    assert name == "room.schem" and [what for what, _ in lost if "labels" in what] == [
        "labels of blocks (class and object)"
    ]
    (tmp_path / name).write_bytes(data)
    read = nbtlib.load(tmp_path / name)
    write_snapshot(editor, tmp_path / "snapshot")
    from world2minecraft.reconstruction.parameters import Parameters

    volume = built_volume(tmp_path / "snapshot", Parameters(blocks_per_metre=2))
    size = (int(read["Width"]), int(read["Height"]), int(read["Length"]))
    assert size == volume.states.shape


def test_a_world_comes_zipped_with_its_level(script, tmp_path):
    name, data, _ = exported(script, "world", blocks_per_metre=1)
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert "world/level.dat" in archive.namelist()
        archive.extractall(tmp_path / "out")
    assert name == "room_world.zip"
    assert (read_world(tmp_path / "out" / "world").states > 0).sum() > 100


def test_a_model_and_a_picture_are_what_they_say(script, tmp_path):
    name, data, _ = exported(script, "glb", blocks_per_metre=1)
    assert name == "room.glb" and data[:4] == b"glTF"
    (tmp_path / name).write_bytes(data)
    assert (read_volume(tmp_path / name).states > 0).any()
    name, data, _ = exported(script, "png", blocks_per_metre=1)
    assert Image.open(io.BytesIO(data)).size == (1280, 960)


def test_what_is_edited_comes_out_as_data_over_http(script, editor):
    name, data, lost = exported(script, "npz")
    arrays = np.load(io.BytesIO(data), allow_pickle=False)
    assert (name, lost) == ("room.npz", [])
    assert np.array_equal(arrays["labels"], editor.draft.labels)


def test_a_room_is_installed_twice_and_nothing_overwritten(script, tmp_path):
    games = script.get("/api/exports").json()["games"]
    assert [game["name"] for game in games] == ["Minecraft launcher"]
    assert str(tmp_path) not in json.dumps(games)
    key = {"game": games[0]["id"], "name": "Den", "blocks_per_metre": 1}
    assert ended(script, "/api/install", **key)["name"] == "Den"
    assert ended(script, "/api/install", **key)["name"] == "Den (2)"
    saves = tmp_path / "user" / ".minecraft" / "saves"
    assert sorted(path.name for path in saves.iterdir()) == ["Den", "Den (2)"]
    worlds = script.get("/api/exports").json()["worlds"]
    assert [world["name"] for world in worlds] == ["Den", "Den (2)"]
    built = ended(
        script, "/api/build/world", world=worlds[0]["id"], at=[40, 70, 40], blocks_per_metre=1
    )
    assert built["changed"] and built["blocks"] > 100


@pytest.mark.parametrize(
    ("path", "told", "words"),
    [
        ("/api/exports", {"form": "exe"}, "no export is named 'exe'"),
        ("/api/exports", {"form": "../x"}, "no export is named '../x'"),
        ("/api/exports", {"form": "schem", "out": "/etc"}, "unknown option 'out'"),
        ("/api/exports", {"form": "schem", "mc_version": "9"}, "9"),
        (
            "/api/install",
            {"game": "/home/me/saves"},
            "choose one of the listed Minecraft installations",
        ),
        ("/api/build/world", {"world": "/home/me/world"}, "choose one of the listed worlds"),
        ("/api/build/server", {"address": "a b", "password": "x"}, "must be HOST:PORT"),
        ("/api/build/server", {"address": "localhost"}, "the RCON password"),
        ("/api/build/server", {"address": "localhost", "password": "x"}, "at must be three"),
        (
            "/api/build/server",
            {"address": "localhost", "password": "x", "at": [0, 0, 1e9]},
            "at must be three",
        ),
    ],
)
def test_wrong_wishes_begin_nothing(script, path, told, words):
    answer = script.post(path, json=told)
    assert answer.status_code == 400 and words in answer.json()["error"]
    assert script.jobs.states() == []


@pytest.mark.parametrize("number", ["x", "a-b", "0" * 16, "a" * 400])
def test_files_that_are_not_there_are_no_files(script, number):
    assert script.get(f"/api/exports/files/{number}").status_code in (400, 404)


def test_a_file_that_is_being_made_is_no_mistake_of_ours(script):
    (script.workspace.exports / "abc").mkdir()
    answer = script.get("/api/exports/files/abc")
    assert (answer.status_code, answer.json()["error"]) == (
        400,
        "export 'abc' not found; export the scene again",
    )


def test_a_saves_folder_that_cannot_be_read_has_no_worlds(tmp_path, monkeypatch):
    def refused(path):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "iterdir", refused)
    assert worlds_of([Game("a", tmp_path, None)]) == {}


def test_a_server_that_is_not_there_says_so(script):
    told = {"address": "127.0.0.1:1", "password": "x", "at": [0, 64, 0], "blocks_per_metre": 1}
    answer = script.post("/api/build/server", json=told)
    state = script.jobs.wait(answer.json()["job"], 300)
    assert state.state == "failed" and "127.0.0.1:1" in state.note
