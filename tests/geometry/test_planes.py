"""Level planes: heights finer than a cell, each table its own plane."""

import numpy as np
import pytest

from world2minecraft.geometry.level_planes import find_horizontal_planes


def room_with_table(table_height_m: float, noise_m: float = 0.0):
    """A floor at 0 and a table of 1.2 x 0.8 m, as 0.08 m cells, their points noisy."""
    random = np.random.default_rng(0)
    labels = np.zeros((40, 30, 20), np.uint8)
    height_m, hits = np.zeros(labels.shape), np.zeros(labels.shape, int)
    origin_z = -0.16

    def put(x, y, z_m, label):
        for point in random.normal(z_m, noise_m, 30) if noise_m else [z_m - 1e-6] * 30:
            k = int(np.floor((point - origin_z) / 0.08))
            total = height_m[x, y, k] * hits[x, y, k] + point
            hits[x, y, k] += 1
            height_m[x, y, k] = total / hits[x, y, k]
            labels[x, y, k] = label

    for x in range(40):
        for y in range(30):
            put(x, y, 0.0, 2)
    for x in range(10, 25):
        for y in range(10, 20):
            put(x, y, table_height_m, 8)
    return labels, height_m, hits


@pytest.mark.parametrize("noise_m", [0.0, 0.008])
@pytest.mark.parametrize("height_m", [0.45, 0.68, 0.72, 0.75, 0.88])
def test_floor_and_table_are_found_to_a_centimetre(height_m, noise_m):
    planes = find_horizontal_planes(*room_with_table(height_m, noise_m), 0.08)
    floors = [p for p in planes if p.class_id == 2]
    tables = [p for p in planes if p.class_id == 8]
    assert len(floors) == 1 and len(tables) == 1
    assert abs(floors[0].height_m) < 0.01
    assert abs(tables[0].height_m - height_m) < 0.01
    assert tables[0].area_m2 == pytest.approx(15 * 10 * 0.08**2, rel=0.05)


def test_two_tables_of_one_height_stay_two():
    labels, height_m, hits = room_with_table(0.72)
    gap = labels.copy()
    gap[17, :, 5:] = 0
    planes = [p for p in find_horizontal_planes(gap, height_m, hits, 0.08) if p.class_id == 8]
    assert len(planes) == 2


def test_nothing_gives_nothing():
    empty = np.zeros((4, 4, 4), np.uint8)
    assert find_horizontal_planes(empty, np.zeros((4, 4, 4)), np.zeros((4, 4, 4), int), 0.08) == ()
