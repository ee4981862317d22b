"""The surface of a scan whose unit nobody knows.

Flat patches are found with thresholds in metres. So depth is first brought to about metres, by
what a person who walks through a room usually looks at, and the surface is carried back.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from world2minecraft.core.types import View
from world2minecraft.geometry.oriented_points import Surface, collect_surface

USUAL_DEPTH_M = 1.9  # Median over the virtual walks of seeds 500 to 549, 1.4 to 2.6 each.
EVERY_PIXEL = 7  # Of the depth images, for their median.


def collect_unscaled(views: Iterable[View], most_each: int = 4096) -> Surface:
    """Gather the flat patches of views in any unit; all lengths of the result are in that unit.

    Args:
        views: read twice, one view at a time; those without depth give nothing.
        most_each: of a view with more patches, that many are taken, evenly spread.
    """
    middle = _median_depth(views)
    if middle <= 0:
        return collect_surface((), most_each)
    factor = USUAL_DEPTH_M / middle
    return resized(collect_surface(_resized_views(views, factor), most_each), 1 / factor)


def resized(surface: Surface, factor: float) -> Surface:
    """Return the surface with all its lengths multiplied by a factor above 0."""
    cameras = surface.cameras.copy()
    cameras[:, :3, 3] *= factor
    return replace(
        surface,
        points_m=surface.points_m * factor,
        cameras=cameras,
        sigma_m=surface.sigma_m * factor,
    )


def _median_depth(views: Iterable[View]) -> float:
    """Return the median over the views of their median depths, 0 where none has depth."""
    middles = []
    for view in views:
        if view.depth_m is not None:
            depth = view.depth_m[::EVERY_PIXEL, ::EVERY_PIXEL]
            if (depth > 0).any():
                middles.append(float(np.median(depth[depth > 0])))
    return float(np.median(middles)) if middles else 0.0


def _resized_views(views: Iterable[View], factor: float) -> Iterator[View]:
    for view in views:
        if view.depth_m is None:
            continue
        pose, between = view.camera_to_scan.copy(), view.depth_to_colour.copy()
        pose[:3, 3] *= factor
        between[:3, 3] *= factor
        depth = (view.depth_m * np.float32(factor)).astype(np.float32)
        yield View(
            view.name,
            pose,
            depth_m=depth,
            depth_camera=view.depth_camera,
            depth_to_colour=between,
        )
