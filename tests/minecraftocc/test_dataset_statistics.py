from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from tests.minecraftocc.samples import FINE, occ_labels, random_labels, sample

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.minecraftocc.importers.imported_samples import CLASS_KINDS
from world2minecraft.minecraftocc.statistics import (
    StatisticsCounter,
    count_samples,
    picture_counts,
)
from world2minecraft.minecraftocc.statistics.counting import WorldCells
from world2minecraft.minecraftocc.types import FineClass, LabelRegion


def slow_statistics(samples):
    """Cell by cell, with Python's own sets."""
    voxels, cells, pixels, clear = Counter(), set(), Counter(), Counter()
    for one in samples:
        seen = Counter()
        centers = one.occ.region.centers_m()
        for place in np.ndindex(one.occ.region.shape):
            label = int(one.occ.labels[place])
            if one.occ.in_frustum[place] and label != 255:
                voxels[CLASS_NAMES[label]] += 1
                if label:
                    cells.add((one.scene_id, *np.floor(centers[place] / 0.5 + 1e-6).astype(int)))
            if one.occ.hits[place] and one.occ.fine[place]:
                name = FINE[one.occ.fine[place]].name
                seen[name] += int(one.occ.hits[place])
        pixels += seen
        clear += Counter({name: 1 for name, count in seen.items() if count >= 100})
    return voxels, cells, pixels, clear


@pytest.fixture
def samples():
    places = [(0.5 * n, -1.0 * n, 0.0) for n in range(8)]
    labels = [
        random_labels(n, at_m=places[n], turn_deg=90 * n) if n < 6 else random_labels(n)
        for n in range(8)
    ]
    scenes = ["house_0001", "house_0002"] * 4
    return [sample(n, scenes[n], labels[n], "test" if n == 7 else "train") for n in range(8)]


def test_counts_are_those_of_the_slow_reference(samples):
    statistics = count_samples(samples).result("made up")
    voxels, cells, pixels, clear = slow_statistics(samples)
    assert dict(zip(CLASS_NAMES, statistics.class_voxels, strict=True)) == {
        name: voxels[name] for name in CLASS_NAMES
    }
    assert statistics.distinct_cells == len(cells) < statistics.voxels
    assert {one.name: (one.pixels, one.clear_pictures) for one in statistics.fine} == {
        name: (pixels[name], clear[name]) for name in pixels
    }
    assert statistics.voxels == sum(voxels.values()) - voxels["empty"]
    assert statistics.splits == {"train": 7, "test": 1}
    whole = sum(int((one.occ.occupied).sum()) for one in samples)
    assert statistics.uncut_voxels == whole > statistics.voxels
    assert (statistics.pictures, statistics.resolution) == (8, "640x480")
    assert [scene.pictures for scene in statistics.scenes] == [4, 4]
    assert statistics.voxels_per_scene == statistics.voxels / 2


@pytest.mark.parametrize("cut", range(9))
def test_parts_add_up_to_the_whole_in_any_cut(samples, cut):
    whole = count_samples(samples).result("x")
    first, second = count_samples(samples[:cut]), count_samples(samples[cut:])
    first.merge(second)
    assert first.result("x") == whole
    backwards = count_samples(samples[::-1]).result("x")
    assert backwards == whole


def test_a_cell_that_two_pictures_hold_counts_twice_and_once():
    labels = occ_labels()
    labels.labels.flags.writeable = False
    wall = labels.labels.copy()
    wall[1, 2, 3] = 3
    one = replace(labels, labels=wall)
    statistics = count_samples([sample(0, occ=one), sample(1, occ=one)]).result("x")
    assert (statistics.voxels, statistics.distinct_cells) == (2, 1)
    # The same cell of the world, seen by a region that is turned and moved.
    turned = occ_labels(at_m=(1.5, 0.5, 1.0), turn_deg=90)
    wall = turned.labels.copy()
    centers = turned.region.centers_m()
    place = tuple(np.argwhere(np.isclose(centers, [0.75, 1.25, 1.75]).all(axis=-1))[0])
    wall[place] = 3
    both = count_samples([sample(0, occ=one), sample(1, occ=replace(turned, labels=wall))])
    assert both.result("x").distinct_cells == 1
    apart = count_samples([sample(0, occ=one), sample(1, "house_0002", occ=one)])
    assert apart.result("x").distinct_cells == 2


def test_cells_of_turned_regions_add_up_part_by_part():
    """Each part lays its grid by its first region, which may be turned and lie anywhere."""
    parts = [WorldCells(), WorldCells()]
    for turn_deg, part in zip((10.0, 33.0), parts, strict=True):
        to_room = rotation_about_z(turn_deg)
        to_room[:3, 3] = 0.004 * turn_deg, -0.29, 0.11
        region = LabelRegion((6, 6, 6), 0.08, to_room, "free")
        part.add(region, np.ones(region.shape, bool))
    counts = [part.count() for part in parts]
    parts[0].merge(parts[1])
    assert max(counts) < parts[0].count() < sum(counts)


def test_grids_that_rounding_parts_by_a_cell_are_one():
    parts = [WorldCells(), WorldCells()]
    for off_m, part in zip((-1e-9, 1e-9), parts, strict=True):
        to_room = np.eye(4)
        to_room[:3, 3] = 0.04 + off_m  # The centres lie on whole multiples of the cell.
        part.add(LabelRegion((6, 6, 6), 0.08, to_room), np.ones((6, 6, 6), bool))
    parts[0].merge(parts[1])
    assert parts[0].count() == 6**3


def test_what_is_out_of_the_frustum_or_unknown_is_no_voxel():
    labels = occ_labels()
    values, inside = labels.labels.copy(), np.ones(labels.labels.shape, bool)
    values[0, 0, 0], values[0, 0, 1], values[0, 0, 2] = 3, 255, 5
    inside[0, 0, 2] = False
    counted = picture_counts(sample(occ=replace(labels, labels=values, in_frustum=inside)))
    assert counted.class_voxels[3] == 1
    assert counted.class_voxels[1:].sum() == 1


def test_a_design_is_one_class_whatever_it_is_made_of():
    labels = occ_labels()
    fine, hits = labels.fine.copy(), labels.hits.copy()
    fine[0, 0], hits[0, 0] = [2, 3, 1, 4], [60, 50, 200, 99]
    pictures = [sample(n, occ=replace(labels, fine=fine, hits=hits)) for n in range(3)]
    statistics = count_samples(pictures).result("x")
    by_name = {one.name: one for one in statistics.fine}
    assert by_name["design:chair_cafe"].pixels == 330
    assert by_name["design:chair_cafe"].is_seen_enough
    assert not by_name["minecraft:white_wool"].is_seen_enough  # 99 pixels a picture.
    assert statistics.fine_classes == 2
    assert count_samples(pictures[:2]).result("x").fine_classes == 0


def test_rooms_are_reported_only_where_every_scene_has_them(samples):
    counter = count_samples(samples)
    for scene, rooms in {"house_0001": 5, "elsewhere": 9}.items():
        counter.set_rooms(scene, rooms)
    assert counter.result("x").rooms is None
    counter.set_rooms("house_0002", 7)
    assert counter.result("x").rooms == 12


def test_nothing_has_numbers_too():
    empty = StatisticsCounter().result("empty")
    assert (empty.voxels, empty.voxels_per_scene, empty.resolution) == (0, 0, "-")
    assert (empty.rooms, empty.distinct_cells, empty.fine_classes) == (None, 0, 0)


def test_memory_does_not_grow_with_pictures_of_the_same_place():
    cells = WorldCells()
    for n in range(20):
        occ = random_labels(n, (60, 60, 36), voxel_m=0.08)
        cells.add(occ.region, occ.occupied)
    assert len(cells._blocks) <= 8
    assert cells.count() <= 60 * 60 * 36


def test_cells_of_two_sizes_in_one_world_are_refused():
    cells = WorldCells()
    occ = random_labels(1)
    cells.add(occ.region, occ.occupied)
    with pytest.raises(ValueError, match=r"cells of a world must have the same size, got 0.5 m"):
        cells.add(replace(occ.region, voxel_m=0.25), occ.occupied)


def test_a_fine_class_without_a_design_is_its_block():
    assert FineClass("minecraft:glass").name == "minecraft:glass"


def test_rooms_of_the_pictures_count_where_the_scene_tells_none(samples):
    told = [replace(one, facts={"room": n % 3}) for n, one in enumerate(samples)]
    assert [scene.rooms for scene in count_samples(told).result("x").scenes] == [3, 3]
    counter = count_samples(told)
    counter.set_rooms("house_0001", 9)
    assert counter.result("x").rooms == 12
    one_silent = [*told[:7], samples[7]]
    assert [scene.rooms for scene in count_samples(one_silent).result("x").scenes] == [3, None]


def test_the_twelve_classes_are_no_fine_classes():
    twelve = replace(sample(0), fine_classes=CLASS_KINDS)
    assert count_samples([twelve]).result("x").fine is None
