"""Layouts of other methods: score, build, judge and describe them; and truths of ScanNet."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import path_of
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.evaluation.scoring.scannet.scannet_truth import TruthMade
    from world2minecraft.external_models.model_options import ModelOptions
    from world2minecraft.paper.layouts import ComparedScene
    from world2minecraft.paper.layouts.importers import How
    from world2minecraft.paper.layouts.judge import Grades

MAX_WISH_BYTES = 16 << 10
DEFAULT_PX_M = 3.5 / 256  # paper.layouts.importers.PX_M, to which a test holds it.


@dataclass(frozen=True, eq=False)
class LayoutScores:
    """The scores of layouts, by method or by scene.

    Attributes:
        scores: the figures of each method, such as ``["LayoutGPT"]["out_of_bounds"]``.
        skipped: the objects that were left out, each with its scene and the reason.
        scenes: how many scenes were scored.
        runs: how many of them are reconstructions.
        uses_true_rooms: whether reconstructions were held to the rooms of a scan's truth.
    """

    scores: Mapping[str, Mapping[str, Any]]
    skipped: Sequence[str]
    scenes: int
    runs: int
    uses_true_rooms: bool

    def tables(self) -> tuple[list[list[str]], list[list[str]]]:
        """Return the paper's table and that by the rules of others; the first rows are titles."""
        from world2minecraft.paper.layouts.score_table import layout_table, other_table

        return layout_table(self.scores), other_table(self.scores)

    def notes(self) -> tuple[str, ...]:
        """Return what the titles mean."""
        from world2minecraft.paper.layouts.score_table import NOTES

        return NOTES

    def __repr__(self) -> str:
        return f"LayoutScores({', '.join(self.scores)}; {self.scenes:,} scenes)"


def score_layouts(
    layouts: Sequence[Run | str | Path],
    *,
    truth: str | Path | None = None,
    by_scene: bool = False,
    format: str = "",
    px_m: float = DEFAULT_PX_M,
    task: str | Path | None = None,
    assets: str | Path | None = None,
    progress: Progress = no_progress,
) -> LayoutScores:
    """Score layouts of rooms, of any method, by one rule.

    Boxes are scored before they become blocks. docs/layout-baselines.md defines what counts as out
    of bounds and as a collision.

    Args:
        layouts: files of LayoutGPT, I-Design or LayoutVLM, folders of ``build_layouts``, and
            finished runs.
        truth: the true scene, for semantic integrity: a scan of a generated room, or a repaired
            run. Runs are held to the rooms of a scan.
        by_scene: return a row for each scene instead of each method.
        format: ``layoutgpt``, ``idesign``, ``layoutvlm``, ``stored`` or ``run``; detected by
            default.
        px_m: the side of a pixel in metres, for layouts in pixels.
        task: the scene file of LayoutVLM, where it is not beside the layout.
        assets: the folder of LayoutVLM's assets, for sizes.
        progress: called after each scene.

    Raises:
        InputError: a layout cannot be read. UsageError: an argument is wrong.

    Example:
        >>> from world2minecraft.api.comparison import score_layouts
        >>> found = score_layouts([run], truth=scan)
        >>> found.scenes, found.uses_true_rooms
        (1, True)
    """
    from world2minecraft.paper.layouts import score_scene, summary_of
    from world2minecraft.paper.layouts.importers import read_layouts_of
    from world2minecraft.paper.layouts.reference_scene import is_truth, true_scene
    from world2minecraft.paper.layouts.score_table import by_method

    reference = None if truth is None else Path(truth)
    how = _how(px_m, task, assets, reference if reference and is_truth(reference) else None)
    known = None if reference is None else score_scene(true_scene(reference))
    found = [one for path in layouts for one in read_layouts_of(path_of(path), how, format)]
    scored = []
    for done, scene in enumerate(found):
        progress("layouts", done, len(found), scene.name)
        scored.append((scene.name if by_scene else scene.method, score_scene(scene)))
    progress("layouts", len(found), len(found))
    scores = {
        name: summary_of(some, [known] * len(some) if known else ())
        for name, some in by_method(scored).items()
    }
    runs = sum(scene.collided is not None for scene in found)
    return LayoutScores(scores, skipped_objects(found), len(found), runs, how.truth is not None)


def is_layout(path: str | Path) -> bool:
    """Return whether a file holds a layout that ``score_layouts`` reads."""
    from world2minecraft.core.errors import InputError
    from world2minecraft.paper.layouts.importers import read_layouts_of

    try:
        return bool(read_layouts_of(Path(path)))
    except InputError:
        return False


@dataclass(frozen=True)
class BuiltLayout:
    """A layout that was built as a world.

    Attributes:
        folder: a run's folder with the world, a picture and a brief report.
        name: that of the scene.
        method: who made the layout.
        built: how many objects were built.
        objects: how many the layout has.
    """

    folder: Path
    name: str
    method: str
    built: int
    objects: int


@dataclass(frozen=True, eq=False)
class BuiltLayouts:
    """The layouts that were built from a file.

    Attributes:
        built: one for each scene.
        skipped: the objects that were left out, each with its scene and the reason.
        scenes: how many scenes the file has.
    """

    built: Sequence[BuiltLayout]
    skipped: Sequence[str]
    scenes: int


def build_layouts(
    layout: str | Path,
    out: str | Path,
    *,
    scenes: Sequence[str] = (),
    count: int | None = None,
    format: str = "",
    px_m: float = DEFAULT_PX_M,
    task: str | Path | None = None,
    assets: str | Path | None = None,
    blocks_per_metre: float = 4.0,
    progress: Progress = no_progress,
) -> BuiltLayouts:
    """Build layouts of other methods as Minecraft worlds; no fault is repaired.

    Each becomes a run's folder; its boxes remain in ``compared.json``, from which
    ``score_layouts`` scores it.

    Args:
        layout: a file of LayoutGPT, I-Design or LayoutVLM.
        out: the folder of the world; of several scenes, that of their folders.
        scenes: parts of the names of scenes; the first scene by default.
        count: how many scenes.
        format: ``layoutgpt``, ``idesign`` or ``layoutvlm``; detected by default.
        px_m: the side of a pixel in metres, for layouts in pixels.
        task: the scene file of LayoutVLM, where it is not beside the layout.
        assets: the folder of LayoutVLM's assets, for sizes.
        blocks_per_metre: the scale.
        progress: called at each step.

    Raises:
        InputError: the layout cannot be read. UsageError: an argument is wrong.
    """
    from world2minecraft.paper.layouts.importers import read_layouts_of
    from world2minecraft.paper.layouts.layout_to_world import build_scene
    from world2minecraft.paper.layouts.scene_selection import folder_names, select_scenes
    from world2minecraft.reconstruction.parameters import Parameters

    how = _how(px_m, task, assets)
    chosen = Parameters(blocks_per_metre=blocks_per_metre)
    found = read_layouts_of(Path(layout), how, format)
    several = count is not None or len(scenes) > 1
    wanted = select_scenes(found, scenes, count)
    places = [Path(out) / name for name in folder_names(wanted)] if several else [Path(out)]
    built = []
    for one, place in zip(wanted, places, strict=True):
        made = build_scene(one, place, chosen, progress)
        built.append(BuiltLayout(place, one.name, one.method, made.objects, len(one.objects)))
    return BuiltLayouts(built, skipped_objects(wanted), len(found))


@dataclass(frozen=True, eq=False)
class JudgedRooms:
    """The grades of rooms by a vision-language model.

    Attributes:
        model: its name.
        grades: those of each room, with every repeat.
        repeats: how often each room was graded.
        cost: questions, tokens and dollars.
    """

    model: str
    grades: "Sequence[Grades]"
    repeats: int
    cost: Mapping[str, Any]

    @property
    def unread(self) -> int:
        """How many replies hold no grades."""
        return sum(one.unread for one in self.grades)

    def table(self) -> list[list[str]]:
        """Return the mean grades by method as a table of text; the first row holds the titles."""
        from world2minecraft.paper.layouts.judge import means_of
        from world2minecraft.paper.layouts.score_table import grade_table

        return grade_table(means_of(self.grades))


def judge_rooms(
    rooms: Sequence[Run | str | Path],
    out: str | Path,
    *,
    agent: str,
    repeats: int = 3,
    wish: str = "",
    model: "ModelOptions | None" = None,
    progress: Progress = no_progress,
) -> JudgedRooms:
    """Let a vision-language model grade rooms from 1 to 10: realism, completeness, atmosphere.

    Each is shown from the same two corners in the same light, without the name of its method.

    Args:
        rooms: folders of ``build_layouts``, and finished runs.
        out: the folder for ``judged.json``, ``replies.jsonl`` and the pictures.
        agent: ``gemini``, ``openai``, ``qwen`` or ``local``, each with ``:MODEL`` if wanted, or
            the address of a server.
        repeats: how often each room is graded.
        wish: what the rooms were meant to be, as ``describe_room`` describes it.
        model: options of the model; the temperature is that of the server by default.
        progress: called after each room.

    Raises:
        InputError: a world cannot be read. ServerError: the model does not reply.
        BudgetError: a cap is reached.
    """
    from world2minecraft.core.files import write_json
    from world2minecraft.external_models.model_options import ModelOptions
    from world2minecraft.paper.layouts.judge import prompt_sum

    folder = Path(out)
    chat = (model or ModelOptions(temperature=None)).open(agent, folder)
    grades = _grades([path_of(room) for room in rooms], chat, folder, wish, repeats, progress)
    write_json(
        folder / "judged.json",
        {"model": chat.name, "prompt": prompt_sum(), "wish": wish, "repeats": repeats,
         "temperature": chat.temperature, "scenes": [one.told() for one in grades]},
    )  # fmt: skip
    return JudgedRooms(chat.name, grades, repeats, chat.ledger.to_json())


def read_wish(path: str | Path) -> str:
    """Return the text of a description, at most 16 KiB.

    Raises:
        InputError: it cannot be read. LimitError: it is too large.
    """
    from world2minecraft.core.files import read_bytes

    return read_bytes(path, MAX_WISH_BYTES).decode("utf-8", "replace")


@dataclass(frozen=True)
class RoomDescription:
    """A room in the form that a text-to-layout method reads.

    Attributes:
        text: what is written to its file.
        px_m: for layoutgpt, the side of a pixel in metres in what the method will return.
    """

    text: str
    px_m: float | None = None


def describe_room(
    scene: Run | str | Path,
    *,
    method: str = "text",
    from_truth: bool = False,
    agent: str = "",
    photos: int = 6,
    replies: str | Path = "described",
    model: "ModelOptions | None" = None,
) -> RoomDescription:
    """Describe a room in words, by rule from its boxes or by a model from its photos.

    Args:
        scene: a finished run or a layout; a capture with ``agent`` or ``from_truth``.
        method: ``text``, ``layoutgpt``, ``idesign`` or ``layoutvlm``: the form.
        from_truth: describe the truth of a scan of a generated room.
        agent: let this model describe the photos of a capture.
        photos: how many photos it is shown.
        replies: the folder for the replies of the model.
        model: options of the model.

    Raises:
        UsageError: an argument is wrong. InputError: the scene cannot be read.
        ServerError: the model does not reply. BudgetError: a cap is reached.

    Example:
        >>> from world2minecraft.api.comparison import describe_room
        >>> describe_room(scan, from_truth=True).text
        'A...'
    """
    from world2minecraft.external_models.model_options import ModelOptions
    from world2minecraft.paper.layouts.importers import read_layouts_of
    from world2minecraft.paper.layouts.reference_scene import true_scene
    from world2minecraft.paper.layouts.room_description import (
        METHODS,
        capture_photos,
        describe_photos,
        describe_scene,
        for_method,
        layoutgpt_px_m,
    )

    if method not in METHODS:
        raise UnknownNameError("form", method, METHODS)
    if agent and method != "text":
        raise UsageError("photos have no sizes: combine --agent with --for text")
    place = path_of(scene)
    if agent:
        chat = (model or ModelOptions()).open(agent, Path(replies))
        return RoomDescription(describe_photos(chat, capture_photos(place, photos)))
    known = true_scene(place) if from_truth else read_layouts_of(place)[0]
    told = for_method(method, known, describe_scene(known))
    text = told if isinstance(told, str) else json.dumps(told, indent=1) + "\n"
    return RoomDescription(text, layoutgpt_px_m(known) if method == "layoutgpt" else None)


@dataclass(frozen=True)
class ScanNetTruth:
    """The truth of a ScanNet scene.

    Attributes:
        scene: the folder of the scene.
        folder: where the truth was written.
        made: what it holds.
    """

    scene: Path
    folder: Path
    made: "TruthMade"


def scannet_truths(
    scenes: str | Path, out: str | Path | None = None, *, progress: Progress = no_progress
) -> list[ScanNetTruth]:
    """Make truths of ScanNet scenes, so that reconstructions of them can be scored.

    Args:
        scenes: a scene of ScanNet's train or val split, or a folder of scenes.
        out: the folder of the truth; of several scenes, that of their folders. By default the
            truth is written to the folder of its scene.
        progress: called at each step.

    Raises:
        InputError: there is no scene, or a file of one is missing or damaged.
        OutputError: the folder cannot be written.
    """
    from world2minecraft.evaluation.scoring.scannet import scenes_in, write_scannet_truth

    place, folder = Path(scenes), None if out is None else Path(out)
    made = []
    for one in scenes_in(place):
        target = folder if folder is None or one == place else folder / one.name
        truth = write_scannet_truth(one, target, progress)
        made.append(ScanNetTruth(one, target or one, truth))
    return made


def skipped_objects(scenes: "Sequence[ComparedScene]") -> tuple[str, ...]:
    """Return the objects that were left out of scenes, each with the scene and the reason."""
    return tuple(f"{scene.name}: {line}" for scene in scenes for line in scene.skipped)


def _how(
    px_m: float, task: str | Path | None, assets: str | Path | None, truth: Path | None = None
) -> "How":
    """Return what files do not say. Raises UsageError where a pixel is no length."""
    from world2minecraft.paper.layouts.importers import How

    if not 0 < px_m < 1:
        raise UsageError(f"--px-m must be metres per pixel, above 0 and below 1, not {px_m:g}")
    task_file = None if task is None else Path(task)
    return How(px_m, task_file, None if assets is None else Path(assets), truth)


def _grades(
    places: Sequence[Path], chat: Any, out: Path, wish: str, repeats: int, progress: Progress
) -> "list[Grades]":
    """Return the grades of rooms; their pictures are written to ``out/pictures``."""
    from world2minecraft.core.files import write_bytes
    from world2minecraft.formats.build_reader import read_build
    from world2minecraft.paper.layouts.importers import read_layouts_of
    from world2minecraft.paper.layouts.judge import grade, pictures_of
    from world2minecraft.paper.layouts.scene_selection import folder_names

    scenes = [read_layouts_of(place)[0] for place in places]
    names, grades = folder_names(scenes), []
    for done, (place, scene) in enumerate(zip(places, scenes, strict=True)):
        progress("judge", done, len(places), scene.name)
        pictures = pictures_of(read_build(place).volume)
        for number, picture in enumerate(pictures, start=1):
            write_bytes(out / "pictures" / f"{names[done]}-{number}.jpg", picture.data)
        grades.append(grade(chat, scene.name, scene.method, pictures, wish=wish, repeats=repeats))
    progress("judge", len(places), len(places))
    return grades
