"""CIELAB and CIEDE2000 against published values."""

import numpy as np
import pytest

from world2minecraft.geometry.colour import ciede2000, linear_to_lab, srgb_to_linear

# Pairs of Sharma, Wu and Dalal (2005), which exercise every branch of the formula.
PAIRS = (
    ((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425),
    ((50, -1.3802, -84.2814), (50, 0, -82.7485), 1.0),
    ((50, 0, 0), (50, -1, 2), 2.3669),
    ((50, 2.49, -0.001), (50, -2.49, 0.0009), 7.1792),
    ((50, 2.49, -0.001), (50, -2.49, 0.0011), 7.2195),
    ((50, -0.001, 2.49), (50, 0.0011, -2.49), 4.7461),
    ((50, 2.5, 0), (50, 0, -2.5), 4.3065),
    ((50, 2.5, 0), (73, 25, -18), 27.1492),
    ((22.7233, 20.0904, -46.6940), (23.0331, 14.9730, -42.5619), 2.0373),
    ((6.7747, -0.2908, -2.4247), (5.8714, -0.0985, -2.2286), 0.6377),
    ((90.8027, -2.0831, 1.4410), (91.1528, -1.6435, 0.0447), 1.4441),
)


@pytest.mark.parametrize(("one", "other", "expected"), PAIRS)
def test_published_differences(one, other, expected):
    assert ciede2000(np.array(one), np.array(other)) == pytest.approx(expected, abs=1e-4)
    assert ciede2000(np.array(other), np.array(one)) == pytest.approx(expected, abs=1e-4)


def test_lab_of_white_red_and_black():
    colours = np.array([[255, 255, 255], [255, 0, 0], [0, 0, 0]], np.uint8)
    expected = [[100, 0, 0], [53.241, 80.092, 67.203], [0, 0, 0]]
    assert linear_to_lab(srgb_to_linear(colours)) == pytest.approx(np.array(expected), abs=2e-3)


def test_black_and_white_differ_by_100():
    ends = linear_to_lab(np.array([[0.0, 0, 0], [1, 1, 1]]))
    assert ciede2000(ends[0], ends[1]) == pytest.approx(100, abs=1e-3)
