"""Procedurally generated rooms as metric layouts and 2 cm voxels, and their virtual scans.

``generate_room`` generates a room from a seed, and ``generate_house`` a house of several rooms.
``scan_room`` writes a capture as a depth camera would record it, together with the ground truth.
"""

from world2minecraft.procgen.houses.house import generate_house
from world2minecraft.procgen.preview import room_picture, room_view
from world2minecraft.procgen.room_files import read_generated, write_generated
from world2minecraft.procgen.rooms.floor_shapes import SHAPES
from world2minecraft.procgen.rooms.recipes import BASE_KINDS, KINDS
from world2minecraft.procgen.rooms.room import Room, generate_room
from world2minecraft.procgen.sensors.depth_camera import SENSORS, Sensor
from world2minecraft.procgen.virtual_scan import room_views, scan_room

__all__ = [
    "BASE_KINDS",
    "KINDS",
    "SENSORS",
    "SHAPES",
    "Room",
    "Sensor",
    "generate_house",
    "generate_room",
    "read_generated",
    "room_picture",
    "room_view",
    "room_views",
    "scan_room",
    "write_generated",
]
