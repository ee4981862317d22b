"""Captures that lack depth or poses: both are computed from the pictures.

``prepare_capture`` gives the place of a capture that ``open_scan`` can read. What has poses and
depth is returned as it is. All else is written anew to ``OUT/capture`` in our plain layout:
pictures without distortion, poses, depth, how far each pixel is to be trusted, and where the scale
is from.
"""

from world2minecraft.reconstruction.opening.open_capture import (
    FOLDER,
    prepare_and_open,
    prepare_capture,
    scene_name,
)

__all__ = ["FOLDER", "prepare_and_open", "prepare_capture", "scene_name"]
