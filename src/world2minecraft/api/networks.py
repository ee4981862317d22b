"""Occupancy networks: train, export and evaluate them, and predict the cells of a room."""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.datasets import Dataset
from world2minecraft.core.errors import (
    InputError,
    MissingExtraError,
    UnknownNameError,
    UsageError,
)
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.cell_predictions import PredictedCells
    from world2minecraft.minecraftocc.scene_completion import GridPlace
    from world2minecraft.networks.config import DataSource, RunConfig

TRAINING_MODULES = ("torch", "lightning", "safetensors", "tensorboard")
LAST_STAGE = "label"  # Of a reconstruction, for ``predict_occupancy``.

Source = str | Path | Dataset


@dataclass(frozen=True, eq=False)
class TrainedNetwork:
    """A network that was trained, and its scores.

    Attributes:
        folder: the run's folder, with ``weights.safetensors``, ``run.yaml`` and ``scores.json``.
        config: every setting of the run.
        steps: the steps that were trained.
        best_step: the step of the best weights.
        stopped_early: whether training ended because the network improved no more.
        seconds: of training and validation, all attempts together.
        scores: of the best weights, as in ``scores.json``.
        data: one line for each data set, with its format and its numbers of frames.
    """

    folder: Path
    config: "RunConfig"
    steps: int
    best_step: int
    stopped_early: bool
    seconds: float
    scores: dict[str, Any]
    data: tuple[str, ...]

    def __repr__(self) -> str:
        return f"TrainedNetwork({str(self.folder)!r}, {self.config.network}, {self.steps:,} steps)"


def train_network(
    network: str = "",
    data: Source | tuple[Source, float] | Sequence[Source | tuple[Source, float]] = (),
    out: str | Path = "RUN",
    *,
    config: str | Path | None = None,
    preset: str = "",
    size: str | None = None,
    backbone: str | None = None,
    grid: str | None = None,
    image: tuple[int, int] | None = None,
    depth: str | None = None,
    steps: int | None = None,
    batch: int | None = None,
    learning_rate: float | None = None,
    precision: str | None = None,
    val_share: float | None = None,
    patience: int | None = None,
    seed: int | None = None,
    threads: int | None = None,
    workers: int | None = None,
    device: str = "auto",
    cache: str = "",
    progress: Progress = no_progress,
) -> TrainedNetwork:
    """Train an occupancy network, keep its best weights and score them.

    A run that was interrupted continues when it is called again with the same arguments.
    ``run.yaml`` in its folder holds every setting; settings without an argument are changed there.

    Args:
        network: ``monoscene``, ``iso``, ``ndc_scene``, ``symphonies`` or ``embodied``; left out
            with ``config``.
        data: data sets; with ``(data, weight)`` one is drawn from more or less often. The first
            is validated and scored on.
        out: the folder of the run.
        config: a ``run.yaml`` with all settings.
        preset: ``smoke``, ``quick``, ``1k`` or ``8k``: sizes and steps together; ``1k`` by
            default.
        size: ``tiny``, ``small`` or ``full``.
        backbone: a model of transformers that sees the images, ``hf:ID``.
        grid: the side of a cell in metres, ``0.16`` or ``0.08``.
        image: width and height of the images; 320x240 by default.
        depth: ``taught`` to the network, ``given`` to it, or ``none``.
        steps: 2,000 by default.
        batch: frames per step; 4 by default.
        learning_rate: 5e-4 by default.
        precision: ``auto``, ``bf16`` or ``32``.
        val_share: the share of scenes that are held out for validation; 0 for the test split.
        patience: validations without improvement before training stops.
        seed: the same seed gives the same run.
        threads: of the CPU; all by default.
        workers: processes that prepare batches.
        device: ``auto``, ``cpu`` or ``cuda``.
        cache: the folder of decoded frames, or ``off``; the user's cache folder by default.
        progress: called for frames, steps and scores.

    Raises:
        UsageError: an argument is wrong. MissingExtraError: torch is not installed.
        ConflictError: the folder holds a run with other settings. InputError: a set cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> trained = w2m.train_network(
        ...     "monoscene", data, tmp / "RUN", preset="smoke", image=(32, 24), steps=1, batch=1,
        ...     val_share=0, device="cpu", cache="off"
        ... )
        >>> trained.steps, trained.scores["split"]
        (1, 'test')
    """
    changes = {
        "size": size, "backbone": backbone, "grid": grid, "image": image, "depth": depth,
        "steps": steps, "batch": batch, "learning_rate": learning_rate, "precision": precision,
        "val_share": val_share, "patience": patience, "seed": seed, "threads": threads,
        "workers": workers,
    }  # fmt: skip
    given = {name: value for name, value in changes.items() if value is not None}
    chosen = _run_config(network, _data_sources(data), config, preset, given)
    _check_training_extra()
    from world2minecraft.networks.data.training_data import CacheLocation
    from world2minecraft.networks.training import score_run, train_run

    place = CacheLocation.parse(cache)
    trained = train_run(chosen, Path(out), device=device, cache=place, progress=progress)
    scores = score_run(trained, chosen, device, progress)
    state = trained.state
    return TrainedNetwork(
        trained.folder, chosen, state.step, state.best_step, state.stopped, state.seconds, scores,
        trained.data.descriptions,
    )  # fmt: skip


@dataclass(frozen=True)
class ExportedNetwork:
    """An ONNX file that was written, compared with its network on one image.

    Attributes:
        path: the file.
        name: what reports call the network.
        weights: how they are stored: ``float``, ``half`` or ``int8``.
        bytes: the size of the file.
        difference: the largest difference of a logit from the network's.
        moved_mean: by how much stored weights move a logit on average; 0 of ``float``,
        moved: and at most.
        spread: the standard deviation of all logits.
        relabelled: the share of the cells that get another class by it.
    """

    path: Path
    name: str
    weights: str
    bytes: int
    difference: float
    moved_mean: float
    moved: float
    spread: float
    relabelled: float


def export_network(
    run: str | Path, out: str | Path, *, name: str = "", weights: str = "float"
) -> ExportedNetwork:
    """Write a trained occupancy network as one ONNX file, which runs without torch.

    The file and the network are compared on one image; nothing is written where they differ.
    docs/networks-onnx.md describes the file.

    Args:
        run: the folder of a run, or a file of weights.
        out: the ONNX file to write.
        name: what reports call the network.
        weights: how they are stored: ``float``, ``half`` or ``int8`` (a quarter of the size).

    Raises:
        InputError: there are no weights. UnknownNameError: weights are not stored so.
        MissingExtraError: torch or onnx is not installed. OutputError: the file cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> trained = w2m.train_network(
        ...     "monoscene", data, tmp / "RUN", preset="smoke", image=(32, 24), steps=1, batch=1,
        ...     val_share=0, device="cpu", cache="off"
        ... )
        >>> w2m.export_network(tmp / "RUN", tmp / "net.onnx").name
        'monoscene-tiny'
    """
    from world2minecraft.reconstruction.occupancy.onnx_network import NetworkFacts, OccupancyNetwork

    _check_training_extra()
    from world2minecraft.networks.onnx_export import export_network as export
    from world2minecraft.networks.training import load_weights_file

    network, config = load_weights_file(Path(run))
    facts = NetworkFacts(
        name or f"{config.network}-{config.size}",
        config.cells.shape,
        config.cells.voxel_m,
        config.image,
        wants_depth=config.depth == "given",
    )
    written = export(network, out, facts, weights=weights)
    OccupancyNetwork(Path(out))
    return ExportedNetwork(
        path=Path(out),
        name=facts.name,
        weights=weights,
        bytes=written.size,
        difference=written.difference,
        moved_mean=written.moved_mean,
        moved=written.moved,
        spread=written.spread,
        relabelled=written.renamed,
    )


def evaluate_network(
    predicted: str | Path,
    data: str | Path,
    *,
    protocols: Sequence[str] = (),
    split: str = "",
    limit: int | None = None,
    order: str = "",
    classes: str = "",
    labels: str | Path | None = None,
    seed: int = 0,
    device: str = "auto",
    cache: str = "",
    progress: Progress = no_progress,
) -> dict[str, Any]:
    """Score occupancy by the published protocols, with confidence intervals over scenes.

    docs/occupancy-scores.md states what each protocol counts, and how it treats unknown cells.

    Args:
        predicted: the folder of a run, weights, an ``.onnx`` file, or saved predictions (a file,
            or a folder of KEY.npz, .npy or .pkl).
        data: any occupancy data set.
        protocols: ``monoscene``, ``iso``, ``embodied``, ``ssc`` and ``visible``; all by default.
        split: ``train``, ``test`` or ``all``; ``test`` by default, where there is one.
        limit: score this many frames at most, spread evenly.
        order: the axes of saved predictions: ``xyz``, ``xzy`` (NYUv2) or ``yxz``; by their shape
            by default.
        classes: the classes of saved predictions: ``ours``, or ``embodied`` (12 is empty).
        labels: of NYUv2, the folder of MonoScene's preprocessed ``base/``, if elsewhere.
        seed: of the intervals.
        device: ``auto``, ``cpu`` or ``cuda``.
        cache: the folder of decoded frames, or ``off``; the user's cache folder by default.
        progress: called after each frame.

    Returns:
        ``["protocols"][name]`` with the ``micro`` and ``macro`` figures, such as
        ``["micro"]["miou"]``; ``["left_out"]`` with the reason by name.

    Raises:
        InputError: a file is missing or cannot be read. UsageError: a protocol cannot be scored.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.datasets import build_photo_dataset
        >>> data = build_photo_dataset(tmp / "DATA", rooms=2, images=2, size=(64, 48))
        >>> report = w2m.export_dataset(data, tmp / "NPZ", "npz")  # The truth, as predictions.
        >>> scores = w2m.evaluate_network(tmp / "NPZ" / "test", tmp / "DATA")
        >>> scores["protocols"]["monoscene"]["micro"]["iou"]
        1.0
    """
    from world2minecraft.minecraftocc.importers import open_occupancy
    from world2minecraft.networks.evaluation import Evaluation, choose_split, needs_torch

    place = Path(predicted)
    if not place.exists():
        raise InputError(place, "not found; give a run, weights, an .onnx file or predictions")
    truth = open_occupancy(data, labels=labels)
    part = choose_split(split, truth.splits.values())
    if needs_torch(place):
        _check_training_extra()
    scores = Evaluation(
        place, truth, part, limit, tuple(protocols), order, classes, device, cache, seed
    ).scores(progress)
    return scores | {"said": str(predicted), "data": str(data), "split": part or "all"}


def scores_latex(scores: dict[str, Any], name: str) -> str:
    """Return scores as rows of a LaTeX table in the columns of the paper, one per protocol.

    Args:
        scores: of ``evaluate_network``.
        name: what the rows call the method.
    """
    from world2minecraft.networks.scoring import latex_rows

    return latex_rows(scores, name)


def predict_occupancy(
    source: str | Path,
    out: str | Path | None = None,
    *,
    grid: str | Path | None = None,
    colour: str | Path | None = None,
    depth_code: str = "auto",
    focal_px: float = 518.8579,
    predictor: str = "depth",
    labels: str | Path | None = None,
    fov_deg: float | None = None,
    run_folder: str | Path | None = None,
    progress: Progress = no_progress,
) -> "PredictedCells":
    """Predict the class of every cell: of one frame's grid, or of a whole captured room.

    With ``grid`` and a picture, the cells are those of the file: 60x36x60 of 8 cm, x right, z up,
    y forward. Of a ``.bin`` only the places of grid and camera are read, never its labels.
    Without ``grid``, a capture is registered, fused and labelled, and the cells are the room's.

    Args:
        source: a depth PNG of 16 bits, a photo, or a capture.
        out: an ``.npz`` file to write: ``labels``, ``confidence``, ``observed`` and their place.
        grid: an SSCNet ``.bin``, or an ``.npz`` with ``origin_m`` and ``camera_to_world``.
        colour: of a depth picture, the photo of its camera.
        depth_code: how a depth PNG holds metres: ``auto``, ``rotated``, ``mm`` or ``8000``.
        focal_px: of a frame, the focal length at its size; NYUv2's by default.
        predictor: ``depth``; or ``mono`` or ``mono:FILE.onnx``, a network that sees photos.
        labels: of a capture, a folder of 2D label images.
        fov_deg: of one photo without ``grid``, its vertical field of view in degrees.
        run_folder: of a capture, the folder for the files of the run.
        progress: called at each step.

    Returns:
        ``labels`` (uint8 [X, Y, Z], 0 to 11, 255 unknown), ``confidence`` and ``observed`` of each
        cell, along the axes x, y, z up.

    Raises:
        UsageError: arguments contradict each other. InputError: a file cannot be read.
        UnknownNameError: there is no such predictor.

    Example:
        >>> import world2minecraft as w2m
        >>> cells = w2m.predict_occupancy(scan, tmp / "room.npz")
        >>> cells.labels.shape == cells.observed.shape, cells.voxel_m
        (True, 0.08)
    """
    from world2minecraft.capture.readers.photo_folder import PHOTO_SUFFIXES
    from world2minecraft.minecraftocc.cell_predictions import write_cells
    from world2minecraft.minecraftocc.frame_occupancy import Frame
    from world2minecraft.minecraftocc.scene_completion import read_grid_place

    path = Path(source)
    if not path.exists():
        raise InputError(path, "not found; give a depth PNG, a photo or a capture")
    place = None if grid is None else read_grid_place(Path(grid))
    more: dict[str, Any] = {} if place is None else {"camera_to_world": place.camera_to_world}
    if place is not None and path.is_file() and path.suffix.lower() in PHOTO_SUFFIXES:
        frame = Frame(path, None if colour is None else Path(colour), depth_code, focal_px)
        network = _mono_network(predictor)
        cells = frame.from_depth(place) if network is None else frame.from_photo(place, network)
    else:
        _check_no_depth(path)
        if colour is not None:
            raise UsageError("--colour needs one depth picture and its --grid")
        cells, scan_to_room = _capture_cells(
            path, place, predictor, labels, fov_deg, run_folder, progress
        )
        more = more or {"scan_to_room": scan_to_room}
    if out is not None:
        write_cells(Path(out), cells, "xyz" if place is None else "xzy", **more)
    return cells


def _capture_cells(
    capture: Path,
    place: "GridPlace | None",
    predictor: str,
    labels: str | Path | None,
    fov_deg: float | None,
    run_folder: str | Path | None,
    progress: Progress,
) -> "tuple[PredictedCells, Any]":
    """Reconstruct a capture up to its labels; return its cells, and ``scan_to_room``."""
    from world2minecraft.formats.run_arrays import read_room
    from world2minecraft.minecraftocc.cell_predictions import cells_of_room, resample_to_grid
    from world2minecraft.reconstruction.parameters import Parameters, with_settings
    from world2minecraft.reconstruction.pipeline import reconstruct

    chosen = Parameters(predictor=predictor)
    chosen = with_settings(chosen, [] if fov_deg is None else [f"capture.fov_deg={fov_deg}"])
    label_folder = None if labels is None else Path(labels)
    with tempfile.TemporaryDirectory() as spare:
        folder = Path(spare if run_folder is None else run_folder)
        reconstruct(
            capture, folder, chosen, until=LAST_STAGE, labels=label_folder, progress=progress
        )
        room, scan_to_room = read_room(folder / "room.npz")
    cells = cells_of_room(room)
    if place is not None:
        cells = resample_to_grid(cells, scan_to_room, place)
    return cells, scan_to_room


def _check_no_depth(source: Path) -> None:
    """Raise UsageError for a depth picture without a grid."""
    from world2minecraft.capture.images import read_header

    if source.suffix.lower() == ".png" and read_header(source).mode.startswith("I"):
        raise UsageError(f"{source} is a depth picture; add --grid, which places its cells")


def _mono_network(predictor: str) -> str | None:
    """Return the ONNX file of a predictor of photos, empty for the shipped one; None for depth."""
    kind, _, file = predictor.partition(":")
    if kind not in ("depth", "mono"):
        raise UnknownNameError("predictor", kind, ("depth", "mono"))
    return file if kind == "mono" else None


def _run_config(
    network: str,
    sources: "tuple[DataSource, ...]",
    config: str | Path | None,
    preset: str,
    changes: dict[str, Any],
) -> "RunConfig":
    """Return the settings of a run. Raises UsageError, UnknownNameError or InputError."""
    from world2minecraft.networks.config import RunConfig, read_config

    if config is not None:
        if network or preset:
            raise UsageError("--config states network and sizes; leave out NET and --preset")
        held = read_config(config)
        return replace(held, **(changes | ({"data": sources} if sources else {})))
    if not network:
        raise UsageError("no network; give its name, such as w2m train monoscene --data DIR")
    made = RunConfig(network, sources)
    return replace(made.with_preset(preset) if preset else made, **changes)


def _data_sources(data: Any) -> "tuple[DataSource, ...]":
    """Return what data sets with or without weights mean; texts may be ``DIR:WEIGHT``."""
    from world2minecraft.networks.config import DataSource

    is_single = isinstance(data, str | Path | Dataset) or (
        isinstance(data, tuple) and len(data) == 2 and isinstance(data[1], int | float)
    )
    sources = []
    entries: list[Any] = [data] if is_single else list(data)  # type: ignore[arg-type]
    for one in entries:
        place, weight = one if isinstance(one, tuple) else (one, None)
        path = str(place.folder if isinstance(place, Dataset) else place)
        plain = isinstance(place, str) and weight is None
        sources.append(
            DataSource.parse(path) if plain else DataSource(path, 1.0 if weight is None else weight)
        )
    return tuple(sources)


def _check_training_extra() -> None:
    """Raise MissingExtraError where torch or what training needs is not installed."""
    from importlib.util import find_spec

    if any(find_spec(name) is None for name in TRAINING_MODULES):
        raise MissingExtraError("training", "train")
