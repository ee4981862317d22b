"""Density, candidates and clusters: D, C and C' of the paper's Algorithm 1.

``density_map`` gives D, how full the neighbourhood of each cell is; ``candidate_cells`` gives C,
the cells that reach the threshold; ``cluster_candidates`` parts C by DBSCAN within each class, and
``centroids`` gives C'. ``assign_voxels`` then gives each object cell to a cluster (O_k).
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
    """Return the paper's binary grid, bool [X, Y, Z]: cells of an object class, 5 to 11."""
    return (labels >= OBJECT_CLASSES[0]) & (labels <= OBJECT_CLASSES[-1])


def density_map(binary: np.ndarray, density_kernel: int) -> np.ndarray:
    """Return D = K * binary, float32 [X, Y, Z], as the share (0 to 1) of the kernel that is full.

    The uniform kernel is normalised to sum 1; beyond the grid all is empty. Counts are whole
    numbers until the last step, so that the map is the same on every machine.
    """
    counts = binary.astype(np.int32)
    ones = np.ones(density_kernel, np.int32)
    for axis in range(3):
        counts = ndimage.convolve1d(counts, ones, axis=axis, mode="constant", cval=0)
    return (counts / density_kernel**3).astype(np.float32)


def candidate_cells(
    binary: np.ndarray, density: np.ndarray, density_threshold: float
) -> np.ndarray:
    """Return C, int32 [M, 3] in the order x, y, z: object cells whose density reaches tau.

    Densities are multiples of 1 / k^3; half of one millionth keeps tau = 6/27 from missing 6/27.
    """
    return np.argwhere(binary & (density >= density_threshold - 5e-7)).astype(np.int32)


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
        found = _order_by_centroid(
            _dbscan(candidates[own], cluster_radius, min_samples), candidates[own]
        )
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


def _order_by_centroid(clusters: np.ndarray, points: np.ndarray) -> np.ndarray:
    centers = centroids(points, clusters)
    rank = np.empty(len(centers), np.int32)
    rank[np.lexsort(centers.T[::-1])] = np.arange(len(centers), dtype=np.int32)
    return np.where(clusters >= 0, np.append(rank, 0)[clusters], NO_CLUSTER).astype(np.int32)


def assign_voxels(
    labels: np.ndarray, binary: np.ndarray, candidates: np.ndarray, clusters: np.ndarray
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z]: the cluster of each object cell plus 1, 0 for none.

    A cell goes to the nearest cluster of its own class, by steps through the 26 neighbours along
    cells of that class; of equally near ones to the lower number. The cells of a cluster are
    its sources: the centroid of a shell lies in the air, and the shell's own cells do not.
    """
    owners = np.zeros(labels.shape, np.int32)
    members = clusters >= 0
    seeds = candidates[members]
    owners[tuple(seeds.T)] = clusters[members] + 1
    _flood(labels, binary, owners, seeds.astype(np.int32))
    return owners


@njit
def _flood(labels, binary, owners, seeds):  # pragma: no cover - compiled
    """Carry owners outward ring by ring; within a ring the lowest owner wins."""
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
