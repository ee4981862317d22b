"""Frames for networks: from any occupancy data set to batches, small, mixed and augmented.

``frames`` makes a frame of a sample, ``cache`` keeps frames decoded, ``splits`` says which train,
``mixing`` which are drawn when, ``augment`` changes them, and ``batches`` makes tensors of them.
"""
