"""``w2m train``: occupancy networks."""
