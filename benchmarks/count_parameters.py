"""Parameters of the networks of size ``full``, part by part, beside the published ones.

``python -m benchmarks.count_parameters [--size full]``

Networks are made on torch's meta device, so that no weight takes memory. The grid is that of the
papers, 60x60x36 cells of 0.08 m. Published figures: MonoScene and NDC-Scene were counted in their
code, ISO is MonoScene and about 3 M, Symphonies is what its paper states.

``idle`` are kernels that the published code of MonoScene owns and never uses: the shortcuts of
blocks that halve nothing. With them the 3D part is the published one.
"""

import argparse

import torch
from rich.console import Console
from rich.table import Table
from torch import nn

from world2minecraft.learn.networks import NETWORKS, SIZES, make_network
from world2minecraft.learn.networks.parts.ddr import AxisBlock

GRID, VOXEL_M = (60, 60, 36), 0.08
# Millions: network, part, published.
PUBLISHED = {
    ("monoscene", "all"): 298.35,
    ("monoscene", "picture"): 133.0,
    ("monoscene", "picture.encoder"): 63.8,
    ("monoscene", "picture.decoder"): 69.2,
    ("monoscene", "cells and idle"): 165.3,
    ("monoscene", "cells.context and idle"): 145.4,
    ("ndc_scene", "all"): 271.15,
    ("ndc_scene", "picture and volume"): 137.7,
    ("ndc_scene", "cells and idle"): 133.5,
    ("iso", "all"): 301.0,
    ("iso", "depth"): 3.0,
    ("symphonies", "all"): 59.0,
}


def count(part: nn.Module) -> int:
    """Return how many numbers are learned."""
    return sum(weights.numel() for weights in part.parameters())


def idle(part: nn.Module) -> int:
    """Return what the published blocks own besides: three kernels of a cell and their norms."""
    blocks = [one for one in part.modules() if isinstance(one, AxisBlock) and not one.halve]
    inner = [block.reduce[0].out_channels for block in blocks]
    return sum(3 * (channels**2 + 2 * channels) for channels in inner)


def rows(name: str, size: str) -> list[tuple[str, int]]:
    """Return the parts of a network and how many parameters each has."""
    with torch.device("meta"):
        network = make_network(name, size, grid_shape=GRID, voxel_m=VOXEL_M)
    found = [("all", count(network))]
    for path, part in network.named_children():
        found.append((path, count(part)))
        if path in ("picture", "cells"):
            found += [
                (f"{path}.{inner}", count(one))
                for inner, one in part.named_children()
                if inner in ("encoder", "decoder", "context")
            ]
        if path == "cells":
            found.append(("cells and idle", count(part) + idle(part)))
            found.append(("cells.context and idle", count(part.context) + idle(part.context)))
    held = dict(found)
    if "volume" in held:
        both = held["picture"] + held["volume"] + held["to_cells"]
        found.append(("picture and volume", both))
    found = [row for row in found if "idle" not in row[0] or (name, row[0]) in PUBLISHED]
    direct = sum(weights.numel() for weights in network.parameters(recurse=False))
    return [*found, ("learned starts and places", direct)] if direct else found


def main() -> None:
    """Print one table of all networks."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", choices=SIZES, default="full")
    chosen = parser.parse_args()
    table = Table("network", "part", "ours M", "published M")
    for name in NETWORKS.names():
        for part, number in rows(name, chosen.size):
            told = PUBLISHED.get((name, part)) if chosen.size == "full" else None
            table.add_row(name, part, f"{number / 1e6:.2f}", "" if told is None else f"{told:g}")
        table.add_section()
    Console().print(table)


if __name__ == "__main__":
    main()
