"""Alignment of a scan to its room: gravity, yaw, floor and the inner box of the walls."""
