"""A real server on a free port, and clients of it."""

import json
import socket
from contextlib import contextmanager
from pathlib import Path

import httpx
import numpy as np
from websockets.sync.client import connect

from world2minecraft.formats.occupancy_files import labels_grid
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import OpenedScene
from world2minecraft.sceneforge.server.server_process import ForgeServer

HANG_S = 180.0  # No measure of speed: only what never answers is given up.


def small_editor(shape=(12, 10, 8), folder=Path("none such/OUT")) -> Editor:
    """A floor and a wall, without objects."""
    labels = np.zeros(shape, np.uint8)
    labels[:, :, 0], labels[0] = 2, 3
    return Editor(OpenedScene("den", folder, (), labels_grid(labels), np.eye(4), ()))


@contextmanager
def served(editor=None, **options):
    with ForgeServer(editor, port=0, **options) as server:
        yield server


def bearer(server) -> dict[str, str]:
    return {"Authorization": f"Bearer {server.token}"}


def client(server, **options) -> httpx.Client:
    """A script: it sends the token with each request."""
    return httpx.Client(base_url=server.url, headers=bearer(server), timeout=HANG_S, **options)


@contextmanager
def tab(server, **headers):
    """A websocket whose hello was read."""
    url = f"ws://127.0.0.1:{server.port}/api/live"
    patient = {"ping_interval": None, "max_queue": None}  # A test may look away for long.
    with connect(url, additional_headers=bearer(server) | headers, **patient) as socket_:
        assert heard(socket_)["type"] == "hello"
        yield socket_


def heard(socket_) -> dict:
    return json.loads(socket_.recv(timeout=HANG_S))


def say(socket_, **message) -> None:
    socket_.send(json.dumps(message))


def paint(first, length=3, class_id=8) -> dict:
    return {"op": "set_cells", "cells": [[first, length]], "class_id": class_id}


def raw(server, data: bytes, most=65536) -> bytes:
    """What the server answers to bytes as they are, until it closes."""
    with socket.create_connection(("127.0.0.1", server.port), timeout=HANG_S) as stream:
        stream.sendall(data)
        answer = b""
        while len(answer) < most and (part := stream.recv(65536)):
            answer += part
        return answer
