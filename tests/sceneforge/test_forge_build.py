"""What the page gets of the blocks of an edited scene, and of what stops a person in them."""

import asyncio
import json
import struct
import threading
import zlib
from itertools import pairwise

import numpy as np
import pytest
from forge_serving import client, paint, served, small_editor
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as some

from world2minecraft.construction import build_volume
from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.editing.cleanup.passes import repair_volume
from world2minecraft.formats.occupancy_files import inner_corner_m
from world2minecraft.minecraft.physics import BlockWorld, Body, Keys, body_box, step
from world2minecraft.minecraft.physics.collisions import find_overlaps
from world2minecraft.rendering.mesh import mesh_of
from world2minecraft.rendering.mesh.packets import pack_arrays
from world2minecraft.sceneforge import build_preview as blocks
from world2minecraft.sceneforge.build_preview import BlockBuild, BuildOptions, SceneSnapshot
from world2minecraft.sceneforge.server import build_preview_routes as build_routes
from world2minecraft.sceneforge.session import Session


def unpacked(data: bytes, magic: bytes) -> dict:
    """What the page reads: the header, and each array by its name."""
    assert data[:4] == magic
    size = struct.unpack_from("<I", data, 4)[0]
    told = json.loads(data[8 : 8 + size])
    for name, row in told.pop("arrays").items():
        dtype, shape = np.dtype("<" + row["dtype"]), row["shape"]
        told[name] = np.frombuffer(
            data, dtype, int(np.prod(shape)), 8 + size + row["offset"]
        ).reshape(shape)
    return told


@pytest.fixture(scope="module")
def server():
    with served(small_editor()) as server:
        yield server


@pytest.fixture
def script(server):
    with client(server) as script:
        yield script


kinds = st.sampled_from(["uint8", "uint16", "int32", "float32", "float64"])
arrays = kinds.flatmap(
    lambda kind: some.arrays(np.dtype(kind), some.array_shapes(min_dims=1, min_side=0))
)


@given(st.dictionaries(st.text(min_size=1, max_size=5), arrays, max_size=4))
def test_arrays_come_back_as_they_were(held):
    found = unpacked(pack_arrays(b"TEST", {"said": "ü"}, held), b"TEST")
    assert found.pop("said") == "ü"
    assert found.keys() == held.keys()
    for name, values in held.items():
        assert found[name].dtype == values.dtype and found[name].shape == values.shape
        assert found[name].tobytes() == values.tobytes()


def test_a_build_is_the_one_that_would_be_written(server, script):
    document = server.session.document
    got = unpacked(script.get("/api/build").content, b"W2MB")
    grid = document.draft.grid()
    corner = inner_corner_m(grid)
    volume = repair_volume(build_volume(grid, (), (), corner_m=corner, name=document.name))[0]
    mesh = mesh_of(volume)
    assert got["palette"] == list(volume.palette)
    assert (got["rev"], got["blocks_per_metre"], got["style"]) == (0, 4.0, "blocks")
    assert got["blocks"] == np.count_nonzero(volume.states)
    assert np.array_equal(got["position"].reshape(-1, 4, 3), mesh.position)
    assert np.array_equal(got["kind"][::4, 0], mesh.layer)
    assert np.array_equal(got["kind"][::4, 1], mesh.semantic + 256 * mesh.cuts.astype(int))
    assert np.array_equal(got["state"], mesh.state)
    room = apply(np.reshape(got["grid_to_room"], (4, 4)), got["position"].astype(float))
    size = np.array(grid.shape) * grid.voxel_m
    assert (room > grid.origin_m - 1.5).all() and (room < grid.origin_m + size + 1.5).all()


def test_a_build_shows_the_scene_as_it_is_edited_now(script):
    before = script.get("/api/build", params={"blocks_per_metre": 12.5})
    said = script.post("/api/do", json=paint(500, 40, 8)).json()
    after = script.get("/api/build", params={"blocks_per_metre": 12.5})
    assert after.headers["X-Rev"] == str(said["rev"])
    assert after.content != before.content
    script.post("/api/undo")
    again = unpacked(script.get("/api/build", params={"blocks_per_metre": 12.5}).content, b"W2MB")
    old = unpacked(before.content, b"W2MB")
    assert np.array_equal(again["position"], old["position"])


def test_a_build_that_was_made_is_not_made_again(server, script, monkeypatch):
    made = []
    monkeypatch.setattr(blocks, "mesh_of", lambda volume: made.append(1) or mesh_of(volume))
    asked = {"style": "voxels"}
    one = script.get("/api/build", params=asked)
    with client(server) as other:
        two = other.get("/api/build", params=asked)
    assert one.content == two.content and len(made) == 1
    script.post("/api/do", json=paint(500, 4, 8))
    script.get("/api/build", params=asked)
    script.post("/api/undo")
    assert len(made) == 2


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ("blocks_per_metre=lots", "blocks_per_metre must be a number such as 4, got 'lots'"),
        ("blocks_per_metre=nan", "must be 0.25 to 100, got nan; try 1, 2, 4 or 12.5"),
        ("blocks_per_metre=0", "blocks_per_metre must be 0.25 to 100, got 0.0"),
        ("style=block", "no style is named 'block'; did you mean 'blocks'?"),
    ],
)
def test_a_wrong_wish_is_refused_with_what_is_right(script, asked, said):
    answer = script.get(f"/api/build?{asked}")
    assert answer.status_code == 400 and said in answer.json()["error"]


def test_too_many_blocks_are_refused_before_they_are_made():
    scene = SceneSnapshot.of(small_editor((200, 200, 120)))

    with pytest.raises(UsageError, match="choose fewer"):
        BlockBuild.of(scene, BuildOptions(100.0))


def test_options_are_checked():
    with pytest.raises(UnknownNameError):
        BuildOptions(4.0, "")


def world_of(got: dict) -> BlockWorld:
    ends = got["starts"]
    shapes = [got["boxes"][a:b] for a, b in pairwise(ends)]
    return BlockWorld(got["kinds"], shapes, (0, 0, 0))


@pytest.mark.parametrize("asked", ["what=build&blocks_per_metre=4", "what=voxels"])
def test_a_person_stands_and_walks_in_what_is_sent(script, asked):
    got = unpacked(script.get(f"/api/collision?{asked}").content, b"W2MC")
    world, scale = world_of(got), got["blocks_per_metre"]
    body = Body(tuple(got["feet"]))
    box = body_box(body.position, scale)
    assert not find_overlaps(world.near(box[:3], box[3:]), box, 1e-6).any()
    for _ in range(10):
        body = step(world, body, Keys(), scale)
    assert body.on_ground
    place = np.reshape(got["grid_to_room"], (4, 4)) @ [*body.position, 1]
    assert abs(place[2]) < 0.3, "the floor's top is z = 0, give or take a block"


def test_voxels_stop_a_person_where_they_are(server, script):
    got = unpacked(script.get("/api/collision?what=voxels").content, b"W2MC")
    draft = server.session.document.draft
    solid = np.argwhere(got["kinds"] > 0) + 0.5
    room = apply(np.reshape(got["grid_to_room"], (4, 4)), solid)
    cells = np.round((room - draft.origin_m) / draft.voxel_m - 0.5).astype(int)
    assert set(map(tuple, cells.tolist())) == set(
        map(tuple, np.argwhere(draft.labels % 255).tolist())
    )


def test_an_unknown_kind_of_boxes_is_refused(script):
    answer = script.get("/api/collision?what=air")
    assert answer.json()["error"] == "what must be 'build' or 'voxels', got 'air'"


def test_a_room_opened_during_a_build_never_gets_its_blocks(monkeypatch, tmp_path):
    begun, go_on = threading.Event(), threading.Event()

    def slowly(scene: SceneSnapshot) -> bytes:
        begun.set()
        go_on.wait(20)
        return str(scene.grid.shape).encode()

    monkeypatch.setattr(build_routes, "voxel_collision", slowly)

    async def scenario():
        session = Session(small_editor((4, 4, 4), tmp_path / "a"))
        builds = build_routes.BuildCache(session)
        first = asyncio.create_task(builds.collision(None))
        await asyncio.to_thread(begun.wait, 20)
        await session.show(small_editor((5, 5, 5), tmp_path / "b"))
        go_on.set()
        await first
        return zlib.decompress((await builds.collision(None))[1], 31)

    assert asyncio.run(scenario()) == b"(5, 5, 5)"
