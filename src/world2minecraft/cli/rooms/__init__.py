"""The verbs ``w2m rooms ...``, which generate rooms and scan them virtually."""
