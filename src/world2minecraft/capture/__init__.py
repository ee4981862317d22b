"""Stage 1 of the pipeline: open a capture on disk as an aligned ``Scan``.

``open_scan`` detects the format of a capture, validates its frames, aligns the room and returns
views that are read from disk one at a time. ``describe_capture`` summarises a capture within
seconds. ``write_plain`` writes captures in the project's own layout.
"""

from world2minecraft.capture.alignment.room_frame import realign
from world2minecraft.capture.open_scan import open_scan
from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.capture.summary import CaptureSummary, describe_capture
from world2minecraft.capture.view_stream import skip_damaged_frames

__all__ = [
    "CaptureSummary",
    "describe_capture",
    "open_scan",
    "realign",
    "skip_damaged_frames",
    "write_plain",
]
