"""Generation of furnished rooms: floor shapes, furniture, placement, clutter and voxels."""
