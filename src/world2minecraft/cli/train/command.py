"""Train an occupancy network on data sets: ``w2m train``."""

from pathlib import Path
from typing import TYPE_CHECKING

from world2minecraft.cli.train import options

if TYPE_CHECKING:
    from world2minecraft.api.networks import TrainedNetwork

EXAMPLES = """\
w2m dataset build DATA --houses 40 --images 1000               build a data set to train on
w2m train monoscene --data DATA --out RUN                      2,000 steps at 0.16 m
w2m train monoscene --data DATA --out TRY --preset smoke       a test of some seconds
w2m train iso --data PHOTO --data BLOCKS:3 --out JOINT         two data sets; the first is scored
w2m train symphonies --data NYU --preset 8k --out FULL         the papers' grid and size, for a GPU
w2m train --config RUN/run.yaml --out AGAIN                    repeat a run
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
    """Train an occupancy network, keep the best weights and score them.

    Repeat the command to resume an interrupted run. RUN/run.yaml contains all settings. To change
    settings without an option, edit the file and train with --config.
    """
    from world2minecraft.api import train_network
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.arguments import size_of

    image_px = size_of(image, "--image")
    with show_progress() as progress:
        trained = train_network(
            network, data or [], out, config=config, preset=preset, size=size, backbone=backbone,
            grid=grid, image=image_px, depth=depth, steps=steps, batch=batch, learning_rate=lr,
            precision=precision, val_share=val_share, patience=patience, seed=seed,
            threads=threads, workers=workers, device=device, cache=cache, progress=progress,
        )  # fmt: skip
    for line in trained.data:
        print(line)
    print_summary(trained)


def print_summary(trained: "TrainedNetwork") -> None:
    """Print the scores of a training run and the next steps."""
    from world2minecraft.api.progress import format_duration

    out, scores = trained.folder, trained.scores
    micro = scores["protocols"]["monoscene"]["micro"]
    stopped = ", stopped early" if trained.stopped_early else ""
    seconds = format_duration(trained.seconds)
    print(f"{trained.steps:,} steps in {seconds}{stopped}; best at {trained.best_step:,}")
    print(
        f"IoU {100 * micro['iou']:.2f}, mIoU {100 * micro['miou']:.2f} (protocol monoscene) on the "
        f"{scores['split']} frames ({out / 'scores.json'} contains all protocols)"
    )
    data = trained.config.data[0].path
    print(f"next: w2m evaluate occupancy {out} {data}    score with all protocols")
    print(f"then: w2m export {out} --out net.onnx    export it to run without torch")
