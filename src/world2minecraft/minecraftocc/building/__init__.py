"""Build a data set from its plan: survey scenes, render shards with an engine, write the index."""

from world2minecraft.minecraftocc.building.build import BuildReport, build_dataset
from world2minecraft.minecraftocc.building.cpu_clock import STAGES, TITLES

__all__ = ["STAGES", "TITLES", "BuildReport", "build_dataset"]
