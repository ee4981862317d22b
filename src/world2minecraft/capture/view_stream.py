"""The views of a capture as a stream: each is decoded when it is read, and again next time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from world2minecraft.capture.depth_images import DepthEncoding, read_depth
from world2minecraft.capture.images import read_colour, read_raw
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import Scan, View


@dataclass(eq=False, repr=False)
class CaptureViews:
    """Views read from disk one at a time, in the order of the frames.

    ``damaged`` maps the names of frames whose files passed the check of their outside but could
    not be decoded to the reason; they are left out while iterating, and listed here.
    """

    frames: tuple[FrameFiles, ...]
    encoding: DepthEncoding
    full_trust: float = 255.0
    damaged: dict[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        """The number of frames, those that turn out damaged while decoding included."""
        return len(self.frames)

    def __iter__(self) -> Iterator[View]:
        """Read the views from the first."""
        return self.read(self.frames)

    def depth_views(self) -> Iterator[View]:
        """Read the views that have depth, without decoding their colours and labels."""
        return self.read(without_colour(self.frames))

    def read(self, frames: Sequence[FrameFiles]) -> Iterator[View]:
        """Read the views of some frames; those that cannot be decoded are left out and noted."""
        for frame in frames:
            try:
                view = read_view(frame, self.encoding, self.full_trust)
            except InputError as error:
                self.damaged[frame.name] = str(error)
                continue
            yield view


def without_colour(frames: Sequence[FrameFiles]) -> list[FrameFiles]:
    """Return the frames that have depth, without colour; the depth camera's pose stays the same."""
    return [
        replace(frame, colour_path=None, colour_camera=None, labels_path=None)
        for frame in frames
        if frame.depth_path
    ]


def skip_damaged_frames(scan: Scan) -> Scan:
    """Return the scan with the frames that could not be decoded among those skipped.

    Call it after its views have been read.
    """
    damaged = getattr(scan.views, "damaged", {})
    late = [(name, reason) for name, reason in damaged.items() if name in scan.frames_used]
    return replace(
        scan,
        frames_used=tuple(name for name in scan.frames_used if name not in damaged),
        frames_skipped=(*scan.frames_skipped, *late),
    )


def read_view(frame: FrameFiles, encoding: DepthEncoding, full_trust: float = 255.0) -> View:
    """Decode one frame. Raises InputError where a file cannot be decoded."""
    colour = None if frame.colour_path is None else read_colour(frame.colour_path)
    depth = None if frame.depth_path is None else read_depth(frame.depth_path, encoding)
    trust = _read_trust(frame, depth, full_trust)
    if depth is not None and trust is not None:
        depth = np.where(trust > 0, depth, np.float32(0))
    try:
        return View(
            frame.name,
            np.asarray(frame.camera_to_world),
            colour,
            frame.colour_camera,
            depth,
            frame.depth_camera,
            frame.depth_to_colour,
            _read_labels(frame, colour),
            trust,
        )
    except ValueError as error:
        path = frame.colour_path or frame.depth_path or frame.name
        raise DamagedFileError(path, str(error)) from error


def _read_labels(frame: FrameFiles, colour: np.ndarray | None) -> np.ndarray | None:
    """Return a frame's label image, carried to the colour image's size by nearest pixels."""
    if frame.labels_path is None or colour is None:
        return None
    labels = read_raw(frame.labels_path)
    if labels.dtype != np.uint8 or labels.ndim != 2:
        given = f"{labels.dtype} {labels.shape}"
        raise DamagedFileError(
            frame.labels_path, f"must hold one 8-bit class id a pixel, not {given}"
        )
    return _resize_nearest(labels, colour.shape[:2])


def _read_trust(frame: FrameFiles, depth: np.ndarray | None, full: float) -> np.ndarray | None:
    """Return how far each depth pixel is to be trusted, uint8 at the depth image's size."""
    if frame.trust_path is None or depth is None:
        return None
    stored = read_raw(frame.trust_path)
    if stored.ndim != 2 or stored.dtype.kind not in "uf":
        given = f"{stored.dtype} {stored.shape}"
        raise DamagedFileError(frame.trust_path, f"must hold one confidence a pixel, not {given}")
    share = np.clip(np.nan_to_num(stored.astype(np.float32)) / np.float32(full), 0, 1)
    return _resize_nearest(np.round(255 * share).astype(np.uint8), depth.shape)


def _resize_nearest(image: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Return an image at another size, by nearest pixels."""
    if image.shape == shape:
        return image
    rows = (np.arange(shape[0]) + 0.5) * image.shape[0] / shape[0]
    columns = (np.arange(shape[1]) + 0.5) * image.shape[1] / shape[1]
    return np.ascontiguousarray(image[rows.astype(np.intp)][:, columns.astype(np.intp)])
