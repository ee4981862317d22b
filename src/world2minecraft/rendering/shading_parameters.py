"""The light parameters of the kernels, computed from the user's settings and the scene."""

from functools import lru_cache

import numpy as np

from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.light.exposure import scene_exposure
from world2minecraft.rendering.ray_caster.shading import (
    ShadingParameters,
    block_face_shades,
    corner_lights,
)
from world2minecraft.rendering.scene import BlockScene

Backdrop = tuple[tuple[int, int, int], tuple[int, int, int]]

EXPOSURE_CELLS = 8  # Eyes so near to each other see by one exposure.
DAY = LightSettings()
NEUTRAL = LightSettings(preset="neutral")
# A quiet, warm light grey, a little darker towards the bottom.
BACKDROP: Backdrop = ((238, 238, 236), (214, 214, 212))


def shading_parameters(
    light: LightSettings,
    scene: BlockScene,
    background: Backdrop | None = None,
    eyes: np.ndarray | None = None,
) -> ShadingParameters:
    """Return the light parameters for the kernels.

    Args:
        light: The user's light settings.
        scene: The scene, whose exposure is used if ``light`` has none.
        background: sRGB colours of the first and last row of the background. None uses the sky of
            the hour, or a plain background if the light has no hour.
        eyes: Camera positions in cells of the scene, float64 [N, 3]. None stands for anywhere.
    """
    return _cached_parameters(light, exposure_of(light, scene, eyes), background)


def exposure_of(light: LightSettings, scene: BlockScene, eyes: np.ndarray | None = None) -> float:
    """Return the exposure for images from given eyes. Nearby eyes share one exposure."""
    for stated in (light.exposure, scene.exposure):
        if stated is not None:
            return stated
    if eyes is None:
        key: object = light
    else:
        lumps = np.unique(np.floor(np.asarray(eyes) / EXPOSURE_CELLS).astype(int), axis=0)
        key = (light, lumps.tobytes())
        eyes = np.unique(np.floor(np.asarray(eyes)) + 0.5, axis=0)
    if key not in scene.exposures:
        scene.exposures[key] = scene_exposure(scene.light, light, eyes)
    return scene.exposures[key]


@lru_cache(maxsize=64)
def _cached_parameters(
    light: LightSettings, exposure: float, background: Backdrop | None
) -> ShadingParameters:
    parameters, tone = light.parameters(exposure), light.tone
    if background is None and light.preset == "neutral":
        background = BACKDROP
    return ShadingParameters(
        lit=parameters,
        corners=corner_lights(parameters),
        shades=block_face_shades(parameters),
        tone=tone,
        background=light.background(exposure),
        paper=tone.decode[np.array(background or BACKDROP)].astype(np.float64),
        by_row=background is not None,
    )
