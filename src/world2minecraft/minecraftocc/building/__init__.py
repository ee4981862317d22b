"""A data set from its plan: scenes looked at, shards made by an engine, the index written."""

from world2minecraft.minecraftocc.building.build import BuildReport, build_dataset
from world2minecraft.minecraftocc.building.cpu_clock import STAGES, TITLES

__all__ = ["STAGES", "TITLES", "BuildReport", "build_dataset"]
