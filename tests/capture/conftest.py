"""The box room."""

from tests.exact_room import CAMERA, BoxRoom, box_room

__all__ = ["CAMERA", "BoxRoom", "box_room"]
