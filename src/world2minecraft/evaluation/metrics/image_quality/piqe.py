"""PIQE: the share of distorted blocks in an image, 0 to 100. Lower is better.

N. Venkatanath, D. Praneeth, M. C. Bh, S. S. Channappayya, S. S. Medasani: Blind image quality
evaluation using perception based features, National Conference on Communications, 2015. Only blocks
of 16 x 16 pixels with sufficient variance are assessed. A block with a uniform segment at its edge
counts as blocky, and a block whose centre varies as much as its surround counts as noisy. The
method requires no training.
"""

from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from world2minecraft.evaluation.metrics.image_quality.scene_statistics import normalise, to_grey

BLOCK_PX = 16
LIVELY = 0.1  # Minimum variance of an assessed block.
EVEN = 0.1  # A segment of an edge with a smaller deviation is an artefact.
STRETCH_PX = 6


class BlockFaults(NamedTuple):
    """The assessment of each block, [rows, columns].

    Attributes:
        variance: The variance as float64.
        lively: Whether the block has sufficient variance to be assessed, as bool.
        blocky: Whether an assessed block is blocky, as bool.
        noisy: Whether an assessed block is noisy, as bool.
    """

    variance: np.ndarray
    lively: np.ndarray
    blocky: np.ndarray
    noisy: np.ndarray


def piqe(picture: np.ndarray) -> float:
    """Return the PIQE score of an image, which is 100 without any block of sufficient variance.

    Args:
        picture: The image as uint8 [H, W] or [H, W, 3] in sRGB.

    Raises:
        ValueError: If the shape or type is not supported.

    Example:
        >>> piqe(np.zeros((32, 32), np.uint8))
        100.0
    """
    faults = block_faults(picture)
    distorted = np.where(faults.blocky, 1 - faults.variance, 0.0)
    distorted = distorted + np.where(faults.noisy, faults.variance, 0.0)
    return float(100 * (distorted.sum() + 1) / (int(faults.lively.sum()) + 1))


def block_faults(picture: np.ndarray) -> BlockFaults:
    """Assess the blocks of an image.

    Incomplete blocks at the right and the bottom are padded by mirroring.

    Args:
        picture: The image as uint8 [H, W] or [H, W, 3] in sRGB.

    Raises:
        ValueError: If the shape or type is not supported.
    """
    grey = to_grey(picture)
    over = [(0, -side % BLOCK_PX) for side in grey.shape]
    coefficients, _ = normalise(np.pad(grey, over, mode="symmetric"))
    rows, columns = (side // BLOCK_PX for side in coefficients.shape)
    blocks = coefficients.reshape(rows, BLOCK_PX, columns, BLOCK_PX).swapaxes(1, 2)
    variance = blocks.var(axis=(2, 3), ddof=1)
    lively = variance > LIVELY
    return BlockFaults(
        variance, lively, lively & _has_even_rim(blocks), lively & _is_noisy(blocks, variance)
    )


def _has_even_rim(blocks: np.ndarray) -> np.ndarray:
    rims = np.stack(
        [blocks[..., 0, :], blocks[..., -1, :], blocks[..., :, 0], blocks[..., :, -1]], axis=2
    )
    stretches = sliding_window_view(rims, STRETCH_PX, axis=-1)
    return (stretches.std(axis=-1, ddof=1) < EVEN).any(axis=(2, 3))


def _is_noisy(blocks: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """Compare the deviation of a block's two middle columns with that of its other columns.

    The authors' code removes the middle columns one after the other, so that the second removal
    affects the following column. This is reproduced here in order to obtain the same scores.
    """
    middle = BLOCK_PX // 2 - 1
    centre = blocks[..., middle : middle + 2].std(axis=(2, 3), ddof=1)
    kept = [n for n in range(BLOCK_PX) if n not in (middle, middle + 2)]
    surround = blocks[..., kept].std(axis=(2, 3), ddof=1)
    deviation = np.sqrt(variance)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.nan_to_num(centre / surround, nan=0.0)
        beta = np.abs(deviation - ratio) / np.maximum(deviation, ratio)
    return deviation > 2 * beta
