"""Monocular occupancy networks: reimplementations of published networks with shared layers.

Each network is a module with a class that is created from ``(size, grid_shape, voxel_m, backbone)``
and whose ``forward`` maps an ``OccInput`` to an ``OccOutput``, and has one entry in ``NETWORKS``.
"""

from world2minecraft.networks.models.factory import NETWORKS, SIZES, make_network

__all__ = ["NETWORKS", "SIZES", "make_network"]
