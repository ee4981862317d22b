"""C': clusters within classes, and their order."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.reconstruction.instances.density_clustering import (
    centroids,
    cluster_candidates,
)


def _slow_clusters(points, radius, min_samples):
    """DBSCAN by its definition: cores joined by reach, borders to a core in reach."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    near = apart <= radius
    core = near.sum(axis=1) >= min_samples
    joined = near & core[:, None] & core[None]
    for _ in range(len(points)):
        joined |= joined @ joined
    return core, joined, near


@given(st.integers(0, 2**32 - 1), st.floats(1.0, 3.0), st.integers(1, 5))
def test_clusters_are_those_of_the_definition(seed, radius, min_samples):
    rng = np.random.default_rng(seed)
    points = np.unique(rng.integers(0, 9, (25, 3)), axis=0).astype(np.int32)
    found = cluster_candidates(points, np.full(len(points), 5, np.uint8), radius, min_samples)
    core, joined, near = _slow_clusters(points.astype(float), radius, min_samples)
    for one in range(len(points)):
        assert (found[one] >= 0) == bool((near[one] & core).any())
        for two in np.flatnonzero(core):
            if core[one]:
                assert (found[one] == found[two]) == bool(joined[one, two])


@given(st.integers(0, 2**32 - 1), st.sampled_from([1.0, 2**0.5, 2.0, 2.5]), st.integers(1, 6))
def test_clusters_are_those_of_scikit_learn(seed, radius, min_samples):
    from sklearn.cluster import DBSCAN

    rng = np.random.default_rng(seed)
    points = rng.permutation(np.unique(rng.integers(0, 7, (60, 3)), axis=0)).astype(np.int32)
    labels = DBSCAN(eps=radius, min_samples=min_samples).fit(points.astype(float)).labels_
    found = cluster_candidates(points, np.full(len(points), 5, np.uint8), radius, min_samples)
    np.testing.assert_array_equal(found < 0, labels < 0)
    pairs = set(zip(labels.tolist(), found.tolist(), strict=True))
    assert len(pairs) == len(set(labels.tolist())) == len(set(found.tolist()))


@given(st.integers(0, 2**32 - 1))
def test_clusters_are_numbered_by_class_then_place(seed):
    rng = np.random.default_rng(seed)
    points = np.argwhere(rng.random((8, 8, 5)) < 0.3).astype(np.int32)
    classes = rng.integers(5, 8, len(points)).astype(np.uint8)
    found = cluster_candidates(points, classes, 1.5, 2)
    ranks = []
    for number, center in enumerate(centroids(points, found)):
        held = np.unique(classes[found == number])
        assert len(held) == 1
        ranks.append((int(held[0]), *center))
    assert ranks == sorted(ranks)


def test_nothing_gives_no_clusters():
    none = np.zeros((0, 3), np.int32)
    assert cluster_candidates(none, np.zeros(0, np.uint8), 2.0, 4).tolist() == []
    assert centroids(none, np.zeros(0, np.int32)).shape == (0, 3)
