"""Readers of the formats written by RGB-D data sets, depth cameras and photogrammetry tools."""
