"""Layers: backbones, projection and lifting, attention, 3D blocks and U-Nets, heads."""
