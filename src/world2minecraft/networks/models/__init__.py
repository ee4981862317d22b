"""Monocular occupancy networks: the published ones, on shared layers, in plain PyTorch.

A network is one file that holds a class made of ``(size, grid_shape, voxel_m, backbone)`` whose
``forward`` turns an ``OccInput`` into an ``OccOutput``, and one line of ``NETWORKS``.
"""

from world2minecraft.networks.models.factory import NETWORKS, SIZES, make_network

__all__ = ["NETWORKS", "SIZES", "make_network"]
