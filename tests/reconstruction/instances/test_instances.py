"""Algorithm 1 as a whole: which objects are found, and that no cell is lost."""

from collections import deque

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.furniture import surface_cells, template, template_cells
from world2minecraft.reconstruction.instances import InstanceParameters, find_objects
from world2minecraft.reconstruction.instances.denoise import relabel_specks
from world2minecraft.reconstruction.instances.density_clustering import assign_voxels


def grid_of(labels: np.ndarray) -> OccupancyGrid:
    """Return a grid of labels alone, the floor's top after layer 0."""
    return OccupancyGrid(
        labels=labels,
        confidence=np.full(labels.shape, 0.5, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=(labels != 255).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )


def _room(*boxes, shape=(40, 36, 24)):
    """Return labels with a floor and boxes (class, x0, y0, z0, x1, y1, z1)."""
    labels = np.zeros(shape, np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    for class_id, x0, y0, z0, x1, y1, z1 in boxes:
        labels[x0:x1, y0:y1, z0:z1] = class_id
    return labels


def _noisy(seed):
    rng = np.random.default_rng(seed)
    labels = _room((8, 3, 3, 8, 15, 12, 10), (5, 20, 20, 1, 26, 26, 9), (10, 15, 5, 1, 22, 9, 12))
    speckle = rng.random(labels.shape)
    labels[speckle < 0.02] = rng.integers(5, 12, int((speckle < 0.02).sum()))
    labels[speckle > 0.9] = 255
    return labels


def test_two_separated_boxes_are_two_objects():
    labels = _room((5, 4, 4, 1, 9, 9, 6), (5, 12, 4, 1, 18, 10, 6))
    found = find_objects(grid_of(labels))
    assert [instance.id for instance in found.instances] == [1, 2]
    np.testing.assert_allclose(found.instances[0].center_m, [0.52, 0.52, 0.2])
    np.testing.assert_allclose(found.instances[0].size_m, [0.4, 0.4, 0.4])
    assert found.leftover == 0
    assert found.instances[0].confidence == 0.5


def test_touching_boxes_of_two_classes_stay_apart():
    labels = _room((5, 4, 4, 1, 9, 9, 6), (8, 9, 4, 1, 15, 10, 6))
    found = find_objects(grid_of(labels))
    assert [instance.class_id for instance in found.instances] == [5, 8]
    for instance in found.instances:
        assert (labels[tuple(instance.cells.T)] == instance.class_id).all()


@settings(max_examples=15)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_object_cells_have_an_instance_or_are_leftover(seed, paper_compat):
    labels = _noisy(seed)
    found = find_objects(grid_of(labels), InstanceParameters(paper_compat=paper_compat))
    objects = (labels >= 5) & (labels <= 11)
    marked = found.grid.instance > 0
    assert not (marked & ~objects).any()
    assert np.count_nonzero(objects & ~marked) == found.leftover
    assert sum(len(instance.cells) for instance in found.instances) == np.count_nonzero(marked)
    taken = labels if paper_compat else relabel_specks(labels)
    for instance in found.instances:
        cells = tuple(instance.cells.T)
        assert (taken[cells] == instance.class_id).all()
        assert (found.grid.instance[cells] == instance.id).all()
        assert paper_compat or len(instance.cells) >= InstanceParameters().min_cells
    keys = [(instance.class_id, *instance.center_m) for instance in found.instances]
    assert keys == sorted(keys)
    np.testing.assert_array_equal(found.grid.labels, labels)


def test_the_center_map_holds_what_the_paper_names():
    labels = _room((5, 4, 4, 1, 9, 9, 6))
    centers = find_objects(grid_of(labels)).centers
    assert centers.density.dtype == np.float32 and centers.density.shape == labels.shape
    assert centers.candidates.dtype == np.int32 and centers.cluster.dtype == np.int32
    inside = centers.density[tuple(centers.candidates.T)]
    assert inside.min() >= 0.2 - 1e-6 and inside.max() == 1.0
    assert set(centers.cluster.tolist()) == {0}


@pytest.mark.parametrize("name", ["chair", "office_chair", "bunk_bed", "round_table", "lamp"])
def test_an_object_seen_as_a_shell_is_one_object(name):
    one = template(name)
    labels = _room()
    labels[tuple(template_cells(one, one.typical_m, shift=(5, 5, 1)).T)] = one.class_id
    solid = labels == one.class_id
    labels[solid & ~surface_cells(solid)] = 255
    found = find_objects(grid_of(labels))
    assert len(found.instances) == 1
    assert found.leftover == 0


def test_a_torn_off_leg_comes_back_and_a_speck_does_not():
    labels = _room((5, 4, 4, 6, 10, 10, 8))
    labels[4, 4, 1:4] = 5
    labels[30, 30, 10:12] = 5
    found = find_objects(grid_of(labels))
    assert len(found.instances) == 1
    assert found.grid.instance[4, 4, 1] == 1
    assert found.grid.instance[30, 30, 10] == 0
    assert found.leftover == 2


def test_the_paper_joins_nothing_again():
    labels = _room((5, 4, 4, 6, 10, 10, 8))
    labels[4, 4, 1:4] = 5
    found = find_objects(grid_of(labels), InstanceParameters(paper_compat=True))
    assert found.grid.instance[4, 4, 1] == 0
    assert found.leftover == 3


def test_a_turned_room_has_the_same_objects_turned():
    labels = _noisy(3)
    straight = find_objects(grid_of(labels))
    turned = find_objects(grid_of(np.ascontiguousarray(turn_grid(labels, 1))))
    assert len(straight.instances) == len(turned.instances)
    before = {_key(turn_grid(straight.grid.instance == i.id, 1)) for i in straight.instances}
    after = {_key(turned.grid.instance == i.id) for i in turned.instances}
    assert before == after


def _key(mask):
    return np.ascontiguousarray(mask).tobytes()


def test_nothing_is_found_in_an_empty_room():
    found = find_objects(grid_of(_room()))
    assert found.instances == ()
    assert found.leftover == 0
    assert len(found.centers.candidates) == 0


@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1))
def test_growth_is_a_search_by_steps(seed):
    rng = np.random.default_rng(seed)
    labels = np.where(rng.random((7, 7, 6)) < 0.5, rng.integers(5, 7, (7, 7, 6)), 0).astype(
        np.uint8
    )
    binary = labels > 0
    candidates = np.argwhere(binary & (rng.random(labels.shape) < 0.08)).astype(np.int32)
    clusters = rng.integers(-1, 3, len(candidates)).astype(np.int32)
    found = assign_voxels(labels, binary, candidates, clusters)
    np.testing.assert_array_equal(found, _slow_growth(labels, candidates, clusters))


def _slow_growth(labels, candidates, clusters):
    """Search from each cluster by itself; the nearest wins, of equally near the lowest."""
    best = {}
    for number in range(int(clusters.max(initial=-1)) + 1):
        seeds = [tuple(cell) for cell in candidates[clusters == number].tolist()]
        steps = dict.fromkeys(seeds, 0)
        queue = deque(seeds)
        while queue:
            cell = queue.popleft()
            for shift in np.ndindex(3, 3, 3):
                near = tuple(int(a + b - 1) for a, b in zip(cell, shift, strict=True))
                inside = all(0 <= a < n for a, n in zip(near, labels.shape, strict=True))
                if inside and near not in steps and labels[near] == labels[cell]:
                    steps[near] = steps[cell] + 1
                    queue.append(near)
        for cell, count in steps.items():
            if cell not in best or count < best[cell][0]:
                best[cell] = (count, number + 1)
    owners = np.zeros(labels.shape, np.int32)
    for cell, (_, owner) in best.items():
        owners[cell] = owner
    return owners


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"density_kernel": 4}, "find.density_kernel must be odd and above 0, got 4"),
        ({"density_threshold": 1.5}, "find.density_threshold must be between 0 and 1, got 1.5"),
        ({"cluster_radius": 0.0}, "find.cluster_radius must be above 0, got 0.0"),
        ({"join_radius": -1.0}, "find.join_radius must be 0 or more, got -1.0"),
    ],
)
def test_parameters_out_of_bounds_are_refused(changed, message):
    with pytest.raises(UsageError) as refused:
        InstanceParameters(**changed)
    assert str(refused.value) == message
