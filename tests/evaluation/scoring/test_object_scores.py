"""Instances that are carried into coarse cells: the majority of an object's own class has them."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from world2minecraft.evaluation.scoring.oracle_stages import _majority


@given(arrays.arrays(np.int64, (7, 5), elements=st.integers(0, 3)))
def test_the_majority_is_that_of_a_slow_count(votes):
    for row, winner in zip(votes, _majority(votes, 4), strict=True):
        counts = [(row == number).sum() for number in (1, 2, 3)]
        assert winner == (1 + int(np.argmax(counts)) if max(counts) else 0)
