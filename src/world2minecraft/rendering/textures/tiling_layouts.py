"""Seamless layouts of boards, bricks, stones and frames; lengths are sixteenths of a block."""

from typing import NamedTuple

import numpy as np

from world2minecraft.rendering.textures.canvas import SIDE, Canvas, hash_values, smooth


class Pieces(NamedTuple):
    """A surface divided into pieces.

    ``identity`` int64 [N, N] numbers the pieces. ``x`` and ``y`` are a texel's position in its
    piece. ``edge`` is the distance to the edge of the piece, negative in a joint. ``joint`` is 1 in
    joints.
    """

    identity: np.ndarray
    x: np.ndarray
    y: np.ndarray
    edge: np.ndarray
    joint: np.ndarray


def _pieces(identity, x, y, width: float, height: float, joint: float) -> Pieces:
    """Return pieces of one size; the joint is at their right and lower side."""
    edge = np.minimum.reduce([x, y, width - joint - x, height - joint - y])
    return Pieces(identity.astype(np.int64), x, y, edge, (edge < 0).astype(np.float64))


def boards(canvas: Canvas, count: int) -> Pieces:
    """Return ``count`` boards along x, one per row, with their ends spread over the rows."""
    height = SIDE / count
    row = np.floor(canvas.y / height)
    # Ends that are far apart in neighbouring rows: 7 and 16 have no common divisor.
    end = (row * 7 + 3) % 16
    x = (canvas.x - end) % SIDE
    return _pieces(row, x, canvas.y - row * height, SIDE, height, canvas.joint)


def bricks(
    canvas: Canvas, rows: int, columns: int, bond: float = 0.5, joint: float | None = None
) -> Pieces:
    """Return bricks, with every other row shifted by ``bond`` of a brick."""
    width, height = SIDE / columns, SIDE / rows
    row = np.floor(canvas.y / height)
    along = (canvas.x + (row % 2) * bond * width) % SIDE
    column = np.floor(along / width)
    gap = canvas.joint if joint is None else joint
    x, y = along - column * width, canvas.y - row * height
    return _pieces(row * columns + column, x, y, width, height, gap)


def stones(canvas: Canvas, count: int, salt: int, jitter: float = 0.7) -> Pieces:
    """Return round pieces around ``count`` times ``count`` scattered points.

    ``edge`` is 0 at the border between two pieces and increases inwards.
    """
    step = SIDE / count
    column, row = np.floor(canvas.x / step), np.floor(canvas.y / step)
    near = np.full(canvas.x.shape, 1e9)
    second, identity = near.copy(), np.zeros(canvas.x.shape)
    x, y = near.copy(), near.copy()
    for down in (-2, -1, 0, 1, 2):
        for across in (-2, -1, 0, 1, 2):
            cell = ((row + down) % count) * count + (column + across) % count
            away_x = canvas.x - (column + across + 0.5 + _jitter(canvas, cell, salt, jitter)) * step
            away_y = canvas.y - (row + down + 0.5 + _jitter(canvas, cell, salt + 1, jitter)) * step
            far = np.sqrt(away_x * away_x + away_y * away_y)
            closer = far < near
            second = np.where(closer, near, np.minimum(second, far))
            identity = np.where(closer, cell, identity)
            x, y = np.where(closer, away_x, x), np.where(closer, away_y, y)
            near = np.minimum(near, far)
    edge = (second - near) / 2
    joint = (edge < canvas.joint * 0.45).astype(np.float64)
    return Pieces(identity.astype(np.int64), x, y, edge, joint)


def _jitter(canvas: Canvas, cell: np.ndarray, salt: int, jitter: float) -> np.ndarray:
    return hash_values(canvas.seed, salt, cell) * 0.5 * jitter


def rim(canvas: Canvas) -> np.ndarray:
    """Return the distance to the nearest side of the texture."""
    return np.minimum.reduce([canvas.x, canvas.y, SIDE - canvas.x, SIDE - canvas.y])


def box(canvas: Canvas, left: float, top: float, right: float, bottom: float) -> np.ndarray:
    """Return the distance to the nearest side of a box, negative outside the box."""
    return np.minimum.reduce([canvas.x - left, canvas.y - top, right - canvas.x, bottom - canvas.y])


def bevel(canvas: Canvas, edge: np.ndarray, width: float) -> np.ndarray:
    """Return a height from 0 at an edge to 1 at ``width`` inside, at least one texel wide."""
    return smooth(edge, 0.0, max(width, 0.5 * SIDE / canvas.size_px))
