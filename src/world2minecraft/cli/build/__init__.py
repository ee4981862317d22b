"""``w2m build``: occupancy files become blocks."""
