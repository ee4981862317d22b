"""A room in words: by rule, in the form of each method, or by a model."""

import io
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from tests.external_models.scripted_server import scripted

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import ServerError, UnknownNameError
from world2minecraft.core.types import Layout, Opening, Placement
from world2minecraft.external_models.chat_client import open_chat
from world2minecraft.external_models.chat_messages import Picture
from world2minecraft.paper.layouts import ComparedScene
from world2minecraft.paper.layouts.importers.value_checks import Box, object_of
from world2minecraft.paper.layouts.room_description import (
    describe_photos,
    describe_scene,
    for_method,
    layoutgpt_px_m,
    room_kind,
)

ROOM = Layout(
    [[0, 0], [4, 0], [4, 3], [0, 3]], 2.6, (Opening("window", [1, 3], [2.5, 3], 0.9, 2.0),)
)


def thing(name, center, size, yaw=0.0):
    return object_of(Box(name, center, size, yaw))


SCENE = ComparedScene(
    "room",
    "method",
    (ROOM,),
    (
        thing("double_bed", (1.0, 1.5, 0.25), (2.0, 1.6, 0.5)),
        thing("nightstand_1", (0.25, 0.4, 0.25), (0.4, 0.45, 0.5)),
        thing("nightstand_2", (0.25, 2.6, 0.25), (0.4, 0.45, 0.5)),
        thing("wardrobe", (2.4, 0.35, 1.0), (0.6, 1.2, 2.0), 90.0),
    ),
)

WORDS = (
    "A bedroom of 4.0 m from west to east and 3.0 m from south to north, 2.6 m high. There is a "
    "window of 1.5 m in the north wall. There is one double bed (1.6 m wide, 2.0 m deep, 0.5 m "
    "high) at the west wall. There are two nightstands (0.5 m wide, 0.4 m deep, 0.5 m "
    "high) at the west wall. There is one wardrobe (1.2 m wide, 0.6 m deep, 2.0 m high) at the "
    "south wall.\n"
)


def test_a_room_in_plain_words():
    assert describe_scene(SCENE) == WORDS


def test_things_of_a_run_have_the_names_of_its_furniture():
    placed = [
        Placement(1, int(SemanticClass.SOFA), "sofa_two_seats", np.array([2, 1.5, 0.4]),
                  np.array([0.9, 1.4, 0.8]), 1, 0.9),
        Placement(2, int(SemanticClass.FURN), "cells", np.array([0.5, 0.5, 0.5]),
                  np.array([1.0, 1.0, 1.0]), 0, 0.0),
    ]  # fmt: skip
    words = describe_scene(ComparedScene("r", "ours", (ROOM,), tuple(placed)))
    assert "A living room" in describe_scene(
        ComparedScene("r", "ours", (ROOM,), (thing("sofa", (1, 1, 0.4), (0.9, 1.4, 0.8)),))
    )
    assert "one loveseat (1.4 m wide, 0.9 m deep, 0.8 m high)" in words
    assert "one piece of furniture" in words


def test_each_room_of_a_home_has_its_words():
    other = Layout([[5, 0], [8, 0], [8, 3], [5, 3]], 2.6)
    home = ComparedScene(
        "home", "m", (ROOM, other), (*SCENE.objects, thing("toilet", (6, 1, 0.4), (0.7, 0.4, 0.8)))
    )
    first, second = describe_scene(home).strip().split("\n\n")
    assert first == WORDS.strip() and second.startswith("A bathroom")
    assert room_kind(ComparedScene("x", "m", (ROOM,), ())) == "room"


def test_the_form_of_each_method():
    assert for_method("text", SCENE, WORDS) == WORDS
    condition = for_method("layoutgpt", SCENE, WORDS)
    assert condition.endswith("Room Size: max length 341px, max width 256px\n")
    assert "Room Type: bedroom" in condition
    px_m = layoutgpt_px_m(SCENE)  # What comes back by this is as large as the room is.
    assert [round(side * px_m, 2) for side in (341, 256)] == [4.0, 3.0]
    told = for_method("idesign", SCENE, WORDS)
    assert told["room_dimensions"] == [4.0, 3.0, 2.6] and told["no_of_objects"] == 4
    task = for_method("layoutvlm", SCENE, WORDS)
    assert task["boundary"]["floor_vertices"][2] == [4.0, 3.0, 0]
    with pytest.raises(UnknownNameError, match="did you mean 'layoutvlm'"):
        for_method("layoutvml", SCENE, WORDS)


def test_a_model_describes_photos():
    with scripted(["A small kitchen."]) as server:
        assert describe_photos(open_chat(server.url), [Picture(b"x")]) == "A small kitchen.\n"
        parts = server.requests[0]["messages"][0]["content"]
        assert [part["type"] for part in parts] == ["text", "image_url"]
    with scripted([" "]) as server, pytest.raises(ServerError, match="did not describe the photos"):
        describe_photos(open_chat(server.url), [Picture(b"x")])


def test_photos_are_spread_over_a_capture_and_made_small(tmp_path, monkeypatch):
    from world2minecraft.paper.layouts import room_description as photos

    paths = []
    for n in range(10):
        path = tmp_path / f"{n}.png"
        Image.fromarray(np.full((1200, 1600, 3), 20 * n, np.uint8)).save(path)
        paths.append(path)

    found = SimpleNamespace(frames=[SimpleNamespace(colour_path=path) for path in paths])
    monkeypatch.setattr(photos, "find_capture", lambda place: found)
    shown = photos.capture_photos(tmp_path, 2)
    assert len(shown) == 2
    sizes = [Image.open(io.BytesIO(one.data)).size for one in shown]
    levels = [np.asarray(Image.open(io.BytesIO(one.data))).mean() for one in shown]
    assert sizes == [(1024, 768)] * 2
    assert levels == pytest.approx([40, 140], abs=3)
