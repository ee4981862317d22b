"""Score, build, judge and describe layouts from other methods, and prepare ScanNet ground truth."""

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
DEFAULT_PX_M = 3.5 / 256  # Must equal paper.layouts.importers.PX_M; a test checks this.


@dataclass(frozen=True, eq=False)
class LayoutScores:
    """Scores for layouts, by method or by scene.

    Attributes:
        scores: Scores for each method or scene, such as ``["LayoutGPT"]["out_of_bounds"]``.
        skipped: Skipped objects, each with its scene and the reason.
        scenes: Number of scored scenes.
        runs: Number of scored scenes that are reconstructions.
        uses_true_rooms: Whether reconstructions were compared with the ground-truth rooms of a
            scan.
    """

    scores: Mapping[str, Mapping[str, Any]]
    skipped: Sequence[str]
    scenes: int
    runs: int
    uses_true_rooms: bool

    def tables(self) -> tuple[list[list[str]], list[list[str]]]:
        """Return the paper's table and one with other published metrics, both with a header row."""
        from world2minecraft.paper.layouts.score_table import layout_table, other_table

        return layout_table(self.scores), other_table(self.scores)

    def notes(self) -> tuple[str, ...]:
        """Return explanations of the column titles."""
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
    """Score room layouts from any method with the same metrics.

    Boxes are scored before they are converted to blocks. docs/results/layout-baselines.md defines
    out-of-bounds objects and collisions.

    Args:
        layouts: LayoutGPT, I-Design or LayoutVLM files, folders written by ``build_layouts``, and
            finished runs.
        truth: Ground-truth scene for semantic integrity: a scan of a generated room, or a repaired
            run. With a scan, runs are also compared with its rooms.
        by_scene: Return one row per scene instead of one per method.
        format: ``layoutgpt``, ``idesign``, ``layoutvlm``, ``stored`` or ``run``. Detected
            automatically by default.
        px_m: Size of a pixel in metres, for layouts in pixels.
        task: LayoutVLM scene file, if it is not stored next to the layout.
        assets: Folder of LayoutVLM assets, from which object sizes are read.
        progress: Callback that is called after each scene.

    Raises:
        InputError: If a layout cannot be read.
        UsageError: If an argument is invalid.

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
    """Return whether a file contains a layout that ``score_layouts`` supports."""
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
        folder: Run folder with the world, a picture and a short report.
        name: Name of the scene.
        method: Name of the method that created the layout.
        built: Number of objects that were built.
        objects: Number of objects in the layout.
    """

    folder: Path
    name: str
    method: str
    built: int
    objects: int


@dataclass(frozen=True, eq=False)
class BuiltLayouts:
    """The layouts that were built from one file.

    Attributes:
        built: One entry per built scene.
        skipped: Skipped objects, each with its scene and the reason.
        scenes: Number of scenes in the file.
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
    force: bool = False,
    progress: Progress = no_progress,
) -> BuiltLayouts:
    """Build layouts from other methods as Minecraft worlds, without correcting their errors.

    Each layout becomes a run folder. Its original boxes are stored in ``compared.json``, which
    ``score_layouts`` uses for scoring.

    Args:
        layout: A LayoutGPT, I-Design or LayoutVLM file.
        out: Output folder of the world, or the parent folder if several scenes are built.
        scenes: Substrings of the scene names to build. Defaults to the first scene.
        count: Number of scenes to build. Applies to each name in ``scenes``.
        format: ``layoutgpt``, ``idesign`` or ``layoutvlm``. Detected automatically by default.
        px_m: Size of a pixel in metres, for layouts in pixels.
        task: LayoutVLM scene file, if it is not stored next to the layout.
        assets: Folder of LayoutVLM assets, from which object sizes are read.
        blocks_per_metre: Scale of the world.
        force: Write into a folder that contains other files.
        progress: Callback that reports each step.

    Raises:
        InputError: If the layout cannot be read.
        UsageError: If an argument is invalid, or a folder contains other files without ``force``.
        ConflictError: If another process writes a folder.
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.paper.layouts.importers import read_layouts_of
    from world2minecraft.paper.layouts.layout_to_world import build_scene
    from world2minecraft.paper.layouts.scene_selection import folder_names, select_scenes
    from world2minecraft.reconstruction.parameters import Parameters
    from world2minecraft.reconstruction.run_folder import RUN

    how = _how(px_m, task, assets)
    chosen = Parameters(blocks_per_metre=blocks_per_metre)
    found = read_layouts_of(Path(layout), how, format)
    several = count is not None or len(scenes) > 1
    wanted = select_scenes(found, scenes, count)
    places = [Path(out) / name for name in folder_names(wanted)] if several else [Path(out)]
    built = []
    for one, place in zip(wanted, places, strict=True):
        with output_folder(place, RUN, "built", force=force, keep=False):
            made = build_scene(one, place, chosen, progress)
        built.append(BuiltLayout(place, one.name, one.method, made.objects, len(one.objects)))
    return BuiltLayouts(built, skipped_objects(wanted), len(found))


@dataclass(frozen=True, eq=False)
class JudgedRooms:
    """Grades for rooms from a vision-language model.

    Attributes:
        model: Name of the model.
        grades: Grades for each room, with all repeats.
        repeats: Number of times each room was graded.
        cost: Number of requests and tokens and the cost in dollars.
    """

    model: str
    grades: "Sequence[Grades]"
    repeats: int
    cost: Mapping[str, Any]

    @property
    def unread(self) -> int:
        """Number of replies without valid grades."""
        return sum(one.unread for one in self.grades)

    def table(self) -> list[list[str]]:
        """Return the mean grades of each method as a table of strings with a header row."""
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
    """Grade rooms with a vision-language model.

    The model grades realism, completeness and atmosphere from 1 to 10. All rooms are shown from the
    same two corners with the same lighting, without the name of the method.

    Args:
        rooms: Folders written by ``build_layouts``, and finished runs.
        out: Output folder for ``judged.json``, ``replies.jsonl`` and the pictures.
        agent: ``gemini``, ``openai``, ``qwen`` or ``local``, optionally followed by ``:MODEL``, or
            a server address.
        repeats: Number of times each room is graded.
        wish: Description of the intended room, such as the output of ``describe_room``.
        model: Options for the model. By default, the server sets the temperature.
        progress: Callback that is called after each room.

    Raises:
        InputError: If a world cannot be read.
        ServerError: If the model does not reply.
        BudgetError: If a limit on requests or cost is reached.
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
    """Return the text of a room description from a file of at most 16 KiB.

    Raises:
        InputError: If the file cannot be read.
        LimitError: If the file is too large.
    """
    from world2minecraft.core.files import read_bytes

    return read_bytes(path, MAX_WISH_BYTES).decode("utf-8", "replace")


@dataclass(frozen=True)
class RoomDescription:
    """A room in the input format of a text-to-layout method.

    Attributes:
        text: Contents of the input file.
        px_m: Size of a pixel in metres in the layouts that the method will return. Only for
            ``layoutgpt``.
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
    """Describe a room in words, from its boxes with fixed rules or from its photos with a model.

    Args:
        scene: A finished run or a layout. With ``agent`` or ``from_truth``, a capture.
        method: Output format: ``text``, ``layoutgpt``, ``idesign`` or ``layoutvlm``.
        from_truth: Describe the ground truth of a scan of a generated room.
        agent: Model that describes the photos in a capture. Requires the format ``text``.
        photos: Number of photos sent to the model.
        replies: Folder for the model's replies.
        model: Options for the model.

    Raises:
        UsageError: If an argument is invalid.
        InputError: If the scene cannot be read.
        ServerError: If the model does not reply.
        BudgetError: If a limit on requests or cost is reached.

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
        raise UsageError("--agent describes photos, which contain no sizes; it requires --for text")
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
    """Ground truth for a ScanNet scene.

    Attributes:
        scene: Folder of the scene.
        folder: Folder of the ground truth.
        made: Summary of the ground truth.
    """

    scene: Path
    folder: Path
    made: "TruthMade"


def scannet_truths(
    scenes: str | Path, out: str | Path | None = None, *, progress: Progress = no_progress
) -> list[ScanNetTruth]:
    """Create ground truth for ScanNet scenes, so that their reconstructions can be scored.

    Args:
        scenes: A scene from ScanNet's train or val split, or a folder of scenes.
        out: Output folder, or the parent folder if several scenes are given. Defaults to the folder
            of each scene.
        progress: Callback that reports each step.

    Raises:
        InputError: If no scene is found, or a scene file is missing or damaged.
        OutputError: If the folder cannot be written.
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
    """Return a description of each skipped object with its scene and the reason."""
    return tuple(f"{scene.name}: {line}" for scene in scenes for line in scene.skipped)


def _how(
    px_m: float, task: str | Path | None, assets: str | Path | None, truth: Path | None = None
) -> "How":
    """Return the import options that are not stored in the files.

    Raises:
        UsageError: If ``px_m`` is out of range.
    """
    from world2minecraft.paper.layouts.importers import How

    if not 0 < px_m < 1:
        raise UsageError(f"--px-m must be metres per pixel, above 0 and below 1, got {px_m:g}")
    task_file = None if task is None else Path(task)
    return How(px_m, task_file, None if assets is None else Path(assets), truth)


def _grades(
    places: Sequence[Path], chat: Any, out: Path, wish: str, repeats: int, progress: Progress
) -> "list[Grades]":
    """Return the grades for rooms and write their pictures to ``out/pictures``."""
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
