"""The views of a capture as a stream, decoded on each access."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from world2minecraft.capture.depth_images import DepthEncoding, read_depth
from world2minecraft.capture.images import read_colour, read_raw
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import Scan, View, ViewStream
from world2minecraft.core.vocabulary import label_id_classes


@dataclass(eq=False, repr=False)
class CaptureViews:
    """The views of a capture, read from disk one at a time in frame order.

    Attributes:
        frames: The frames to read.
        encoding: Encoding of the depth images.
        full_trust: Value in confidence images that means full confidence.
        damaged: Reasons by name of the frames that could not be decoded, which iteration skips.
    """

    frames: tuple[FrameFiles, ...]
    encoding: DepthEncoding
    full_trust: float = 255.0
    damaged: dict[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of frames, including frames that may fail to decode."""
        return len(self.frames)

    def __iter__(self) -> Iterator[View]:
        """Read the views from the start."""
        return self.read(self.frames)

    def depth_views(self) -> Iterator[View]:
        """Read the views that have depth, without decoding colour and labels."""
        return self.read(without_colour(self.frames))

    def named(self, names: Collection[str]) -> Iterator[View]:
        """Read the views of the given names, without decoding the others."""
        return self.read([frame for frame in self.frames if frame.name in names])

    def read(self, frames: Sequence[FrameFiles]) -> Iterator[View]:
        """Read the views of frames; frames that cannot be decoded are skipped and recorded."""
        for frame in frames:
            try:
                view = read_view(frame, self.encoding, self.full_trust)
            except InputError as error:
                self.damaged[frame.name] = str(error)
                continue
            yield view


def views_named(views: ViewStream, names: Collection[str]) -> Iterator[View]:
    """Read the views of the given names. Streams with a method ``named`` decode only these."""
    named = getattr(views, "named", None)
    if named is not None:
        return named(names)
    return (view for view in views if view.name in names)


def without_colour(frames: Sequence[FrameFiles]) -> list[FrameFiles]:
    """Return the frames that have depth, without colour, with unchanged poses."""
    return [
        replace(frame, colour_path=None, colour_camera=None, labels_path=None)
        for frame in frames
        if frame.depth_path
    ]


def skip_damaged_frames(scan: Scan) -> Scan:
    """Return a scan whose skipped frames include those that could not be decoded.

    Call this function after the views have been read.
    """
    damaged = getattr(scan.views, "damaged", {})
    late = [(name, reason) for name, reason in damaged.items() if name in scan.frames_used]
    return replace(
        scan,
        frames_used=tuple(name for name in scan.frames_used if name not in damaged),
        frames_skipped=(*scan.frames_skipped, *late),
    )


def read_view(frame: FrameFiles, encoding: DepthEncoding, full_trust: float = 255.0) -> View:
    """Decode the images of a frame.

    Raises:
        InputError: If a file cannot be decoded.
    """
    colour = None if frame.colour_path is None else read_colour(frame.colour_path)
    depth = None if frame.depth_path is None else read_depth(frame.depth_path, encoding)
    trust = _read_trust(frame, depth, full_trust)
    if depth is not None and trust is not None:
        depth = np.where(trust > 0, depth, np.float32(0))
    labels, label_ids = _read_labels(frame, colour)
    try:
        return View(
            frame.name,
            np.asarray(frame.camera_to_world),
            colour,
            frame.colour_camera,
            depth,
            frame.depth_camera,
            frame.depth_to_colour,
            labels,
            trust,
            label_ids,
        )
    except ValueError as error:
        path = frame.colour_path or frame.depth_path or frame.name
        raise DamagedFileError(path, str(error)) from error


def _read_labels(
    frame: FrameFiles, colour: np.ndarray | None
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Return the classes and the label ids of a frame, resampled to the colour image."""
    if frame.labels_path is None or colour is None:
        return None, None
    labels = read_raw(frame.labels_path)
    if getattr(frame.labels_path, "holds_label_ids", False):
        label_ids = _resize_nearest(labels, colour.shape[:2])
        return label_id_classes()[label_ids], label_ids
    if labels.dtype != np.uint8 or labels.ndim != 2:
        given = f"{labels.dtype} {labels.shape}"
        raise DamagedFileError(
            frame.labels_path, f"must be a single-channel image of 8-bit class ids, got {given}"
        )
    return _resize_nearest(labels, colour.shape[:2]), None


def _read_trust(frame: FrameFiles, depth: np.ndarray | None, full: float) -> np.ndarray | None:
    """Return the depth confidence as uint8 at the size of the depth image."""
    if frame.trust_path is None or depth is None:
        return None
    stored = read_raw(frame.trust_path)
    if stored.ndim != 2 or stored.dtype.kind not in "uf":
        given = f"{stored.dtype} {stored.shape}"
        raise DamagedFileError(
            frame.trust_path, f"must be a single-channel confidence image, got {given}"
        )
    share = np.clip(np.nan_to_num(stored.astype(np.float32)) / np.float32(full), 0, 1)
    return _resize_nearest(np.round(255 * share).astype(np.uint8), depth.shape)


def _resize_nearest(image: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Resize an image by nearest neighbour."""
    if image.shape == shape:
        return image
    rows = (np.arange(shape[0]) + 0.5) * image.shape[0] / shape[0]
    columns = (np.arange(shape[1]) + 0.5) * image.shape[1] / shape[1]
    return np.ascontiguousarray(image[rows.astype(np.intp)][:, columns.astype(np.intp)])
