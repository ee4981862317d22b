"""Block states, block shapes, game physics and file formats of Minecraft."""
