"""Training of a network, from its data sets to its scores. The same call resumes a stopped run.

The folder of a run contains::

    run.yaml                 all settings; w2m train --config repeats the training
    weights.safetensors      best weights by mIoU on the validation frames
    last.safetensors         weights of the last step
    checkpoint.safetensors   state for resuming a stopped run
    metrics.csv              step, name, value; also written to tensorboard/
    scores.json              scores of the best weights on the test split, for all protocols
    scores_last.json         scores of the last weights, if requested
    run.json                 times, machine and versions, which differ between runs
"""

import logging
import os
import platform
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import lightning
import torch
from torch import nn

from world2minecraft import __version__
from world2minecraft.core.errors import ConflictError, DamagedFileError, UsageError
from world2minecraft.core.files import write_json
from world2minecraft.core.locks import LOCK_FILE, Lock, acquire_or_wait
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.minecraftocc.importers import open_occupancy
from world2minecraft.networks.callbacks import CHECKPOINT, LAST, WEIGHTS, RunState, TrainingCallback
from world2minecraft.networks.checkpoints import (
    load_checkpoint,
    load_weights,
    read_facts,
    read_weights_config,
    write_weights,
)
from world2minecraft.networks.config import DEFAULT_FRAMES, RunConfig, read_config, write_config
from world2minecraft.networks.data.batches import plan_draws, training_loader
from world2minecraft.networks.data.class_weights import class_weights
from world2minecraft.networks.data.splits import take_evenly
from world2minecraft.networks.data.training_data import CacheLocation, RunData, open_run_data
from world2minecraft.networks.lightning_module import OccupancyModule
from world2minecraft.networks.memory_scoring import add_memory_scores
from world2minecraft.networks.models import make_network
from world2minecraft.networks.scoring import network_predictions, protocol_scores
from world2minecraft.networks.validation import (
    predict_labels,
    resolve_device,
    resolve_precision,
    validate,
)

RUN, FACTS, SCORES = "run.yaml", "run.json", "scores.json"
LAST_SCORES = "scores_last.json"  # Of the weights of the last step, if requested.
LIGHTNING_PRECISION = {"bf16": "bf16-mixed", "32": "32-true"}
# Settings that may change when a run is resumed, because they do not affect the results.
FREE_SETTINGS = ("threads", "workers", "checkpoint_every")


class TrainedRun(NamedTuple):
    """The result of a training run.

    Attributes:
        folder: Folder of the run.
        state: Final state of the run.
        data: Data sets of the run.
    """

    folder: Path
    state: RunState
    data: RunData


def build_network(config: RunConfig) -> nn.Module:
    """Create the network for a run with its initial weights.

    Raises the same exceptions as ``make_network``.
    """
    return make_network(
        config.network,
        config.size,
        grid_shape=config.cells.shape,
        voxel_m=config.cells.voxel_m,
        backbone=config.backbone or None,
        seed=config.seed,
    )


def train_run(
    config: RunConfig,
    folder: Path,
    *,
    device: str = "auto",
    cache: CacheLocation | None = None,
    progress: Progress = no_progress,
) -> TrainedRun:
    """Train a network, or resume a run with the same settings in the same folder.

    Args:
        config: Settings of the run.
        folder: Folder of the run.
        device: ``auto``, ``cpu`` or ``cuda``.
        cache: Cache for decoded frames.
        progress: Callback that reports progress on the stages ``frames`` and ``train``.

    Raises:
        ConflictError: If the folder contains a run with other settings, or if another process is
            training there.
        InputError: If a data set cannot be used.
        UsageError: If the settings are not valid, or if the loss is not finite.
    """
    if config.frames > 1 and config.network not in DEFAULT_FRAMES:
        raise UsageError(
            f"{config.network} processes single frames; frames above 1 is only for embodied"
        )
    check_folder(config, folder)
    folder.mkdir(parents=True, exist_ok=True)
    lock = Lock(folder / LOCK_FILE, "trained")
    acquire_or_wait(lock)
    try:
        if config.threads:
            torch.set_num_threads(config.threads)
        data = open_run_data(config, cache, progress)
        write_config(folder / RUN, config)  # Only after the data sets could be opened.
        state = _fit(config, folder, data, resolve_device(device), progress)
        return TrainedRun(folder, state, data)
    finally:
        lock.remove()
        with suppress(OSError):
            folder.rmdir()  # Only if it is empty.


def check_folder(config: RunConfig, folder: Path) -> None:
    """Check that a folder does not contain a run with other settings.

    Raises:
        ConflictError: If it does.
    """
    if not (folder / RUN).is_file():
        return
    existing = read_config(folder / RUN)
    same = replace(existing, **{name: getattr(config, name) for name in FREE_SETTINGS})
    if same == config:
        return
    names = [name for name in vars(config) if getattr(same, name) != getattr(config, name)]
    texts = [
        [_describe_setting(getattr(one, name)) for one in (existing, config)] for name in names
    ]
    differences = ", ".join(
        f"{name} is {held}, requested {wanted}"
        for name, (held, wanted) in zip(names, texts, strict=True)
    )
    raise ConflictError(
        folder, f"contains a run with other settings ({differences}); choose another output folder"
    )


def _describe_setting(value: Any) -> str:
    if isinstance(value, tuple):
        return " ".join(str(getattr(one, "path", one)) for one in value)
    return str(value)


def _fit(
    config: RunConfig, folder: Path, data: RunData, device: torch.device, progress: Progress
) -> RunState:
    state = _read_state(folder / CHECKPOINT)
    if state.step >= config.steps or state.stopped:
        if not (folder / LAST).is_file() or not (folder / FACTS).is_file():
            _finish_again(config, folder, device, state)
        return state
    network = build_network(config)
    weights = torch.from_numpy(class_weights(data.counts, config.class_weights))
    module = OccupancyModule(network, config, weights)
    module.first_step = state.step
    rows = take_evenly(data.split.val, config.validate_frames)
    callback = TrainingCallback(
        folder, config, state, lambda: validate(network, data.target, rows, config), progress
    )
    sizes = [len(part.rows) for part in data.parts]
    draws = plan_draws(sizes, data.weights, config.steps * config.batch, config.seed)
    batches = training_loader(data.parts, draws, config, state.step)
    began = time.monotonic()
    with _quiet():
        trainer = lightning.Trainer(
            accelerator=device.type if device.type == "cpu" else "gpu",
            devices=1,
            precision=LIGHTNING_PRECISION[resolve_precision(config.precision, device)],  # type: ignore[arg-type]
            max_epochs=1,
            gradient_clip_val=config.clip_norm or None,
            callbacks=[callback, _CheckpointLoader(folder)],
            logger=False,
            enable_checkpointing=False,
            enable_progress_bar=False,
            enable_model_summary=False,
            num_sanity_val_steps=0,
            default_root_dir=folder,
        )
        trainer.fit(module, batches)
    if trainer.interrupted:  # Lightning treats Ctrl-C as the end of a run.
        raise KeyboardInterrupt
    callback.finish(module)
    _write_facts(folder, config, network, device, callback.state, time.monotonic() - began)
    return callback.state


def _read_state(checkpoint: Path) -> RunState:
    """Read the state of a run, or return the initial state without a checkpoint."""
    if not checkpoint.is_file():
        return RunState()
    facts = read_facts(checkpoint)
    if facts.keys() != vars(RunState()).keys():
        raise DamagedFileError(
            checkpoint, "written by another version of w2m train; choose another output folder"
        )
    return RunState(**facts)


def _finish_again(config: RunConfig, folder: Path, device: torch.device, state: RunState) -> None:
    """Write the final files of a run that was interrupted after its last checkpoint."""
    network = build_network(config)
    load_checkpoint(folder / CHECKPOINT, network)
    write_weights(folder / LAST, network, config)
    _write_facts(folder, config, network, device, state, 0.0)


class _CheckpointLoader(lightning.Callback):
    """A callback that loads a checkpoint once the network and the optimizer are on their device."""

    def __init__(self, folder: Path):
        self._path = folder / CHECKPOINT

    def on_train_start(self, trainer: Any, pl_module: Any) -> None:
        if self._path.is_file():
            load_checkpoint(self._path, pl_module.network, trainer.optimizers[0])


def score_run(
    trained: TrainedRun,
    config: RunConfig,
    device: str = "auto",
    progress: Progress = no_progress,
    *,
    last: bool = False,
) -> dict[str, Any]:
    """Evaluate the weights of a run on its test split with all protocols.

    The scores of the best weights are written to scores.json, and those of the last step to
    scores_last.json. Without a test split, the validation frames are used, which gives scores that
    are too high; ``split`` in the result states which frames were used.

    Args:
        trained: Result of the training.
        config: Settings of the run.
        device: ``auto``, ``cpu`` or ``cuda``.
        progress: Callback that reports progress on the stage ``score``.
        last: Whether to evaluate the weights of the last step instead of the best ones.
    """
    data, folder = trained.data, trained.folder
    network = load_trained_network(folder, config, device, last=last)
    rows = data.split.scored
    predicted = predict_labels(network, data.target, rows, config, progress=progress)
    frames = network_predictions(data.target, rows, predicted)
    scores = protocol_scores(frames, config.cells.voxel_m)
    found = open_occupancy(config.data[0].path)
    add_memory_scores(scores, network, found, data.target, rows, config, progress=progress)
    scores |= {
        "data": config.data[0].path,
        "split": "test" if data.split.test else "validation",
        "grid": config.grid,
        "step": trained.state.step if last else trained.state.best_step,
    }
    write_json(folder / (LAST_SCORES if last else SCORES), scores)
    return scores


def load_trained_network(
    folder: Path, config: RunConfig, device: str = "auto", *, last: bool = False
) -> nn.Module:
    """Load the network of a run with its best or its last weights.

    Raises:
        InputError: If the weights do not exist.
    """
    network = build_network(config)
    load_weights(folder / (LAST if last else WEIGHTS), network)
    return network.to(resolve_device(device)).eval()


def load_weights_file(path: Path) -> tuple[nn.Module, RunConfig]:
    """Load the network and the settings from a run folder or a file of weights.

    Raises:
        InputError: If there are no weights.
        DamagedFileError: If the weights are not valid.
    """
    file = path / WEIGHTS if path.is_dir() else path
    config = read_weights_config(file)
    network = build_network(config)
    load_weights(file, network)
    return network, config


def _write_facts(
    folder: Path,
    config: RunConfig,
    network: nn.Module,
    device: torch.device,
    state: RunState,
    seconds: float,
) -> None:
    facts = {
        "seconds": state.seconds,
        "cpu_seconds": state.cpu_seconds,
        "seconds_of_last_try": seconds,
        "steps": state.step,
        "best_step": state.best_step,
        "best_val_miou": state.best_miou,
        "stopped_early": state.stopped,
        "parameters": sum(one.numel() for one in network.parameters()),
        "device": device.type,
        "hardware": describe_hardware(device),
        "threads": torch.get_num_threads(),
        "precision": resolve_precision(config.precision, device),
        "versions": {
            "world2minecraft": __version__,
            "torch": torch.__version__,
            "lightning": lightning.__version__,
            "python": platform.python_version(),
        },
    }
    if device.type == "cuda":
        facts["peak_gpu_bytes"] = torch.cuda.max_memory_allocated()
    write_json(folder / FACTS, facts)


def describe_hardware(device: torch.device) -> str:
    """Return a description of a device for the user."""
    if device.type == "cuda":
        return torch.cuda.get_device_name()
    named = platform.processor() or platform.machine()
    listed = Path("/proc/cpuinfo")
    if listed.is_file():
        lines = [one for one in listed.read_text().splitlines() if one.startswith("model name")]
        named = lines[0].partition(":")[2].strip() if lines else named
    return f"{os.cpu_count()} cores of {named}"


@contextmanager
def _quiet() -> Iterator[None]:
    """Suppress Lightning's messages about worker processes and devices."""
    loud = [logging.getLogger(name) for name in ("lightning.pytorch", "lightning.fabric")]
    levels = [one.level for one in loud]
    for one in loud:
        one.setLevel(logging.ERROR)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", module="lightning")
            warnings.filterwarnings("ignore", message=".*does not have many workers.*")
            yield
    finally:
        for one, level in zip(loud, levels, strict=True):
            one.setLevel(level)
