"""Density, candidates and clusters: D, C and C' of the paper's Algorithm 1.

``density_map`` computes D, the filled share around each cell; ``candidate_cells`` returns C, the
cells above the threshold; ``cluster_candidates`` clusters C by DBSCAN within each class, and
``centroids`` returns C'. ``assign_voxels`` then assigns each object cell to a cluster (O_k).
"""

import numpy as np
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import KDTree

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.jit import njit

NO_CLUSTER = -1


def object_cells(labels: np.ndarray) -> np.ndarray:
    """Return the paper's binary grid, bool [X, Y, Z]: the cells of object classes 5 to 11."""
    return (labels >= OBJECT_CLASSES[0]) & (labels <= OBJECT_CLASSES[-1])


def density_map(binary: np.ndarray, density_kernel: int) -> np.ndarray:
    """Compute the density D = K * binary, float32 [X, Y, Z], as the filled share of the kernel.

    The uniform kernel is normalized to sum 1; cells outside the grid are empty. Counts are integers
    until the last step, so the result is the same on every machine.
    """
    counts = binary.astype(np.int32)
    ones = np.ones(density_kernel, np.int32)
    for axis in range(3):
        counts = ndimage.convolve1d(counts, ones, axis=axis, mode="constant", cval=0)
    return (counts / density_kernel**3).astype(np.float32)


def candidate_cells(
    binary: np.ndarray, density: np.ndarray, density_threshold: float
) -> np.ndarray:
    """Return the candidates C, int32 [M, 3] in x, y, z order: object cells of density tau or more.

    Densities are multiples of 1 / k^3. A tolerance of 5e-7 ensures that tau = 6/27 includes 6/27.
    """
    return np.argwhere(binary & (density >= density_threshold - 5e-7)).astype(np.int32)


def cluster_candidates(
    candidates: np.ndarray, classes: np.ndarray, cluster_radius: float, min_samples: int
) -> np.ndarray:
    """Return the cluster of each candidate, int32 [M]; -1 is no cluster.

    Each cluster contains one class. Clusters are numbered by class, then by the x, y, z of their
    centroid.

    Args:
        candidates: Cells, int32 [M, 3].
        classes: Class of each candidate, uint8 [M].
        cluster_radius: The paper's eta: the L2 distance in cells up to which candidates are
            neighbours.
        min_samples: Number of neighbours, including itself, that make a candidate a core point.
    """
    clusters = np.full(len(candidates), NO_CLUSTER, np.int32)
    count = 0
    for class_id in np.unique(classes):
        own = np.flatnonzero(classes == class_id)
        found = _order_by_centroid(
            _dbscan(candidates[own], cluster_radius, min_samples), candidates[own]
        )
        clusters[own] = np.where(found >= 0, found + count, NO_CLUSTER)
        count += int(found.max(initial=-1)) + 1
    return clusters


def centroids(candidates: np.ndarray, clusters: np.ndarray) -> np.ndarray:
    """Return the centroids C', float64 [K, 3]: the mean cell of each cluster."""
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
    part = joined_parts(joined.T, count)
    firsts, found = np.unique(part[is_core], return_index=True)
    labels = np.full(count, count)
    labels[is_core] = np.argsort(np.argsort(found))[np.searchsorted(firsts, part[is_core])]
    for border, core in (pairs.T, pairs.T[::-1]):
        reached = ~is_core[border] & is_core[core]
        np.minimum.at(labels, border[reached], labels[core[reached]])
    return np.where(labels < count, labels, NO_CLUSTER)


def joined_parts(pairs: np.ndarray, count: int) -> np.ndarray:
    """Return the connected part of each of ``count`` nodes, int32 [count] from 0.

    Args:
        pairs: Nodes that are joined, int [2, M].
        count: Number of nodes.
    """
    first, second = pairs
    graph = coo_array((np.ones(len(first), bool), (first, second)), shape=(count, count))
    return connected_components(graph, directed=False)[1]


def _order_by_centroid(clusters: np.ndarray, points: np.ndarray) -> np.ndarray:
    centers = centroids(points, clusters)
    rank = np.empty(len(centers), np.int32)
    rank[np.lexsort(centers.T[::-1])] = np.arange(len(centers), dtype=np.int32)
    return np.where(clusters >= 0, np.append(rank, 0)[clusters], NO_CLUSTER).astype(np.int32)


def assign_voxels(
    labels: np.ndarray, binary: np.ndarray, candidates: np.ndarray, clusters: np.ndarray
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z]: the cluster of each object cell plus 1; 0 is none.

    A cell is assigned to the nearest cluster of its class, measured in steps through the 26
    neighbours along cells of that class; the lower number wins a tie. Distances start at the cells
    of a cluster, since its centroid can be in the air.
    """
    owners = np.zeros(labels.shape, np.int32)
    members = clusters >= 0
    seeds = candidates[members]
    owners[tuple(seeds.T)] = clusters[members] + 1
    _flood(labels, binary, owners, seeds.astype(np.int32))
    return owners


@njit
def _flood(labels, binary, owners, seeds):  # pragma: no cover - compiled
    """Extend owners outward ring by ring; within a ring the lowest owner wins."""
    nx, ny, nz = labels.shape
    ring = seeds
    while len(ring):
        reached = np.empty((26 * len(ring), 3), np.int32)
        claims = np.zeros(26 * len(ring), np.int32)
        count = 0
        for index in range(len(ring)):
            x, y, z = ring[index]
            owner, label = owners[x, y, z], labels[x, y, z]
            for dx in range(-1, 2):
                for dy in range(-1, 2):
                    for dz in range(-1, 2):
                        i, j, k = x + dx, y + dy, z + dz
                        if i < 0 or j < 0 or k < 0 or i >= nx or j >= ny or k >= nz:
                            continue
                        if binary[i, j, k] and owners[i, j, k] == 0 and labels[i, j, k] == label:
                            reached[count, 0], reached[count, 1], reached[count, 2] = i, j, k
                            claims[count] = owner
                            count += 1
        ring = np.empty((count, 3), np.int32)
        unclaimed = 0
        for index in range(count):
            i, j, k = reached[index]
            if owners[i, j, k] == 0:
                ring[unclaimed] = reached[index]
                unclaimed += 1
                owners[i, j, k] = claims[index]
            elif claims[index] < owners[i, j, k]:
                owners[i, j, k] = claims[index]
        ring = ring[:unclaimed]
