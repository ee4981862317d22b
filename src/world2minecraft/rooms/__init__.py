"""Procedural furnished rooms as metric layouts and 2 cm voxels, and virtual scans of them.

``generate_room`` gives the room of a seed; ``scan_room`` writes a capture of it as a depth camera
would hand it over, with the exact truth beside it.
"""

from world2minecraft.rooms.capture import room_views, scan_room
from world2minecraft.rooms.kinds import KINDS
from world2minecraft.rooms.room import Room, generate_room
from world2minecraft.rooms.sensor import SENSORS, Sensor

__all__ = ["KINDS", "SENSORS", "Room", "Sensor", "generate_room", "room_views", "scan_room"]
