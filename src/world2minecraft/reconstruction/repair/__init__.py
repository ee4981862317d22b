"""Repair by rendering: other furniture for objects that compare badly with the photos."""

from world2minecraft.reconstruction.repair.parameters import RepairParameters

__all__ = ["RepairParameters"]
