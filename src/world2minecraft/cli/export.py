"""``w2m export``: a trained network as one ONNX file, which runs without torch."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.networks.onnx_export import ExportReport

EXAMPLES = """\
w2m export RUN --out net.onnx                              the best weights of a run
w2m export RUN/last.safetensors --out last.onnx            or others
w2m export RUN --out net.onnx --weights int8               a quarter of the size
w2m reconstruct my_scan --out OUT --predictor mono:net.onnx
"""


def run(
    weights: Annotated[Path, typer.Argument(help="A run's folder, or weights of w2m train.")],
    out: Annotated[Path, typer.Option("--out", help="The ONNX file to write.")],
    name: Annotated[str, typer.Option("--name", help="What reports call it.")] = "",
    stored: Annotated[
        str, typer.Option("--weights", help="How they are stored: float, half or int8.")
    ] = "float",
) -> None:
    """Write a trained occupancy network as ONNX, by the contract of docs/networks-onnx.md.

    The file is asked about one picture beside the network, and written only where both agree.
    Weights stored as half or int8 are made whole again as the file is loaded: the file shrinks,
    nothing gets faster, and what it says moves a little. Score it before you trust it.
    """
    from world2minecraft.cli.train.options import check_extra
    from world2minecraft.reconstruction.occupancy.onnx_network import NetworkFacts, OccupancyNetwork

    check_extra()
    from world2minecraft.networks.callbacks import WEIGHTS
    from world2minecraft.networks.checkpoints import load_weights, read_weights_config
    from world2minecraft.networks.onnx_export import export_network
    from world2minecraft.networks.training import build_network

    path = weights / WEIGHTS if weights.is_dir() else weights
    config = read_weights_config(path)
    network = build_network(config)
    load_weights(path, network)
    facts = NetworkFacts(
        name or f"{config.network}-{config.size}",
        config.cells.shape,
        config.cells.voxel_m,
        config.image,
        wants_depth=config.depth == "given",
    )
    written = export_network(network, out, facts, weights=stored)
    OccupancyNetwork(out)
    for line in summary_lines(out, facts.name, stored, written):
        print(line)


def summary_lines(out: Path, name: str, stored: str, written: "ExportReport") -> list[str]:
    """Return what is printed of a file."""
    lines = [
        f"{out}: {name}, {written.size / 1e6:.1f} MB; "
        f"its logits differ by {written.difference:.1g} at most"
    ]
    if stored != "float":
        lines.append(
            f"weights as {stored} move a logit by {written.moved_mean:.2g} on the mean, "
            f"{written.moved:.2g} at most (all have a spread of {written.spread:.2g}); "
            f"{written.renamed:.1%} of the cells take another class"
        )
        lines.append(f"next: w2m evaluate occupancy {out} DATA      to see what that costs")
    lines.append(f"next: w2m reconstruct CAPTURE --out OUT --predictor mono:{out}")
    return lines
