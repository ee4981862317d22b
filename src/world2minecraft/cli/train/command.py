"""``w2m train``: an occupancy network from data sets to weights and scores."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.cli.train import options

if TYPE_CHECKING:
    from world2minecraft.networks.config import RunConfig

EXAMPLES = """\
w2m dataset build DATA --houses 40 --images 1000               something to train on
w2m train monoscene --data DATA --out RUN                      2,000 steps at 0.16 m
w2m train monoscene --data DATA --out TRY --preset smoke       does it run? some seconds
w2m train iso --data PHOTO --data BLOCKS:3 --out JOINT         two sets; the first is the target
w2m train symphonies --data NYU --preset 8k --out FULL         the papers' grid and size, for a GPU
w2m train --config RUN/run.yaml --out AGAIN                    the same run again
"""


def run(
    network: options.Network = "",
    data: options.Data = None,
    out: options.Out = Path("RUN"),
    config: options.Config = None,
    preset: options.Preset = "",
    size: options.Size = None,
    backbone: options.Backbone = None,
    grid: options.GridName = None,
    image: options.Image = "",
    depth: options.Depth = None,
    steps: options.Steps = None,
    batch: options.Batch = None,
    lr: options.Rate = None,
    precision: options.Precision = None,
    val_share: options.ValShare = None,
    patience: options.Patience = None,
    seed: options.Seed = None,
    threads: options.Threads = None,
    workers: options.Workers = None,
    device: options.Device = "auto",
    cache: options.Cache = "",
) -> None:
    """Train an occupancy network, keep its best weights and score them.

    A run that was stopped goes on with the same command. RUN/run.yaml holds every setting; others
    than the options here are set there, and trained with --config.
    """
    from world2minecraft.api.progress import show_progress

    given = {
        "size": size, "backbone": backbone, "grid": grid, "depth": depth, "steps": steps,
        "batch": batch, "learning_rate": lr, "precision": precision, "val_share": val_share,
        "patience": patience, "seed": seed, "threads": threads, "workers": workers,
    }  # fmt: skip
    changes = {name: value for name, value in given.items() if value is not None}
    if image:
        changes["image"] = options.image_size(image)
    chosen = options.run_config(network, data or [], config, preset, changes)
    options.check_extra()
    from world2minecraft.networks.data.training_data import CacheLocation
    from world2minecraft.networks.training import score_run, train_run

    with show_progress() as progress:
        trained = train_run(
            chosen, out, device=device, cache=CacheLocation.parse(cache), progress=progress
        )
        scores = score_run(trained, chosen, device, progress)
    for line in trained.data.descriptions:
        print(line)
    print_summary(out, chosen, trained.state, scores)


def print_summary(out: Path, config: "RunConfig", state: Any, scores: dict[str, Any]) -> None:
    """Say what came of a run and what to do next."""
    from world2minecraft.api.progress import format_duration

    micro = scores["protocols"]["monoscene"]["micro"]
    stopped = ", stopped early" if state.stopped else ""
    seconds = format_duration(state.seconds)
    print(f"{state.step:,} steps in {seconds}{stopped}; best at {state.best_step:,}")
    print(
        f"IoU {100 * micro['iou']:.2f}, mIoU {100 * micro['miou']:.2f} by monoscene on the "
        f"{scores['split']} frames ({out / 'scores.json'} has all protocols)"
    )
    data = config.data[0].path
    print(f"next: w2m evaluate occupancy {out} {data}    every protocol, class and interval")
    print(f"then: w2m export {out} --out net.onnx    to run it without torch")
