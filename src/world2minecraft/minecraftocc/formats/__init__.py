"""What exporters and importers share: pickles, SSCNet's voxels, depth codes, cameras, boxes."""
