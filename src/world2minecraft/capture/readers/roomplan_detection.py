"""Detection of captures that consist of a RoomPlan file without frames."""

from pathlib import Path

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.core.archives import AnyPath, is_zip
from world2minecraft.core.errors import InputError
from world2minecraft.formats import roomplan


def find_lone_roomplan(capture: Path) -> AnyPath | None:
    """Return the RoomPlan JSON of a capture that has no frames, or None.

    For a capture with frames, a RoomPlan file is given with ``--plan`` instead.
    """
    try:
        if capture.suffix.lower() == ".json":
            return roomplan.find_roomplan(capture)
        if capture.is_file() and not is_zip(capture):  # A video is not looked through for this.
            return None
    except OSError:
        return None  # ``find_capture`` says why it cannot be read.
    try:
        find_capture(capture)
    except InputError:
        return roomplan.find_roomplan(capture)
    return None
