"""Joint training on photos and block worlds: is it better than training on few photos alone?

``python -m benchmarks.train_joint``::

    w2m dataset rooms PHOTO --rooms 12 --images 240 --test-share 0.5
    w2m dataset build BLOCKS --houses 40 --images 1000
    python -m benchmarks.train_joint --target PHOTO --others BLOCKS:3 --out RUNS

Three ways, the same steps, the same test scenes of the target: ``alone`` trains on the target,
``joint`` on target and others, ``others`` on the others alone. Each is trained with every seed, and
the weights of its last step are scored. ``no picture`` is the average of the target's training
boxes. The gain of ``joint`` over ``alone`` is assessed by a bootstrap over test scenes and seeds:
a win if its whole 95 % interval is above 0, a loss if below, otherwise undecided.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.train_table import BLIND, average_scenes, done_run, done_scenes, figure_of, markdown
from world2minecraft.api.progress import show_progress
from world2minecraft.core.files import write_text
from world2minecraft.networks.config import PRESETS, DataSource, RunConfig
from world2minecraft.networks.data.training_data import CacheLocation

WAYS = ("alone", "joint", "others")
DRAWS = 2000
Counts = dict[str, np.ndarray]  # By scene.


def middle(values: np.ndarray) -> tuple[float, float]:
    low, high = np.quantile(values, [0.025, 0.975])
    return float(low), float(high)


def drawn_figures(runs: list[Counts], name: str, draws: int = DRAWS, seed: int = 0) -> np.ndarray:
    """Return a figure of redrawn scenes and seeds, float64 [draws]; the same draws for any runs."""
    scenes = sorted(runs[0])
    tables = np.array([[run[scene] for scene in scenes] for run in runs])  # seeds, scenes, 12, 12
    rng = np.random.default_rng(seed)
    found = np.empty(draws)
    for draw in range(draws):
        times = rng.multinomial(len(scenes), np.full(len(scenes), 1 / len(scenes)))
        chosen = rng.integers(0, len(runs), len(runs))
        sums = np.tensordot(tables, times, axes=(1, 0))
        found[draw] = np.mean([figure_of(sums[run], name) for run in chosen])
    return found


def verdict(gain: np.ndarray) -> str:
    """Return win, loss or undecided."""
    low, high = middle(gain)
    return "win" if low > 0 else "loss" if high < 0 else "undecided"


def rows_of(runs: dict[str, list[Counts]], draws: int = DRAWS) -> list[list[str]]:
    """Return a line a way, and the gain."""
    lines, drawn = [], {}
    for way, counts in runs.items():
        cells = [way, str(len(counts)), str(len(counts[0]))]
        for name in ("iou", "miou"):
            drawn[way, name] = drawn_figures(counts, name, draws)
            seeds = [100 * figure_of(sum(one.values()), name) for one in counts]  # type: ignore[arg-type]
            low, high = middle(100 * drawn[way, name])
            cells.append(f"{np.mean(seeds):.2f} ({low:.2f}-{high:.2f})")
            cells.append(", ".join(f"{value:.2f}" for value in seeds))
        lines.append(cells)
    if {"alone", "joint"} <= set(runs):
        gain = ["joint - alone", "", ""]
        for name in ("iou", "miou"):
            apart = 100 * (drawn["joint", name] - drawn["alone", name])
            low, high = middle(apart)
            gain += [f"{np.mean(apart):+.2f} ({low:+.2f} to {high:+.2f})", verdict(apart)]
        lines.append(gain)
    return lines


HEAD = ("way", "seeds", "test scenes", "IoU (95 %)", "IoU by seed", "mIoU (95 %)", "mIoU by seed")


def config_of(words: argparse.Namespace, way: str, seed: int) -> RunConfig:
    target, others = DataSource(words.target), DataSource.parse(words.others)
    data = {"alone": (target,), "joint": (target, others), "others": (others,)}[way]
    config = RunConfig(words.network, data).with_preset(words.preset)
    steps = words.steps or config.steps
    warmup = min(config.warmup_steps, steps // 10)
    size = words.size or config.size
    return replace(
        config, steps=steps, warmup_steps=warmup, size=size, seed=seed, threads=words.threads,
        val_share=config.val_share if words.val_share is None else words.val_share,
    )  # fmt: skip


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--target", required=True)
    parser.add_argument("--others", required=True, help="DIR or DIR:WEIGHT")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--network", default="monoscene")
    parser.add_argument("--ways", nargs="+", default=list(WAYS), choices=WAYS)
    parser.add_argument("--seeds", nargs="+", type=int, default=[0, 1, 2])
    parser.add_argument("--preset", default="1k", choices=PRESETS)
    parser.add_argument("--steps", type=int)
    parser.add_argument("--size")
    parser.add_argument("--val-share", type=float)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--cache", default="")
    parser.add_argument("--markdown", type=Path)
    words = parser.parse_args(arguments)
    cache, runs = CacheLocation.parse(words.cache), {way: [] for way in words.ways}
    with show_progress() as progress:
        blind = [average_scenes(config_of(words, "alone", 0), cache, progress)]
    for seed in words.seeds:  # Seeds first: a stopped table has whole rows of fewer seeds.
        for way in words.ways:
            config, folder = config_of(words, way, seed), words.out / f"{way}-{seed}"
            with show_progress() as progress:
                done_run(config, folder, words.device, cache, progress)
                runs[way].append(
                    done_scenes(config, folder, words.target, words.device, cache, progress)
                )
    lines = rows_of({BLIND: blind, **runs})
    table = Table(*HEAD, box=None)
    for line in lines:
        table.add_row(*line)
    Console(width=180, highlight=False).print(table)
    if words.markdown is not None:
        write_text(words.markdown, markdown(HEAD, lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
