"""Few boxes for many cells: what they are together, and the slow way to the same."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from world2minecraft.geometry.box_decomposition import (
    cover_boxes,
    decompose_boxes,
    join_adjacent_boxes,
    partition_boxes,
    simplify_boxes,
)


def rasterize_boxes(boxes, shape):
    """The int32 label grid that boxes, int [N, 7], fill; later boxes take precedence."""
    labels = np.zeros(shape, np.int32)
    for label, x0, y0, z0, x1, y1, z1 in boxes.tolist():
        labels[x0:x1, y0:y1, z0:z1] = label
    return labels


SHAPES = stn.arrays(
    np.int32, st.tuples(*[st.integers(1, 7)] * 3), elements=st.sampled_from([0, 0, 1, 1, 1, 2])
)


def slow_sweep(labels: np.ndarray) -> set[tuple[int, ...]]:
    """Greedy boxes along z, then y, then x, cell by cell, by sets of cells alone."""
    left = {tuple(cell): int(labels[tuple(cell)]) for cell in np.argwhere(labels)}
    boxes = set()
    while left:
        low = min(left)
        label, high = left[low], [value + 1 for value in low]
        for axis in (2, 1, 0):
            while True:
                layer = [
                    cell for cell in np.ndindex(*(h - a for a, h in zip(low, high, strict=True)))
                ]
                cells = [tuple(a + b for a, b in zip(low, cell, strict=True)) for cell in layer]
                last = [cell for cell in cells if cell[axis] == high[axis] - 1]
                beyond = [tuple(v + (n == axis) for n, v in enumerate(cell)) for cell in last]
                if any(left.get(cell) != label for cell in beyond):
                    break
                high[axis] += 1
        for cell in np.ndindex(*(h - a for a, h in zip(low, high, strict=True))):
            del left[tuple(a + b for a, b in zip(low, cell, strict=True))]
        boxes.add((label, *low, *high))
    return boxes


def volume(boxes: np.ndarray) -> int:
    return int(np.prod(boxes[:, 4:] - boxes[:, 1:4], axis=1).sum())


@given(SHAPES)
def test_a_partition_is_the_shape_and_shares_no_cell(labels):
    boxes = partition_boxes(labels)
    assert np.array_equal(rasterize_boxes(boxes, labels.shape), labels)
    assert volume(boxes) == np.count_nonzero(labels)
    assert len(boxes) <= len(slow_sweep(labels))


@given(SHAPES)
def test_one_sweep_is_the_slow_one(labels):
    from world2minecraft.geometry.box_decomposition import _sweep

    boxes = _sweep(labels, (0, 1, 2), (False, False, False))
    assert {tuple(row) for row in boxes.tolist()} == slow_sweep(labels)


@given(SHAPES, st.permutations([0, 1, 2]))
def test_a_shape_seen_from_another_side_takes_as_many_boxes(labels, axes):
    turned = np.ascontiguousarray(labels.transpose(axes)[::-1])
    # Joining pairs at the end goes axis by axis, so that a view may save one box more.
    assert abs(len(partition_boxes(turned)) - len(partition_boxes(labels))) <= 1


@given(SHAPES)
def test_a_cover_is_the_shape_and_none_of_its_boxes_is_spare(labels):
    boxes = cover_boxes(labels)
    assert np.array_equal(rasterize_boxes(boxes, labels.shape), labels)
    for n in range(len(boxes)):
        rest = np.delete(boxes, n, axis=0)
        assert not np.array_equal(rasterize_boxes(rest, labels.shape), labels)
    assert np.array_equal(rasterize_boxes(decompose_boxes(labels), labels.shape), labels)


@given(SHAPES, st.sampled_from([0.7, 0.9, 1.0]))
def test_coarser_boxes_keep_their_bound_and_share_no_cell(labels, least):
    boxes = simplify_boxes(labels, least)
    filled = rasterize_boxes(boxes, labels.shape) > 0
    assert volume(boxes) == filled.sum()
    assert len(boxes) <= len(partition_boxes(labels))
    if labels.any():
        union = (filled | (labels > 0)).sum()
        assert (filled & (labels > 0)).sum() / union >= least - 1e-9


@given(SHAPES)
def test_at_a_bound_of_one_the_shape_stays(labels):
    assert np.array_equal(
        rasterize_boxes(simplify_boxes(labels, 1.0), labels.shape) > 0, labels > 0
    )


def test_boxes_are_joined_no_further_than_asked():
    stairs = np.tril(np.ones((12, 12), np.int32))[:, :, None]
    counts = [len(simplify_boxes(stairs, 0.5, enough=most)) for most in (1, 4, 8, 99)]
    assert counts == sorted(counts)
    assert 4 >= counts[1] > counts[0] == 1
    assert counts[3] == len(partition_boxes(stairs))


def test_open_cells_are_filled_at_no_cost():
    hollow = np.ones((6, 6, 6), np.int32)
    hollow[1:-1, 1:-1, 1:-1] = 0
    assert len(simplify_boxes(hollow, 0.99)) > 1
    assert simplify_boxes(hollow, 0.99, hollow == 0).tolist() == [[1, 0, 0, 0, 6, 6, 6]]


def test_chairs_tables_and_round_tops_take_few_boxes():
    chair = np.zeros((24, 22, 44), np.int32)
    chair[:, :, 20:23] = 1
    chair[:3, :, 20:] = 1
    for x in (slice(0, 2), slice(-2, None)):
        for y in (slice(0, 2), slice(-2, None)):
            chair[x, y, :20] = 1
    assert len(partition_boxes(chair)) == 6
    across = np.indices((50, 50)) - 24.5
    top = np.zeros((50, 50, 38), np.int32)
    top[:, :, 36:] = ((across**2).sum(axis=0) <= 25**2)[:, :, None]
    top[22:28, 22:28, 2:36] = top[13:37, 13:37, :2] = 1
    boxes = decompose_boxes(top)
    assert len(boxes) <= 20 < len(partition_boxes(top))
    assert np.array_equal(rasterize_boxes(boxes, top.shape), top)


def test_pairs_that_make_one_box_are_joined():
    halves = np.array([[1, 0, 0, 0, 2, 2, 2], [1, 2, 0, 0, 5, 2, 2], [2, 5, 0, 0, 6, 2, 2]])
    assert join_adjacent_boxes(halves).tolist() == [[1, 0, 0, 0, 5, 2, 2], [2, 5, 0, 0, 6, 2, 2]]


def test_nothing_gives_no_boxes_and_wrong_questions_are_refused():
    assert partition_boxes(np.zeros((3, 4, 5), int)).shape == (0, 7)
    assert cover_boxes(np.zeros((3, 4, 5), int)).shape == (0, 7)
    with pytest.raises(ValueError, match=r"labels must have shape \[X, Y, Z\], got \(3, 4\)"):
        partition_boxes(np.zeros((3, 4), int))
    with pytest.raises(ValueError, match=r"least_iou must be above 0 and at most 1, got 1\.5"):
        simplify_boxes(np.zeros((3, 4, 5), int), 1.5)
