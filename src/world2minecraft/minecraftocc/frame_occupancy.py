"""Occupancy prediction for the grid of a single frame, from its depth map or from a photo."""

from dataclasses import dataclass
from pathlib import Path

from world2minecraft.capture.depth_images import check_depth_kind
from world2minecraft.capture.images import read_colour, read_header, read_raw
from world2minecraft.core.errors import CaptureError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.formats.sscnet import NYU_FOCAL_PX
from world2minecraft.minecraftocc.cell_predictions import PredictedCells, predict_cells
from world2minecraft.minecraftocc.scene_completion import (
    VOXEL_M,
    GridPlace,
    complete_frame,
    depth_of_png,
)
from world2minecraft.reconstruction.occupancy.monocular_occupancy import MonoPredictor


@dataclass(frozen=True)
class Frame:
    """A depth map with an optional photo, or a photo without a depth map.

    Attributes:
        source: 16-bit depth PNG, or the photo.
        colour: Photo taken with the same camera as the depth map.
        depth_code: Encoding of the depth PNG: ``auto``, ``rotated``, ``mm`` or ``8000``.
        focal_px: Focal length of the camera in pixels, at the size of the image.
    """

    source: Path
    colour: Path | None = None
    depth_code: str = "auto"
    focal_px: float = NYU_FOCAL_PX

    def from_depth(self, place: GridPlace) -> PredictedCells:
        """Predict the grid from the depth map with the completion network.

        Raises:
            CaptureError: If the source is a photo.
            UsageError: If the photo and the depth map differ in size.
        """
        header = read_header(self.source)
        if header.mode in ("RGB", "RGBA", "CMYK", "YCbCr"):
            raise CaptureError(
                self.source,
                "this is a photo, expected a depth image; choose a depth image or the predictor "
                "mono (--predictor mono)",
            )
        check_depth_kind(self.source, header)
        depth_m = depth_of_png(self.source, read_raw(self.source), self.depth_code)
        photo = None if self.colour is None else read_colour(self.colour)
        if photo is not None and photo.shape[:2] != depth_m.shape:
            raise UsageError(
                f"{self.colour} has {photo.shape[1]}x{photo.shape[0]} pixels, but the depth image "
                f"has {depth_m.shape[1]}x{depth_m.shape[0]}; choose the photo of the same camera"
            )
        camera = self._camera(*depth_m.shape)
        found = complete_frame(depth_m, place, colour=photo, camera=camera)
        return PredictedCells(
            found.labels, found.confidence, found.observed, VOXEL_M, place.origin_m
        )

    def from_photo(self, place: GridPlace, network: str) -> PredictedCells:
        """Predict the grid from the photo with a monocular network.

        Args:
            place: Position of the grid and pose of the camera.
            network: ONNX file of the network. An empty string selects the shipped network.

        Raises:
            CaptureError: If there is no photo.
        """
        photo = self.colour or self.source
        if read_header(photo).mode.startswith(("I", "F")):
            raise CaptureError(
                photo,
                "this is a depth image, but the predictor mono needs a photo; add one (--colour "
                "PHOTO)",
            )
        loaded = MonoPredictor(network).network
        pixels = read_colour(photo)
        return predict_cells(pixels, self._camera(*pixels.shape[:2]), place, loaded)

    def _camera(self, height: int, width: int) -> Camera:
        focal_px = self.focal_px
        return Camera(width, height, focal_px, focal_px, width / 2 + 0.5, height / 2 + 0.5)
