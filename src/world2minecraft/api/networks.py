"""Train, export and evaluate occupancy networks, and predict the cells of a frame or a room."""

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
LAST_STAGE = "label"  # Last reconstruction stage that ``predict_occupancy`` runs.

Source = str | Path | Dataset


@dataclass(frozen=True, eq=False)
class TrainedNetwork:
    """A trained network with its scores.

    Attributes:
        folder: Run folder with ``weights.safetensors``, ``run.yaml`` and ``scores.json``.
        config: All settings of the run.
        steps: Number of completed training steps.
        best_step: Step with the best weights.
        stopped_early: Whether training stopped early because the validation score stopped
            improving.
        seconds: Duration of training and validation in seconds, including interrupted attempts.
        scores: Scores for the best weights, as in ``scores.json``.
        data: One line per data set with its format and its number of frames.
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
    """Train an occupancy network, save the best weights and score them.

    Call the function again with the same arguments to resume an interrupted run. ``run.yaml`` in
    the run folder contains all settings. To change a setting that is not an argument of this
    function, pass an edited copy of this file as ``config``.

    Args:
        network: ``monoscene``, ``iso``, ``ndc_scene``, ``symphonies`` or ``embodied``. Must be
            omitted with ``config``.
        data: One or more data sets. A pair ``(data, weight)`` sets how often a data set is sampled,
            relative to the others. Validation and scoring use the first data set.
        out: Run folder.
        config: A ``run.yaml`` file with all settings.
        preset: Predefined sizes and number of steps: ``smoke``, ``quick``, ``1k`` or ``8k``.
            Defaults to ``1k``.
        size: Network size: ``tiny``, ``small`` or ``full``.
        backbone: Image backbone from transformers, as ``hf:ID``.
        grid: Cell size in metres: ``0.16`` or ``0.08``.
        image: Image width and height in pixels. Defaults to 320x240.
        depth: Use of depth: ``taught`` (as a training target), ``given`` (also as an input) or
            ``none``.
        steps: Number of training steps. Defaults to 2,000.
        batch: Number of frames per step. Defaults to 4.
        learning_rate: Learning rate. Defaults to 5e-4.
        precision: ``auto``, ``bf16`` or ``32``.
        val_share: Fraction of the training scenes to hold out for validation. 0 validates on the
            test split.
        patience: Number of validations without improvement after which training stops. 0 never
            stops early.
        seed: Random seed. The same seed reproduces the same run.
        threads: Number of CPU threads. Defaults to all.
        workers: Number of processes that prepare batches.
        device: ``auto``, ``cpu`` or ``cuda``.
        cache: Cache folder for decoded frames, or ``off``. Defaults to the user's cache folder.
        progress: Callback that reports progress on frames, steps and scores.

    Raises:
        UsageError: If an argument is invalid.
        MissingExtraError: If torch or another training dependency is not installed.
        ConflictError: If the folder contains a run with other settings.
        InputError: If a data set cannot be read.

    Example:
        >>> import world2minecraft as w2m
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
    """An exported ONNX file, compared with the original network on one image.

    Attributes:
        path: Path of the file.
        name: Name of the network in reports.
        weights: Storage type of the weights: ``float``, ``half`` or ``int8``.
        bytes: File size in bytes.
        difference: Maximum absolute difference in a logit between the network and the ONNX model
            before the weights are compressed.
        moved_mean: Mean absolute change in a logit when the weights are compressed. 0 for
            ``float``.
        moved: Maximum absolute change in a logit when the weights are compressed.
        spread: Standard deviation of all logits.
        relabelled: Fraction of the cells whose class changes when the weights are compressed.
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
    """Export a trained occupancy network as a single ONNX file, which runs without torch.

    The ONNX model is compared with the network on one image. If their outputs differ, the function
    raises an error and writes no file. docs/reference/onnx-networks.md describes the file.

    Args:
        run: Run folder or weights file.
        out: ONNX file to write.
        name: Name of the network in reports.
        weights: Storage type of the weights: ``float``, ``half`` or ``int8`` (a quarter of the
            size).

    Raises:
        InputError: If the weights are missing.
        UnknownNameError: If the storage type is unknown.
        MissingExtraError: If torch or onnx is not installed.
        OutputError: If the outputs differ or the file cannot be written.

    Example:
        >>> import world2minecraft as w2m
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
    """Score occupancy predictions with the published protocols.

    The scores have confidence intervals over scenes. docs/reference/occupancy-scores.md describes
    which cells each protocol counts and how it handles unknown cells.

    Args:
        predicted: A run folder, a weights file, an ``.onnx`` file, or saved predictions (one file,
            or a folder of KEY.npz, .npy or .pkl files).
        data: An occupancy data set in any supported format.
        protocols: ``monoscene``, ``iso``, ``embodied``, ``ssc`` or ``visible``. Defaults to all.
        split: ``train``, ``test`` or ``all``. Defaults to ``test`` if the data set has a test
            split, and to ``all`` otherwise.
        limit: Maximum number of frames to score, spread evenly over the split.
        order: Axis order of saved predictions: ``xyz``, ``xzy`` (NYUv2) or ``yxz``. Inferred from
            their shape by default.
        classes: Class numbering of saved predictions: ``ours`` or ``embodied`` (12 is empty).
        labels: Folder with MonoScene's preprocessed ``base/``, if it is stored elsewhere. Only for
            NYUv2.
        seed: Random seed for the confidence intervals.
        device: ``auto``, ``cpu`` or ``cuda``.
        cache: Cache folder for decoded frames, or ``off``. Defaults to the user's cache folder.
        progress: Callback that is called after each frame.

    Returns:
        A dictionary. ``["protocols"][name]`` contains the ``micro`` and ``macro`` scores, such as
        ``["micro"]["miou"]``. ``["left_out"]`` contains the reason for each protocol that was
        skipped.

    Raises:
        InputError: If a file is missing or cannot be read.
        UsageError: If a protocol cannot be scored.

    Example:
        >>> import world2minecraft as w2m
        >>> report = w2m.export_dataset(data, tmp / "NPZ", "npz")  # The truth, as predictions.
        >>> scores = w2m.evaluate_network(tmp / "NPZ" / "test", data.folder)
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


def evaluate_frame(
    predicted: str | Path,
    truth: str | Path,
    *,
    colour: str | Path | None = None,
    labels: str | Path | None = None,
    depth_code: str = "auto",
) -> dict[str, Any]:
    """Score the completion of one frame by SSCNet's protocol.

    Only cells in the image are scored: those hidden by the visible surface, and the surface. Cells
    with the true label 255, which is outside the room in NYUv2, are left out.

    Args:
        predicted: A depth PNG, which the completion network completes; saved labels (.npz, .npy or
            .pkl); or the folder of a run of this frame.
        truth: An SSCNet ``.bin`` file with its depth ``NAME.png``, or an occupancy data set with
            depth. With several frames, the one with the name of the prediction is used.
        colour: Photo from the camera of a depth PNG.
        labels: Folder with MonoScene's preprocessed ``base/``, if it is stored elsewhere. Only for
            NYUv2.
        depth_code: Encoding of a depth PNG: ``auto``, ``rotated``, ``mm`` or ``8000``.

    Returns:
        A dictionary with fractions from 0 to 1. ``["completion"]`` has the IoU, precision and
        recall over hidden and surface cells, ``["completion_hidden"]`` those over hidden cells
        alone. ``["miou"]`` is the mean over 11 classes, ``["miou_with_empty"]`` over 12, and
        ``["miou_present_classes"]`` over those in the ground truth.

    Raises:
        InputError: If a file is missing or cannot be read.
        UsageError: If the ground truth has no depth.

    Example:
        >>> import world2minecraft as w2m
        >>> from world2minecraft.api.networks import evaluate_frame
        >>> report = w2m.export_dataset(data, tmp / "NPZ", "npz")  # The truth, as predictions.
        >>> frame = sorted((tmp / "NPZ").glob("*/*.npz"))[0]
        >>> evaluate_frame(frame, data.folder)["completion"]["iou"]
        1.0
    """
    from world2minecraft.minecraftocc.importers import open_occupancy
    from world2minecraft.networks.frame_scoring import frame_scores

    place = Path(predicted)
    if not place.exists():
        raise InputError(place, "not found; give a depth PNG, saved labels or a run")
    known = open_occupancy(truth, labels=labels)
    photo = None if colour is None else Path(colour)
    scores = frame_scores(place, known, colour=photo, depth_code=depth_code)
    return scores | {"predicted": str(predicted), "truth": str(truth)}


def scores_latex(scores: dict[str, Any], name: str) -> str:
    """Return scores as rows of a LaTeX table with the paper's columns, one row per protocol.

    Args:
        scores: Scores returned by ``evaluate_network``.
        name: Name of the method in the table.
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
    force: bool = False,
    progress: Progress = no_progress,
) -> "PredictedCells":
    """Predict the class of every cell in the grid of one frame or in a whole captured room.

    With ``grid`` and a single image, the function predicts the cells of the grid file: 60x36x60
    cells with a size of 8 cm and the axes x right, z up, y forward. From a ``.bin`` file only the
    position of the grid and the camera is read, never the labels. Without ``grid``, the capture is
    registered, fused and labelled, and the function returns the cells of the room.

    Args:
        source: A 16-bit depth PNG, a photo or a capture.
        out: Optional ``.npz`` file for ``labels``, ``confidence``, ``observed`` and the grid
            position.
        grid: An SSCNet ``.bin`` file, or an ``.npz`` file with ``origin_m`` and
            ``camera_to_world``.
        colour: Photo from the same camera as a depth image.
        depth_code: Encoding of a depth PNG: ``auto``, ``rotated``, ``mm`` or ``8000``.
        focal_px: Focal length in pixels at the size of the image. Only for a single frame. Defaults
            to that of NYUv2.
        predictor: ``depth``, or ``mono`` or ``mono:FILE.onnx`` for a network that uses photos.
        labels: Folder of 2D label images. Only for a capture.
        fov_deg: Vertical field of view in degrees. Only for a single photo without ``grid``.
        run_folder: Folder for the files of the run. Only for a capture. Defaults to a temporary
            folder.
        force: Write into a ``run_folder`` that contains other files.
        progress: Callback that reports each step.

    Returns:
        The ``labels`` (uint8 [X, Y, Z], 0 to 11, or 255 for unknown), ``confidence`` and
        ``observed`` arrays, with the axes x, y and z (up).

    Raises:
        UsageError: If arguments contradict each other, or ``run_folder`` contains other files
            without ``force``.
        ConflictError: If another process writes ``run_folder``.
        InputError: If a file cannot be read.
        UnknownNameError: If the predictor is unknown.

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
            raise UsageError("colour requires a single depth image and a grid (--grid)")
        cells, scan_to_room = _capture_cells(
            path, place, predictor, labels, fov_deg, run_folder, force, progress
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
    force: bool,
    progress: Progress,
) -> "tuple[PredictedCells, Any]":
    """Reconstruct a capture up to the label stage and return its cells and ``scan_to_room``."""
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.formats.run_arrays import read_room
    from world2minecraft.minecraftocc.cell_predictions import cells_of_room, resample_to_grid
    from world2minecraft.reconstruction.parameters import Parameters, with_settings
    from world2minecraft.reconstruction.pipeline import reconstruct
    from world2minecraft.reconstruction.run_folder import RUN

    chosen = Parameters(predictor=predictor)
    chosen = with_settings(chosen, [] if fov_deg is None else [f"capture.fov_deg={fov_deg}"])
    label_folder = None if labels is None else Path(labels)
    with tempfile.TemporaryDirectory() as spare:
        folder = Path(spare if run_folder is None else run_folder)
        with output_folder(folder, RUN, "reconstructed", force=force, source=capture):
            reconstruct(
                capture, folder, chosen, until=LAST_STAGE, labels=label_folder, progress=progress
            )
        room, scan_to_room = read_room(folder / "room.npz")
    cells = cells_of_room(room)
    if place is not None:
        cells = resample_to_grid(cells, scan_to_room, place)
    return cells, scan_to_room


def _check_no_depth(source: Path) -> None:
    """Raise UsageError if the source is a depth image, which requires a grid."""
    from world2minecraft.capture.images import read_header

    if source.suffix.lower() == ".png" and read_header(source).mode.startswith("I"):
        raise UsageError(
            f"{source} is a depth image; add a grid (--grid FILE), which defines the position of "
            "the cells"
        )


def _mono_network(predictor: str) -> str | None:
    """Return the ONNX file of a photo predictor, or None for the depth predictor.

    An empty string selects the ONNX file that is included in the package.
    """
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
    """Return the settings for a run.

    Raises:
        UsageError: If arguments contradict each other or no network is given.
        UnknownNameError: If the preset or a setting is unknown.
        InputError: If the configuration file cannot be read.
    """
    from world2minecraft.networks.config import RunConfig, read_config

    if config is not None:
        if network or preset:
            raise UsageError(
                "config already defines the network and its size; omit the network and the preset"
            )
        held = read_config(config)
        return replace(held, **(changes | ({"data": sources} if sources else {})))
    if not network:
        raise UsageError("no network given; name one, as in w2m train monoscene --data DIR")
    made = RunConfig(network, sources)
    return replace(made.with_preset(preset) if preset else made, **changes)


def _data_sources(data: Any) -> "tuple[DataSource, ...]":
    """Convert data sets with or without weights to data sources. Strings can be ``DIR:WEIGHT``."""
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
    """Raise MissingExtraError if torch or another training dependency is not installed."""
    from importlib.util import find_spec

    if any(find_spec(name) is None for name in TRAINING_MODULES):
        raise MissingExtraError("training", "train")
