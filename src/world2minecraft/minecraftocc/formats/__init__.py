"""What the exchange formats share: pickles, SSCNet's voxels, codes of depth, cameras, axes."""
