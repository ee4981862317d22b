"""Readers of formats that RGB-D data sets, depth cameras and photogrammetry write."""
