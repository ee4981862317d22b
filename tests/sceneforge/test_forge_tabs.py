"""Tabs in step: fast ones, ones that sleep, and edits that take long."""

import asyncio
import json
import socket
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from typing import Literal

import numpy as np
import pytest
from forge_serving import HANG_S, client, heard, paint, raw, say, served, small_editor, tab
from websockets.client import ClientProtocol
from websockets.uri import parse_uri

from world2minecraft.editing.scene import COMMANDS, Command
from world2minecraft.sceneforge import broadcast as hub
from world2minecraft.sceneforge import session
from world2minecraft.sceneforge.array_messages import HEADER
from world2minecraft.sceneforge.broadcast import MAX_QUEUED, MAX_TABS, Broadcaster
from world2minecraft.sceneforge.server.server_process import ForgeServer


@pytest.mark.parametrize("quick_cells", [session.QUICK_CELLS, 0])  # At once; by the thread.
def test_changes_are_broadcast_before_the_answer(monkeypatch, quick_cells):
    monkeypatch.setattr(session, "QUICK_CELLS", quick_cells)
    with served(small_editor()) as server, tab(server) as page:
        for number in range(20):
            say(page, type="do", seq=3 * number, command=paint(100))
            say(page, type="undo", seq=3 * number + 1)
            say(page, type="redo", seq=3 * number + 2)
            say(page, type="undo", seq=-1)
            told = [heard(page) for _ in range(8)]
            assert [m["type"] for m in told] == ["change", "done"] * 4
            assert [m["rev"] for m in told[::2]] == [m["rev"] for m in told[1::2]]


def test_edits_of_many_tabs_are_one_row(server_of_many):
    """Each tab edits at once; every tab is told the same changes in the same order."""
    _server, tabs = server_of_many

    def work(number, socket_):
        for seq in range(20):
            say(socket_, type="do", seq=seq, command=paint(81 * 8 + 80 * number + 2 * seq + 1, 1))

    threads = [threading.Thread(target=work, args=one) for one in enumerate(tabs)]
    for thread in threads:
        thread.start()
    told = []
    for socket_ in tabs:
        messages = [heard(socket_) for _ in range(20 * len(tabs) + 20)]
        assert sum(m["type"] == "done" for m in messages) == 20
        told.append([m for m in messages if m["type"] == "change"])
    for thread in threads:
        thread.join()
    assert all(changes == told[0] for changes in told[1:])
    assert [m["rev"] for m in told[0]] == list(range(1, 20 * len(tabs) + 1))


@pytest.fixture
def server_of_many():
    with served(small_editor((30, 10, 8))) as server, ExitStack() as held:
        yield server, [held.enter_context(tab(server)) for _ in range(3)]


class Sleeper:
    """A tab whose machine sleeps: its socket is open, and nothing reads it."""

    def __init__(self, server):
        self.protocol = ClientProtocol(parse_uri(f"ws://127.0.0.1:{server.port}/api/live"))
        self.socket = socket.socket()
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self.socket.connect(("127.0.0.1", server.port))
        request = self.protocol.connect()
        request.headers["Authorization"] = f"Bearer {server.token}"
        self.protocol.send_request(request)
        self._send()
        self.frames, self.bytes = [], 0

    def wake(self, until) -> list[dict]:
        """Read until a message is as asked, and return all messages."""
        self.socket.settimeout(HANG_S)
        deadline = time.monotonic() + HANG_S
        while not self.frames or not until(self.frames[-1]):
            assert time.monotonic() < deadline, "it was not told in time"
            data = self.socket.recv(1 << 16)
            assert data, "the server has closed"
            self.bytes += len(data)
            self.protocol.receive_data(data)
            self._send()
            self.frames += [
                json.loads(event.data)
                for event in self.protocol.events_received()
                if hasattr(event, "opcode") and event.opcode == 1
            ]
        return self.frames

    def _send(self):
        for data in self.protocol.data_to_send():
            self.socket.sendall(data)


def test_a_tab_that_slept_starts_again_and_loses_nothing(monkeypatch):
    monkeypatch.setattr(hub, "MAX_QUEUED_BYTES", 200_000)
    hours = iter(range(10**9))
    editor = small_editor((20, 20, 20))
    editor.clock = lambda: 3600.0 * next(hours)  # Each edit is an hour after the one before.
    server = ForgeServer(editor, port=0)
    server.socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 16384)
    most = 40
    with server, client(server) as script, tab(server) as awake:
        sleeper = Sleeper(server)
        assert sleeper.wake(lambda message: message["type"] == "hello")[0]["rev"] == 0
        for number in range(most):
            runs = [[cell, 1] for cell in range(1 + number % 2, 8000, 8)]
            command = {"op": "set_cells", "cells": runs, "class_id": 5 + number % 6}
            assert script.post("/api/do", json=command).json()["rev"] == number + 1
            assert heard(awake)["rev"] == number + 1  # It does not wait for the sleeper.
        told = sleeper.wake(lambda message: message.get("rev") == most)[1:]
        assert [m["rev"] for m in told if m["type"] == "hello"] == [most]
        assert len(told) < most, "what waits for a tab is bounded"
        assert script.post("/api/do", json=paint(1, 1, 2)).status_code == 200
        assert sleeper.wake(lambda m: m["type"] == "change" and m["rev"] == most + 1)
        cells = np.frombuffer(script.get("/api/volume").content[HEADER.size :], np.uint8)
        assert np.array_equal(cells, editor.draft.labels.ravel())


def test_a_tab_without_pings_is_dropped_and_greeted_on_return():
    server = ForgeServer(small_editor(), port=0)
    server._server.config.ws_ping_interval = server._server.config.ws_ping_timeout = 0.05
    with server, client(server) as script:
        sleeper = Sleeper(server)
        sleeper.wake(lambda message: message["type"] == "hello")
        assert soon(lambda: not server.session.broadcaster.count)
        script.post("/api/do", json=paint(100))
        again = Sleeper(server)
        assert again.wake(lambda message: message["type"] == "hello")[0]["rev"] == 1


def soon(asked) -> bool:
    """Whether something comes true within a time that no machine needs."""
    deadline = time.monotonic() + HANG_S
    while not asked() and time.monotonic() < deadline:
        time.sleep(0.01)
    return asked()


def test_a_tab_that_went_without_a_word_is_forgotten():
    with served(small_editor()) as server, client(server) as script:
        sleeper = Sleeper(server)
        sleeper.wake(lambda message: message["type"] == "hello")
        linger = (1).to_bytes(4, "little") + (0).to_bytes(4, "little")
        sleeper.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger)
        sleeper.socket.close()
        script.post("/api/do", json=paint(100))
        assert soon(lambda: not server.session.broadcaster.count)


def test_too_many_tabs_are_refused():
    with served(small_editor()) as server, client(server) as script:
        sleepers = [Sleeper(server) for _ in range(MAX_TABS)]
        for one in sleepers:
            one.wake(lambda message: message["type"] == "hello")
        headers = f"Host: 127.0.0.1\r\nAuthorization: Bearer {server.token}\r\n"
        upgrade = "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
        key = "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        asked = f"GET /api/live HTTP/1.1\r\n{headers}{upgrade}{key}"
        assert raw(server, asked.encode()).startswith(b"HTTP/1.1 403")
        assert script.get("/api/scene").status_code == 200
        for one in sleepers:
            one.socket.close()


class Slow(Command):
    """Takes as long as the test wants."""

    op: Literal["slow"] = "slow"

    def plan(self, draft, tools):
        SLOW_BEGAN.set()
        assert SLOW_MAY_END.wait(20)
        return COMMANDS["set_cells"].model_validate(paint(100)).plan(draft, tools)


SLOW_BEGAN, SLOW_MAY_END = threading.Event(), threading.Event()


def test_what_takes_long_blocks_no_reading_and_keeps_its_turn(monkeypatch):
    monkeypatch.setitem(COMMANDS, "slow", Slow)
    SLOW_BEGAN.clear()
    SLOW_MAY_END.clear()
    with served(small_editor()) as server, client(server) as script, tab(server) as page:
        say(page, type="do", seq=1, command={"op": "slow"})
        assert SLOW_BEGAN.wait(20)
        with tab(server) as other:
            say(other, type="do", seq=2, command=paint(201))
            say(other, type="active")
            assert script.get("/api/scene").json()["rev"] == 0
            assert script.get("/api/volume").headers["x-rev"] == "0"
            SLOW_MAY_END.set()
            told = [heard(other) for _ in range(3)]
        assert [m["rev"] for m in told] == [1, 2, 2]
        assert [m["actor"] for m in told[:2]] == ["tab 1", "tab 2"]


def test_an_internal_error_is_reported_and_the_next_edit_works(monkeypatch):
    def broken(self, draft, tools):
        raise ZeroDivisionError("secret details")

    with served(small_editor()) as server, client(server) as script, tab(server) as page:
        kind = COMMANDS["set_cells"]
        monkeypatch.setattr(kind, "plan", broken)
        wanted = "unexpected ZeroDivisionError; see the terminal of w2m forge for details"
        say(page, type="do", seq=1, command=paint(100))
        assert heard(page)["error"] == wanted
        answer = script.post("/api/do", json=paint(100))
        assert (answer.status_code, answer.json()["error"]) == (500, wanted)
        monkeypatch.undo()
        say(page, type="do", seq=2, command=paint(100))
        assert heard(page)["type"] == "change"


def test_another_document_makes_every_tab_start_again():
    with served() as server, client(server) as script, tab(server) as page:
        loop = server.session.broadcaster._loop
        for shown in (1, 2):
            opening = server.session.show(small_editor())
            asyncio.run_coroutine_threadsafe(opening, loop).result(20)
            hello = {"type": "hello", "protocol": 1, "rev": 0, "document": shown}
            assert heard(page) == hello
            assert script.get("/api/scene").json()["document"] == shown
        script.post("/api/do", json=paint(100))
        assert heard(page)["rev"] == 1


def test_a_queue_that_is_full_is_emptied_and_begins_with_hello():
    async def scenario():
        tabs = Broadcaster()
        tab_ = tabs.open()
        assert tab_
        for number in range(MAX_QUEUED + 100):
            tabs.broadcast({"n": number})
        first = await tab_.get(lambda: {"type": "hello"})
        tabs.broadcast({"n": "next"})
        return [json.loads(text) for text in (first, await tab_.get(dict))]

    with ThreadPoolExecutor(1) as own_thread:  # A browser of other tests has a loop in this one.
        got = own_thread.submit(asyncio.run, scenario()).result(20)
    assert got == [{"type": "hello"}, {"n": "next"}]


def test_a_job_is_sent_to_open_tabs_and_to_later_ones():
    with served() as server, tab(server) as page:
        may_end = threading.Event()

        def work(report):
            report("look", 1, 2)
            while not may_end.wait(0.01):
                report("look", 1, 2)
            return {"found": 3}

        name = server.session.jobs.start("Look", work)
        assert heard(page)["state"] == "running"
        with tab(server) as late:
            assert heard(late)["id"] == name
            say(late, type="cancel", job="none")
            while "error" not in (told := heard(late)):
                pass
            assert told["error"] == f"no job is named 'none'; known: {name}"
        may_end.set()
        while (told := heard(page))["state"] == "running":
            pass
        assert (told["state"], told["result"]) == ("done", {"found": 3})
