"""The server's HTTP and websocket, over a real socket."""

import gzip

import numpy as np
import pytest
from forge_serving import client, heard, paint, say, served, small_editor, tab

from world2minecraft.sceneforge.array_messages import HEADER


@pytest.fixture
def server():
    with served(small_editor()) as server:
        yield server


@pytest.fixture
def script(server):
    with client(server) as script:
        yield script


def test_the_link_opens_the_page_and_leaves_the_address_bar(server):
    with client(server) as browser:
        browser.headers.pop("authorization")
        assert browser.get("/api/scene").status_code == 403
        sent_on = browser.get("/", params={"token": server.token})
        assert (sent_on.status_code, sent_on.headers["location"]) == (303, "/")
        assert "HttpOnly" in sent_on.headers["set-cookie"]
        assert "SameSite=Strict" in sent_on.headers["set-cookie"]
        page = browser.get("/")
        assert page.status_code == 200 and "<html" in page.text
        assert browser.get("/api/scene").json()["name"] == "den"


def test_every_answer_has_the_headers_that_keep_a_page_safe(script):
    for path in ("/", "/api/scene", "/api/none", "/none"):
        headers = script.get(path).headers
        assert "frame-ancestors 'none'" in headers["content-security-policy"], path
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"
    assert script.get("/api/scene").headers["cache-control"] == "no-store"


@pytest.mark.parametrize("what", ["labels", "instance", "confidence", "colour"])
def test_a_volume_is_its_header_and_its_cells(server, script, what):
    draft = server.session.document.draft
    answer = script.get("/api/volume", params={"what": what})
    head, body = answer.content[: HEADER.size], answer.content[HEADER.size :]
    magic, version, kind, flags, *rest = HEADER.unpack(head)
    assert (magic, version, kind, flags) == (
        b"W2MV",
        1,
        int(what == "instance"),
        int(what == "colour"),
    )
    assert rest == [*draft.shape, np.float32(0.08), 0, 0, 0, 12]
    values = np.frombuffer(body, "<u2" if kind else "u1")
    wanted = draft.confidence * 255 if what == "confidence" else getattr(draft, what)
    assert np.array_equal(values, wanted.ravel())
    assert answer.headers["x-rev"] == "0"


def test_a_volume_is_packed_where_the_page_can_unpack_it(script):
    plain = script.get("/api/volume", headers={"Accept-Encoding": "identity"})
    assert "content-encoding" not in plain.headers
    with script.stream("GET", "/api/volume", headers={"Accept-Encoding": "gzip"}) as packed:
        data = b"".join(packed.iter_raw())
    assert packed.headers["content-encoding"] == "gzip"
    assert gzip.decompress(data) == plain.content


def test_a_volume_is_that_of_its_revision(script):
    for rev in range(3):
        answer = script.get("/api/volume")
        assert answer.headers["x-rev"] == str(rev)
        painted = np.frombuffer(answer.content, np.uint8)[HEADER.size :][201:204]
        assert painted.tolist() == [8] * rev + [0] * (3 - rev)
        script.post("/api/do", json=paint(201 + rev, 1))


def test_what_one_tab_does_every_tab_is_told_in_order(server):
    with tab(server) as one, tab(server) as other:
        say(one, type="do", seq=7, command=paint(100))
        say(one, type="undo", seq=8)
        say(one, type="redo", seq=9)
        told = [heard(one) for _ in range(6)]
        assert [m["type"] for m in told] == ["change", "done"] * 3
        assert [m["seq"] for m in told[1::2]] == [7, 8, 9]
        changes = told[::2]
        assert [(m["rev"], m["step"], m["actor"]) for m in changes] == [
            (1, "do", "tab 1"), (2, "undo", "tab 1"), (3, "redo", "tab 1"),
        ]  # fmt: skip
        assert changes[0]["cells"] == [[100, 3, 8, 0, 255]]
        assert [heard(other) for _ in range(3)] == changes


def test_a_script_over_http_is_seen_by_the_tabs(server, script):
    with tab(server) as page:
        done = script.post("/api/do", json=paint(100)).json()
        assert done == {"rev": 1, "kind": "paint", "counts_as": "add", "cells": 3}
        assert heard(page)["actor"] == "script"
        assert script.post("/api/undo").json()["rev"] == 2
        assert heard(page)["step"] == "undo"
        assert script.post("/api/redo").json()["rev"] == 3


def test_python_beside_the_server_is_seen_by_the_tabs(server):
    with tab(server) as page:
        server.session.document.do("set_cells", cells=[(100, 3)], class_id=8, actor="notebook")
        assert heard(page)["actor"] == "notebook"


def test_a_preview_changes_nothing(server, script):
    planned = script.post("/api/preview", json=paint(100)).json()
    assert planned["cells"] == [[100, 3, 8, 0, 255]] and planned["gone"] == []
    assert server.session.rev == 0


def test_questions_are_answered(script):
    assert script.post("/api/ask/counts").json()["objects"] == 0
    assert "no query is named 'count'" in script.post("/api/ask/count").json()["error"]


def test_what_cannot_be_done_is_refused_with_one_line(server, script):
    answer = script.post("/api/do", json={"op": "set_cellz"})
    assert answer.status_code == 400
    assert answer.json()["error"] == "no command is named 'set_cellz'; did you mean 'set_cells'?"
    assert script.post("/api/undo").json()["error"] == "nothing to undo"
    with tab(server) as page:
        say(page, type="undo", seq=3)
        assert heard(page) == {"type": "refused", "seq": 3, "error": "nothing to undo"}
        say(page, type="dance", seq=4)
        assert heard(page)["error"] == "unknown message type 'dance'"
        say(page, type="do", seq=5)
        assert heard(page)["error"].startswith("a command must be an object")


def test_without_a_room_the_page_starts_and_the_api_says_so():
    with served() as server, client(server) as script:
        assert script.get("/").status_code == 200
        assert script.get("/api/scene").status_code == 404
        assert script.get("/api/volume").status_code == 400
        for path in ("do", "undo", "save", "preview", "ask/counts"):
            answer = script.post(f"/api/{path}", json=paint(1) if path in ("do", "preview") else {})
            assert answer.json()["error"] == "no room is open; choose one on the start page"


def test_saving_is_told_to_every_tab(tmp_path):
    editor = small_editor(folder=tmp_path)
    with served(editor) as server, client(server) as script, tab(server) as page:
        script.post("/api/do", json=paint(100))
        assert heard(page)["rev"] == 1
        assert script.post("/api/save").json() == {"rev": 1}
        assert heard(page) == {"type": "saved", "rev": 1}
    assert (tmp_path / "room.npz").is_file()


def test_commands_are_described_as_json_schema(script):
    told = script.get("/api/commands").json()
    schema = told["commands"]["set_cells"]
    assert schema["properties"]["class_id"]["maximum"] == 11
    assert "counts" in told["queries"]


def test_two_servers_live_side_by_side():
    with served(small_editor()) as one, served(small_editor()) as other, client(one) as browser:
        browser.headers.pop("authorization")
        for server in (one, other):
            browser.get(server.link)
        for server in (one, other):
            assert browser.get(f"{server.url}api/scene").status_code == 200


def test_a_port_that_is_taken_is_said_so():
    from world2minecraft.core.errors import UsageError
    from world2minecraft.sceneforge.server.server_process import ForgeServer

    with served(small_editor()) as one, pytest.raises(UsageError, match="omit the port"):
        ForgeServer(port=one.port)
