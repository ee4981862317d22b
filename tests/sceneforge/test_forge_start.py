"""The start page's server side: a capture comes, is looked at, becomes a room, and opens."""

import asyncio
import io
import shutil
import socket
import time
import zipfile

import numpy as np
import pytest
from forge_serving import bearer, client, heard, raw, served, small_editor, tab
from PIL import Image

from world2minecraft.core.errors import ConflictError
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.sceneforge.document.document_metadata import document_folder
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.jobs.subprocess_job import run_in_subprocess
from world2minecraft.sceneforge.scene_sources import DEMO_FOLDER
from world2minecraft.sceneforge.session import Session
from world2minecraft.sceneforge.uploads import CaptureStore, is_capture
from world2minecraft.sceneforge.workspace import Workspace


@pytest.fixture
def server(tmp_path):
    with served(home=tmp_path / "home", max_upload_bytes=64 << 20) as server:
        yield server


@pytest.fixture
def script(server):
    with client(server) as script:
        yield script


def announced(script, files: dict[str, bytes], title="den"):
    told = [{"path": path, "size": len(data)} for path, data in files.items()]
    answer = script.post("/api/start/captures", json={"title": title, "files": told})
    assert answer.status_code == 200, answer.text
    return answer.json()


def send(script, number, index, data, at=0):
    return script.put(
        f"/api/start/captures/{number}/files/{index}", params={"at": at}, content=data
    )


def sent(script, files: dict[str, bytes], title="den") -> str:
    made = announced(script, files, title)
    for index, data in enumerate(files.values()):
        assert send(script, made["id"], index, data).json()["held"] == len(data)
    return made["id"]


def busy(report):
    """Work until it is cancelled."""
    while True:
        report("wait", 0, 1)
        time.sleep(0.01)


def ended(server, answer):
    assert answer.status_code == 200, answer.text
    return server.workspace.jobs.wait(answer.json()["job"], 300)


def photo(size=(64, 48), seed=0) -> bytes:
    stream = io.BytesIO()
    noise = np.random.default_rng(seed).integers(0, 255, (size[1], size[0], 3), np.uint8)
    Image.fromarray(noise).save(stream, "JPEG")
    return stream.getvalue()


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    """A tiny capture: eight frames of a generated room, as files by their names."""
    folder = tmp_path_factory.mktemp("scan") / "den"
    scan_room(generate_room(3, kind="study"), folder, frames=8, width=160, height=120)
    return {
        f"den/{path.relative_to(folder).as_posix()}": path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "truth" not in path.name
    }


def test_a_capture_becomes_a_room_that_opens(server, script, scanned):
    number = sent(script, scanned)
    state = ended(server, script.post(f"/api/start/captures/{number}/look"))
    assert state.state == "done", state.note
    told = script.get(f"/api/start/captures/{number}").json()
    assert told["complete"] and not told["has_room"]
    assert told["survey"]["called"] == "posed RGB-D frames" and told["survey"]["can_start"]
    names = [name for name, _ in told["survey"]["lines"]]
    assert names[:4] == ["route", "colour", "depth", "poses"]
    picture = script.get(f"/api/start/captures/{number}/picture.png")
    assert Image.open(io.BytesIO(picture.content)).size == (1600, 1040)
    with tab(server) as socket_:
        choice = {"blocks_per_metre": 2, "style": "blocks"}
        begun = script.post(f"/api/start/captures/{number}/reconstruct", json=choice)
        state = ended(server, begun)
        assert state.state == "done", state.note
        stages, shares = [], []
        while (message := heard(socket_))["state"] == "running":
            stages.append(message["stage"])
            shares.append(message["share"] or 0)
        assert message["state"] == "done" and message["result"]["objects"] >= 0
        assert [one for one in dict.fromkeys(stages) if one][-1] == "report"
        assert shares == sorted(shares)
    assert script.get("/api/scene").status_code == 404
    assert script.post("/api/start/open", json={"id": number}).status_code == 200
    assert script.get("/api/scene").status_code == 200
    assert script.get(f"/api/start/rooms/{number}/picture").status_code == 200
    refused = script.delete(f"/api/start/captures/{number}")
    assert "the room of this capture is open in the editor" in refused.json()["error"]
    script.post("/api/start/close")
    assert script.delete(f"/api/start/captures/{number}").status_code == 200
    assert script.get("/api/start").json()["captures"] == []


def test_a_dropped_folder_is_named_by_itself(script, server):
    number = sent(script, {"kitchen/a.jpg": photo(), "kitchen/b/c.jpg": photo(seed=1)}, "kitchen")
    found = server.workspace.captures.named(number)
    assert found.source.name == "kitchen"
    assert sorted(p.name for p in found.source.rglob("*.jpg")) == ["a.jpg", "c.jpg"]


@pytest.mark.parametrize("name", ["capture.json", "survey.json", "run", "upload"])
def test_an_upload_never_meets_our_own_files(script, server, name):
    number = sent(script, {name: b"{}"})
    found = server.workspace.captures.named(number)
    assert found.source.read_bytes() == b"{}" and found.title == "den"
    assert script.get(f"/api/start/captures/{number}").json()["survey"] is None


def test_what_was_cut_off_goes_on_where_it_stopped(server, script):
    data = np.random.default_rng(0).integers(0, 255, 3 << 20, np.uint8).tobytes()
    number = announced(script, {"a.mp4": data})["id"]
    head = put_head(server, number, len(data))
    with socket.create_connection(("127.0.0.1", server.port)) as stream:
        stream.sendall(head.encode() + data[: 1 << 20])
    held = wait_for(lambda: script.get(f"/api/start/captures/{number}").json()["held"][0])
    assert 0 < held <= 1 << 20
    assert "is incomplete" in script.post(f"/api/start/captures/{number}/look").json()["error"]
    again = send(script, number, 0, data[:10], at=0)
    assert "bytes are already uploaded; continue from there" in again.json()["error"]
    now = script.get(f"/api/start/captures/{number}").json()["held"][0]
    assert send(script, number, 0, data[now:], at=now).json() == {
        "held": len(data),
        "size": len(data),
    }
    assert server.workspace.captures.named(number).source.read_bytes() == data


def put_head(server, number, length) -> str:
    """The head of a request that sends the first file of a capture."""
    lines = [
        f"PUT /api/start/captures/{number}/files/0?at=0 HTTP/1.1",
        f"Host: 127.0.0.1:{server.port}",
        f"Authorization: {bearer(server)['Authorization']}",
        f"Content-Length: {length}",
    ]
    return "\r\n".join([*lines, "", ""])


def wait_for(value):
    for _ in range(400):
        if found := value():
            return found
    raise AssertionError("it never came")


def test_more_than_was_said_is_not_taken(server, script):
    number = announced(script, {"a.mp4": b"1234"})["id"]
    answer = send(script, number, 0, b"12345")
    assert answer.status_code == 400
    assert answer.json()["error"] == "a.mp4: the upload exceeds the announced 4 bytes"
    assert server.workspace.captures.named(number).place_of(0).stat().st_size <= 4


def test_a_gigabyte_is_refused_before_a_byte_comes(server, script):
    files = [{"path": "a.mp4", "size": 1 << 30}]
    answer = script.post("/api/start/captures", json={"title": "a", "files": files})
    assert answer.status_code == 400
    assert "is 1,024 MB, the upload limit is 64 MB" in answer.json()["error"]
    assert list(server.workspace.home.rglob("*.mp4")) == []


def test_a_chunk_that_says_it_is_a_gigabyte_is_refused_unread(server, script):
    number = announced(script, {"a.mp4": b"1234"})["id"]
    head = put_head(server, number, 1 << 30)
    assert b" 413 " in raw(server, head.encode() + b"x" * 1000).split(b"\r\n")[0]


@pytest.mark.parametrize("path", ["../x", "/etc/passwd", "C:\\x", "a/../../b", "con"])
def test_hostile_names_never_reach_the_disk(server, script, path):
    files = [{"path": path, "size": 3}]
    answer = script.post("/api/start/captures", json={"title": "a", "files": files})
    assert answer.status_code == 400 and "invalid file name" in answer.json()["error"]
    assert not server.workspace.captures.folder.exists()


@pytest.mark.parametrize("number", ["..", "%2e%2e", "x" * 65, "..%2f..%2fetc", "A"])
def test_hostile_ids_name_nothing(script, number):
    answer = script.get(f"/api/start/captures/{number}/picture.png")
    assert answer.status_code in (400, 404)


@pytest.mark.parametrize("title", ["", "..", "/", "con", "\0\1", "x" * 500, "Küche <3"])
def test_any_title_makes_a_folder(server, script, title):
    number = sent(script, {"a.jpg": photo(), "b.jpg": photo(seed=1)}, title)
    found = server.workspace.captures.named(number)
    assert found.source.resolve().is_relative_to(server.workspace.captures.folder.resolve())
    assert found.complete


def test_a_bomb_is_seen_when_it_is_looked_at(server, script):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("frames/0.jpg", "frames/1.jpg", "frames/2.jpg"):
            archive.writestr(name, bytes(40 << 20))
    number = sent(script, {"bomb.zip": stream.getvalue()})
    state = ended(server, script.post(f"/api/start/captures/{number}/look"))
    assert state.state == "failed"
    assert "would unpack to" in state.note or "is no" in state.note
    assert sum(p.stat().st_size for p in server.workspace.home.rglob("*")) < 1 << 20


def test_what_is_no_capture_says_what_is(server, script):
    number = sent(script, {"notes.pdf": b"hello"})
    state = ended(server, script.post(f"/api/start/captures/{number}/look"))
    assert state.state == "failed" and "supported formats: " in state.note
    assert state.note.startswith("notes.pdf: is a file (.pdf) of an unknown format")
    told = script.get(f"/api/start/captures/{number}").json()
    assert told["survey"] is None and told["job"] is None


@pytest.mark.parametrize(
    ("choice", "words"),
    [
        ({"blocks_per_metre": 1000}, "blocks_per_metre must be 0.25 to 100"),
        ({"blocks_per_metre": "many"}, "an option has the wrong type"),
        ({"blocks_per_metre": 10**400}, "an option has the wrong type"),
        ({"style": "marble"}, "style"),
        ({"seed": 3}, "unknown option 'seed'"),
        ({"known": ["table height"]}, "an option has the wrong type"),
        ({"mc_version": "0.1"}, "0.1"),
    ],
)
def test_a_wrong_choice_begins_nothing(server, script, choice, words):
    number = sent(script, {"a.jpg": photo()})
    answer = script.post(f"/api/start/captures/{number}/reconstruct", json=choice)
    assert answer.status_code == 400 and words in answer.json()["error"]
    assert server.workspace.jobs.states() == []


def test_a_job_is_cancelled_over_http(server, script):
    number = server.workspace.jobs.start(
        "Demo", run_in_subprocess("demo", out=str(server.workspace.home / "x"), frames=200)
    )
    assert script.post(f"/api/jobs/{number}/cancel").status_code == 200
    assert server.workspace.jobs.wait(number, 30).state == "cancelled"
    assert script.get("/api/jobs").json()[0]["state"] == "cancelled"


def test_a_capture_elsewhere_is_read_where_it_is(tmp_path):
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "a.jpg").write_bytes(photo())
    captures = CaptureStore(tmp_path / "home")
    one = captures.register(tmp_path / "photos")
    assert captures.register(tmp_path / "photos") == one and one.complete
    captures.delete(one.id)
    assert (tmp_path / "photos" / "a.jpg").is_file() and captures.all() == []


def test_rooms_that_were_open_come_again(tmp_path):
    with served(small_editor(), home=tmp_path / "home") as server, client(server) as script:
        (tmp_path / "OUT").mkdir()
        server.workspace.add_recent(tmp_path / "OUT")
        server.workspace.add_recent(tmp_path / "gone")
        recent = script.get("/api/start").json()["recent"]
        assert [row["name"] for row in recent] == ["OUT"] and recent[0]["id"] == "recent-0"
        assert not recent[0]["has_picture"]
        missing = script.get("/api/start/rooms/recent-0/picture")
        assert missing.status_code == 400 and "create the room first" in missing.json()["error"]
        Image.new("RGB", (4, 3)).save(tmp_path / "OUT" / "preview.png")
        assert script.get("/api/start").json()["recent"][0]["has_picture"]
        picture = script.get("/api/start/rooms/recent-0/picture")
        assert Image.open(io.BytesIO(picture.content)).size == (4, 3)


def test_the_example_opens_at_once_with_its_picture(tmp_path):
    with served(home=tmp_path / "home") as server, client(server) as script:
        picture = script.get("/api/start/rooms/example/picture")
        assert Image.open(io.BytesIO(picture.content)).format == "WEBP"
        for _ in range(2):  # A second click finds it open.
            opened = script.post("/api/start/open", json={"id": "example"})
            assert opened.json()["name"] == "Demo room"
        assert script.get("/api/scene").json()["objects"]
        box = {"op": "fill_box", "low": [20, 20, 9], "high": [22, 22, 11], "class_id": 11}
        assert script.post("/api/do", json=box).json()["rev"] == 1


@pytest.mark.parametrize(
    "number", ["recent-7", "recent-x", "recent-" + "9" * 5000, "example2", "..", "%2e%2e%2fx"]
)
def test_pictures_of_unknown_rooms_are_refused(server, script, number):
    assert script.get(f"/api/start/rooms/{number}/picture").status_code in (400, 404)


def test_a_file_of_a_broken_capture_leaves_the_others(tmp_path):
    captures = CaptureStore(tmp_path)
    one = captures.create("a", [{"path": "a.jpg", "size": 1}])
    other = captures.create("b", [{"path": "b.jpg", "size": 1}])
    (one.folder / "capture.json").write_text("{")
    assert [found.id for found in captures.all()] == [other.id]


def test_a_capture_on_the_command_line_is_shown_first(tmp_path, scanned):
    place = tmp_path / "den"
    for name, data in scanned.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(data)
    assert is_capture(place) and not is_capture(tmp_path / "room.npz")
    with served(home=tmp_path / "home") as server, client(server) as script:
        server.workspace.begin_with(place, True)
        told = script.get("/api/start").json()
    assert told["wanted"] == told["captures"][0]["id"]
    assert told["captures"][0]["elsewhere"] == str(place)


def test_a_run_and_an_occupancy_file_are_no_captures(small_run, tmp_path):
    assert not is_capture(small_run)
    assert not is_capture(small_run / "occ.json")
    assert not is_capture(tmp_path)


def test_a_closed_demo_room_is_offered_again_with_its_edits(tmp_path):
    home = tmp_path / "home"
    with served(Editor.open(None, out=home / "demo-room"), home=home) as server:
        server.workspace.begin_with(document_folder(None, home / "demo-room"), False)
        with client(server) as script:
            box = {"op": "fill_box", "low": [20, 20, 9], "high": [22, 22, 11], "class_id": 11}
            assert script.post("/api/do", json=box).json()["rev"] == 1
            script.post("/api/start/close")
            (row,) = script.get("/api/start").json()["recent"]
            assert row["name"] == "demo-room"
            assert (
                script.post("/api/start/open", json={"id": row["id"]}).json()["name"] == "Demo room"
            )
            assert script.get("/api/scene").json()["rev"] == 1
            answer = script.post("/api/start/open", json={"id": "recent-1"})
            assert "no recent room is named 'recent-1'" in answer.json()["error"]


def test_bytes_that_two_connections_bring_never_mix(tmp_path):
    captures = CaptureStore(tmp_path)
    one = captures.create("den", [{"path": "a.mp4", "size": 8}])

    async def scenario():
        on_its_way = asyncio.Event()

        async def slow():
            yield b"abcd"
            await on_its_way.wait()
            yield b"efgh"

        async def quick():
            yield b"XXXX"

        first = asyncio.create_task(one.receive(0, 0, slow()))
        await asyncio.sleep(0)
        with pytest.raises(ConflictError, match="another upload of this file is running"):
            await one.receive(0, 0, quick())
        on_its_way.set()
        assert await first == 8

    asyncio.run(scenario())
    assert one.place_of(0).read_bytes() == b"abcdefgh"


def test_a_room_that_is_clicked_twice_can_be_edited(tmp_path):
    run = tmp_path / "den"
    shutil.copytree(DEMO_FOLDER, run)

    async def scenario():
        session = Session()
        workspace = Workspace(session, tmp_path / "home")
        await asyncio.gather(workspace.open(run), workspace.open(run))
        assert session.document.read_only == ""
        assert session.shown == 1
        await session.close()

    asyncio.run(scenario())


def test_a_home_that_cannot_be_written_keeps_nobody_from_opening(tmp_path):
    run, home = tmp_path / "den", tmp_path / "home"
    shutil.copytree(DEMO_FOLDER, run)
    home.write_text("a file")

    async def scenario():
        session = Session()
        workspace = Workspace(session, home, capture=tmp_path)
        await workspace.open(run)
        workspace._capture = tmp_path  # As ``w2m forge den --capture`` has it.
        assert workspace.extras()["truth"] is False
        await session.close()

    asyncio.run(scenario())


def test_a_demo_room_is_made_once_at_a_time(server, script):
    server.workspace.running_jobs["demo/study-9"] = number = server.workspace.jobs.start(
        "busy", busy
    )
    answer = script.post("/api/start/demo", json={"kind": "study", "seed": 9})
    assert answer.json() == {"job": number}
    assert len(server.workspace.jobs.states()) == 1
