"""One room at three scales and in three styles on a page: is it the same room in all nine?

``python -m benchmarks.check_styles OUT --out styles.png [--scales 1 2 4] [--set build.KEY=VALUE]``

OUT is a run's folder. A row for each scale, a column for each style; under each picture its blocks,
its entities and the processor's seconds that it took. States that a block update would change are
counted too: there should be none.
"""

import argparse
import time
from pathlib import Path

import numpy as np
from PIL import Image
from rich.console import Console

from benchmarks.compare_builds import captioned, in_rows
from world2minecraft.build.parameters import STYLES
from world2minecraft.files import write_bytes
from world2minecraft.minecraft.rules.stability import unstable
from world2minecraft.parameters import Parameters, with_settings
from world2minecraft.rebuild import blocks_of
from world2minecraft.render.preview import preview
from world2minecraft.report.pictures import as_png
from world2minecraft.types import BlockVolume

SCALES = (1.0, 2.0, 4.0)


def built(run: Path, scale: float, style: str, settings: list[str]) -> tuple[BlockVolume, float]:
    """Return a run at a scale in a style, and the seconds of processor time that it took."""
    chosen = Parameters(blocks_per_metre=scale)
    chosen = with_settings(chosen, [f"build.style={style}", *settings])
    began = time.process_time()
    volume = blocks_of(run, chosen)
    return volume, time.process_time() - began


def caption(volume: BlockVolume, scale: float, style: str, seconds: float) -> str:
    """Return the figures of a build in a line."""
    blocks, kinds = int((volume.semantic > 0).sum()), len(volume.palette)
    text = f"{style}, {scale:g} a metre: {blocks:,} blocks, {kinds} states, "
    if volume.entities:
        text += f"{len(volume.entities)} entities, "
    return text + f"{len(unstable(volume))} unstable, {seconds:.1f} s"


def page_of(run: Path, scales: list[float], size: tuple[int, int], settings: list[str]):
    """Return the page, uint8 [H, W, 3]."""
    rows: list[list[Image.Image]] = []
    for scale in scales:
        row = []
        for style in STYLES:
            volume, seconds = built(run, scale, style, settings)
            text = caption(volume, scale, style, seconds)
            Console().print(text)
            row.append(captioned(preview(volume, *size), text))
        rows.append(row)
    return np.asarray(in_rows(rows))


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("run", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--scales", type=float, nargs="+", default=list(SCALES))
    parser.add_argument("--size", type=int, nargs=2, default=(720, 540))
    parser.add_argument("--set", dest="settings", action="append", default=[])
    chosen = parser.parse_args()
    page = page_of(chosen.run, chosen.scales, tuple(chosen.size), chosen.settings)
    write_bytes(chosen.out, as_png(page))
    Console().print(f"{chosen.out}: {page.shape[1]} x {page.shape[0]} pixels")


if __name__ == "__main__":
    main()
