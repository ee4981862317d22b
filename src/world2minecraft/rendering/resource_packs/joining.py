"""Textures laid one over another, each times a colour: what joined elements are drawn with."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.rendering.texture import Texture

# The maps of a texture, and what stands for one that a layer lacks where another has it.
FLAT = {"normal": (128, 128, 255), "roughness": 204, "metal": 0, "emission": 0}


def joined(layers: Sequence[tuple[Texture, tuple[int, ...]]]) -> Texture:
    """Return one texture of several, the first at the bottom.

    Args:
        layers: at least one texture, each with the sRGB colour that it is times.
    """
    side = max(texture.colour.shape[0] for texture, _ in layers)
    done: Texture | None = None
    for texture, tint in layers:
        above = _tinted(_scaled(texture, side), np.array(tint))
        done = above if done is None else _over(done, above)
    if done is None:
        raise ValueError("there is no layer")
    return done


def _scaled(texture: Texture, side: int) -> Texture:
    """Return a texture with each pixel repeated; sides are powers of two."""
    times = side // texture.colour.shape[0]
    maps = {
        name: None if (held := getattr(texture, name)) is None else _grown(held, times)
        for name in FLAT
    }
    return replace(texture, colour=_grown(texture.colour, times), **maps)


def _grown(pixels: np.ndarray, times: int) -> np.ndarray:
    return pixels.repeat(times, axis=0).repeat(times, axis=1)


def _tinted(texture: Texture, tint: np.ndarray) -> Texture:
    """Return a texture times a colour, multiplied in linear light."""
    if (tint == 255).all():
        return texture
    colour = texture.colour.copy()
    product = _linear(colour[..., :3]) * _linear(tint)
    colour[..., :3] = np.round(_srgb(product) * 255)
    return replace(texture, colour=colour)


def _linear(values: np.ndarray) -> np.ndarray:
    share = values / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def _srgb(light: np.ndarray) -> np.ndarray:
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def _over(below: Texture, above: Texture) -> Texture:
    """Return one texture over another; each map is that of the one that is seen."""
    cover = above.colour[..., 3:] / 255
    if not above.translucent:
        cover = (cover >= 0.5).astype(np.float64)
    colour = below.colour.copy()
    mixed = below.colour[..., :3] * (1 - cover) + above.colour[..., :3] * cover
    colour[..., :3] = np.round(mixed)
    colour[..., 3] = np.maximum(below.colour[..., 3], above.colour[..., 3])
    seen = cover[..., 0] >= 0.5
    maps: dict[str, np.ndarray | None] = {}
    for name, value in FLAT.items():
        lower, upper = getattr(below, name), getattr(above, name)
        if lower is None and upper is None:
            continue
        flat = np.zeros((*seen.shape, 3) if name == "normal" else seen.shape, np.uint8)
        flat[...] = value
        lower, upper = (flat if one is None else one for one in (lower, upper))
        maps[name] = np.where(seen[..., None] if name == "normal" else seen, upper, lower)
    is_clear = (below.translucent or above.translucent) and bool((colour[..., 3] < 255).any())
    return replace(below, colour=colour, translucent=is_clear, **maps)
