"""``w2m evaluate occupancy``: a network, an ONNX file or saved predictions against any data set."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.train.options import Cache, Device

if TYPE_CHECKING:
    from rich.table import Table

    from world2minecraft.core.progress import Progress

EXAMPLES = """\
w2m evaluate occupancy RUN DATA                                 what w2m train made
w2m evaluate occupancy net.onnx NYU --protocol monoscene        an exported network, on real NYUv2
w2m evaluate occupancy PREDICTED NYU --protocol ssc --protocol monoscene
w2m evaluate occupancy PRED.npz NYU0003_0000.bin                one frame
w2m evaluate occupancy saved OCC --protocol embodied            EmbodiedOcc's or GPOcc's own files
w2m evaluate occupancy scenes OCC --protocol embodied           ... or SCENE.npy, grids of scenes
w2m evaluate occupancy RUN DATA --json scores.json --latex rows.tex
"""


Said = Annotated[
    Path,
    typer.Argument(metavar="PRED_OR_NET",
                   help="A run's folder, weights, an .onnx, or saved predictions."),
]  # fmt: skip
Truth = Annotated[Path, typer.Argument(metavar="GT_OR_DATA", help="Any occupancy data set.")]
Protocols = Annotated[
    list[str] | None,
    typer.Option("--protocol", help="monoscene, iso, embodied, ssc or visible; all by default."),
]
Split = Annotated[str, typer.Option("--split", help="train, test or all; test where there is one.")]
Limit = Annotated[
    int | None, typer.Option("--limit", min=1, help="At most so many frames, spread evenly.")
]
Order = Annotated[
    str, typer.Option("--order", help="Of saved axes: xyz, xzy (NYUv2) or yxz; by the shape.")
]
Classes = Annotated[
    str, typer.Option("--classes", help="Of saved labels: ours, or embodied (12 is empty).")
]
Labels = Annotated[
    Path | None, typer.Option("--labels", help="NYUv2: where base/ lies, if elsewhere.")
]
Json = Annotated[
    Path | None, typer.Option("--json", metavar="FILE", help="Write every figure here, too.")
]
Latex = Annotated[
    Path | None, typer.Option("--latex", metavar="FILE", help="Write rows of a table here.")
]
Seed = Annotated[int, typer.Option("--seed", help="Of the intervals.")]


def run(
    said: Said,
    truth: Truth,
    protocol: Protocols = None,
    split: Split = "",
    limit: Limit = None,
    order: Order = "",
    classes: Classes = "",
    labels: Labels = None,
    json_path: Json = None,
    latex: Latex = None,
    seed: Seed = 0,
    device: Device = "auto",
    cache: Cache = "",
) -> None:
    """Score occupancy by the published protocols, with intervals over scenes.

    What each protocol counts, and what it makes of 255, is in docs/occupancy-scores.md.
    """
    from rich.console import Console

    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.files import write_json, write_text
    from world2minecraft.minecraftocc.importers import open_occupancy
    from world2minecraft.networks.scoring import latex_rows

    if not said.exists():
        from world2minecraft.core.errors import InputError

        raise InputError(said, "is not there; give a run's folder, weights, .onnx or predictions")
    found = open_occupancy(truth, labels=labels)
    part = _split_of(split, found.splits.values())
    what = _Evaluation(
        said, found, part, limit, tuple(protocol or ()), order, classes, device, cache, seed
    )
    with show_progress() as progress:
        scores = what.scores(progress)
    scores |= {"said": str(said), "data": str(truth), "split": part or "all"}
    console = Console(highlight=False)
    console.print(score_table(scores))
    intervals = interval_table(scores)
    for table in (intervals, class_table(scores)):
        if table is not None:
            console.print(table)
    for name, reason in scores["left_out"].items():
        print(f"{name} left out: {reason}")
    if json_path is not None:
        write_json(json_path, scores)
        print(f"figures  {json_path}")
    if latex is not None:
        write_text(latex, latex_rows(scores, said.stem))
        print(f"rows     {latex}")
    if json_path is None:
        print("next: the same with --json scores.json, for every figure and interval")


class _Evaluation:
    """What is to be scored, and how."""

    def __init__(
        self, said: Path, found: Any, split: str | None, limit: int | None,
        protocols: tuple[str, ...], order: str, classes: str, device: str, cache: str, seed: int,
    ):  # fmt: skip
        self.said, self.found, self.split, self.limit = said, found, split, limit
        self.protocols, self.order, self.classes = protocols, order, classes
        self.device, self.cache, self.seed = device, cache, seed

    def scores(self, progress: "Progress") -> dict[str, Any]:
        """Return the scores by the kind of what is scored."""
        if self.said.suffix == ".onnx":
            return self._of_onnx(progress)
        if self.said.suffix == ".safetensors" or (self.said / "run.yaml").is_file():
            return self._of_weights(progress)
        return self._of_files(progress)

    def _scored(self, frames: Any, voxel_m: float) -> dict[str, Any]:
        from world2minecraft.networks.scoring import protocol_scores

        return protocol_scores(frames, voxel_m, self.protocols, seed=self.seed)

    def _rows(self, frames: Any) -> list[int]:
        from world2minecraft.networks.data.splits import take_evenly

        of = self.found.splits
        rows = [n for n, key in enumerate(frames.keys) if self.split in (None, of[key])]
        return take_evenly(rows, self.limit or len(rows))

    def _frames(self, grid: Any, size: tuple[int, int], progress: "Progress") -> Any:
        from world2minecraft.networks.data.frames import FrameRule
        from world2minecraft.networks.data.training_data import CacheLocation, open_frames

        place = CacheLocation.parse(self.cache)
        return open_frames(self.found, FrameRule(grid, *size), place, progress)

    def _of_onnx(self, progress: "Progress") -> dict[str, Any]:
        from world2minecraft.networks.config import Grid
        from world2minecraft.networks.scoring import onnx_predictions
        from world2minecraft.reconstruction.occupancy.onnx_network import OccupancyNetwork

        facts = OccupancyNetwork(self.said).facts
        grid = Grid(facts.grid_shape, facts.voxel_m)
        frames = self._frames(grid, facts.image_size_px, progress)
        said = onnx_predictions(self.said, frames, self._rows(frames), progress)
        return self._scored(said, grid.voxel_m)

    def _of_weights(self, progress: "Progress") -> dict[str, Any]:
        from world2minecraft.cli.train.options import check_extra

        check_extra()
        from world2minecraft.networks.callbacks import WEIGHTS
        from world2minecraft.networks.checkpoints import load_weights, read_weights_config
        from world2minecraft.networks.scoring import network_predictions
        from world2minecraft.networks.training import build_network
        from world2minecraft.networks.validation import predict_labels, resolve_device

        path = self.said / WEIGHTS if self.said.is_dir() else self.said
        config = read_weights_config(path)
        network = build_network(config)
        load_weights(path, network)
        network.to(resolve_device(self.device))
        frames = self._frames(config.cells, config.image, progress)
        rows = self._rows(frames)
        said = predict_labels(network, frames, rows, config, progress=progress)
        scores = self._scored(network_predictions(frames, rows, said), config.cells.voxel_m)
        if not self.protocols or "embodied" in self.protocols:
            from world2minecraft.networks.memory_scoring import add_memory_scores

            add_memory_scores(
                scores, network, self.found, frames, rows, config, seed=self.seed, progress=progress
            )
        return scores

    def _of_files(self, progress: "Progress") -> dict[str, Any]:
        from world2minecraft.networks.data.splits import take_evenly
        from world2minecraft.networks.saved_predictions import SavedPredictions, grid_of_labels
        from world2minecraft.networks.scoring import file_predictions, keys_to_score

        saved = SavedPredictions(self.said, self.order, self.classes)
        if (of_scenes := self._of_scenes(saved, progress)) is not None:
            return of_scenes
        keys = keys_to_score(saved, self.found, self.split)
        keys = [keys[n] for n in take_evenly(list(range(len(keys))), self.limit or len(keys))]
        grid = grid_of_labels(saved.labels(keys[0]), self.said)
        return self._scored(file_predictions(saved, self.found, keys, progress), grid.voxel_m)

    def _of_scenes(self, saved: Any, progress: "Progress") -> dict[str, Any] | None:
        """Return scores of grids of whole scenes; None where none of the files is a scene's."""
        from world2minecraft.core.errors import UsageError
        from world2minecraft.networks.scoring import saved_scene_scores, scenes_to_score

        if self.found.format != "embodied":
            return None
        from world2minecraft.minecraftocc.importers.embodied import open_scenes

        scenes = open_scenes(self.found.path)
        if not (names := scenes_to_score(saved, scenes, self.split)):
            return None
        if self.protocols not in ((), ("embodied",)):
            raise UsageError(f"{self.said} holds whole scenes, which --protocol embodied scores")
        return saved_scene_scores(saved, scenes, names, seed=self.seed, progress=progress)


def _split_of(asked: str, held: Any) -> str | None:
    """Return the split to score, None for all. Raises UsageError for one that is empty."""
    from world2minecraft.core.errors import UsageError

    there = set(held)
    if not asked:
        return "test" if "test" in there else None
    if asked == "all":
        return None
    if asked not in there:
        known = ", ".join(sorted(one for one in there if one)) or "none"
        raise UsageError(f"there is no frame in {asked!r}; this set has {known}; or say all")
    return asked


def score_table(scores: dict[str, Any]) -> "Table":
    """Return the micro figures by protocol, and the macro ones that most ask for."""
    rows = []
    for name, found in scores["protocols"].items():
        micro, macro = found["micro"], found["macro"]
        both = f"{_per_cent(macro['iou'])} / {_per_cent(macro['miou'])}"
        rows.append(
            (name, f"{found['frames']:,}", *(_per_cent(micro[key]) for key in _FIGURES), both)
        )
    head = ("protocol", "frames", "IoU", "precision", "recall", "mIoU", "macro")
    return _table("per cent; macro: IoU / mIoU, means over frames", head, rows)


def interval_table(scores: dict[str, Any]) -> "Table | None":
    """Return the intervals of the micro figures; None where there is one scene."""
    rows, scenes = [], 0
    for name, found in scores["protocols"].items():
        if found["interval"] is not None:
            ends = (found["interval"][key] for key in _FIGURES)
            rows.append((name, *(f"{100 * low:.1f}-{100 * high:.1f}" for low, high in ends)))
            scenes = max(scenes, found["scenes"])
    head = ("protocol", "IoU", "precision", "recall", "mIoU")
    return _table(f"95 % intervals over {scenes} scenes", head, rows) if rows else None


_FIGURES = ("iou", "precision", "recall", "miou")


def _table(title: str, head: tuple[str, ...], rows: list[tuple[str, ...]]) -> "Table":
    from rich.table import Table

    table = Table(*head, box=None, header_style="bold", pad_edge=False, title=title)
    table.title_justify = "left"
    for column in table.columns[1:]:
        column.justify = "right"
    for row in rows:
        table.add_row(*row)
    return table


def class_table(scores: dict[str, Any]) -> "Table":
    """Return the IoU of each class by protocol."""
    names = list(scores["protocols"])
    micro = {name: scores["protocols"][name]["micro"]["class_iou"] for name in names}
    rows = [
        (label, *(_per_cent(micro[name][label]) for name in names)) for label in micro[names[0]]
    ]
    heads = ("class", *(name.replace(" ", "\n") for name in names))
    return _table("IoU of each class", heads, rows)


def _per_cent(value: float) -> str:
    return f"{100 * value:.2f}"
