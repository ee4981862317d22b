"""Furnished rooms: floor shapes, furniture, placement, clutter and voxels."""
