"""Shared code for exporters and importers: pickles, SSCNet voxels, depth encodings and cameras."""
