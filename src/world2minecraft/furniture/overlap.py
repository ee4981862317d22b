"""The overlap of a template's cells with an object's, at several places at once."""

import numpy as np

from world2minecraft.core.jit import njit


@njit
def overlaps(template, code, corners):  # pragma: no cover - compiled
    """Return int64 [S, 3]: own cells covered, cells against, cells beyond, for each corner.

    Args:
        template: bool [A, B, C], the turned template's cells, C order.
        code: uint8 [X, Y, Z] of ``Evidence``.
        corners: int64 [S, 3], where the template's first cell lies; what falls outside the
            window counts against.
    """
    counts = np.zeros((len(corners), 3), np.int64)
    for x in range(template.shape[0]):
        for y in range(template.shape[1]):
            for z in range(template.shape[2]):
                if not template[x, y, z]:
                    continue
                for s in range(len(corners)):
                    i, j, k = x + corners[s, 0], y + corners[s, 1], z + corners[s, 2]
                    if (
                        i < 0
                        or j < 0
                        or k < 0
                        or i >= code.shape[0]
                        or j >= code.shape[1]
                        or k >= code.shape[2]
                        or code[i, j, k] == 1
                    ):
                        counts[s, 1] += 1
                    elif code[i, j, k] == 2:
                        counts[s, 0] += 1
                    elif code[i, j, k] == 3:
                        counts[s, 2] += 1
    return counts
