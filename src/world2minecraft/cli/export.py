"""Export a trained network to an ONNX file, which runs without torch: ``w2m export``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.networks import ExportedNetwork

EXAMPLES = """\
w2m export RUN --out net.onnx                              the best weights of a run
w2m export RUN/last.safetensors --out last.onnx            the last weights
w2m export RUN --out net.onnx --weights int8               a quarter of the size
w2m reconstruct my_scan --out OUT --predictor mono:net.onnx
"""


def run(
    weights: Annotated[
        Path, typer.Argument(metavar="RUN", help="Run folder, or weights from w2m train.")
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="ONNX file to write.")],
    name: Annotated[
        str,
        typer.Option(
            "--name", help="Name of the network in reports.", show_default="network and size"
        ),
    ] = "",
    stored: Annotated[
        str, typer.Option("--weights", help="Storage type of the weights: float, half or int8.")
    ] = "float",
) -> None:
    """Export a trained network to ONNX. docs/reference/onnx-networks.md describes the file.

    The outputs of the file and the network are compared on one image, and the file is kept only if
    they agree. Weights stored as half or int8 are expanded when the file is loaded, so the file is
    smaller but not faster, and predictions change slightly. Score the file before you use it.
    """
    from world2minecraft.api import export_network

    written = export_network(weights, out, name=name, weights=stored)
    for line in summary_lines(written):
        print(line)


def summary_lines(written: "ExportedNetwork") -> list[str]:
    """Return the lines to print about an exported network."""
    out = written.path
    lines = [
        f"{out}: {written.name}, {written.bytes / 1e6:.1f} MB; "
        f"maximum logit difference {written.difference:.1g}"
    ]
    if written.weights != "float":
        lines.append(
            f"{written.weights} weights change a logit by {written.moved_mean:.2g} on average and "
            f"{written.moved:.2g} at most (standard deviation of all logits: {written.spread:.2g});"
            f" {written.relabelled:.1%} of the cells change class"
        )
        lines.append(f"next: w2m evaluate occupancy {out} DATA      to measure the loss")
    lines.append(f"next: w2m reconstruct CAPTURE --out OUT --predictor mono:{out}")
    return lines
