"""Comparison of the built world with the photos of its capture."""
