"""MinecraftVLN: worlds to walk, instructions to follow, agents to score."""
