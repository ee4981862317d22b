"""A network of a few hundred weights: a bias a cell's height, and the picture's colours."""

import torch
from torch import nn

from world2minecraft.networks.batch import OccInput, OccOutput


class Toy(nn.Module):
    def __init__(self, width=4, height=18):
        super().__init__()
        self.look = nn.Sequential(nn.Conv2d(3, width, 3, 2), nn.ReLU(), nn.Dropout(0.1))
        self.say = nn.Linear(width, 12 * height)

    def forward(self, inputs: OccInput) -> OccOutput:
        seen = self.look(inputs.image).mean(dim=(2, 3))
        x, y, z = inputs.grid_shape
        said = self.say(seen).reshape(-1, 12, 1, 1, z)
        return OccOutput(said.expand(-1, 12, x, y, z))


def make_toy(name, size, *, grid_shape, voxel_m, backbone, seed):
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        return Toy(height=grid_shape[2])
