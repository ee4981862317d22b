"""The page of a shared room: what is in it, what it may do, and that names stay names."""

import base64
import hashlib
import html
import json
import struct
import zlib
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import world2minecraft as w2m
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import InputError, LimitError, UsageError
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.schematics.sponge import write_schem
from world2minecraft.procgen.worlds import write_worlds
from world2minecraft.rendering.mesh import mesh_of
from world2minecraft.rendering.mesh.packets import compact_mesh_arrays
from world2minecraft.rendering.mesh.viewer_page import ICON, assemble
from world2minecraft.sceneforge.share import page as pages
from world2minecraft.sceneforge.share import room_data
from world2minecraft.sceneforge.share.photos import choose_photos, spread_out
from world2minecraft.sceneforge.share.room_data import SharedPacket, SharedRoom

UNIT = 4096
HOSTILE = "</script><img src=x onerror=alert(1)>\"'&<!--\u2028"
PALETTE = (
    AIR,
    "minecraft:stone",
    "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:glass",
    "minecraft:poppy",
    "minecraft:oak_fence[east=true,north=false,south=false,waterlogged=false,west=false]",
)


class Elements(HTMLParser):
    """What a browser makes of a page: its elements, and the text in each of them."""

    def __init__(self, page: bytes):
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[str] = []
        self.is_open = False
        self.feed(page.decode())

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))
        self.texts.append("")
        self.is_open = True

    def handle_endtag(self, tag):
        self.is_open = False

    def handle_data(self, data):
        if self.is_open:
            self.texts[-1] += data

    def of(self, tag: str) -> list[tuple[dict[str, str | None], str]]:
        every = zip(self.found, self.texts, strict=True)
        return [(attrs, text) for (name, attrs), text in every if name == tag]


def block(page: bytes, name: str) -> bytes:
    [text] = [text for attrs, text in Elements(page).of("script") if attrs.get("id") == name]
    return base64.b64decode(text, validate=True)


def unpacked(packet: bytes) -> dict:
    """A second reader of the packet, by the words of its documentation."""
    data = zlib.decompress(packet)
    assert data[:4] == b"W2MS"
    [size] = struct.unpack_from("<I", data, 4)
    told = json.loads(data[8 : 8 + size])
    for name, row in told.pop("arrays").items():
        count = int(np.prod(row["shape"]))
        values = np.frombuffer(data, "<" + row["dtype"], count, 8 + size + row["offset"])
        told[name] = values.reshape(row["shape"])
    return told


def quads(planes: np.ndarray, wide: int) -> np.ndarray:
    """Four corners a quad, from planes of bytes of a corner and two edges."""
    weights = np.array([1, 1 << 8, 1 << 16, 1 << 24], np.uint64)
    whole = (planes.astype(np.uint64) * weights[:, None, None]).sum(axis=0)
    numbers = np.where(whole >= 1 << 31, whole.astype(np.int64) - (1 << 32), whole) / UNIT
    first, one, two = numbers.reshape(3, wide, -1).transpose(0, 2, 1)
    return np.stack([first, first + one, first + one + two, first + two], axis=1)


def world(shape, cells) -> BlockVolume:
    states = np.zeros(shape, np.uint16)
    instance = np.zeros(shape, np.uint16)
    for place, state, owner in cells:
        at = tuple(p % side for p, side in zip(place, shape, strict=True))
        states[at], instance[at] = state, owner
    semantic = np.where(instance > 0, 11, 0).astype(np.uint8)
    return BlockVolume(states, PALETTE, semantic, instance, (3, 60, -2), block_to_room((0, 3), 4.0))


places = st.tuples(*[st.integers(0, 5)] * 3)
cells = st.tuples(places, st.integers(0, len(PALETTE) - 1), st.integers(0, 300))
worlds = st.builds(
    world, st.tuples(*[st.integers(1, 5)] * 3), st.lists(cells, min_size=1, max_size=25)
)


@settings(max_examples=20)
@given(worlds, st.text(max_size=40))
def test_blocks_of_small_worlds_come_back_from_the_page(volume, title):
    mesh = mesh_of(volume)
    packet = SharedPacket({"title": title}, compact_mesh_arrays(mesh)).compressed()
    page = assemble(title, {"room-data": packet})
    got = unpacked(block(page, "room-data"))
    assert got["title"] == title
    assert np.abs(quads(got["corners"], 3) - mesh.position).max(initial=0) <= 2 / UNIT
    assert np.abs(quads(got["uvs"], 2) - mesh.uv).max(initial=0) <= 2 / UNIT
    assert np.array_equal(got["lights"][:12].T.reshape(-1, 4, 3), mesh.light)
    assert np.array_equal(got["lights"][12], mesh.emission)
    assert np.array_equal(got["colours"].T, np.column_stack([mesh.tint, mesh.shade]))
    layer, kind, cover, instance = got["kinds_of_quads"]
    assert np.array_equal(layer, mesh.layer) and np.array_equal(cover, mesh.cover)
    assert np.array_equal(kind % 256, mesh.semantic) and np.array_equal(kind // 256, mesh.cuts)
    assert np.array_equal(instance, mesh.instance)


@pytest.fixture(scope="module")
def room(example_run) -> SharedRoom:
    return SharedRoom.read(example_run.folder)


@pytest.fixture(scope="module")
def page(room) -> bytes:
    return pages.room_page(room)[0]


def test_the_page_may_run_its_own_script_and_fetch_nothing(page):
    elements = Elements(page)
    metas = [attrs for attrs, _ in elements.of("meta")]
    [policy] = [m["content"] for m in metas if m.get("http-equiv") == "Content-Security-Policy"]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == rules["connect-src"] == rules["base-uri"] == "'none'"
    assert rules["img-src"] == "data: blob:" and "unsafe" not in policy
    [script] = [text for attrs, text in elements.of("script") if "id" not in attrs]
    [(_, style)] = elements.of("style")
    for name, text in (("script-src", script), ("style-src", style)):
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert rules[name] == f"'sha256-{digest}'"
    links = [attrs.get("href") or attrs.get("src") for _, attrs in elements.found]
    assert [link for link in links if link] == [ICON]
    assert "Copyright © 2010-2026 three.js authors" in page.decode()  # As its licence demands.
    assert not any(name.startswith("on") for _, attrs in elements.found for name in attrs)


def test_hostile_names_stay_names(room):
    things = tuple(replace(one, name=HOSTILE, noun=HOSTILE) for one in room.landmarks[:2])
    hostile = replace(room, title=HOSTILE, landmarks=things)
    page, _ = pages.room_page(hostile)
    elements = Elements(page)
    assert len(elements.of("script")) == 4 and not elements.of("img")
    assert [html.unescape(text) for _, text in elements.of("title")] == [HOSTILE]
    assert HOSTILE.encode() not in page
    got = unpacked(block(page, "room-data"))
    assert {thing["name"] for thing in got["things"]} == {HOSTILE} == {got["title"]}


def test_ways_end_at_their_things_on_the_shortest_path(room):
    got, scene = unpacked(room.floor_packet().compressed()), room.scene
    feet, turns = got["feet_of_ways"].astype(float), got["turns"]
    assert len(turns) == len(room.landmarks) > 3
    rng = np.random.default_rng(0)
    for row, thing in zip(turns, room.landmarks, strict=True):
        goals = scene.goals_at(thing)
        if not goals:
            continue
        start = rng.choice(np.flatnonzero(row != room_data.NO_WAY))
        here, length = start, 0.0
        while row[here] != here:
            length += float(np.linalg.norm(feet[row[here]] - feet[here]))
            here = row[here]
        away = np.linalg.norm(feet[here] + room.volume.corner - np.array(goals), axis=1)
        assert away.min() < 1.0
        wanted = scene.corner_distances_m(goals)[start]
        assert length / scene.blocks_per_metre == pytest.approx(wanted, rel=0.02, abs=0.02)


def test_a_generated_house_fits_into_the_limit(tmp_path, monkeypatch):
    monkeypatch.setattr(room_data, "MAX_TURNS", 1_000_000)  # Ways to the first things alone.
    [house] = write_worlds(tmp_path, 1, 1)
    page, _ = pages.room_page(SharedRoom.read(house))
    assert len(page) < 3_000_000
    got, turns = (unpacked(block(page, name)) for name in ("room-data", "floor-data"))
    assert len(got["things"]) > 100 and len(turns["turns"]) > 10
    assert sum(thing["way"] >= 0 for thing in got["things"]) == len(turns["turns"])


def test_a_page_over_the_limit_says_what_to_do(room, monkeypatch):
    monkeypatch.setattr(pages, "MAX_PAGE_BYTES", 100_000)
    with pytest.raises(LimitError, match=r"limit is 0 MB; build it with fewer blocks \(w2m build"):
        pages.room_page(room)


def test_photos_fit_into_what_is_left(example_run, example_scan):
    many = choose_photos(example_run.folder, example_scan, 5, 4_000_000)
    few = choose_photos(example_run.folder, example_scan, 5, 30_000)
    assert len(many) == 5 and 0 < sum(len(one.jpeg) for one in few) <= 30_000
    assert [one.facts["name"] for one in many] == [f"Photo {n}" for n in range(1, 6)]
    assert not any(one.jpeg.count(b"Exif") for one in many)
    assert choose_photos(example_run.folder, example_scan, 5, 10) == ()
    with pytest.raises(UsageError, match=r"does not record where its photos are; .*--capture DIR"):
        choose_photos(example_run.folder, None, 5, 4_000_000)


@given(st.lists(st.tuples(*[st.floats(-5, 5)] * 3), max_size=12), st.integers(1, 6))
def test_photos_that_are_chosen_lie_apart(middles, most):
    poses = [np.eye(4) for _ in middles]
    for pose, middle in zip(poses, middles, strict=True):
        pose[:3, 3] = middle
    chosen = spread_out(poses, most)
    assert len(chosen) == len(set(chosen)) == min(most, len(poses))

    def gap(number: int, others: list[int]) -> float:
        return min(np.linalg.norm(poses[number][:3, 3] - poses[one][:3, 3]) for one in others)

    for count in range(1, len(chosen)):  # Each was the farthest from those before.
        farthest = max(gap(one, chosen[:count]) for one in range(len(poses)))
        assert gap(chosen[count], chosen[:count]) == pytest.approx(farthest)


def test_a_volume_without_floor_can_still_be_looked_at(tmp_path):
    flowers = world((3, 3, 3), [((0, 0, 0), 4, 0), ((2, 2, 2), 4, 0)])
    write_schem(flowers, tmp_path / "pieces.schem")
    page = tmp_path / "pieces.html"
    assert w2m.share(tmp_path / "pieces.schem", page).bytes == page.stat().st_size
    got = unpacked(block(page.read_bytes(), "room-data"))
    assert not got["can_walk"] and got["title"] == "Pieces"
    assert unpacked(block(page.read_bytes(), "floor-data"))["turns"].size == 0


FAULTS = [
    ("room.txt", {}, UsageError, "room.txt must end in .html, .gif"),
    ("room.gif", {"photos": 2}, UsageError, "is a film, which contains no photos"),
    ("room.html", {"photos": 99}, UsageError, "photos must be 0 to 24, got 99"),
    ("taken.html", {}, UsageError, "taken.html exists; use --force to replace it"),
    ("folder.html", {}, UsageError, "folder.html is a folder; give a file such as"),
]


@pytest.mark.parametrize(("name", "options", "error", "text"), FAULTS)
def test_faults_are_told_before_any_work(tmp_path, name, options, error, text):
    (tmp_path / "taken.html").write_text("mine")
    (tmp_path / "folder.html").mkdir()
    with pytest.raises(error) as caught:
        w2m.share(tmp_path / "nothing", tmp_path / name, **options)
    assert text in str(caught.value)
    assert (tmp_path / "taken.html").read_text() == "mine"


def test_a_missing_room_is_bad_input(tmp_path):
    with pytest.raises(InputError, match="not found"):
        w2m.share(tmp_path / "nothing", tmp_path / "room.html")
    assert not (tmp_path / "room.html").exists()
