"""Labels and masks are those of slow references, pixel by pixel and cell by cell."""

from dataclasses import replace

import label_reference as reference
import numpy as np
import pytest
from label_worlds import CAMERA, poses_in, room_of_things

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.labels.camera_region import RegionRule, region_in
from world2minecraft.minecraftocc.labels.image_labels import (
    cast_depth,
    cells_of_pixels,
    label_image,
    occluded_cells,
    resize_camera,
    unknown_cells,
)
from world2minecraft.minecraftocc.labels.voxelization import voxelize_scene
from world2minecraft.minecraftocc.sample_figure import project_labels
from world2minecraft.minecraftocc.types import OccSample
from world2minecraft.rendering import prepare_scene, render_volume

RULE = RegionRule(shape=(24, 22, 20))


@pytest.fixture(scope="module")
def world():
    volume = room_of_things(seed=5)
    scene = prepare_scene(volume)
    return volume, scene, voxelize_scene(volume, scene=scene)


@pytest.mark.parametrize("seed", range(6))
def test_labels_and_masks_are_those_of_the_reference(world, seed):
    volume, scene, voxels = world
    (pose,) = poses_in(volume, 1, seed)
    small = Camera(48, 36, 30.0, 30.0, 24.0, 18.0)
    depth_m = render_volume(scene, small, pose, outputs=()).depth_m
    region = region_in(voxels, pose, RegionRule(shape=(16, 18, 12)))
    occ = label_image(voxels, region, small, pose, depth_m)
    assert np.array_equal(occ.labels, reference.labels_of(voxels, region))
    assert np.array_equal(occ.in_frustum, reference.in_frustum(region, small, pose))
    seen = reference.scene_cells_seen(voxels, small, pose, depth_m)
    assert np.array_equal(occ.hits, reference.hits(voxels, region, seen))
    empty = np.argwhere(occ.labels == 0)
    free = reference.crossed(region, empty, small, pose, depth_m)
    assert np.array_equal(occ.free[tuple(empty.T)], free)


def test_every_pixel_lies_in_a_solid_cell(world):
    volume, scene, voxels = world
    for pose in poses_in(volume, 30, 50):
        depth_m = render_volume(scene, CAMERA, pose, outputs=()).depth_m
        seen = reference.scene_cells_seen(voxels, CAMERA, pose, depth_m)
        assert ((seen >= 0).all(axis=-1) == (depth_m > 0)).all()


def test_a_cell_a_block_says_what_the_ids_of_its_pixels_say(world):
    volume, scene, _ = world
    voxels = voxelize_scene(volume, voxel_m=None, scene=scene)
    rule = RegionRule(shape=(20, 20, 12), voxel_m=voxels.voxel_m)
    wrong = pixels = 0
    for pose in poses_in(volume, 20, 60):
        picture = render_volume(scene, CAMERA, pose)
        region = region_in(voxels, pose, rule)
        occ = label_image(voxels, region, CAMERA, pose, picture.depth_m)
        cells = cells_of_pixels(voxels, region, CAMERA, pose, picture.depth_m)
        mine = (cells >= 0) & (picture.block_index >= 0)
        wrong += (occ.instance.reshape(-1)[cells[mine]] != picture.instance[mine]).sum()
        pixels += mine.sum()
    # Where a display stands in a block's cell, one of the two is the cell's.
    assert wrong < 0.05 * pixels


@pytest.mark.parametrize("kind", ["paper", "free"])
def test_masks_are_laws(world, kind):
    volume, scene, voxels = world
    for pose in poses_in(volume, 6, 9):
        region = region_in(voxels, pose, RegionRule(kind, (24, 22, 20)))
        camera, depth_m = cast_depth(scene, CAMERA, pose)
        occ = label_image(voxels, region, camera, pose, depth_m)
        assert not (occ.free & (occ.fine > 0)).any()
        assert not (occ.visible & (occ.fine == 0)).any()
        parts = [occ.visible & occ.in_frustum, occluded_cells(occ), unknown_cells(occ)]
        parts.append(occ.free & occ.in_frustum)
        assert np.array_equal(np.sum(parts, axis=0) == 1, occ.in_frustum)


def test_a_rotated_region_samples_labels_and_hits(world):
    volume, scene, voxels = world
    (pose,) = poses_in(volume, 1, 3)
    depth_m = render_volume(scene, CAMERA, pose, outputs=()).depth_m
    region = region_in(voxels, pose, RegionRule("free", (14, 15, 9)))
    occ = label_image(voxels, region, CAMERA, pose, depth_m)
    seen = reference.scene_cells_seen(voxels, CAMERA, pose, depth_m)
    counts = np.zeros(voxels.labels.shape, int)
    np.add.at(counts, tuple(seen[(seen >= 0).all(axis=-1)].T), 1)
    cells = np.floor((region.centers_m() - voxels.origin_m) / voxels.voxel_m).astype(int)
    sampled = reference._at(counts, cells)
    sampling = {tuple(cell) for cell in cells.reshape(-1, 3).tolist()}
    assert np.array_equal(occ.labels, reference.labels_of(voxels, region))
    pixels = cells_of_pixels(voxels, region, CAMERA, pose, depth_m)
    shown = pixels >= 0
    own, theirs = cells.reshape(-1, 3)[pixels[shown]], seen[shown]
    taken = np.array([tuple(cell) not in sampling for cell in theirs.tolist()])
    assert np.array_equal(own[~taken], theirs[~taken])
    assert np.abs(own - theirs).max() <= 2  # The nearest, where no cell is the pixel's own.
    extra = np.bincount(pixels[shown][taken], minlength=occ.hits.size)
    assert np.array_equal(occ.hits.ravel(), sampled.ravel() + extra)
    assert (occ.fine[occ.visible] > 0).all()


def test_pixels_sum_up(world):
    volume, scene, voxels = world
    (pose,) = poses_in(volume, 1, 2)
    camera, depth_m = cast_depth(scene, CAMERA, pose, width_px=120)
    region = region_in(voxels, pose, RULE)
    occ = label_image(voxels, region, camera, pose, depth_m)
    cells = cells_of_pixels(voxels, region, camera, pose, depth_m)
    assert np.array_equal(np.bincount(cells[cells >= 0], minlength=occ.hits.size), occ.hits.ravel())
    assert occ.hits.sum() <= (depth_m > 0).sum()


def test_more_pixels_see_no_less_free_space(world):
    volume, scene, voxels = world
    (pose,) = poses_in(volume, 1, 4)
    region = region_in(voxels, pose, RULE)
    found = []
    for width_px in (32, 96, 96 * 3):  # Each pixel's ray is a ray of the three times finer image.
        camera, depth_m = cast_depth(scene, CAMERA, pose, width_px=width_px)
        found.append(label_image(voxels, region, camera, pose, depth_m).free)
    assert not (found[0] & ~found[1]).any()
    assert not (found[1] & ~found[2]).any()


def test_a_resized_camera_sees_the_same():
    camera = resize_camera(Camera(1920, 1129, 806.2, 806.2, 960.0, 564.5), 640)
    assert (camera.width_px, camera.height_px) == (640, 376)
    assert camera.fx_px / camera.width_px == pytest.approx(806.2 / 1920)
    assert camera.cy_px / camera.height_px == pytest.approx(0.5)


def test_depth_of_another_size_is_refused(world):
    volume, _, voxels = world
    (pose,) = poses_in(volume, 1, 2)
    with pytest.raises(ValueError, match=r"the shape of the camera, \(72, 96\), got \(3, 4\)"):
        label_image(
            voxels, region_in(voxels, pose, RULE), CAMERA, pose, np.zeros((3, 4), np.float32)
        )


def test_projected_labels_are_those_of_the_cells_seen(world):
    volume, scene, voxels = world
    (pose,) = poses_in(volume, 1, 7)
    picture = render_volume(scene, CAMERA, pose)
    region = region_in(voxels, pose, RULE)
    occ = label_image(voxels, region, CAMERA, pose, picture.depth_m)
    cells = cells_of_pixels(voxels, region, CAMERA, pose, picture.depth_m)
    told = occ.labels.reshape(-1)[np.maximum(cells, 0)]
    sample = OccSample("a-b-0", "a", "b", 0, CAMERA, pose, occ, voxels.fine_classes)
    for depth_m, share in ((picture.depth_m, 0.98), (None, 0.85)):
        image = project_labels(replace(sample, depth_m=depth_m))
        assert (image == told)[cells >= 0].mean() > share
    x, y, z = (invert_rigid(region.region_to_room) @ pose)[:3, 3] / region.voxel_m
    labels = np.array(occ.labels)
    labels[int(x), int(y), int(z)] = 11  # The camera stands in a cell that holds something.
    inside = replace(sample, occ=replace(occ, labels=labels))
    assert np.array_equal(project_labels(inside), project_labels(sample))
