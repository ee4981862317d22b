"""``w2m export``: a trained network as one ONNX file, which runs without torch."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m export RUN --out net.onnx                              the best weights of a run
w2m export RUN/last.safetensors --out last.onnx            or others
w2m reconstruct my_scan --out OUT --predictor mono:net.onnx
"""


def run(
    weights: Annotated[Path, typer.Argument(help="A run's folder, or weights of w2m train.")],
    out: Annotated[Path, typer.Option("--out", help="The ONNX file to write.")],
    name: Annotated[str, typer.Option("--name", help="What reports call it.")] = "",
) -> None:
    """Write a trained occupancy network as ONNX, by the contract of docs/networks-onnx.md.

    The file is asked about one picture beside the network, and written only where both agree.
    """
    from world2minecraft.cli.train_options import check_extra
    from world2minecraft.files import read_bytes
    from world2minecraft.occupy.network_file import MAX_BYTES, NetworkFacts, OccupancyNetwork

    check_extra()
    from world2minecraft.learn.checkpoints import load_weights, weights_config
    from world2minecraft.learn.export import export_network
    from world2minecraft.learn.keeping import WEIGHTS
    from world2minecraft.learn.training import network_of

    path = weights / WEIGHTS if weights.is_dir() else weights
    config = weights_config(path)
    network = network_of(config)
    load_weights(path, network)
    facts = NetworkFacts(
        name or f"{config.network}-{config.size}",
        config.cells.shape,
        config.cells.voxel_m,
        config.image,
        wants_depth=config.depth == "given",
    )
    difference = export_network(network, out, facts)
    OccupancyNetwork(out)
    size_mb = len(read_bytes(out, MAX_BYTES)) / 1e6
    print(f"{out}: {facts.name}, {size_mb:.1f} MB; its logits differ by {difference:.1g} at most")
    print(f"next: w2m reconstruct CAPTURE --out OUT --predictor mono:{out}")
