"""The small room that the tutorials are walked through."""

from tests.exact_room import box_room

__all__ = ["box_room"]
