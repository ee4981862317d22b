"""``w2m forge`` as a process: its link, its warning, its end."""

import os
import re
import signal
import socket
import subprocess
import sys
from contextlib import contextmanager

import httpx
import numpy as np
import pytest
from websockets.sync.client import connect

from world2minecraft.cli import run

POSIX = pytest.mark.skipif(os.name != "posix", reason="Ctrl+C is sent as a signal")


@pytest.fixture
def labels(tmp_path):
    cells = np.zeros((12, 10, 8), np.uint8)
    cells[:, :, 0], cells[0] = 2, 3
    np.save(tmp_path / "den.npy", cells)
    return tmp_path / "den.npy"


@contextmanager
def forge(*words):
    """The process and the link that it printed; it is ended whatever happens."""
    command = [sys.executable, "-u", "-m", "world2minecraft", "forge", *map(str, words)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    with subprocess.Popen([*command, "--no-browser"], **pipes) as process:
        try:
            lines = []
            while not (found := re.findall(r"http://\S+", "".join(lines))):
                line = process.stdout.readline()
                assert line, lines
                lines.append(line)
            yield process, found[0], "".join(lines)
        finally:
            process.kill()


@POSIX
def test_a_room_is_served_until_ctrl_c_and_keeps_its_edits(labels):
    paint = {"op": "set_cells", "cells": [[41, 3]], "class_id": 8}
    for rev in (0, 1):
        with forge(labels, "--port", 0) as (process, link, _):
            url, token = link.split("?token=")
            headers = {"Authorization": f"Bearer {token}"}
            with httpx.Client(base_url=url, headers=headers, timeout=30) as script:
                assert httpx.get(url).status_code == 403
                scene = script.get("/api/scene").json()
                assert (scene["name"], scene["rev"]) == ("den.npy", rev)
                if not rev:
                    assert script.post("/api/do", json=paint).json()["rev"] == 1
                live = url.replace("http", "ws") + "api/live"
                with connect(live, additional_headers=headers) as tab:
                    assert tab.recv()
                    process.send_signal(signal.SIGINT)
                    assert process.wait(timeout=30) == 0
            assert "Traceback" not in process.stdout.read()


def test_without_a_room_there_is_a_start_page(tmp_path, monkeypatch):
    monkeypatch.setenv("W2M_FORGE_HOME", str(tmp_path))
    with forge("--port", 0) as (_, link, _), httpx.Client(follow_redirects=True) as browser:
        assert "<html" in browser.get(link).text
        assert browser.get(link.partition("?")[0] + "api/scene").status_code == 404


def test_a_server_for_others_warns_and_requires_the_link(labels):
    words = (labels, "--port", 0, "--host", "0.0.0.0", "--allow-host", "den.lan")
    with forge(*words) as (_, link, said):
        assert said.startswith("warning: anyone with the link who can reach 0.0.0.0 can edit")
        url, token = link.split("?token=")
        bearer = {"Authorization": f"Bearer {token}"}
        for host, status in (("127.0.0.2", 200), ("den.lan", 200), ("evil.example", 403)):
            answer = httpx.get(f"{url}api/scene", headers=bearer | {"Host": host})
            assert answer.status_code == status, host
        assert httpx.get(f"{url}api/scene").status_code == 403


def test_a_port_that_is_taken_is_one_line(labels, capsys):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        assert run(["forge", str(labels), "--no-browser", "--port", port]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"error: cannot listen on 127.0.0.1:{port} (Address already in use)")
    assert told.endswith("omit the port (--port) to use a free one\n")


@POSIX
def test_a_phone_page_is_served_beside_the_editor(tmp_path):
    words = ("--phone", "--host", "127.0.0.1", "--port", 0, "--home", tmp_path)
    with forge(*words) as (process, link, _):
        said = [process.stdout.readline() for _ in range(4)]
        phone = re.search(r"phone: +(http://127\.0\.0\.1:\d+/)#[\w-]{22}\n", said[0])
        assert phone and "lets one phone in, within ten minutes" in said[1]
        assert "the phone page is not encrypted" in said[2]
        assert httpx.get(link, follow_redirects=True).status_code in (200, 403)
        assert "phone.js" in httpx.get(phone[1]).text
        assert httpx.get(phone[1] + "api/phone").status_code == 401
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=30) == 0
        assert "Traceback" not in process.stdout.read()


@pytest.mark.parametrize(
    ("words", "code", "why"),
    [
        (["none.npz"], 3, "none.npz"),
        (["--demo", "den.npy"], 2, "--demo opens the demo room; omit either --demo or the file"),
        (["--walk"], 2, "--walk requires a world, as in w2m forge OUT --walk"),
        (["none", "--walk"], 3, "none"),
        (["--host", "no.such.host.invalid", "--demo"], 2, "cannot listen on no.such.host.invalid"),
        (["--walk", "--phone"], 2, "--phone is part of the editor, not of --walk"),
        (["--tls", "cert.pem", "key.pem"], 2, "--tls is for the phone page; add --phone"),
        (["--phone", "--host", "0.0.0.0"], 2, "such as --host 192.168.1.5"),
        (["--phone", "--host", "203.0.113.7"], 2, "cannot listen on 203.0.113.7"),
        (
            ["--phone", "--host", "127.0.0.1", "--tls", "none.pem", "key.pem"],
            3,
            "none.pem: not found; --tls needs the files of a certificate and its key",
        ),
    ],
)
def test_what_cannot_be_opened_is_one_line(words, code, why, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(["forge", *words]) == code
    assert why in capsys.readouterr().err
