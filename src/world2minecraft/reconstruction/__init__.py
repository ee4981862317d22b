"""Algorithm 1 of the paper: from a capture to a Minecraft world, stage by stage."""
