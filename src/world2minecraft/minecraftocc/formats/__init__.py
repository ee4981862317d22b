"""Shared code for exporters and importers: label boxes, depth encodings and cameras."""
