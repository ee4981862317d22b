"""Depth of photos from each other: a plane sweep, semi-global matching and mutual agreement."""

from world2minecraft.stereo.maps import depth_maps
from world2minecraft.stereo.parameters import StereoParameters

__all__ = ["StereoParameters", "depth_maps"]
