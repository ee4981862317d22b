"""Predict the cells of one frame's grid: from its depth picture, or from its photo alone."""

from dataclasses import dataclass
from pathlib import Path

from world2minecraft.capture.depth_images import check_depth_kind
from world2minecraft.capture.images import read_colour, read_header, read_raw
from world2minecraft.core.errors import CaptureError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.cell_predictions import PredictedCells, predict_cells
from world2minecraft.minecraftocc.scene_completion import (
    VOXEL_M,
    GridPlace,
    complete_frame,
    depth_of_png,
)
from world2minecraft.reconstruction.occupancy.monocular_occupancy import MonoPredictor

NYU_FOCAL_PX = 518.8579


@dataclass(frozen=True)
class Frame:
    """A depth picture with its photo, or a photo alone.

    Attributes:
        source: the depth PNG of 16 bits, or the photo.
        colour: the photo of a depth picture's camera.
        depth_code: how a depth PNG holds metres: auto, rotated, mm or 8000.
        focal_px: of the camera, at the picture's size.
    """

    source: Path
    colour: Path | None = None
    depth_code: str = "auto"
    focal_px: float = NYU_FOCAL_PX

    def from_depth(self, place: GridPlace) -> PredictedCells:
        """Predict the grid from the depth picture, by the completion network.

        Raises:
            CaptureError: the source is a photo. UsageError: the photo has another size.
        """
        header = read_header(self.source)
        if header.mode in ("RGB", "RGBA", "CMYK", "YCbCr"):
            raise CaptureError(
                self.source,
                "is a photo; give its depth picture, or a network for photos: --predictor mono",
            )
        check_depth_kind(self.source, header)
        depth_m = depth_of_png(self.source, read_raw(self.source), self.depth_code)
        photo = None if self.colour is None else read_colour(self.colour)
        if photo is not None and photo.shape[:2] != depth_m.shape:
            raise UsageError(
                f"{self.colour} has {photo.shape[1]} x {photo.shape[0]} pixels, the depth picture "
                f"{depth_m.shape[1]} x {depth_m.shape[0]}; give the photo of the same camera"
            )
        camera = self._camera(*depth_m.shape)
        found = complete_frame(depth_m, place, colour=photo, camera=camera)
        return PredictedCells(
            found.labels, found.confidence, found.observed, VOXEL_M, place.origin_m
        )

    def from_photo(self, place: GridPlace, network: str) -> PredictedCells:
        """Predict the grid from the photo, by a monocular network.

        Args:
            place: where the grid lies.
            network: an ONNX file; the shipped one where empty.

        Raises:
            CaptureError: there is no photo.
        """
        photo = self.colour or self.source
        if read_header(photo).mode.startswith(("I", "F")):
            raise CaptureError(
                photo, "is a depth picture; --predictor mono needs the photo: --colour PHOTO"
            )
        loaded = MonoPredictor(network).network
        pixels = read_colour(photo)
        return predict_cells(pixels, self._camera(*pixels.shape[:2]), place, loaded)

    def _camera(self, height: int, width: int) -> Camera:
        focal_px = self.focal_px
        return Camera(width, height, focal_px, focal_px, width / 2 + 0.5, height / 2 + 0.5)
