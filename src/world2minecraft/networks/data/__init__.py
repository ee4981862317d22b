"""Training frames for networks, from data sets to mixed and augmented batches.

``frames`` converts samples to frames, ``cache`` stores decoded frames, ``splits`` selects the
training frames, ``sequences`` finds further frames of a scene, ``batches`` selects, augments and
stacks frames, and ``training_data`` opens all data sets of a run.
"""
