"""What objects stand on or hang from, in a small room made by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.types import ObjectInstance, OccupancyGrid
from world2minecraft.reconstruction.instances.supports import with_supports

SHAPE, VOXEL_M = (30, 30, 30), 0.1


def room(boxes, *, seen_floor=True):
    """A closed room with boxes of (low, high, class); return the supports by id from 1."""
    labels = np.zeros(SHAPE, np.uint8)
    labels[:, :, 0], labels[:, :, -1] = 2, 1
    labels[0, :, 1:-1] = labels[:, 0, 1:-1] = 3
    instance = np.zeros(SHAPE, np.uint16)
    for number, (low, high, class_id) in enumerate(boxes, 1):
        box = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
        if not seen_floor:
            labels[box[0], box[1], 0] = 0
        labels[box], instance[box] = class_id, number
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.ones(SHAPE, np.float16),
        colour=np.zeros((*SHAPE, 3), np.uint8),
        source=np.ones(SHAPE, np.uint8),
        instance=instance,
        voxel_m=VOXEL_M,
        origin_m=np.array([0.0, 0.0, -VOXEL_M]),
    )
    found = [
        ObjectInstance(
            number, class_id, np.ones(3), np.ones(3), 0.0,
            np.argwhere(instance == number).astype(np.int32), 1.0,
        )
        for number, (_, _, class_id) in enumerate(boxes, 1)
    ]  # fmt: skip
    return [one.supported_by for one in with_supports(found, grid)]


TABLE = ((10, 10, 1), (20, 20, 8), 8)


@pytest.mark.parametrize(
    ("thing", "support"),
    [
        (((12, 12, 8), (15, 15, 11), 11), 1),  # A vase on the table,
        (((12, 12, 9), (15, 15, 11), 11), 1),  # with a gap of noise,
        (((18, 12, 8), (24, 15, 9), 9), 1),  # and a screen that juts out.
        (((1, 10, 12), (2, 20, 20), 11), "wall"),  # A picture.
        (((12, 12, 22), (15, 15, 29), 11), "ceiling"),  # A lamp over the table.
        (((12, 12, 14), (15, 15, 18), 11), 1),  # Its lower part alone: over the table.
        (((24, 24, 1), (26, 26, 20), 10), "floor"),
        (((24, 24, 6), (26, 26, 9), 11), "floor"),  # Nothing else is below.
        (((8, 12, 1), (13, 16, 9), 5), "floor"),  # A chair in the table.
    ],
)
def test_things_have_their_supports(thing, support):
    assert room([TABLE, thing]) == ["floor", support]


def test_the_floor_under_furniture_need_not_be_seen():
    assert room([TABLE], seen_floor=False) == ["floor"]


def test_things_stand_in_a_stack():
    boxes = [TABLE, ((11, 11, 8), (15, 15, 11), 11), ((12, 12, 11), (14, 14, 13), 11)]
    assert room(boxes) == ["floor", 1, 2]


corner = st.tuples(st.integers(1, 20), st.integers(1, 20), st.integers(1, 20))
size = st.tuples(*[st.integers(1, 8)] * 3)


@given(st.lists(st.tuples(corner, size), min_size=1, max_size=5))
def test_supports_never_form_a_circle(placed):
    boxes = [(low, tuple(np.add(low, by).tolist()), 11) for low, by in placed]
    supports = dict(enumerate(room(boxes), 1))
    for first in list(supports):
        chain = [first]
        while isinstance(chain[-1], int):
            chain.append(supports[chain[-1]])
            assert len(chain) <= len(boxes) + 1
        assert chain[-1] in ("floor", "wall", "ceiling", "")
