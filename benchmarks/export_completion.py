"""Write the completion network of a run as ONNX.

``python -m benchmarks.export_completion --run FOLDER --out completion.onnx``
"""

import argparse
from pathlib import Path

from safetensors.torch import load_file

from world2minecraft.learn.completion.export import export_completion
from world2minecraft.learn.completion.network import CompletionNet


def main() -> None:
    """Write the file and say how far it is from torch."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--run", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    chosen = parser.parse_args()
    network = CompletionNet()
    network.load_state_dict(load_file(str(chosen.run / "mean.safetensors")))
    steps = (chosen.run / "step.txt").read_text().strip()
    about = {"steps": steps, "run": (chosen.run / "run.txt").read_text().strip()}
    off = export_completion(network, chosen.out, about)
    print(f"{chosen.out}: {chosen.out.stat().st_size / 1e6:.2f} MB after {steps} steps; {off:.1e}")


if __name__ == "__main__":
    main()
