"""A scene and a pose as 32-bit words say what the tables say in 64 bits."""

import re
from dataclasses import replace

import numpy as np
import pytest
from block_models_for_tests import FewLooks
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import random_volume
from test_render_display_entities import random_entity

from world2minecraft.rendering import prepare_scene
from world2minecraft.rendering import scene_tables as tables_module
from world2minecraft.rendering.gpu import scene_buffers as packing
from world2minecraft.rendering.gpu.device import BINDINGS, shader_text
from world2minecraft.rendering.gpu.readback_buffers import MAX_JOBS, plan_submissions
from world2minecraft.rendering.gpu.uniforms import (
    AT_CORNERS,
    AT_ENCODE,
    SCALARS,
    TONE_BYTES,
    VIEW,
    PictureRequest,
    entry_distance,
    parameter_bytes,
    plane_layout,
    struct_text,
    tone_words,
    view_of,
)
from world2minecraft.rendering.scene_tables import ABSOLUTE, BOXES, FLAGS, FULL, TURN
from world2minecraft.rendering.shading_parameters import DAY, shading_parameters


def scene_of(seed=0):
    rng = np.random.default_rng(seed)
    volume = random_volume(rng)
    entities = tuple(random_entity(rng, volume, n) for n in range(4))
    return prepare_scene(replace(volume, entities=entities), FewLooks({1: "glass", 4: "diagonal"}))


def ask_of(scene, size=(36, 48), outputs=("colour",), samples=1):
    layout = plane_layout(outputs, True)
    return PictureRequest(size, (30.0, 30.0, 24.0, 18.0), 1.0, samples, layout)


def test_cells_say_what_space_and_looks_say():
    tables = scene_of().tables
    words = packing.cell_words(tables).reshape(tables.space.shape)
    assert np.array_equal(words[tables.space >= 0], tables.space[tables.space >= 0])
    code = -1 - words
    assert ((code & 1 == 1) == (tables.space == BOXES))[words < 0].all()
    assert ((code & 1 == 0) == (tables.space == FULL))[words < 0].all()
    assert np.array_equal((code >> 1)[words < 0], tables.looks[words < 0])


def test_rotated_elements_keep_points_relative_to_anchors():
    tables = scene_of().tables
    scene = packing.pack_scene(scene_of())
    elements = scene.tables[scene.offsets["at_elements"] : scene.offsets["at_turns"]]
    elements = elements.reshape(-1, packing.ELEMENT_WORDS)
    turns = scene.tables[scene.offsets["at_turns"] : -1].reshape(-1, packing.TURN_WORDS)
    turned = np.flatnonzero(tables.traits[:, TURN] >= 0)
    assert len(turned) > 4
    for n in turned:
        row = elements[n].view(np.int32)[packing.TURN_WORD]
        anchor = elements[n].view(np.int32)[packing.ANCHOR_WORD : packing.FACES_WORD]
        matrix = turns[row].view(np.float32)[:12].reshape(3, 4).astype(float)
        point = np.random.default_rng(n).uniform(-9, 9, 3)
        old = tables.turns[tables.traits[n, TURN]]
        expected = old[:, :3] @ point + old[:, 3]
        assert np.allclose(matrix[:, :3] @ (point - anchor) + matrix[:, 3], expected, atol=1e-5)
        if not tables.traits[n, FLAGS] & ABSOLUTE:
            assert not anchor.any()


def test_bytes_are_known_before_they_are_made():
    scene = scene_of()
    buffers = packing.pack_scene(scene).buffers
    assert {name: array.nbytes for name, array in buffers.items()} == packing.buffer_bytes(scene)
    assert {array.dtype.itemsize for array in buffers.values()} == {4}


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(-1e6, 1e6), min_size=3, max_size=3))
def test_a_view_is_a_cell_and_a_place_in_it(eye):
    pose = np.concatenate([np.eye(3), np.array(eye)[:, None]], axis=1)
    view = view_of(pose, 8)
    inside = view["rows"][:, 3]
    assert ((inside >= 0) & (inside <= 1)).all()
    assert np.allclose(view["base"] + inside.astype(float), eye, atol=1e-6, rtol=0)
    assert view["first_row"] == 8


def test_the_farthest_views_still_fit_whole_numbers():
    pose = np.concatenate([np.eye(3), np.full((3, 1), 1e300)], axis=1)
    assert view_of(pose, 0)["base"].tolist() == [1 << 30] * 3


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000))
def test_no_parallel_ray_enters_the_grid_before_the_way_ahead(seed):
    rng = np.random.default_rng(seed)
    shape = tuple(rng.integers(1, 30, 3))
    pose = np.concatenate(
        [np.linalg.qr(rng.normal(size=(3, 3)))[0] * 4, rng.normal(size=(3, 1)) * 80], axis=1
    )
    ahead = entry_distance(pose, shape)
    points = rng.uniform(0, shape, (200, 3))
    ways = (points - pose[:, 3]) @ pose[:, 2] / (pose[:, 2] @ pose[:, 2])
    assert ahead >= 0
    assert ahead == 0 or (ways > ahead).all()


def test_the_struct_and_its_bytes_have_the_same_members():
    scene = scene_of()
    members = re.findall(r"  (\w+): (\w+),", struct_text())
    assert members == list(SCALARS)
    offsets = packing.pack_scene(scene).offsets
    data = parameter_bytes(ask_of(scene), shading_parameters(DAY, scene), scene, offsets, 36)
    assert len(data) % 16 == 0
    words = np.frombuffer(data, np.uint32)
    names = [name for name, _ in SCALARS]
    assert words[names.index("width")] == 48
    assert words[names.index("at_refs")] == offsets["at_refs"]
    assert words.view(np.float32)[names.index("fx")] == 30.0


def test_the_tone_is_a_table_of_light_and_a_table_of_the_screen():
    lamp = shading_parameters(DAY, scene_of())
    words = tone_words(lamp)
    assert np.array_equal(words[:256].view(np.float32), lamp.tone.decode)
    assert np.array_equal(words[AT_ENCODE:AT_CORNERS].view(np.uint8), lamp.tone.encode)
    assert np.array_equal(words[AT_CORNERS:].view(np.float32), lamp.corners.ravel())
    assert words.nbytes == TONE_BYTES


def test_the_shader_knows_every_flag_of_an_element():
    said = dict(re.findall(r"const ([A-Z_]+): u32 = (\d+)u;", shader_text()))
    names = ("ABSOLUTE", "SEE_THROUGH", "UNSHADED", "JOINS", "EVEN", "PANE")
    assert {name: int(said[name]) for name in names} == {
        name: getattr(tables_module, name) for name in names
    }
    flags = {1 << bit for bit in range(6)}
    assert {getattr(tables_module, name) for name in names} == flags


def test_the_shader_names_each_binding_once_and_few_enough():
    text = shader_text()
    assert len(re.findall(r"@binding\(", text)) == len(BINDINGS) == 9
    assert len(re.findall(r"var<storage", text)) <= 8  # What every WebGPU device gives.
    assert max(map(len, text.splitlines())) <= 110


@pytest.mark.parametrize("samples", [1, 4])
@pytest.mark.parametrize("size", [(1, 1), (36, 48), (1129, 1920), (8000, 8000)])
def test_a_plan_covers_a_picture_within_its_bytes(size, samples):
    ask = ask_of(scene_of(), size, ("colour", "opaque", "normal"), samples)
    for pictures in (1, 1000, None):
        plan = plan_submissions(ask, pictures)
        assert 1 <= plan.band_rows <= size[0]
        assert 1 <= plan.jobs <= MAX_JOBS
        assert plan.words == plan.band_rows * size[1] * ask.layout.planes
        assert 4 * plan.words * plan.jobs <= 64 << 20


def test_a_view_has_the_bytes_of_the_shaders_struct():
    assert VIEW.itemsize == 80
