"""Generation of houses as Minecraft worlds, with the class, object and design of every block."""

from world2minecraft.procgen.worlds.house_world import HouseWorld, generate_world
from world2minecraft.procgen.worlds.styles import styles
from world2minecraft.procgen.worlds.world_files import house_of, write_house, write_worlds

__all__ = ["HouseWorld", "generate_world", "house_of", "styles", "write_house", "write_worlds"]
