"""One small run for tests of photos, comparing and exports: a generated study, twelve frames."""

from pathlib import Path

from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct

FRAMES = 12


def make_small_run(out: Path) -> Path:
    """Scan a room into ``out / "capture"`` and reconstruct it; the truth lies beside the scan."""
    room = generate_room(3, kind="study")
    scan_room(room, out / "capture", frames=FRAMES, width=200, height=150)
    reconstruct(out / "capture", out, Parameters(blocks_per_metre=2))
    return out
