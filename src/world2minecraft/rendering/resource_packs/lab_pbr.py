"""The maps of labPBR beside a texture: ``NAME_n.png`` its relief, ``NAME_s.png`` its material.

In: their pixels. Out: the maps that a ``Texture`` holds. Older layouts of ``_s`` look the same on
disk and are read as labPBR 1.3 all the same.
"""

import numpy as np

FIRST_METAL = 230  # Of the green channel: below it is the reflectance of what is no metal.
NO_EMISSION = 255  # Of alpha; 254 is full.


def normal_map(pixels: np.ndarray) -> np.ndarray:
    """Return uint8 [N, N, 3] tangent-space normals of ``_n`` pixels, uint8 [N, N, 4].

    Red is x along u, green y along v: DirectX's way, down. The third is rebuilt; blue (corner
    darkening) and alpha (height) are left out.
    """
    plane = pixels[..., :2] / 255 * 2 - 1
    length = np.maximum(np.sqrt((plane**2).sum(axis=-1, keepdims=True)), 1.0)
    plane = plane / length
    outward = np.sqrt(np.clip(1 - (plane**2).sum(axis=-1, keepdims=True), 0, 1))
    normal = np.concatenate([plane, outward], axis=-1)
    return np.clip(np.round(128 + 127 * normal), 0, 255).astype(np.uint8)


def material_maps(pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return (roughness, metal, emission), uint8 [N, N] each, of ``_s`` pixels, uint8 [N, N, 4].

    Red is perceptual smoothness, green 230 and more a metal, alpha the light that it gives.
    """
    roughness = 255 - pixels[..., 0]
    metal = np.where(pixels[..., 1] >= FIRST_METAL, 255, 0).astype(np.uint8)
    alpha = pixels[..., 3].astype(np.uint16)
    emission = np.where(alpha == NO_EMISSION, 0, (alpha * 255 + 127) // 254).astype(np.uint8)
    return roughness, metal, emission
