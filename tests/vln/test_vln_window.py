"""The window of an environment: frames to a page, keys from it, and nothing without the token."""

import io
import urllib.error
import urllib.request

import numpy as np
import pytest
from PIL import Image

from world2minecraft.errors import UsageError
from world2minecraft.vln.environment.env import VlnEnv
from world2minecraft.vln.environment.playing import play
from world2minecraft.vln.environment.senses import Eyes
from world2minecraft.vln.environment.window import Window


@pytest.fixture
def window():
    made = Window(32)
    yield made
    made.close()


def fetch(window, path, method="GET"):
    base, _, token = window.link.partition("/?token=")
    joined = f"{base}{path}{'&' if '?' in path else '?'}token={token}"
    return urllib.request.urlopen(urllib.request.Request(joined, method=method), timeout=10)


def test_a_page_shows_the_frame(window):
    assert b'src="/frames?token=' in fetch(window, "/").read()
    frame = np.zeros((24, 32, 3), np.uint8)
    frame[:, 16:] = 200
    window.show(frame)
    with fetch(window, "/frames") as stream:
        head = b"".join(stream.readline() for _ in range(4))
        length = int(head.split(b"Content-Length: ")[1].split()[0])
        shown = np.asarray(Image.open(io.BytesIO(stream.read(length))))
    assert shown.shape == frame.shape and abs(shown.astype(int) - frame).max() < 16


def test_nothing_is_told_without_the_token(window):
    base = window.link.partition("/?")[0]
    for path in ("/", "/frames?token=guess", "/key?key=w"):
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(base + path, timeout=10)
    assert window.keys.empty()


def test_a_person_plays_and_is_scored(flat):
    env = VlnEnv(flat, eyes=Eyes(32, 24), observations=["pose"], render_mode="human")
    env.reset(seed=1)
    for key in ("ArrowLeft", "w", "x", " "):
        fetch(env.window, f"/key?key={urllib.request.quote(key)}", "POST")
    info = play(env, open_browser=False, patience_s=5)
    assert info["steps"] == 3 and info["score"]["steps"] == 3
    env.reset(seed=1)
    with pytest.raises(UsageError, match="nobody pressed a key in 0.1 s; http://127"):
        play(env, open_browser=False, patience_s=0.1)
    env.close()
    assert env.window is None


def test_only_single_moves_are_played(flat):
    env = VlnEnv(flat, eyes=Eyes(32, 24), observations=["pose"], move_set="macro")
    with pytest.raises(UsageError, match='render_mode="human" and single discrete moves'):
        play(env)
