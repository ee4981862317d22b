"""Captures without depth or poses, which are computed from the images.

``prepare_capture`` returns a capture folder that ``open_scan`` can read. A capture with poses and
depth is returned unchanged. Otherwise a capture with undistorted images, poses, depth, the
confidence of each pixel and the origin of the scale is written to ``OUT/capture``.
"""

from world2minecraft.reconstruction.opening.open_capture import (
    FOLDER,
    prepare_and_open,
    prepare_capture,
    scene_name,
)

__all__ = ["FOLDER", "prepare_and_open", "prepare_capture", "scene_name"]
