"""The window of an environment: frames to a page, keys from it, and nothing without the token."""

import io
import json
import threading
import urllib.error
import urllib.request

import numpy as np
import pytest
from open_field import OpenField, an_episode
from PIL import Image

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.browser_window import Window
from world2minecraft.navigation.environment.env import VlnEnv
from world2minecraft.navigation.environment.observations import Eyes
from world2minecraft.navigation.environment.play import play
from world2minecraft.navigation.free_walk import walk_freely
from world2minecraft.navigation.running.episode_runner import walk_episode
from world2minecraft.navigation.running.human_agent import HumanAgent
from world2minecraft.navigation.types import Move


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


def test_words_come_with_frames_and_alone(window):
    window.show(np.zeros((8, 8, 3), np.uint8), "Go to <b>the piano</b>")
    told = json.loads(fetch(window, "/text?after=-1").read())
    assert told == {"number": 1, "text": "Go to <b>the piano</b>", "open": True}
    threading.Timer(0.2, window.say, ["There."]).start()
    assert json.loads(fetch(window, "/text?after=1").read())["text"] == "There."
    window.show(np.zeros((8, 8, 3), np.uint8))
    assert json.loads(fetch(window, "/text?after=2").read())["text"] == "There."


@pytest.mark.parametrize("after", ["", "x", "-5", "9" * 40, "%EF%BC%91"])
def test_any_number_of_the_page_is_taken(window, after):
    window.say("Hello")
    if after == "9" * 40:
        after = after[:1]
        threading.Timer(0.1, window.close).start()
    told = json.loads(fetch(window, f"/text?after={after}").read())
    assert told["number"] == 1


def test_a_person_walks_as_an_agent(window):
    agent = HumanAgent(window, patience_s=5)
    for key in ("w", "x", "a", "w", " "):
        window.keys.put(key)
    walk = walk_episode(OpenField(), an_episode(), agent, observers=[agent])
    assert [move for move, _ in walk.made] == [Move.FORWARD, Move.LEFT, Move.FORWARD]
    assert (walk.agent, walk.end, walk.steps) == ("human", "stopped", 4)
    text = json.loads(fetch(window, "/text?after=-1").read())["text"]
    assert text.startswith("This walk is over. Stopped 2.98 m from the goal after 4 steps")
    window.keys.put(" ")
    shown = []
    window.show = lambda frame, text: shown.append((frame.shape, text))
    walk_episode(OpenField(), an_episode(), agent, observers=[agent])
    ((shape, text),) = shown
    assert shape == (30, 40, 3) and text.startswith("Go to the post\nMove 0 of at most 60.")
    assert "Previous walk: Stopped 2.9" in text


def test_a_person_who_is_not_there_is_told(window):
    agent = HumanAgent(window, patience_s=0.05)
    with pytest.raises(UsageError, match="no key was pressed within 0.05 s; open http://127"):
        walk_episode(OpenField(), an_episode(), agent)


def test_a_stroll_goes_where_the_keys_say(flat, window):
    for key in ("w", "w", " ", "d"):
        window.keys.put(key)
    shown = []
    window.show = lambda frame, text: shown.append((frame, text))
    with pytest.raises(UsageError, match="no key was pressed"):
        walk_freely(flat, window, patience_s=0.05)
    assert len(shown) == 5 and all("living room" in text for _, text in shown)
    assert not np.array_equal(shown[0][0], shown[1][0])
    np.testing.assert_array_equal(shown[0][0], shown[3][0])  # Space led back.


def test_nothing_is_told_without_the_token(window):
    base = window.link.partition("/?")[0]
    for path in ("/", "/frames?token=guess", "/key?key=w", "/text?after=1"):
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
    with pytest.raises(UsageError, match="no key was pressed within 0.1 s; open http://127"):
        play(env, open_browser=False, patience_s=0.1)
    env.close()
    assert env.window is None


def test_only_single_moves_are_played(flat):
    env = VlnEnv(flat, eyes=Eyes(32, 24), observations=["pose"], move_set="macro")
    with pytest.raises(UsageError, match='render_mode="human" and the discrete action space'):
        play(env)
