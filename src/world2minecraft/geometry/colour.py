"""Colour conversion between sRGB, linear light and Oklab.

All colours are compared in Oklab, because its distances match perception better than those of RGB:
a dim red is closer to red than to brown or grey. The matrices are from Björn Ottosson's definition
of 2020.
"""

import numpy as np

_RGB_TO_LMS = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
_LMS_TO_OKLAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
_LMS_TO_RGB = np.linalg.inv(_RGB_TO_LMS)
_OKLAB_TO_LMS = np.linalg.inv(_LMS_TO_OKLAB)


def _linear_of_byte() -> np.ndarray:
    share = np.arange(256) / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


_LINEAR_OF_BYTE = _linear_of_byte()


def srgb_to_linear(rgb: np.ndarray) -> np.ndarray:
    """Convert sRGB bytes, uint8 [..., 3], to linear light, float64 [..., 3] in [0, 1]."""
    return _LINEAR_OF_BYTE[np.asarray(rgb, np.uint8)]


def linear_to_srgb(linear: np.ndarray) -> np.ndarray:
    """Convert linear light to sRGB bytes, uint8 [..., 3]; values outside [0, 1] are clipped."""
    share = np.clip(linear, 0.0, 1.0)
    encoded = np.where(share <= 0.0031308, share * 12.92, 1.055 * share ** (1 / 2.4) - 0.055)
    return np.round(encoded * 255).astype(np.uint8)


def linear_to_oklab(linear: np.ndarray) -> np.ndarray:
    """Convert linear light, float [..., 3], to Oklab, float32 [..., 3]."""
    return (np.cbrt(np.asarray(linear) @ _RGB_TO_LMS.T) @ _LMS_TO_OKLAB.T).astype(np.float32)


def oklab_to_linear(oklab: np.ndarray) -> np.ndarray:
    """Convert Oklab to linear light, float64 [..., 3], without clipping to [0, 1]."""
    return ((np.asarray(oklab, np.float64) @ _OKLAB_TO_LMS.T) ** 3) @ _LMS_TO_RGB.T


def srgb_to_oklab(rgb: np.ndarray) -> np.ndarray:
    """Convert sRGB bytes to Oklab.

    Args:
        rgb: uint8 [..., 3] sRGB colours.

    Returns:
        The Oklab colours as float32 [..., 3]: lightness from 0 to 1, then the green-red and the
        blue-yellow coordinate, each between about -0.4 and 0.4 and 0 for greys.

    Example:
        >>> srgb_to_oklab(np.array([255, 255, 255], np.uint8)).round(3).tolist()[0]
        1.0
    """
    return linear_to_oklab(srgb_to_linear(rgb))
