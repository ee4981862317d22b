"""MinecraftVLN: a navigation environment, and data sets of questions about walks."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    import gymnasium

    from world2minecraft.core.checksums import RepairReport
    from world2minecraft.external_models.chat_client import ChatModel
    from world2minecraft.external_models.model_options import ModelOptions
    from world2minecraft.navigation.data.blind_baselines import BaselineRow
    from world2minecraft.navigation.data.rewording import NavigationSet
    from world2minecraft.navigation.data.set_building import BuiltSet
    from world2minecraft.navigation.data.set_files import SetReport
    from world2minecraft.navigation.data.splits import Leaks
    from world2minecraft.navigation.data.statistics import SetStatistics
    from world2minecraft.navigation.exporters import ExportResult
    from world2minecraft.navigation.types import Item
    from world2minecraft.sceneforge.server.server_process import PageServer


def make_env(scene: Run | str | Path, **options: Any) -> "gymnasium.Env":
    """Create a Gymnasium environment for a world.

    ``gymnasium.make("world2minecraft/MinecraftVLN-v0", scene=...)`` creates the same environment.
    The observations are ``rgb`` and ``pose``, and ``info["instruction"]`` contains the instruction.

    Args:
        scene: A run, a run folder, a world or a block file.
        **options: Options for ``navigation.environment.env.VlnEnv``, such as ``actions``,
            ``observations``, ``episodes`` and ``render_mode``. See
            docs/reference/vln-environment.md for a list.

    Raises:
        MissingExtraError: If Gymnasium is not installed.
        UsageError: If an option is invalid.
        InputError: If the world cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> env = w2m.make_env(run)
        >>> observation, info = env.reset(seed=1)
        >>> observation["rgb"].shape, info["instruction"].startswith("Go to the ")
        ((224, 224, 3), True)
    """
    from world2minecraft.navigation.environment import ENV_ID

    import gymnasium  # isort: skip  # Optional; the import above reports if it is missing.

    return gymnasium.make(ENV_ID, scene=path_of(scene), **options)


def build_navigation_set(
    scenes: Sequence[Run | str | Path],
    out: str | Path,
    *,
    rooms: int = 0,
    houses: int = 0,
    streams: Sequence[str | Path] = (),
    at: str = "eye",
    composition: str = "combined",
    trajectories: int | None = None,
    views: int = 3,
    paper_size: bool = False,
    paper_split: bool = False,
    unseen_share: float = 0.2,
    annotations: str | Path | None = None,
    every_keyframe: bool = False,
    moves: str = "vlnce",
    size: tuple[int, int] = (640, 360),
    seed: int = 0,
    workers: int | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> "BuiltSet":
    """Build a navigation set: walks through scenes, instructions in English and questions.

    The walks lead from object to object, and each section is converted to moves that are possible
    with the game's physics. The questions are about the next view and the next action. The same
    arguments and seed produce identical files with any number of workers.

    Args:
        scenes: Runs, generated houses, worlds and block files.
        out: Output folder.
        rooms: Number of rooms to generate, scan and reconstruct in ``out/scenes`` first.
        houses: Number of houses to generate in ``out/scenes`` first.
        streams: Recorded walks, as tour files or folders written by ``run_agent``.
        at: Reference point of the positions in ``streams`` that do not specify it: ``eye`` or
            ``feet``.
        composition: ``base`` (reconstructions), ``extend`` (all other scenes) or ``combined``.
        trajectories: Number of walks per scene. Defaults to 30 for base scenes and 110 for extend
            scenes.
        views: Maximum number of Next-View items per walk.
        paper_size: Limit the number of items for each task and composition to that of the paper.
        paper_split: Hold out walks instead of scenes, as many as the paper does.
        unseen_share: Fraction of the scenes to hold out, for base and extend scenes separately.
        annotations: CSV or JSONL file with instructions written by people, with the columns
            trajectory_id and instruction.
        every_keyframe: Ask a Next-Action question at every suitable keyframe instead of one
            question per action. Guessing without images then achieves high scores.
        moves: ``vlnce``, ``rxr``, ``block`` or ``macro``.
        size: Image width and height, each from 16 to 4096 pixels.
        seed: Random seed. Must be 0 or more.
        workers: Number of processes. Defaults to one per core.
        force: Write into a folder that contains other files.
        progress: Callback that receives the number of completed walks.

    Returns:
        The items, the results for each scene, and the overlap between the train and held-out
        splits.

    Raises:
        UsageError: If an argument is invalid, the scenes produce no items, or the folder contains
            other files without ``force``.
        ConflictError: If another process writes the folder.
        InputError: If a scene cannot be read.
        OutputError: If the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> made = w2m.build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> {item.task for item in made.items} <= {"next_view", "next_action"}
        True
    """
    from world2minecraft.core.machine import usable_cores
    from world2minecraft.core.output_folders import draft_of, output_folder
    from world2minecraft.navigation.data.generated_scenes import make_scenes
    from world2minecraft.navigation.data.recorded_walks import parse_at
    from world2minecraft.navigation.data.scene_items import SceneRule
    from world2minecraft.navigation.data.set_building import BuildRule
    from world2minecraft.navigation.data.set_building import build_navigation_set as build
    from world2minecraft.navigation.records import NAVIGATION_SET, SCENES_FOLDER

    _check_size(size)
    work = SceneRule(
        views=views, move_set=_checked_moves(moves), balanced=not every_keyframe, size_px=size,
        seed=seed,
    )  # fmt: skip
    rule: BuildRule = BuildRule(
        composition, trajectories, paper_size, paper_split, unseen_share,
        tuple(map(str, streams)), parse_at(at), rooms, houses, work,
    )  # fmt: skip
    if not (scenes or rooms or houses):
        raise UsageError("no scenes given; add scenes, or generate some (--rooms 3)")
    folder, processes = Path(out), workers or usable_cores()
    with output_folder(folder, NAVIGATION_SET, "built", force=force):
        generated = make_scenes(folder / SCENES_FOLDER, rooms, houses, seed, processes, progress)
        places = [*map(path_of, scenes), *generated]
        with draft_of(folder) as draft:
            return build(
                places, draft, rule, progress, processes, annotations=annotations, home=folder
            )


def export_navigation_set(
    navigation_set: str | Path,
    out: str | Path,
    to: str,
    *,
    task: str | None = None,
    composition: str | None = None,
    model: str | None = None,
    max_samples: int | None = None,
    gpus: int | None = None,
    max_pixels: int | None = None,
    images: str | None = None,
    seed: int | None = None,
    progress: Progress = no_progress,
) -> "ExportResult":
    """Export a navigation set for LLaMA-Factory, EasyR1, TRL or VLN-CE, or as JSON in R2R format.

    The output folder contains the rows, the images, the paper's training recipe and the command to
    run it.

    Args:
        navigation_set: Folder written by ``build_navigation_set``.
        out: Output folder. Must be new, empty or contain an export with the same arguments.
        to: ``llamafactory``, ``easyr1``, ``trl``, ``vlnce`` or ``r2r``.
        task: Export only ``next_view`` or only ``next_action``. Defaults to both.
        composition: Export only ``base``, ``extend`` or ``combined``. Defaults to all.
        model: Model to fine-tune, as a name on the Hugging Face Hub or a path. Defaults to
            Qwen2.5-VL-3B-Instruct.
        max_samples: Number of rows for one SFT run, or 0 for all. Defaults to 1000, as in the
            paper.
        gpus: Number of GPUs in the recipe. Defaults to 1 for SFT and 8 for GRPO.
        max_pixels: Maximum image size in pixels during training. Trainers scale down larger images.
            Defaults to 262144.
        images: How images are stored: ``paths`` or ``embedded`` in the parquet file. Only for
            ``easyr1``. Defaults to ``paths``.
        seed: Random seed for the order of the rows. Defaults to 0.
        progress: Callback that reports each step.

    Returns:
        The files that were written, with the number of rows, tokens and steps, the commands and
        notes.

    Raises:
        UsageError: If an argument is invalid or no items match.
        InputError: If the set cannot be read.
        ConflictError: If the output folder contains other files, or another process writes it.

    Example:
        >>> import world2minecraft as w2m
        >>> made = w2m.build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> result = w2m.export_navigation_set(tmp / "set", tmp / "r2r", "r2r")
        >>> result.format, result.written[0].rows > 0
        ('r2r', True)
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.navigation.exporters import ExportOptions, export_set
    from world2minecraft.navigation.records import NAVIGATION_SET

    choices = {
        "tasks": None if task is None else (task,),
        "compositions": None if composition is None else (composition,),
        "model": model,
        "max_samples": max_samples,
        "gpus": gpus,
        "max_pixels": max_pixels,
        "image_style": images,
        "seed": seed,
    }
    rule = ExportOptions(**{name: value for name, value in choices.items() if value is not None})
    with output_folder(Path(out), NAVIGATION_SET, "written", force=True):  # It checks the folder.
        return export_set(navigation_set, to, out, rule, progress=progress)


def verify_navigation_set(folder: str | Path, *, progress: Progress = no_progress) -> "SetReport":
    """Read every file in a navigation set and check it against the list of its files.

    Sets of former versions have no list: of those, the records are read, and their images are
    checked.

    Args:
        folder: Folder of the navigation set.
        progress: Callback that is called after each file.

    Returns:
        The number of items, files and bytes, and ``faults``, with one sentence for each missing,
        changed or unexpected file.

    Raises:
        InputError: If the folder is not a navigation set.

    Example:
        >>> from world2minecraft.api.navigation import build_navigation_set, verify_navigation_set
        >>> made = build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> verify_navigation_set(tmp / "set").faults
        ()
    """
    from world2minecraft.navigation.data.set_files import verify_set

    return verify_set(folder, progress)


def repair_navigation_set(
    folder: str | Path, *, workers: int | None = None, progress: Progress = no_progress
) -> "RepairReport":
    """Make the damaged and missing files of a navigation set again from its options and seed.

    Only files with the same contents as before are replaced. Unexpected files are left alone.

    Args:
        folder: Folder of the navigation set.
        workers: Number of processes. Defaults to one per core.
        progress: Callback that reports progress.

    Returns:
        The names of the ``repaired`` files, and one sentence for each file in ``left``, with what
        to do.

    Raises:
        InputError: If the folder is not a navigation set.
        ConflictError: If another process writes the set.
        OutputError: If the folder cannot be written.

    Example:
        >>> from world2minecraft.api.navigation import build_navigation_set, repair_navigation_set
        >>> made = build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> (tmp / "set" / "README.md").unlink()
        >>> repair_navigation_set(tmp / "set").repaired
        ('README.md',)
    """
    from world2minecraft.core.machine import usable_cores
    from world2minecraft.navigation.data.set_repair import repair_set

    return repair_set(folder, workers or usable_cores(), progress)


@dataclass(frozen=True, eq=False)
class NavigationStatistics:
    """Statistics for a navigation set. ``str()`` returns them as tables next to those of the paper.

    Attributes:
        items: All items in the set.
        statistics: Lengths of instructions, answers and distractors by task and composition.
        leaks: Overlap between the train and held-out splits.
        baselines: Scores for the guessing baselines. Empty if the baselines were not scored.
    """

    items: "Sequence[Item]"
    statistics: "SetStatistics"
    leaks: "Leaks"
    baselines: "Sequence[BaselineRow]" = ()

    @cached_property
    def text(self) -> str:
        """The tables as text."""
        from world2minecraft.navigation.data.statistics import statistics_text

        return statistics_text(self.statistics, self.leaks)

    def to_dict(self) -> dict[str, Any]:
        """Return all statistics as JSON-compatible values."""
        from world2minecraft.navigation.data.statistics import statistics_json

        return statistics_json(self.statistics, self.leaks, self.baselines)

    def plot(self, path: str | Path) -> None:
        """Plot histograms of the lengths, as in the paper's figure, to a PNG file.

        Raises:
            MissingExtraError: If matplotlib is not installed.
            OutputError: If the file cannot be written.
        """
        from world2minecraft.navigation.data.statistics import write_histograms

        write_histograms(self.items, path)

    def __repr__(self) -> str:
        return f"NavigationStatistics({len(self.items):,} items)"

    def __str__(self) -> str:
        return self.text


def navigation_statistics(
    navigation_set: str | Path, *, baselines: bool = True
) -> NavigationStatistics:
    """Count items and measure the lengths of their texts, as in the paper's table.

    The lengths of instructions, answers and distractors are in characters. The baselines are scored
    on the held-out splits. If a baseline without access to images scores ten points above chance,
    it is flagged, because the set is then not a valid test of vision.

    Args:
        navigation_set: Folder written by ``build_navigation_set``, or its ``items.jsonl``.
        baselines: Whether to score the baselines, which requires reading the images.

    Raises:
        InputError: If the folder is not a navigation set or an image is missing.

    Example:
        >>> from world2minecraft.api.navigation import build_navigation_set, navigation_statistics
        >>> made = build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> navigation_statistics(tmp / "set", baselines=False)
        NavigationStatistics(... items)
    """
    from world2minecraft.navigation.data.blind_baselines import score_baselines
    from world2minecraft.navigation.data.splits import find_leaks
    from world2minecraft.navigation.data.statistics import compute_statistics
    from world2minecraft.navigation.records import read_items

    place = Path(navigation_set)
    items = read_items(place)
    statistics, leaks = compute_statistics(items), find_leaks(items)
    rows = score_baselines(items, place if place.is_dir() else place.parent) if baselines else []
    return NavigationStatistics(items, statistics, leaks, rows)


@dataclass(frozen=True)
class RewordedSet:
    """Result of rewording the instructions in a navigation set.

    Attributes:
        sources: Number of items by source of the instruction: ``human``, ``llm`` or ``template``.
        outcomes: Number of texts from a model by outcome: ``""`` if accepted, otherwise the reason
            for rejection.
        cost: Number of requests and tokens and the cost in dollars. None if no model was used.
    """

    sources: Mapping[str, int]
    outcomes: Mapping[str, int] = field(default_factory=dict)
    cost: Mapping[str, Any] | None = None


def reword_navigation_set(
    navigation_set: str | Path,
    *,
    annotations: str | Path | None = None,
    rewrite: str = "",
    plain: bool = False,
    jobs: int = 4,
    model: "ModelOptions | None" = None,
    progress: Progress = no_progress,
) -> RewordedSet:
    """Use instructions from people or from a language model in a navigation set.

    Instructions are added and never removed. Each item and episode uses an instruction from a
    person if available, then one from a model, then the generated one. An instruction from a model
    is accepted only if it contains the same turns and objects in the same order.

    Args:
        navigation_set: Folder of the navigation set, which is modified in place.
        annotations: CSV or JSONL file with instructions written by people, with the columns
            trajectory_id and instruction.
        rewrite: Provider or server address of a model that rewrites the instructions.
        plain: Use the generated instructions again.
        jobs: Number of concurrent requests.
        model: Options for the language model.
        progress: Callback that is called after each reply.

    Raises:
        UsageError: If no change is requested or an option is invalid.
        InputError: If a file cannot be read.
        ConflictError: If another process writes the set.
        ServerError: If the model does not reply.

    Example:
        >>> from world2minecraft.api.navigation import build_navigation_set, reword_navigation_set
        >>> made = build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> dict(reword_navigation_set(tmp / "set", plain=True).sources)
        {'template': ...}
    """
    from world2minecraft.core.locks import folder_lock
    from world2minecraft.navigation.records import ITEMS

    if not (annotations or rewrite or plain):
        raise UsageError("nothing to do; add --annotations FILE, --rewrite MODEL or --plain")
    folder = Path(navigation_set)
    lock = folder_lock(folder, "reworded") if (folder / ITEMS).is_file() else nullcontext()
    with lock:
        return _reword_folder(folder, annotations, rewrite, plain, jobs, model, progress)


def _reword_folder(
    folder: Path,
    annotations: str | Path | None,
    rewrite: str,
    plain: bool,
    jobs: int,
    model: "ModelOptions | None",
    progress: Progress,
) -> RewordedSet:
    """Reword the navigation set in a folder, which is locked."""
    from world2minecraft.core.output_folders import draft_of
    from world2minecraft.external_models.model_options import ModelOptions
    from world2minecraft.navigation.data.rewording import (
        ORDER,
        add_annotations,
        read_set,
        select_instructions,
        write_set,
    )
    from world2minecraft.navigation.data.set_files import check_records, update_list
    from world2minecraft.navigation.records import REPLIES_FOLDER

    check_records(folder)
    made, chat, outcomes = read_set(folder), None, Counter[str]()
    if annotations is not None:
        made = add_annotations(made, annotations)
    if rewrite:
        chat = (model or ModelOptions()).open(rewrite, folder / REPLIES_FOLDER)
        made, outcomes = _reworded(made, chat, jobs, progress)
    made = select_instructions(made, ORDER[-1:] if plain else ORDER)
    with draft_of(folder) as draft:
        write_set(draft, made)
        update_list(folder, draft)
    sources = Counter(item.instruction.source for item in made.items)
    return RewordedSet(sources, outcomes, None if chat is None else chat.ledger.to_json())


@dataclass(frozen=True, eq=False)
class AnnotationPage:
    """A web page on which people write instructions for the walks in a navigation set.

    Attributes:
        server: Web server for the page.
        out: File to which annotations are appended.
        walks: Number of walks.
    """

    server: "PageServer"
    out: Path
    walks: int

    @property
    def link(self) -> str:
        """The URL of the page, including the access token for the current user."""
        return self.server.link

    def run(self, ready: Callable[[], None] = lambda: None) -> None:
        """Serve the page until interrupted; call ``ready`` as soon as the page is available."""
        self.server.run(ready)


def annotation_page(
    navigation_set: str | Path,
    out: str | Path | None = None,
    *,
    port: int | None = None,
    force: bool = False,
) -> AnnotationPage:
    """Prepare the web page on which people write instructions. Call ``run`` to serve it.

    Args:
        navigation_set: Folder of the navigation set.
        out: File to append annotations to. Defaults to ``annotations.jsonl`` in the folder of the
            set.
        port: Port to listen on. Defaults to 8484, or to any free port if 8484 is in use.
        force: Keep only the instructions of a file that contains other data.

    Raises:
        InputError: If the set cannot be read or contains no walks.
        UsageError: If the port is in use, or the file contains other data without ``force``.
    """
    from world2minecraft.sceneforge.annotation.app import annotation_server
    from world2minecraft.sceneforge.annotation.store import AnnotationStore

    store = AnnotationStore(Path(navigation_set), None if out is None else Path(out), force)
    return AnnotationPage(annotation_server(store, port), store.out, len(store.walks))


def _checked_moves(name: str) -> str:
    from world2minecraft.navigation.types import MOVE_SETS

    if name not in MOVE_SETS:
        raise UnknownNameError("move set", name, MOVE_SETS)
    return name


def _check_size(size: tuple[int, int]) -> None:
    if len(size) != 2 or not all(16 <= side <= 4096 for side in size):
        named = "x".join(str(side) for side in size)
        raise UsageError(f"size must be WIDTHxHEIGHT, 16 to 4096 pixels each, got {named}")


def _reworded(
    made: "NavigationSet", chat: "ChatModel", jobs: int, progress: Progress
) -> "tuple[NavigationSet, Counter[str]]":
    from world2minecraft.external_models.chat_messages import Turn
    from world2minecraft.external_models.structured_replies import strip_reasoning
    from world2minecraft.navigation.data.rewording import reword_set

    def ask(prompt: str) -> str:
        return strip_reasoning(chat.ask((Turn("user", (prompt,)),))[1].text)

    return reword_set(made, ask, chat.name, jobs, progress)
