"""All occupancy networks on one set: ``python -m benchmarks.train_table --set DATA --out RUNS``.

DATA is any set with a test split, as ``w2m dataset build DATA --houses 40 --images 1000`` makes
one: no test scene is trained on. Each network is trained for the same steps by ``w2m train``; its
last weights are scored by ``monoscene`` on all test frames. A table that was stopped goes on with
the same command; each run stays in RUNS/NET. ``--markdown FILE`` writes the tables for the docs:
scores with the paper's rows beside them, classes, and mIoU of the scenes held out of training as
it went on. ``--preset 8k`` is the papers' grid and size, for a GPU. ``NET+depth`` is shown measured
depth, as Symphonies was published; the others do without. ``no picture`` is the average of all
training boxes (``box_average``): a network that is no better has not learned to look.
"""

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from tests.metrics.paper_occupancy import MINECRAFTOCC, row

from benchmarks.box_average import averaged
from benchmarks.train_runs import done_run
from world2minecraft.classes import CLASS_NAMES
from world2minecraft.cli.progress import shown
from world2minecraft.files import write_text
from world2minecraft.learn.config import PRESETS, DataSource, RunConfig
from world2minecraft.learn.data.opening import CachePlace
from world2minecraft.learn.journal import METRICS, read_rows
from world2minecraft.learn.networks import NETWORKS
from world2minecraft.learn.scoring import protocol_scores, said_by_network

PAPER_ROWS = {
    "monoscene": "monoscene",
    "ndc_scene": "ndc",
    "iso": "iso",
    "symphonies": "symphonies",
}
BLIND = "no picture"
GIVEN = "+depth"  # Ends the name of a network that is shown measured depth,
ALSO = ("symphonies+depth",)  # as this one was published.
HEAD = (
    "network",
    "million weights",
    "steps",
    "core hours",
    "hardware",
    "IoU",
    "mIoU",
    "precision",
    "recall",
    "visible IoU",
    "visible mIoU",
)


def chosen(words: argparse.Namespace, network: str) -> RunConfig:
    """Return the run of a network."""
    config = RunConfig(network.removesuffix(GIVEN), (DataSource(words.set),))
    config = config.with_preset(words.preset)
    changes: dict[str, Any] = {"seed": words.seed, "threads": words.threads}
    if words.steps:
        changes["steps"] = words.steps
        changes["warmup_steps"] = min(config.warmup_steps, words.steps // 10)
    for name in ("size", "batch", "validate_every", "val_share"):
        if getattr(words, name) is not None:
            changes[name] = getattr(words, name)
    if network.endswith(GIVEN):
        changes["depth"] = "given"
    return replace(config, **changes)


def cells_of(network: str, done: dict[str, Any]) -> list[str]:
    """Return the cells of a row."""
    facts, found = done["facts"], done["scores"]["protocols"]["monoscene"]
    micro, spread = found["micro"], found["interval"]
    figures = [f"{100 * micro['iou']:.2f}", f"{100 * micro['miou']:.2f}"]
    if spread is not None:
        figures = [
            f"{text} ({100 * spread[name][0]:.1f}-{100 * spread[name][1]:.1f})"
            for text, name in zip(figures, ("iou", "miou"), strict=True)
        ]
    figures += [f"{100 * micro['precision']:.2f}", f"{100 * micro['recall']:.2f}"]
    seen = done["scores"]["protocols"].get("visible")
    figures += [f"{100 * seen['micro'][name]:.2f}" if seen else "-" for name in ("iou", "miou")]
    if facts is None:
        return [network, *["-"] * (len(HEAD) - 1 - len(figures)), *figures]
    return [
        network, f"{facts['parameters'] / 1e6:.2f}", f"{facts['steps']:,}",
        f"{facts['cpu_seconds'] / 3600:.2f}", f"{facts['hardware']}, {facts['precision']}",
        *figures,
    ]  # fmt: skip


def blind_row(config: RunConfig, cache: CachePlace) -> dict[str, Any]:
    """Return the scores of the average of all training boxes."""
    with shown() as progress:
        said, frames, rows = averaged(config, cache, progress)
        scored = said_by_network(frames, rows, iter([said] * len(rows)))
        return {"facts": None, "scores": protocol_scores(scored, config.cells.voxel_m)}


def paper_rows(network: str) -> list[list[str]]:
    """Return the paper's row of a network at 8k, or none where it has none."""
    plain = network.removesuffix(GIVEN)
    if plain not in PAPER_ROWS:
        return []
    iou, miou, precision, recall, *_ = row(MINECRAFTOCC[f"8k {PAPER_ROWS[plain]}"])
    figures = (f"{value:.2f}" for value in (iou, miou, precision, recall))
    return [[f"paper, 8k: {plain}", *["-"] * 4, *figures, "-", "-"]]


def class_cells(network: str, done: dict[str, Any]) -> list[str]:
    """Return the IoU of each class."""
    values = done["scores"]["protocols"]["monoscene"]["micro"]["class_iou"]
    return [network, *(f"{100 * values[name]:.2f}" for name in CLASS_NAMES)]


def learning_rows(folders: dict[str, Path]) -> tuple[tuple[str, ...], list[list[str]]]:
    """Return head and rows of mIoU on the scenes held out of training, by step."""
    found = {
        name: {step: value for step, what, value in read_rows(folder / METRICS)
               if what == "val_miou"}
        for name, folder in folders.items()
    }  # fmt: skip
    steps = sorted({step for values in found.values() for step in values})
    rows = [
        [name, *(f"{100 * values[step]:.2f}" if step in values else "-" for step in steps)]
        for name, values in found.items()
    ]
    return ("held-out mIoU at step", *(f"{step:,}" for step in steps)), rows


def markdown(head: tuple[str, ...], rows: list[list[str]]) -> str:
    """Return a table as Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def report(rows: dict[str, dict[str, Any]]) -> tuple[list[list[str]], list[list[str]]]:
    """Return the two tables' rows: figures with the paper's beside, and classes."""
    figures = [
        line for name, done in rows.items() for line in (cells_of(name, done), *paper_rows(name))
    ]
    return figures, [class_cells(name, done) for name, done in rows.items()]


def options() -> argparse.ArgumentParser:
    """Return the command's options."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--set", required=True, help="the data set")
    parser.add_argument("--out", type=Path, required=True, help="the folder of all runs")
    parser.add_argument("--networks", nargs="+", help="all by default; NET+depth is shown depth")
    parser.add_argument("--preset", default="1k", choices=PRESETS)
    parser.add_argument("--steps", type=int, help="instead of the preset's")
    parser.add_argument("--size", help="instead of the preset's")
    parser.add_argument("--batch", type=int)
    parser.add_argument("--validate-every", type=int)
    parser.add_argument("--val-share", type=float)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--cache", default="", help="where decoded frames are kept")
    parser.add_argument("--markdown", type=Path)
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Train, score and print; 0 when every network has its row."""
    words = options().parse_args(arguments)
    names = words.networks or [*NETWORKS.names(), *ALSO]
    cache = CachePlace.named(words.cache)
    rows = {BLIND: blind_row(chosen(words, names[0]), cache)}
    for name in names:
        with shown() as progress:
            rows[name] = done_run(
                chosen(words, name), words.out / name, words.device, cache, progress
            )
        figures, classes = report(rows)  # After each, so that a stopped table says something.
        tables = [
            (HEAD, figures),
            (("class IoU", *CLASS_NAMES), classes),
            learning_rows({done: words.out / done for done in rows if done != BLIND}),
        ]
        if words.markdown is not None:
            write_text(words.markdown, "\n".join(markdown(*table) for table in tables))
    console = Console(width=200, highlight=False)
    for head, lines in tables:
        table = Table(*head, box=None)
        for line in lines:
            table.add_row(*line)
        console.print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
