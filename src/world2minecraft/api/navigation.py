"""MinecraftVLN: an environment to walk in, and sets of questions about walks."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
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

    from world2minecraft.external_models.chat_client import ChatModel
    from world2minecraft.external_models.model_options import ModelOptions
    from world2minecraft.navigation.data.blind_baselines import BaselineRow
    from world2minecraft.navigation.data.rewording import NavigationSet
    from world2minecraft.navigation.data.set_building import BuiltSet
    from world2minecraft.navigation.data.splits import Leaks
    from world2minecraft.navigation.data.statistics import SetStatistics
    from world2minecraft.navigation.exporters import ExportResult
    from world2minecraft.navigation.types import Item
    from world2minecraft.sceneforge.server.server_process import PageServer

REPLIES_FOLDER = "rewriting"  # Of a set, with the recorded replies of a model.


def make_env(scene: Run | str | Path, **options: Any) -> "gymnasium.Env":
    """Make the Gymnasium environment of a world.

    ``gymnasium.make("world2minecraft/MinecraftVLN-v0", scene=...)`` makes the same one. Its
    observations are ``rgb`` and ``pose``; ``info["instruction"]`` holds the instruction.

    Args:
        scene: a run, its folder, a world or a block file.
        **options: those of ``navigation.environment.env.VlnEnv``, such as ``actions``,
            ``observations``, ``episodes`` and ``render_mode``; docs/vln-environment.md lists them.

    Raises:
        MissingExtraError: Gymnasium is not installed. UsageError: an option is wrong.
        InputError: the world cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> env = w2m.make_env(run)
        >>> observation, info = env.reset(seed=1)
        >>> observation["rgb"].shape, info["instruction"].startswith("Go to the ")
        ((224, 224, 3), True)
    """
    from world2minecraft.navigation.environment import ENV_ID

    import gymnasium  # isort: skip  # An extra; the line above says so where it is missing.

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
    progress: Progress = no_progress,
) -> "BuiltSet":
    """Walk through scenes, describe each walk in English, and ask what is seen and done next.

    A scene is toured from object to object; each leg becomes moves that the game's physics can
    make. The same arguments and seed give the same bytes, with any number of workers.

    Args:
        scenes: runs, generated houses, worlds and block files.
        out: the folder of the set.
        rooms: generate, scan and reconstruct this many rooms in ``out/scenes`` first.
        houses: generate this many houses in ``out/scenes`` first.
        streams: recorded walks: tour files, and folders of ``run_agent``.
        at: what the positions of streams are: ``eye`` or ``feet``.
        composition: ``base`` (reconstructions), ``extend`` (all other scenes) or ``combined``.
        trajectories: walks of each scene; 30 of base and 110 of extend by default.
        views: the most Next-View items of a walk.
        paper_size: have no more items than the paper, part by part.
        paper_split: hold out walks instead of scenes, as many as the paper.
        unseen_share: the share of the scenes of each kind that is held out.
        annotations: instructions that people wrote, CSV or JSONL: trajectory_id, instruction.
        every_keyframe: ask at every keyframe; then blind guesses score high.
        moves: ``vlnce``, ``rxr``, ``block`` or ``macro``.
        size: the width and height of pictures, 16 to 4096 pixels.
        seed: 0 or more.
        workers: processes; one for each core by default.
        progress: called with the walks done.

    Returns:
        The items, what came of each scene, and what train shares with the held-out splits.

    Raises:
        UsageError: an argument is wrong, or no scene gives an item.
        InputError: a scene cannot be read. OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> made = w2m.build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> {item.task for item in made.items} <= {"next_view", "next_action"}
        True
    """
    from world2minecraft.core.machine import usable_cores
    from world2minecraft.navigation.data.generated_scenes import make_scenes
    from world2minecraft.navigation.data.recorded_walks import parse_at
    from world2minecraft.navigation.data.rewording import annotate_set
    from world2minecraft.navigation.data.scene_items import SceneRule
    from world2minecraft.navigation.data.set_building import BuildRule
    from world2minecraft.navigation.data.set_building import build_navigation_set as build
    from world2minecraft.navigation.records import SCENES_FOLDER
    from world2minecraft.reconstruction.run_folder import check_writable

    _check_size(size)
    work = SceneRule(
        views=views, move_set=_checked_moves(moves), balanced=not every_keyframe, size_px=size,
        seed=seed,
    )  # fmt: skip
    rule: BuildRule = BuildRule(
        composition, trajectories, paper_size, paper_split, unseen_share,
        tuple(map(str, streams)), parse_at(at), work,
    )  # fmt: skip
    if not (scenes or rooms or houses):
        raise UsageError("no scene is given; give scenes, or generate some with --rooms 3")
    folder, processes = Path(out), workers or usable_cores()
    check_writable(folder)
    generated = make_scenes(folder / SCENES_FOLDER, rooms, houses, seed, processes, progress)
    places = [*map(path_of, scenes), *generated]
    built = build(places, folder, rule, progress, processes)
    if annotations is not None:
        annotate_set(folder, annotations)
    return built


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
    """Write a set for LLaMA-Factory, EasyR1, TRL or VLN-CE, or as R2R's JSON.

    The folder gets the rows, the pictures, the paper's recipe and the command that runs it.

    Args:
        navigation_set: the folder of ``build_navigation_set``.
        out: the folder to write; new, empty, or of an export with the same arguments.
        to: ``llamafactory``, ``easyr1``, ``trl``, ``vlnce`` or ``r2r``.
        task: ``next_view`` or ``next_action`` alone; both by default.
        composition: ``base``, ``extend`` or ``combined`` alone; all by default.
        model: what is tuned, a name on the hub or a path; Qwen2.5-VL-3B-Instruct by default.
        max_samples: the rows of one SFT run; 1000 by default, as in the paper; 0 for all.
        gpus: those of the recipe; 1 for SFT and 8 for GRPO by default.
        max_pixels: trainers reduce larger pictures; 262144 by default.
        images: of easyr1, ``paths`` (the default) or ``embedded`` in the parquet file.
        seed: of the order of rows; 0 by default.
        progress: called at each step.

    Returns:
        The files that were written, with rows, tokens, steps, commands and notes.

    Raises:
        UsageError: a name is wrong, or nothing is left to export. InputError: the set cannot be
        read. ConflictError: the folder holds something else.

    Example:
        >>> import world2minecraft as w2m
        >>> made = w2m.build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> result = w2m.export_navigation_set(tmp / "set", tmp / "r2r", "r2r")
        >>> result.format, result.written[0].rows > 0
        ('r2r', True)
    """
    from world2minecraft.navigation.exporters import ExportOptions, export_set

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
    return export_set(navigation_set, to, out, rule, progress=progress)


@dataclass(frozen=True, eq=False)
class NavigationStatistics:
    """The figures of a navigation set; as text, the tables beside those of the paper.

    Attributes:
        items: those of the set.
        statistics: lengths of instructions, answers and wrong choices, by task and composition.
        leaks: what train shares with the held-out splits.
        baselines: what guessing scores; empty where it was not scored.
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
        """Return every figure, for JSON."""
        from world2minecraft.navigation.data.statistics import statistics_json

        return statistics_json(self.statistics, self.leaks, self.baselines)

    def plot(self, path: str | Path) -> None:
        """Draw the histograms of the lengths, as the paper's figure, to a PNG file.

        Raises:
            MissingExtraError: matplotlib is not installed. OutputError: it cannot be written.
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
    """Count items, lengths of instructions, answers and wrong choices, as the paper's table does.

    Lengths are in characters. Baselines are scored on the held-out splits; one that sees no picture
    and is ten points above chance is flagged, as such a set does not test vision.

    Args:
        navigation_set: the folder of ``build_navigation_set``, or its ``items.jsonl``.
        baselines: score the baselines, which reads the pictures.

    Raises:
        InputError: it is no set, or a picture is missing.

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
    """What rewording a set gave.

    Attributes:
        sources: how many items use the words of ``human``, ``llm`` or ``template``.
        outcomes: how many texts of a model were accepted (``""``) or rejected, by the reason.
        cost: questions, tokens and dollars of the model; None where none was asked.
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
    """Let a set ask in the words of people, or of a language model.

    Words are added and none is removed. Items and episodes use a person's words where there are
    some, else a model's, else the generated ones. A model's words are accepted only where the same
    turns and objects are read from them in the same order.

    Args:
        navigation_set: the folder of the set; it is changed.
        annotations: instructions that people wrote, CSV or JSONL: trajectory_id, instruction.
        rewrite: a provider or the address of a server whose model rewrites the instructions.
        plain: use the generated words again.
        jobs: simultaneous questions.
        model: options of the language model.
        progress: called after each reply.

    Raises:
        UsageError: nothing is asked for, or an option is wrong. InputError: a file cannot be read.
        ServerError: the model does not reply.

    Example:
        >>> from world2minecraft.api.navigation import build_navigation_set, reword_navigation_set
        >>> made = build_navigation_set([run], tmp / "set", trajectories=2, size=(64, 36))
        >>> dict(reword_navigation_set(tmp / "set", plain=True).sources)
        {'template': ...}
    """
    from world2minecraft.external_models.model_options import ModelOptions
    from world2minecraft.navigation.data.rewording import (
        ORDER,
        add_annotations,
        read_set,
        select_instructions,
        write_set,
    )

    if not (annotations or rewrite or plain):
        raise UsageError("nothing to do; add --annotations FILE, --rewrite MODEL or --plain")
    folder = Path(navigation_set)
    made, chat, outcomes = read_set(folder), None, Counter[str]()
    if annotations is not None:
        made = add_annotations(made, annotations)
    if rewrite:
        chat = (model or ModelOptions()).open(rewrite, folder / REPLIES_FOLDER)
        made, outcomes = _reworded(made, chat, jobs, progress)
    made = select_instructions(made, ORDER[-1:] if plain else ORDER)
    write_set(folder, made)
    sources = Counter(item.instruction.source for item in made.items)
    return RewordedSet(sources, outcomes, None if chat is None else chat.ledger.to_json())


@dataclass(frozen=True, eq=False)
class AnnotationPage:
    """A page on which people write instructions for the walks of a set.

    Attributes:
        server: the server behind the page.
        out: the file to which lines are added.
        walks: how many walks there are.
    """

    server: "PageServer"
    out: Path
    walks: int

    @property
    def link(self) -> str:
        """The address of the page, with the token that admits this user."""
        return self.server.link

    def run(self, ready: Callable[[], None] = lambda: None) -> None:
        """Serve until interrupted; ``ready`` is called once the page can be opened."""
        self.server.run(ready)


def annotation_page(
    navigation_set: str | Path, out: str | Path | None = None, *, port: int | None = None
) -> AnnotationPage:
    """Prepare the page on which people write instructions; ``run`` serves it.

    Args:
        navigation_set: the folder of the set.
        out: the file to add lines to; ``annotations.jsonl`` of the set by default.
        port: the port to listen on; 8484, or any free one, by default.

    Raises:
        InputError: the set has no walk, or cannot be read. UsageError: the port is in use.
    """
    from world2minecraft.sceneforge.annotation.app import annotation_server
    from world2minecraft.sceneforge.annotation.store import AnnotationStore

    store = AnnotationStore(Path(navigation_set), None if out is None else Path(out))
    return AnnotationPage(annotation_server(store, port), store.out, len(store.walks))


def _checked_moves(name: str) -> str:
    from world2minecraft.navigation.types import MOVE_SETS

    if name not in MOVE_SETS:
        raise UnknownNameError("set of moves", name, MOVE_SETS)
    return name


def _check_size(size: tuple[int, int]) -> None:
    if len(size) != 2 or not all(16 <= side <= 4096 for side in size):
        named = "x".join(str(side) for side in size)
        raise UsageError(f"--size is WIDTHxHEIGHT of 16 to 4096 pixels, not {named}")


def _reworded(
    made: "NavigationSet", chat: "ChatModel", jobs: int, progress: Progress
) -> "tuple[NavigationSet, Counter[str]]":
    from world2minecraft.external_models.chat_messages import Turn
    from world2minecraft.external_models.structured_replies import strip_reasoning
    from world2minecraft.navigation.data.rewording import reword_set

    def ask(prompt: str) -> str:
        return strip_reasoning(chat.ask((Turn("user", (prompt,)),))[1].text)

    return reword_set(made, ask, chat.name, jobs, progress)
