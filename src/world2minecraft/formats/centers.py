"""``centers.npz``: the density map, the candidates and their clusters (the paper's D, C and C').

Arrays: ``density`` float32 [X, Y, Z]; ``candidates`` int32 [M, 3], cells; ``cluster`` int32 [M],
the number of each candidate's cluster, -1 for none.
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.files import write_npz


def write_centers(
    path: str | Path, density: np.ndarray, candidates: np.ndarray, cluster: np.ndarray
) -> None:
    """Write the density map, the candidates and their clusters."""
    write_npz(
        path,
        {
            "density": density.astype(np.float32),
            "candidates": candidates.astype(np.int32),
            "cluster": cluster.astype(np.int32),
        },
    )
