"""The segmentation network: the probabilities of the 40 NYU classes for each pixel of an image.

The network (``weights/segmentation.onnx``) was trained on labelled frames of real and of generated
rooms, ``weights/segmentation_generated.onnx`` on those of generated rooms alone. It takes colour,
depth or both. It is run by ONNX Runtime on one thread, so the same image gives the same
bytes.

The ONNX file has these inputs and outputs:

===============  ==========================================  ======================================
name             shape and type                              content
===============  ==========================================  ======================================
``colour``       float32 [1, 3, H, W]                        red, green, blue from 0 to 255, minus
                                                             ``COLOUR_MEAN``, divided by
                                                             ``COLOUR_SPREAD``; all 0 without colour
``geometry``     float32 [1, 7, ceil(H / 2), ceil(W / 2)]    ``geometry_channels`` of
                                                             ``segmentation_channels.py``; all 0
                                                             without depth
``probability``  float32 [1, 40, H, W]                       probability of each NYU40 class, in the
                                                             order of the ids 1 to 40
===============  ==========================================  ======================================

H and W are any size; the network was trained for a long side of 320 pixels. Calibration is inside
the file: the class weights of the training are partly undone and the logits are divided by a
temperature, which differs between colour with depth, colour alone and depth alone. Class 40 (other
prop) was never a target, and its probability is close to 0.
"""

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.onnx_sessions import open_session, session_options
from world2minecraft.core.shipped_weights import read_weights, shipped
from world2minecraft.core.types import Camera
from world2minecraft.core.vocabulary import NYU40_COUNT
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    COLOUR_MEAN,
    COLOUR_SPREAD,
    GEOMETRY_CHANNELS,
    geometry_channels,
    geometry_size,
    network_size,
)

WEIGHTS = shipped("segmentation.onnx")
GENERATED_WEIGHTS = shipped("segmentation_generated.onnx")
COLOUR, GEOMETRY, PROBABILITY = "colour", "geometry", "probability"
MAX_BYTES = 256 << 20


def colour_channels(colour: np.ndarray | None, width_px: int, height_px: int) -> np.ndarray:
    """Return the normalised colours as the network takes them, float32 [3, H, W].

    Args:
        colour: Colours, uint8 [H, W, 3], or None, which gives zeros.
        width_px: Width of the result.
        height_px: Height of the result.
    """
    if colour is None:
        return np.zeros((3, height_px, width_px), np.float32)
    small = Image.fromarray(colour).resize((width_px, height_px), Image.Resampling.BOX)
    values = np.asarray(small, np.float32) - np.array(COLOUR_MEAN, np.float32)
    values /= np.array(COLOUR_SPREAD, np.float32)
    return np.ascontiguousarray(np.moveaxis(values, 2, 0))


def splat_depth(
    depth_m: np.ndarray, down: np.ndarray, right: np.ndarray, size_px: tuple[int, int]
) -> np.ndarray:
    """Return the depth image of points, float32 [H, W], with the nearest point of each pixel.

    Args:
        depth_m: Depth of each point along the optical axis in metres, float [N].
        down: Place of each point in the image from top to bottom, 0 to 1, float [N].
        right: Place of each point in the image from left to right, 0 to 1, float [N].
        size_px: Width and height of the image.
    """
    width, height = size_px
    result = np.full(width * height, np.inf, np.float32)
    rows = np.minimum((down * height).astype(np.int64), height - 1)
    columns = np.minimum((right * width).astype(np.int64), width - 1)
    np.minimum.at(result, rows * width + columns, np.asarray(depth_m, np.float32))
    result[~np.isfinite(result) | (result < 0)] = 0
    return result.reshape(height, width)


class SegmentationModel:
    """The segmentation network of a file, which is read on first use."""

    def __init__(self, weights: Path | None = None):
        self.weights = weights or WEIGHTS

    @cached_property
    def _session(self) -> Any:
        options = session_options()
        options.enable_cpu_mem_arena = False
        session = open_session(self.weights, read_weights(self.weights, MAX_BYTES), options)
        taken = {one.name: one.shape for one in session.get_inputs()}
        given = {one.name: one.shape for one in session.get_outputs()}
        wanted = {COLOUR: 3, GEOMETRY: GEOMETRY_CHANNELS, PROBABILITY: NYU40_COUNT}
        for name, channels in wanted.items():
            shape = (taken | given).get(name)
            if shape is None or len(shape) != 4 or shape[1] != channels:
                raise DamagedFileError(
                    self.weights,
                    f"is no segmentation network: expected {name} of shape "
                    f"[1, {channels}, H, W], got {shape}",
                )
        return session

    def predict(
        self,
        colour: np.ndarray | None,
        depth_m: np.ndarray | None,
        camera: Camera,
        up: np.ndarray | None = None,
        camera_height_m: float | None = None,
    ) -> np.ndarray:
        """Predict the probability of each NYU40 class for each pixel.

        Args:
            colour: Colours, uint8 [H, W, 3], or None.
            depth_m: Depth in metres from the same camera, of the same or another resolution, 0
                where unknown; or None.
            camera: Camera of the image.
            up: Direction of up in the camera frame (x right, y down, z forward), or None if
                unknown.
            camera_height_m: Height of the camera above the floor in metres, or None if unknown.

        Returns:
            Probabilities of the ids 1 to 40, float32 [h, w, 40], at ``network_size`` of the camera.

        Raises:
            UsageError: If neither colour nor depth is given.
            InputError: If the weights file does not exist.
            DamagedFileError: If the weights file is not a valid network.
        """
        if colour is None and depth_m is None:
            raise UsageError("recognition needs colour or depth; the image has neither")
        width, height = network_size(camera.width_px, camera.height_px)
        small = camera.scaled_to(*geometry_size(width, height))
        geometry = geometry_channels(depth_m, small, up, camera_height_m)
        given = {COLOUR: colour_channels(colour, width, height)[None], GEOMETRY: geometry[None]}
        (probability,) = self._session.run([PROBABILITY], given)
        return np.moveaxis(probability[0], 0, 2)
