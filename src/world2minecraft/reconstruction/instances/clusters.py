"""The paper's clustering: candidates within each class by DBSCAN, and the centroids C'."""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

NO_CLUSTER = -1


def cluster_candidates(
    candidates: np.ndarray, classes: np.ndarray, cluster_radius: float, min_samples: int
) -> np.ndarray:
    """Return the cluster, int32 [M], of each candidate; -1 for those in none.

    Classes never share a cluster. Clusters are numbered by class, then by their centroid's
    x, y, z.

    Args:
        candidates: int32 [M, 3], cells.
        classes: uint8 [M], the class of each.
        cluster_radius: eta, the L2 distance in cells within which two candidates are neighbours.
        min_samples: neighbours, itself included, that make a candidate a core of its cluster.
    """
    clusters = np.full(len(candidates), NO_CLUSTER, np.int32)
    count = 0
    for class_id in np.unique(classes):
        own = np.flatnonzero(classes == class_id)
        found = _ordered(_dbscan(candidates[own], cluster_radius, min_samples), candidates[own])
        clusters[own] = np.where(found >= 0, found + count, NO_CLUSTER)
        count += int(found.max(initial=-1)) + 1
    return clusters


def centroids(candidates: np.ndarray, clusters: np.ndarray) -> np.ndarray:
    """Return C', float64 [K, 3]: the mean cell of each cluster."""
    members = clusters >= 0
    counts = np.bincount(clusters[members])
    sums = [np.bincount(clusters[members], candidates[members, axis]) for axis in range(3)]
    return np.stack(sums, axis=1) / counts[:, None] if len(counts) else np.zeros((0, 3))


def _dbscan(points: np.ndarray, radius: float, min_samples: int) -> np.ndarray:
    """Return DBSCAN's cluster of each point, int [N], as scikit-learn numbers them.

    Cores within reach of each other are one cluster, numbered by its first core; a border point
    goes to the first cluster that reaches it. Importing scikit-learn took longer than the stage.
    """
    count = len(points)
    pairs = KDTree(points.astype(np.float64)).query_pairs(radius, output_type="ndarray")
    is_core = np.bincount(pairs.ravel(), minlength=count) + 1 >= min_samples
    joined = pairs[is_core[pairs].all(axis=1)]
    graph = coo_array((np.ones(len(joined), bool), tuple(joined.T)), shape=(count, count))
    part = connected_components(graph, directed=False)[1]
    firsts, found = np.unique(part[is_core], return_index=True)
    labels = np.full(count, count)
    labels[is_core] = np.argsort(np.argsort(found))[np.searchsorted(firsts, part[is_core])]
    for border, core in (pairs.T, pairs.T[::-1]):
        reached = ~is_core[border] & is_core[core]
        np.minimum.at(labels, border[reached], labels[core[reached]])
    return np.where(labels < count, labels, NO_CLUSTER)


def _ordered(clusters: np.ndarray, points: np.ndarray) -> np.ndarray:
    centers = centroids(points, clusters)
    rank = np.empty(len(centers), np.int32)
    rank[np.lexsort(centers.T[::-1])] = np.arange(len(centers), dtype=np.int32)
    return np.where(clusters >= 0, np.append(rank, 0)[clusters], NO_CLUSTER).astype(np.int32)
