"""From clusters to the cells of each object: a search by steps along connected cells of a class."""

import numpy as np

from world2minecraft.core.jit import njit


def grow(
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
    _spread(labels, binary, owners, seeds.astype(np.int32))
    return owners


@njit
def _spread(labels, binary, owners, seeds):  # pragma: no cover - compiled
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
        fresh = 0
        for index in range(count):
            i, j, k = reached[index]
            if owners[i, j, k] == 0:
                ring[fresh] = reached[index]
                fresh += 1
                owners[i, j, k] = claims[index]
            elif claims[index] < owners[i, j, k]:
                owners[i, j, k] = claims[index]
        ring = ring[:fresh]
