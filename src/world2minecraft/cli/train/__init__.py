"""The verb ``w2m train``, which trains occupancy networks."""
