"""The kernel sees what the oracle sees, indoors and inside odd models; what is off is noticed."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.check_render import LEAST_EQUAL, MOST_MEDIAN_M, compare, differences
from benchmarks.render_scenes import (
    RandomLooks,
    camera_of,
    poses,
    random_models,
    scene_looks,
    storeys,
)
from benchmarks.rival_rasteriser import mesh_of
from oracle import Hits, WithoutGlass, has_face, oracle_picture
from scenes import CAMERA

from world2minecraft.rendering import LightSettings, prepare_scene, render_volume
from world2minecraft.rendering.block_elements import BlockModel, Element


def flats():
    return storeys((26, 14, 26), ground=1, furnished=0.3, seed=3)


@pytest.mark.parametrize("inside", [False, True])
def test_flats_are_seen_as_the_oracle_sees_them(inside):
    volume, looks = flats(), scene_looks()
    row = compare(volume, looks, CAMERA, poses(volume, 6, 1, looks=looks, inside=inside))
    assert row.equal >= LEAST_EQUAL
    assert row.median_m < MOST_MEDIAN_M
    assert row.worst_m < 1e-4


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_odd_models_are_seen_as_the_oracle_sees_them(seed, inside):
    volume, looks = random_models(seed), RandomLooks(seed)
    row = compare(volume, looks, CAMERA, poses(volume, 5, seed, looks=looks, inside=inside))
    assert row.equal >= LEAST_EQUAL
    assert row.median_m < MOST_MEDIAN_M


def test_a_camera_a_millimetre_off_is_noticed():
    volume, looks = flats(), scene_looks()
    row = compare(volume, looks, CAMERA, poses(volume, 3, 1), spoil_m=1e-3)
    assert not row.holds


def test_an_element_a_sixteenth_off_is_noticed():
    volume, looks = random_models(0), RandomLooks(0)
    (pose,) = poses(volume, 1, 0, looks=looks)
    picture = render_volume(prepare_scene(volume, Moved()), CAMERA, pose, outputs=())
    same, _ = differences(picture, volume, looks, CAMERA, pose)
    assert same.mean() < 0.999


class Moved(RandomLooks):
    """The odd models with every box a sixteenth lower."""

    def model(self, state: str) -> BlockModel | None:
        model = super().model(state)
        return model and BlockModel(tuple(map(lowered, model.elements)))


def lowered(element: Element) -> Element:
    low, high = element.low, element.high
    return replace(
        element,
        low=(low[0], max(low[1] - 1 / 16, 0.0), low[2]),
        high=(high[0], max(high[1] - 1 / 16, 1 / 16), high[2]),
    )


@pytest.mark.parametrize("seed", [0, 5])
def test_what_lies_behind_glass_is_what_is_there_without_it(seed):
    volume, looks = random_models(seed), RandomLooks(seed)
    scene = prepare_scene(volume, looks)
    equal, errors = [], []
    for pose in poses(volume, 4, seed, looks=looks):
        picture = render_volume(scene, CAMERA, pose, outputs=("opaque",))
        truth = oracle_picture(volume, WithoutGlass(looks), CAMERA, pose)
        same = picture.opaque_index == truth.index
        equal.append(same.mean())
        errors.append(np.abs(picture.opaque_depth_m - truth.depth)[same & (truth.index >= 0)])
    assert np.mean(equal) >= LEAST_EQUAL
    assert np.median(np.concatenate(errors)) < MOST_MEDIAN_M


def test_normals_are_those_of_the_oracle():
    volume, looks = random_models(4), RandomLooks(4)
    scene = prepare_scene(volume, looks)
    for pose in poses(volume, 3, 5, looks=looks):
        picture = render_volume(scene, CAMERA, pose, outputs=("normal",))
        truth: Hits = oracle_picture(volume, looks, CAMERA, pose)
        same = has_face(truth, picture.face) & (picture.block_index == truth.index)
        off = np.abs(picture.normal - truth.normal).max(axis=-1)
        assert (off[same] < 1e-6).mean() >= LEAST_EQUAL


def test_the_rivals_mesh_has_no_faces_between_cubes():
    states = np.zeros((4, 3, 3), np.uint16)
    states[1:3, 1, 1] = 1
    volume = replace(flats(), states=states, semantic=states.astype(np.uint8), instance=states)
    mesh = mesh_of(prepare_scene(volume).tables, LightSettings().parameters(1.0))
    assert mesh.quads == 10
    places = mesh.vertices["place"]
    assert places.min(axis=0).tolist() == [1, 1, 1]
    assert places.max(axis=0).tolist() == [3, 2, 2]


def test_the_scenes_are_the_same_every_time():
    first, again = flats(), flats()
    assert np.array_equal(first.states, again.states)
    assert np.array_equal(poses(first, 3, 2), poses(again, 3, 2))
    assert camera_of(64, 48).fy_px == pytest.approx(24 / np.tan(np.radians(35)))
