"""What networks are taught by: cross entropy, and losses of scenes, frusta, relations and depth."""

from world2minecraft.networks.losses_one import LossWeights, occupancy_losses

__all__ = ["LossWeights", "occupancy_losses"]
