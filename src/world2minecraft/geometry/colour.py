"""Colour conversion between sRGB, linear light, Oklab and CIELAB, and the CIEDE2000 difference.

Colours are chosen in Oklab, because its distances match perception better than those of RGB: a dim
red is closer to red than to brown or grey. The matrices are from Björn Ottosson's definition of
2020. Reports state colour differences by CIEDE2000, the standard of colorimetry.
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
_RGB_TO_XYZ = np.array(
    [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ]
)
_WHITE_XYZ = _RGB_TO_XYZ.sum(axis=1)  # D65
_LAB_KNEE = 6 / 29
_CHROMA_7 = 25.0**7


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


def oklab_to_lab(oklab: np.ndarray) -> np.ndarray:
    """Convert Oklab, float [..., 3], to CIELAB (D65), float64 [..., 3]."""
    return linear_to_lab(np.maximum(oklab_to_linear(oklab), 0))


def linear_to_lab(linear: np.ndarray) -> np.ndarray:
    """Convert linear light, float [..., 3], to CIELAB (D65), float64 [..., 3], L from 0 to 100."""
    share = np.asarray(linear, np.float64) @ _RGB_TO_XYZ.T / _WHITE_XYZ
    bent = np.where(share > _LAB_KNEE**3, np.cbrt(share), share / (3 * _LAB_KNEE**2) + 4 / 29)
    x, y, z = np.moveaxis(bent, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def ciede2000(one: np.ndarray, other: np.ndarray, lightness_weight: float = 1.0) -> np.ndarray:
    """Return the CIEDE2000 difference of CIELAB colours, float64 [...].

    A difference of 2 is just noticeable; black and white differ by 100. The formula is that of
    Sharma, Wu and Dalal (2005) with weights 1 of chroma and hue.

    Args:
        one: CIELAB colours, float [..., 3].
        other: CIELAB colours, float [..., 3].
        lightness_weight: Weight of the squared difference of lightness.
    """
    (light_1, a_1, b_1), (light_2, a_2, b_2) = (
        np.moveaxis(np.asarray(lab, np.float64), -1, 0) for lab in (one, other)
    )
    mean_7 = ((np.hypot(a_1, b_1) + np.hypot(a_2, b_2)) / 2) ** 7
    stretch = 1.5 - 0.5 * np.sqrt(mean_7 / (mean_7 + _CHROMA_7))
    chroma_1, chroma_2 = np.hypot(a_1 * stretch, b_1), np.hypot(a_2 * stretch, b_2)
    hue_1 = np.degrees(np.arctan2(b_1, a_1 * stretch)) % 360
    hue_2 = np.degrees(np.arctan2(b_2, a_2 * stretch)) % 360
    grey = chroma_1 * chroma_2 == 0
    turn = np.where(grey, 0.0, (hue_2 - hue_1 + 180) % 360 - 180)
    hue = np.where(grey, hue_1 + hue_2, hue_1 + turn / 2)
    d_hue = 2 * np.sqrt(chroma_1 * chroma_2) * np.sin(np.radians(turn / 2))
    light, chroma = (light_1 + light_2) / 2, (chroma_1 + chroma_2) / 2
    weight = (
        1
        - 0.17 * np.cos(np.radians(hue - 30))
        + 0.24 * np.cos(np.radians(2 * hue))
        + 0.32 * np.cos(np.radians(3 * hue + 6))
        - 0.20 * np.cos(np.radians(4 * hue - 63))
    )
    off = (light - 50) ** 2
    by_light = (light_2 - light_1) / (1 + 0.015 * off / np.sqrt(20 + off))
    by_chroma = (chroma_2 - chroma_1) / (1 + 0.045 * chroma)
    by_hue = d_hue / (1 + 0.015 * chroma * weight)
    chroma_7 = chroma**7
    bend = np.radians(60 * np.exp(-((((hue % 360) - 275) / 25) ** 2)))
    mixed = -2 * np.sqrt(chroma_7 / (chroma_7 + _CHROMA_7)) * np.sin(bend)
    squares = lightness_weight * by_light**2 + by_chroma**2 + by_hue**2 + mixed * by_chroma * by_hue
    return np.sqrt(np.maximum(squares, 0))
