"""What is too large, too deep or no number: refused over HTTP and websocket, at once."""

import gzip
import io
import json
import socket
import zipfile
import zlib

import pytest
from forge_serving import (
    HANG_S,
    bearer,
    client,
    heard,
    paint,
    raw,
    say,
    served,
    small_editor,
    tab,
)
from websockets.exceptions import ConnectionClosed

from world2minecraft.core.errors import UsageError
from world2minecraft.sceneforge.server.limits import MAX_JSON_BYTES, MAX_JSON_DEPTH, parse_json

GIGABYTE = 1 << 30
DEEP = "[" * 100_000 + "]" * 100_000
DEEP_OBJECTS = '{"a":' * 100_000 + "1" + "}" * 100_000


@pytest.fixture(scope="module")
def server():
    with served(small_editor()) as server:
        yield server


def posted(server, body: str) -> tuple[int, str]:
    with client(server) as script:
        answer = script.post("/api/do", content=body)
        return answer.status_code, answer.json()["error"]


def command(**fields) -> str:
    return json.dumps(paint(100) | fields)


BAD = [
    (DEEP, "the JSON is nested more than 32 levels deep"),
    (DEEP_OBJECTS, "the JSON is nested more than 32 levels deep"),
    (command()[:-1] + ', "x": ' + DEEP + "}", "the JSON is nested more than 32 levels deep"),
    (command(class_id=float("nan")), "invalid JSON: NaN is not allowed in JSON"),
    (command(cells=[[float("inf"), 1]]), "invalid JSON: Infinity is not allowed in JSON"),
    (command(class_id=-float("inf")), "invalid JSON: -Infinity is not allowed in JSON"),
    ("[" * 31, "invalid JSON: "),
    ("9" * 5000, "invalid JSON: "),
    (command(verb="\ud800"), "invalid JSON: "),
    ('{"op": "set_cells"}', "set_cells: "),
    (command(class_id="8e400"), "set_cells: class_id"),
    (command(cells=[[0, 10**30]]), "cells must be [start, length] pairs of integers"),
    (command(cells=[[0, 2**63 - 1]]), "a run of cells extends beyond the grid"),
    (command(cells=[[-1, 2]]), "set_cells: cells.0.0"),
    (command(cells=[[1, 2], [2, 2]]), "two runs of cells overlap"),
    (command(cells=[[i, 1] for i in range(200_001)]), "set_cells: cells"),
    (command(__proto__={"a": 1}), "set_cells: __proto__"),
]


@pytest.mark.parametrize("chunked", [False, True])
def test_too_large_a_body_is_answered_and_not_reset(server, chunked):
    body = b" " * (MAX_JSON_BYTES + (1 << 20))
    parts = (body[start : start + 65536] for start in range(0, len(body), 65536))
    for _ in range(3):
        with client(server) as script:
            answer = script.post("/api/do", content=parts if chunked else body)
        assert answer.status_code == 413
        assert answer.json()["error"] == "the request is larger than 8 MB"
        parts = iter([body])


@pytest.mark.parametrize(("body", "why"), BAD, ids=range(len(BAD)))
def test_bad_json_is_refused_over_http(server, body, why):
    code, error = posted(server, body)
    assert code == 400 and error.startswith(why) and len(error) < 400 and "\n" not in error


@pytest.mark.parametrize(("body", "why"), BAD, ids=range(len(BAD)))
def test_bad_json_over_the_websocket_is_refused(server, body, why):
    with tab(server) as page:
        page.send(f'{{"type":"do","seq":1,"command":{body}}}')
        told = heard(page)
        assert told["type"] == "refused" and why.partition(":")[0] in told["error"]
        say(page, type="undo", seq=2)
        assert heard(page)["error"] == "nothing to undo"


@pytest.mark.parametrize("kind", ["preview", "ask/counts"])
def test_every_body_is_checked(server, kind):
    with client(server) as script:
        for body in (DEEP, '{"a": NaN}', "[]", "3"):
            answer = script.post(f"/api/{kind}", content=body)
            assert answer.status_code == 400 and answer.json()["error"]


def head(server, *lines: str, path="/api/do") -> bytes:
    always = (
        f"POST {path} HTTP/1.1",
        f"Host: 127.0.0.1:{server.port}",
        f"Authorization: Bearer {server.token}",
    )
    return ("\r\n".join((*always, *lines)) + "\r\n\r\n").encode()


@pytest.mark.parametrize("path", ["/api/do", "/api/upload"])
def test_a_gigabyte_is_refused_by_its_length_before_a_byte_of_it(server, path):
    answer = raw(server, head(server, f"Content-Length: {GIGABYTE}", path=path))
    assert answer.startswith(b"HTTP/1.1 413") and b"the request is larger than" in answer


def test_a_gigabyte_in_chunks_is_cut_off_at_the_limit(server):
    sent = 0
    block = b"100000\r\n" + b" " * (1 << 20) + b"\r\n"
    with socket.create_connection(("127.0.0.1", server.port), timeout=HANG_S) as stream:
        stream.sendall(head(server, "Transfer-Encoding: chunked"))
        try:
            while sent < GIGABYTE:
                stream.sendall(block)
                sent += len(block)
        except OSError:  # Closed in the midst of it, as it should be.
            pass
    assert MAX_JSON_BYTES <= sent < 8 * MAX_JSON_BYTES


def test_chunks_over_the_limit_are_answered(server):
    with client(server) as script:
        blocks = (b" " * (1 << 20) for _ in range(9))
        answer = script.post("/api/do", content=blocks)
        assert answer.status_code == 413


@pytest.mark.parametrize("length", ["-1", "1e9", "99999999999999999999", "0x10", "1, 2"])
def test_a_length_that_is_none_is_refused(server, length):
    answer = raw(server, head(server, f"Content-Length: {length}"))
    assert answer.startswith((b"HTTP/1.1 400", b"HTTP/1.1 413"))


@pytest.mark.parametrize("coding", ["gzip", "deflate", "br", "zstd", "gzip, gzip"])
def test_a_packed_body_is_never_unpacked(server, coding):
    bomb = gzip.compress(b" " * (16 << 20))
    with client(server) as script:
        answer = script.post("/api/do", content=bomb, headers={"Content-Encoding": coding})
        assert answer.status_code == 415


def test_a_packed_websocket_message_is_never_unpacked(server):
    """Even where the tab packs without having been allowed to."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    bomb = packer.compress(b" " * (64 << 20)) + packer.flush(zlib.Z_SYNC_FLUSH)
    with tab(server) as page:
        frame = b"\xc1\xff" + len(bomb).to_bytes(8, "big") + b"\0\0\0\0" + bomb
        page.socket.sendall(frame)
        with pytest.raises(ConnectionClosed, match="1002"):
            page.recv(timeout=HANG_S)


def test_an_oversized_websocket_message_closes_that_tab_alone(server):
    with tab(server) as one, tab(server) as other:
        with pytest.raises(ConnectionClosed):
            one.send(" " * (MAX_JSON_BYTES + 1))
            one.recv(timeout=HANG_S)
        say(other, type="undo", seq=1)
        assert heard(other)["type"] == "refused"


def test_a_websocket_message_in_pieces_has_the_same_limit(server):
    with tab(server) as page, pytest.raises(ConnectionClosed):
        page.send(" " * (1 << 20) for _ in range(64))
        page.recv(timeout=HANG_S)


@pytest.mark.parametrize("data", [b"\xff\xfe", b"\xed\xa0\x80", b"\x00" * 100, b"W2MV" * 100])
def test_bytes_that_are_no_json_are_refused(server, data):
    with tab(server) as page:
        page.send(data)
        assert heard(page)["error"].startswith("invalid JSON")


def test_brackets_in_strings_are_no_depth():
    deep = "[" * 100_000
    assert parse_json(json.dumps({"name": deep + '"\\' + deep}))["name"] == deep + '"\\' + deep
    with pytest.raises(UsageError, match="nested"):
        parse_json('{"a": "]]]]]]]]", "b": ' + "[" * 40 + '"]"' + "]" * 40 + "}")
    edge = "[" * MAX_JSON_DEPTH + "]" * MAX_JSON_DEPTH
    assert parse_json(edge) is not None
    with pytest.raises(UsageError, match="nested"):
        parse_json("[" + edge + "]")


def test_the_server_is_well_after_all_this(server):
    with client(server) as script:
        assert script.get("/api/scene", headers=bearer(server)).json()["rev"] == 0


def npz_bomb() -> bytes:
    """An archive of 0.3 MB that holds 300 MB."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("labels.npy", b"\x93NUMPY" + b"\0" * (300 << 20))
    return made.getvalue()


def npy_of(shape: str) -> bytes:
    """An array that says it is larger than the file."""
    text = f"{{'descr': '|u1', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode()


FILES = [
    ("bomb.npz", npz_bomb),
    ("huge.npy", lambda: npy_of("(100000, 100000, 100000)")),
    ("pickle.npy", lambda: npy_of("(1,)").replace(b"|u1", b"|O ")),
    ("deep.json", DEEP.encode),
    ("nan.json", lambda: b'{"voxels": [[NaN, 1, 2, 3]], "voxel_size": 0.08, "shape": [9, 9, 9]}'),
    ("shape.json", lambda: b'{"shape": [100000, 100000, 100000], "voxels": [], "voxel_m": 0.08}'),
    ("name.exe", lambda: b"MZ"),
    ("../../up.npy", lambda: npy_of("(1, 1, 1)")),
    ("empty.npz", lambda: b""),
]


@pytest.mark.parametrize(("name", "made"), FILES, ids=[name for name, _ in FILES])
def test_a_file_that_is_a_bomb_is_refused_with_a_line(server, name, made):
    with client(server) as script:
        answer = script.post("/api/upload/compare", params={"name": name}, content=made())
        assert answer.status_code == 400, answer.text
        assert 0 < len(answer.json()["error"]) < 400 and "/tmp" not in answer.text
