"""``w2m export``: a trained network as one ONNX file, which runs without torch."""

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
        Path, typer.Argument(metavar="RUN", help="A run's folder, or weights of w2m train.")
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="The ONNX file to write.")],
    name: Annotated[
        str,
        typer.Option(
            "--name", help="The network's name in reports.", show_default="network and size"
        ),
    ] = "",
    stored: Annotated[
        str, typer.Option("--weights", help="How weights are stored: float, half or int8.")
    ] = "float",
) -> None:
    """Write a trained occupancy network as ONNX, as docs/networks-onnx.md describes.

    The file and the network are compared on one image, and the file is written only if they agree.
    Weights stored as half or int8 are expanded as the file is loaded: the file is smaller, nothing
    is faster, and predictions change a little. Score the file before you use it.
    """
    from world2minecraft.api import export_network

    written = export_network(weights, out, name=name, weights=stored)
    for line in summary_lines(written):
        print(line)


def summary_lines(written: "ExportedNetwork") -> list[str]:
    """Return what is printed of a file."""
    out = written.path
    lines = [
        f"{out}: {written.name}, {written.bytes / 1e6:.1f} MB; "
        f"its logits differ by {written.difference:.1g} at most"
    ]
    if written.weights != "float":
        lines.append(
            f"weights as {written.weights} move a logit by {written.moved_mean:.2g} on average, "
            f"{written.moved:.2g} at most (all have a spread of {written.spread:.2g}); "
            f"{written.relabelled:.1%} of the cells get another class"
        )
        lines.append(f"next: w2m evaluate occupancy {out} DATA      to see what that costs")
    lines.append(f"next: w2m reconstruct CAPTURE --out OUT --predictor mono:{out}")
    return lines
