"""Alignment of a scan to its room: gravity, yaw, floor and the inner bounding box of the walls."""
