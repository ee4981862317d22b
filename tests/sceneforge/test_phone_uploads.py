"""A phone's upload that is cut off anywhere goes on where it stopped, and makes a room."""

import asyncio
import random
import socket
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from phone_serving import ONE, announced, paired, phone_served, put_head
from starlette.requests import ClientDisconnect

from world2minecraft.core.errors import ConflictError, MissingExtraError, UsageError
from world2minecraft.sceneforge import phone_captures
from world2minecraft.sceneforge.phone_captures import (
    check_phone_files,
    check_phone_libraries,
    start_phone_room,
)
from world2minecraft.sceneforge.server import capture_requests
from world2minecraft.sceneforge.session import Session
from world2minecraft.sceneforge.uploads import CaptureStore
from world2minecraft.sceneforge.workspace import Workspace


@pytest.fixture
def server(tmp_path):
    with phone_served(tmp_path / "home") as server:
        yield server


@pytest.fixture
def phone(server):
    with paired(server) as phone:
        yield phone


def sent_in_parts(one, number: int, data: bytes, cuts, wrong_starts) -> None:
    """Send a file as the page does, while connections end at the cuts, each a part of the rest."""

    async def cut_off(part: bytes, cut: int):
        yield part[: cut // 2]
        yield part[cut // 2 : cut]
        raise ClientDisconnect

    async def whole(part: bytes):
        yield part

    async def send() -> None:
        for share, wrong in zip(cuts, wrong_starts, strict=False):
            held = one.received_bytes()[number]
            if wrong:  # A page that did not ask how much is there.
                with pytest.raises(ConflictError, match="continue from there"):
                    await one.receive(number, held + wrong, whole(b"x"))
            with suppress(ClientDisconnect):
                await one.receive(
                    number, held, cut_off(data[held:], int(share * (len(data) - held)))
                )
        held = one.received_bytes()[number]
        assert await one.receive(number, held, whole(data[held:])) == len(data)

    with ThreadPoolExecutor(1) as other:  # Playwright leaves a loop in this thread.
        other.submit(asyncio.run, send()).result()


@settings(max_examples=60, deadline=None)
@given(
    files=st.lists(st.binary(min_size=1, max_size=3000), min_size=1, max_size=4),
    cuts=st.lists(st.floats(0, 1), max_size=6),
    wrong_starts=st.lists(st.integers(0, 50), min_size=6, max_size=6),
)
def test_cut_off_anywhere_the_bytes_are_the_same(files, cuts, wrong_starts):
    with tempfile.TemporaryDirectory() as home:
        store = CaptureStore(Path(home))
        told = [{"path": f"{n}.jpg", "size": len(data)} for n, data in enumerate(files)]
        one = store.create("den", told)
        for number, data in enumerate(files):
            assert not one.complete
            sent_in_parts(one, number, data, cuts, wrong_starts)
        assert one.complete
        assert [one.place_of(n).read_bytes() for n in range(len(files))] == files


def test_a_connection_cut_at_random_offsets_goes_on(server, phone):
    dice = random.Random(7)
    data = dice.randbytes(900_000)
    number = announced(phone, ("video.mp4", len(data))).json()["id"]

    def held() -> int:
        return phone.get(f"{ONE}/{number}").json()["held"][0]

    for _ in range(8):
        start = held()
        head = put_head(server, phone, number, start, len(data) - start)
        with socket.create_connection(("127.0.0.1", server.phone.port)) as stream:
            stream.sendall(head + data[start : start + dice.randrange(120_000)])
        settle(held)
    while (start := held()) < len(data):
        answer = phone.put(
            f"{ONE}/{number}/files/0?at={start}", content=data[start : start + 500_000]
        )
        assert answer.json()["held"] > start
    assert phone.get(f"{ONE}/{number}").json()["complete"]
    assert server.workspace.captures.named(number).source.read_bytes() == data


def settle(value) -> None:
    """Wait until what was cut off has arrived."""
    last = None
    while (now := value()) != last:
        last = now
        time.sleep(0.05)


def test_a_silent_connection_gives_its_file_back(server, phone, monkeypatch):
    monkeypatch.setattr(capture_requests, "MAX_SILENCE_S", 0.3)
    number = announced(phone, ("a.jpg", 8)).json()["id"]
    head = put_head(server, phone, number, 0, 8)
    with socket.create_connection(("127.0.0.1", server.phone.port)) as stream:
        stream.sendall(head + b"1234")  # The Wi-Fi is gone; nobody says so.
        statuses, end = [], time.monotonic() + 60
        while 200 not in statuses and time.monotonic() < end:
            start = phone.get(f"{ONE}/{number}").json()["held"][0]
            answer = phone.put(f"{ONE}/{number}/files/0?at={start}", content=b"12345678"[start:])
            statuses.append(answer.status_code)
            time.sleep(0.05)
    assert statuses[-1] == 200 and set(statuses[:-1]) <= {409}
    assert server.workspace.captures.named(number).source.read_bytes() == b"12345678"


@pytest.mark.parametrize(
    "names", [["a.JPG", "b.heic", "c.webp"], ["a.MOV"], ["a.mp4"], ["Küche 1.jpeg"]]
)
def test_what_phones_take_is_accepted(names):
    files = [{"path": name, "size": 1} for name in names]
    assert [one.path for one in check_phone_files(files, 100)] == names


def test_a_missing_library_is_told_before_anyone_films(monkeypatch):
    monkeypatch.setattr(phone_captures, "find_spec", lambda name: name != "pycolmap")
    with pytest.raises(MissingExtraError, match=r"--phone needs an extra: .*\[capture\]"):
        check_phone_libraries()


def test_folders_of_a_phone_are_refused_before_the_suffix():
    with pytest.raises(UsageError, match="no folders"):
        check_phone_files([{"path": "a/b.jpg", "size": 1}], 100)


@pytest.fixture
def one(tmp_path):
    """A workspace with a complete capture of one photo."""
    workspace = Workspace(Session(), tmp_path)
    made = workspace.captures.create("den", [{"path": "a.jpg", "size": 1}])
    made.source.parent.mkdir(parents=True)
    made.source.write_bytes(b"x")
    return workspace, made


def tasks(monkeypatch, found, fails=()):
    """Replace the tasks of the job, and note which ran."""
    ran = []

    def task(name, within, **needs):
        def work(report):
            ran.append(name)
            report({"survey": "look", "reconstruct": "fuse"}.get(name, name), 1, 1)
            if name in fails:
                raise UsageError(f"{name} failed")
            return found if name == "survey" else {"objects": 3}

        return work

    monkeypatch.setattr(phone_captures, "run_in_subprocess", task)
    return ran


GOOD = {"can_start": True, "route": "photos", "frames": 40}


def test_a_room_is_surveyed_built_and_written_as_a_page(one, monkeypatch):
    workspace, made = one
    ran = tasks(monkeypatch, GOOD)
    state = workspace.jobs.wait(start_phone_room(workspace, made), 60)
    assert ran == ["survey", "reconstruct", "share"]
    assert state.state == "done" and state.result == {"objects": 3, "note": ""}
    assert workspace.running_jobs[made.id] == state.id


def test_a_room_without_a_page_is_a_room(one, monkeypatch):
    workspace, made = one
    tasks(monkeypatch, GOOD, fails=("share",))
    state = workspace.jobs.wait(start_phone_room(workspace, made), 60)
    assert state.state == "done" and state.result["note"] == "share failed"


@pytest.mark.parametrize(
    ("doubts", "why"),
    [
        (
            [
                {"level": "warn", "text": "dark", "advice": "light"},
                {"level": "stop", "text": "too few", "advice": "take more; or --depth hf:X"},
            ],
            "den: too few; take more",
        ),
        ([], "den: shows no usable picture; film or photograph the room again in good light"),
    ],
)
def test_a_capture_that_cannot_start_says_what_helps(one, monkeypatch, doubts, why):
    workspace, made = one
    ran = tasks(monkeypatch, {"can_start": False, "doubts": doubts})
    state = workspace.jobs.wait(start_phone_room(workspace, made), 60)
    assert (state.state, state.note, ran) == ("failed", why, ["survey"])
