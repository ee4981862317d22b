"""Where a row changes, against a search of all ways to cut it."""

from itertools import combinations, pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.reconstruction.instances.change_points import SEAM_PENALTY, change_points

rows = st.lists(st.sampled_from([-3.0, 0.0, 0.5, 4.0, np.nan]), min_size=1, max_size=9)


def cost(values: np.ndarray, cuts: tuple[int, ...]) -> float:
    """Return what a way to cut costs: the squared change inside parts, and a penalty each."""
    parts = [values[a:b] for a, b in pairwise([0, *cuts, len(values)])]
    seen = [part[np.isfinite(part)] for part in parts]
    return sum(float(((one - one.mean()) ** 2).sum()) if len(one) else 0.0 for one in seen) + (
        SEAM_PENALTY * len(cuts)
    )


@given(rows, st.integers(1, 4))
def test_the_cuts_cost_least(row, least):
    values = np.array(row)
    found = change_points(values[:, None], least)
    allowed = [
        cuts
        for count in range(len(values))
        for cuts in combinations(range(1, len(values)), count)
        if all(b - a >= least for a, b in pairwise([0, *cuts, len(values)])) or not cuts
    ]
    assert tuple(found) in allowed
    assert cost(values, tuple(found)) <= min(cost(values, cuts) for cuts in allowed) + 1e-6


@given(rows, st.integers(1, 3))
def test_a_mirrored_row_costs_the_same(row, least):
    values = np.array(row)
    there, back = (change_points(one[:, None], least) for one in (values, values[::-1]))
    mirrored = tuple(len(values) - cut for cut in reversed(back))
    assert abs(cost(values, tuple(there)) - cost(values, mirrored)) < 1e-6
