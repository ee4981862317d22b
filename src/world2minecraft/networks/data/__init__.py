"""Frames for networks: from any occupancy data set to batches, small, mixed and augmented.

``frames`` makes a frame of a sample, ``cache`` stores frames decoded, ``splits`` says which train,
``sequences`` finds further frames of a scene, ``batches`` draws, augments and stacks frames, and
``run_data`` opens all sets of a run.
"""
