"""Multi-view stereo: plane sweep, semi-global matching and consistency of depth maps."""

from world2minecraft.capture.stereo.depth_maps import compute_depth_maps
from world2minecraft.capture.stereo.monocular_depth import (
    DEPTH_MODELS,
    DepthModel,
    load_depth_model,
    network_maps,
)
from world2minecraft.capture.stereo.parameters import StereoParameters

__all__ = [
    "DEPTH_MODELS",
    "DepthModel",
    "StereoParameters",
    "compute_depth_maps",
    "load_depth_model",
    "network_maps",
]
