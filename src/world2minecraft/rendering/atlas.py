"""Texture atlases: all textures of a scene at one size with their mip levels, in one array.

Level 0 is the finest. The levels of a texture are stored one after another: n*n texels, then a
quarter as many, down to one. Colours are averaged in linear light with alpha weights, so that
leaves do not get dark edges around their holes.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from world2minecraft.rendering.light.tone_mapping import linear_to_srgb, srgb_to_linear
from world2minecraft.rendering.texture import SIZES_PX, Texture

MATERIAL = ("normal x", "normal y", "roughness", "metal", "emission")
MAX_CACHED_PX = 32  # 12 kB a texture with all its levels.
_ROWS: WeakKeyDictionary[Texture, dict[int, tuple[np.ndarray, np.ndarray]]] = WeakKeyDictionary()
_FLAT = np.array([128, 128, 200, 0, 0], np.uint8)  # Facing outward, rather rough, no metal, dark.


@dataclass(frozen=True, eq=False)
class Atlas:
    """A texture atlas.

    ``texels`` uint8 [L, M, 4] contains sRGB and alpha. ``material`` uint8 [L, M, 5] is described at
    ``MATERIAL``.
    """

    side_px: int
    texels: np.ndarray
    material: np.ndarray
    translucent: np.ndarray  # bool [L]


def texel_count(side_px: int) -> int:
    """Return the number of texels of a texture with all its mip levels."""
    return (4 * side_px * side_px - 1) // 3


def to_linear(srgb: np.ndarray) -> np.ndarray:
    """Convert sRGB values 0 to 255 to linear light, float64 0 to 1."""
    return srgb_to_linear(np.asarray(srgb, np.float64) / 255)


def to_srgb(linear: np.ndarray) -> np.ndarray:
    """Convert linear light to sRGB values, uint8."""
    return (linear_to_srgb(linear) * 255 + 0.5).astype(np.uint8)


def build_atlas(textures: Sequence[Texture], side_px: int) -> Atlas:
    """Resample textures to one size and compute their mip levels.

    Args:
        textures: At least one texture, of any size.
        side_px: Texture size in pixels: 16, 32, 64 or 128.

    Raises:
        ValueError: If there are no textures, or if the size is not supported.
    """
    if side_px not in SIZES_PX or not textures:
        raise ValueError(
            f"an atlas needs at least one texture and a size from {SIZES_PX}, got {side_px}"
        )
    texels = np.empty((len(textures), texel_count(side_px), 4), np.uint8)
    material = np.empty((len(textures), texel_count(side_px), 5), np.uint8)
    for row, texture in enumerate(textures):
        texels[row], material[row] = _texel_rows(texture, side_px)
    translucent = np.array([texture.translucent for texture in textures], bool)
    return Atlas(side_px, texels, material, translucent)


def _texel_rows(texture: Texture, side_px: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the texels and the material of a texture with all its levels.

    Those of small ones are kept as long as their texture: scene after scene is made of the same.
    """
    kept = _ROWS.setdefault(texture, {}) if side_px <= MAX_CACHED_PX else {}
    if side_px not in kept:
        colour = _resize(texture.colour, side_px)
        extra = _resize(_material_channels(texture), side_px)
        kept[side_px] = (
            np.concatenate(_colour_mip_levels(colour)),
            np.concatenate(_mip_levels(extra)),
        )
    return kept[side_px]


def _material_channels(texture: Texture) -> np.ndarray:
    """Return uint8 [N, N, 5] of the material channels of a texture."""
    size = texture.colour.shape[0]
    result = np.broadcast_to(_FLAT, (size, size, 5)).copy()
    if texture.normal is not None:
        result[..., :2] = texture.normal[..., :2]
    for place, name in enumerate(("roughness", "metal", "emission"), 2):
        value = getattr(texture, name)
        if value is not None:
            result[..., place] = value
    return result


def _resize(values: np.ndarray, side_px: int) -> np.ndarray:
    """Return [side, side, C] of [N, N, C]: means of squares where it shrinks, else repeated."""
    size = values.shape[0]
    if size > side_px and size % side_px == 0:
        step = size // side_px
        squares = values.reshape(side_px, step, side_px, step, -1).astype(np.float64)
        return (squares.mean(axis=(1, 3)) + 0.5).astype(np.uint8)
    at = (np.arange(side_px) + 0.5) * size / side_px
    return values[at.astype(int)][:, at.astype(int)]


def _colour_mip_levels(colour: np.ndarray) -> list[np.ndarray]:
    alpha = colour[..., 3:].astype(np.float64) / 255
    light = to_linear(colour[..., :3]) * alpha
    levels = []
    while True:
        own = np.where(alpha > 0, light / np.maximum(alpha, 1e-9), to_linear(colour[..., :3]))
        whole = np.concatenate([to_srgb(own), (alpha * 255 + 0.5).astype(np.uint8)], axis=-1)
        levels.append(whole.reshape(-1, 4))
        if len(alpha) == 1:
            return levels
        colour = whole[::2, ::2]
        light, alpha = _halve(light), _halve(alpha)


def _mip_levels(values: np.ndarray) -> list[np.ndarray]:
    exact, levels = values.astype(np.float64), []
    while True:
        levels.append((exact + 0.5).astype(np.uint8).reshape(-1, values.shape[-1]))
        if len(exact) == 1:
            return levels
        exact = _halve(exact)


def _halve(values: np.ndarray) -> np.ndarray:
    half = values.shape[0] // 2
    return values.reshape(half, 2, half, 2, -1).mean(axis=(1, 3))
