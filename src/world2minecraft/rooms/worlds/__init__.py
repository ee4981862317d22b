"""Houses as Minecraft worlds, made without a scan: every block with its class, thing and design."""

from world2minecraft.rooms.worlds.looks import styles
from world2minecraft.rooms.worlds.making import HouseWorld, generate_world
from world2minecraft.rooms.worlds.stored import house_of, write_house, write_worlds

__all__ = ["HouseWorld", "generate_world", "house_of", "styles", "write_house", "write_worlds"]
