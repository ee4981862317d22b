"""The segmentation network: labelled frames, the network, its training, calibration and export.

The network names what an image shows with the 40 classes of NYUv2.
``docs/how-to/train-segmentation.md`` describes the commands.
"""
