"""The canvas of a texture, and noise functions that tile on it.

Lengths are sixteenths of a block for all sizes in pixels, so that a layout is the same from 16 to
128 px, and only detail is added. Noise is a lattice of hashed values at the centres of its cells:
at 16 px, noise with 16 cells has one value per texel, as in pixel art. At 64 px it has the same
values interpolated smoothly, with finer octaves added.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

SIDE = 16.0  # Sixteenths a block.
# Width of a joint between boards or bricks, in sixteenths: a texel at 16 px, finer above.
JOINT = {16: 1.0, 32: 0.5, 64: 0.5, 128: 0.375}
MIX = (0x9E3779B97F4A7C15, 0xBF58476D1CE4E5B9, 0x94D049BB133111EB)  # Those of splitmix64.
MASK = (1 << 64) - 1


@dataclass(frozen=True, eq=False)
class Canvas:
    """The pixel coordinates of a texture.

    ``x`` and ``y`` float64 [N, N] are the centres of the texels, 0 to 16, right and down.
    """

    size_px: int
    seed: int
    x: np.ndarray
    y: np.ndarray

    @property
    def joint(self) -> float:
        """The width of a joint."""
        return JOINT[self.size_px]

    @property
    def fineness(self) -> float:
        """The amount of fine detail: 0 at 16 px, 1 at 64 px and above."""
        return {16: 0.0, 32: 0.5}.get(self.size_px, 1.0)


@lru_cache(maxsize=8)
def _centres(size_px: int) -> tuple[np.ndarray, np.ndarray]:
    line = (np.arange(size_px) + 0.5) * (SIDE / size_px)
    across, down = np.meshgrid(line, line)
    return across, down


def canvas_of(size_px: int, seed: int) -> Canvas:
    """Return an empty canvas with a size and a seed."""
    return Canvas(size_px, seed, *_centres(size_px))


def hash_values(seed: int, salt: int, index: np.ndarray) -> np.ndarray:
    """Return a value in [-1, 1) for each integer index, identical on every machine."""
    start = (seed + salt * MIX[2]) & MASK
    mixed = (index.astype(np.uint64) + np.uint64(start)) * np.uint64(MIX[0])
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(MIX[1])
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(MIX[2])
    mixed ^= mixed >> np.uint64(31)
    return (mixed >> np.uint64(11)).astype(np.float64) * 2.0**-52 - 1.0


def pick(canvas: Canvas, identity: np.ndarray, salt: int) -> np.ndarray:
    """Return a value in [-1, 1) for each piece of a layout, by its identity."""
    return hash_values(canvas.seed, salt, identity)


def noise(
    canvas: Canvas,
    across: int,
    down: int,
    salt: int,
    x: np.ndarray | None = None,
    y: np.ndarray | None = None,
) -> np.ndarray:
    """Return smooth tiling noise in [-1, 1) with ``across`` times ``down`` cells.

    ``x`` and ``y`` float64 [N, N] are the sample positions. The default is the texel centres.
    """
    left, right, part = _cell(canvas.x if x is None else x, across)
    above, below, share = _cell(canvas.y if y is None else y, down)
    values = hash_values(canvas.seed, salt, np.arange(across * down)).reshape(down, across)
    top = values[above, left] * (1 - part) + values[above, right] * part
    bottom = values[below, left] * (1 - part) + values[below, right] * part
    return top * (1 - share) + bottom * share


def _cell(place: np.ndarray, cells: int):
    """Return the two lattice points around a place, and how far it is to the second."""
    scaled = place * (cells / SIDE) - 0.5
    floor = np.floor(scaled)
    part = scaled - floor
    low = floor.astype(np.int64) % cells
    return low, (low + 1) % cells, part * part * (3 - 2 * part)


def fractal(
    canvas: Canvas,
    across: int,
    down: int,
    salt: int,
    gain: float = 0.5,
    x: np.ndarray | None = None,
) -> np.ndarray:
    """Return noise with all finer octaves that the size can show, each scaled by ``gain``."""
    total = noise(canvas, across, down, salt, x)
    weight, octave = gain, 1
    while max(across, down) * 2**octave <= canvas.size_px:
        scale = 2**octave
        total = total + weight * noise(canvas, across * scale, down * scale, salt + 97 * octave, x)
        weight, octave = weight * gain, octave + 1
    return total


def smooth(value: np.ndarray, low: np.ndarray | float, high: np.ndarray | float) -> np.ndarray:
    """Return 0 below ``low``, 1 above ``high``, and a smooth step between them."""
    part = np.clip((value - low) / (high - low), 0.0, 1.0)
    return part * part * (3 - 2 * part)


def relief(canvas: Canvas, height: np.ndarray) -> np.ndarray:
    """Return the light from the upper left on a height field in sixteenths, -1 to 1."""
    rise = 2 * height - np.roll(height, 1, axis=0) - np.roll(height, 1, axis=1)
    return np.clip(rise * (canvas.size_px / SIDE), -1.0, 1.0)


def contour(canvas: Canvas, values: np.ndarray) -> np.ndarray:
    """Return the distance in sixteenths to the zero lines of a field, for veins of even width."""
    across = np.roll(values, -1, axis=1) - np.roll(values, 1, axis=1)
    down = np.roll(values, -1, axis=0) - np.roll(values, 1, axis=0)
    slope = np.sqrt(across * across + down * down) * (canvas.size_px / SIDE / 2)
    return np.abs(values) / np.maximum(slope, 0.06)  # Flat places are no wide veins.
