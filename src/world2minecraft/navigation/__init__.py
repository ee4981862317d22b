"""MinecraftVLN: vision-and-language navigation in voxel worlds.

The package contains the scenes, the navigation data sets, the agents and the evaluation.
"""
