"""The visible faces of boxes, as few rectangles: what a mesh of blocks is made of.

Boxes of one owner that touch hide each other's faces, and faces of one material that lie side by
side become one rectangle (greedy meshing). What is left is exactly the surface of the union of an
owner's boxes, where these share no volume. Owners do not hide each other: each is a closed body
of its own, so that it can be moved. Through a clear material one sees what is behind, so it hides
only what is clear too.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit

# Which ends of u and v the four corners take, counter-clockwise for a face along its axis.
_U_ENDS, _V_ENDS = np.array([0, 1, 1, 0]), np.array([0, 0, 1, 1])


class Faces(NamedTuple):
    """Rectangles on planes across an axis; ``u`` and ``v`` are the two axes after it, in a ring.

    Rows are sorted by owner. A face looks along its axis where ``side`` is 1, else against it.
    """

    owner: np.ndarray  # int32 [F]
    axis: np.ndarray  # int32 [F], 0 x, 1 y, 2 z
    plane: np.ndarray  # int32 [F]
    side: np.ndarray  # int32 [F], 0 or 1
    u: np.ndarray  # int32 [F, 2], low and high
    v: np.ndarray  # int32 [F, 2]
    material: np.ndarray  # int32 [F]

    def corners(self) -> np.ndarray:
        """Return the corners, int32 [F, 4, 3], counter-clockwise seen from outside."""
        corners = np.empty((len(self.owner), 4, 3), np.int32)
        u_ends = np.where(self.side[:, None] == 1, _U_ENDS, _U_ENDS[::-1])
        v_ends = np.where(self.side[:, None] == 1, _V_ENDS, _V_ENDS[::-1])
        axis = self.axis[:, None, None]
        values = (
            self.plane[:, None].repeat(4, 1),
            np.take_along_axis(self.u, u_ends, 1),
            np.take_along_axis(self.v, v_ends, 1),
        )
        for step, value in enumerate(values):
            np.put_along_axis(
                corners, np.broadcast_to((axis + step) % 3, (len(axis), 4, 1)), value[..., None], 2
            )
        return corners

    def normals(self) -> np.ndarray:
        """Return the directions that the faces look, int32 [F, 3]."""
        result = np.zeros((len(self.owner), 3), np.int32)
        result[np.arange(len(result)), self.axis] = 2 * self.side - 1
        return result


def faces_of_boxes(
    boxes: np.ndarray, owner: np.ndarray, material: np.ndarray, is_clear: np.ndarray
) -> Faces:
    """Return the surface of each owner's boxes.

    Args:
        boxes: int32 [N, 6], x0 y0 z0 x1 y1 z1, each with some volume.
        owner: int32 [N], whose each box is.
        material: int32 [N], indices into ``is_clear``.
        is_clear: bool [M], whether one sees through a material.
    """
    rows = np.concatenate([_side(boxes, owner, material, a, s) for a in range(3) for s in (0, 1)])
    rows = rows[np.lexsort((rows[:, 2], rows[:, 1], rows[:, 0]))]
    is_first = np.ones(len(rows) + 1, bool)
    is_first[1:-1] = (rows[1:, :3] != rows[:-1, :3]).any(axis=1)
    starts = np.flatnonzero(is_first)
    plane = np.cumsum(is_first[:-1]) - 1
    us, u_starts, u_ranks = _ranks(plane, rows[:, [4, 6]])
    vs, v_starts, v_ranks = _ranks(plane, rows[:, [5, 7]])
    tables = (rows, starts, us, u_starts, u_ranks, vs, v_starts, v_ranks, is_clear)
    found = np.empty((len(rows), 9), np.int32)
    count = _visible(*tables, found)
    if count > len(found):  # Parts of faces may be more than the faces.
        found = np.empty((count, 9), np.int32)
        _visible(*tables, found)
    owner, axis, plane, side, u0, v0, u1, v1, material = np.ascontiguousarray(found[:count].T)
    return Faces(owner, axis, plane, side, np.stack([u0, u1], 1), np.stack([v0, v1], 1), material)


def _ranks(plane: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Number the values of each plane in order.

    Args:
        plane: int64 [N], rising, whose each row is.
        ends: int32 [N, 2], values of the rows.

    Returns:
        The different values, int32 [K], plane by plane; where each plane's begin, int64 [P + 1];
        and the number of each value within its plane, int64 [N, 2].
    """
    wide = np.int64(1) << 32
    keys = plane[:, None] * wide + (ends.astype(np.int64) + (wide >> 1))
    held, numbers = np.unique(keys, return_inverse=True)
    owner = held // wide
    starts = np.searchsorted(owner, np.arange(int(plane[-1]) + 2 if len(plane) else 1))
    ranks = numbers.reshape(ends.shape) - starts[plane][:, None]
    return (held % wide - (wide >> 1)).astype(np.int32), starts, ranks


def _side(
    boxes: np.ndarray, owner: np.ndarray, material: np.ndarray, axis: int, side: int
) -> np.ndarray:
    """Return one face of each box: owner, axis, plane, side, u0 v0 u1 v1, material."""
    u, v = (axis + 1) % 3, (axis + 2) % 3
    rows = np.empty((len(boxes), 9), np.int32)
    rows[:, 0], rows[:, 1], rows[:, 3], rows[:, 8] = owner, axis, side, material
    rows[:, 2] = boxes[:, axis + 3 * side]
    rows[:, 4], rows[:, 5], rows[:, 6], rows[:, 7] = boxes[:, [u, v, u + 3, v + 3]].T
    return rows


@njit
def _visible(
    rows, starts, us, u_starts, u_ranks, vs, v_starts, v_ranks, is_clear, found
):  # pragma: no cover
    """Fill ``found`` as far as it has room; return how many rows there are."""
    count = 0
    for plane in range(len(starts) - 1):
        wide = u_starts[plane + 1] - u_starts[plane] - 1
        high = v_starts[plane + 1] - v_starts[plane] - 1
        drawn = np.zeros((2, wide, high), np.int32)
        for row in range(starts[plane], starts[plane + 1]):
            side, kind = rows[row, 3], rows[row, 8] + 1
            for u in range(u_ranks[row, 0], u_ranks[row, 1]):
                for v in range(v_ranks[row, 0], v_ranks[row, 1]):
                    held = drawn[side, u, v]
                    if held == 0 or is_clear[held - 1]:
                        drawn[side, u, v] = kind
        for u in range(wide):
            for v in range(high):
                low, up = drawn[0, u, v], drawn[1, u, v]
                if low != 0 and up != 0:
                    low_is_clear, up_is_clear = is_clear[low - 1], is_clear[up - 1]
                    if low_is_clear or not up_is_clear:
                        drawn[0, u, v] = 0
                    if up_is_clear or not low_is_clear:
                        drawn[1, u, v] = 0
        first = starts[plane]
        for side in range(2):
            for u in range(wide):
                for v in range(high):
                    kind = drawn[side, u, v]
                    if kind == 0:
                        continue
                    v1 = v + 1
                    while v1 < high and drawn[side, u, v1] == kind:
                        v1 += 1
                    u1 = u + 1
                    while u1 < wide and _is_all(drawn, side, u1, v, v1, kind):
                        u1 += 1
                    for a in range(u, u1):
                        for b in range(v, v1):
                            drawn[side, a, b] = 0
                    if count < len(found):
                        found[count, 0] = rows[first, 0]
                        found[count, 1] = rows[first, 1]
                        found[count, 2] = rows[first, 2]
                        found[count, 3], found[count, 8] = side, kind - 1
                        found[count, 4] = us[u_starts[plane] + u]
                        found[count, 5] = vs[v_starts[plane] + v]
                        found[count, 6] = us[u_starts[plane] + u1]
                        found[count, 7] = vs[v_starts[plane] + v1]
                    count += 1
    return count


@njit
def _is_all(drawn, side, u, v0, v1, kind):  # pragma: no cover
    for v in range(v0, v1):  # noqa: SIM110  # A kernel has no generators.
        if drawn[side, u, v] != kind:
            return False
    return True
