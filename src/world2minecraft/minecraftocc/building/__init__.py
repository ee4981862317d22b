"""Data set builds: survey the scenes of a plan, render the shards and write the index."""

from world2minecraft.minecraftocc.building.build import BuildReport, build_dataset
from world2minecraft.minecraftocc.building.cpu_clock import STAGES, TITLES
from world2minecraft.minecraftocc.building.repair import repair_dataset

__all__ = ["STAGES", "TITLES", "BuildReport", "build_dataset", "repair_dataset"]
