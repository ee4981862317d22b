"""Reconstruct a room from a capture, and build it at any scale and in any style."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.core.types import BlockVolume
    from world2minecraft.reconstruction.parameters import Parameters

Settings = Mapping[str, Any]


@dataclass(frozen=True)
class BuildOptions:
    """Options for building a room from blocks.

    Functions that build a room accept these options as keyword arguments.

    Attributes:
        blocks_per_metre: Scale of the world: 1 is true to size, 4 shows furniture, 12.5 is one
            block per cell of 0.08 m.
        style: ``blocks``, ``display`` (block display entities, which show finer detail) or
            ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: Additional file formats to write, such as ``("litematic", "glb")``.
        mc_version: Minecraft version to write the files for.
        settings: Further parameters by key, such as ``{"build.ceiling": "glass"}``.
            ``w2m.settings()`` lists all keys.
        classes: Class ids of an occupancy grid: ``nyu12`` (the default), ``embodied`` (12 is
            empty), ``occscannet`` or a YAML file of ids and names.
    """

    blocks_per_metre: float = 4.0
    style: str | None = None
    palette: str | Path | None = None
    formats: Sequence[str] = ()
    mc_version: str = "1.20.1"
    settings: Settings | None = None
    classes: str | Path = ""

    def parameters(self, base: "Parameters | None" = None) -> "Parameters":
        """Return reconstruction parameters with these options applied.

        Args:
            base: Parameters to start from. Uses the default parameters if None.

        Raises:
            UsageError: If a value is out of range.
            UnknownNameError: If a style, palette, format or setting is unknown.
            InputError: If the palette file cannot be read.
        """
        from dataclasses import replace

        from world2minecraft.reconstruction.parameters import Parameters, with_settings

        chosen = replace(
            base or Parameters(),
            blocks_per_metre=self.blocks_per_metre,
            mc_version=self.mc_version,
        )
        named = {
            "build.style": self.style,
            "build.palette": _checked_palette(self.palette),
            "formats": ",".join(self.formats) or None,
        }
        settings = {key: value for key, value in named.items() if value is not None}
        settings |= self.settings or {}
        return with_settings(chosen, [f"{key}={value}" for key, value in settings.items()])


def reconstruct(
    capture: str | Path,
    out: str | Path,
    *,
    labels: str | Path | None = None,
    method: str = "best",
    voxel_m: float = 0.08,
    blocks_per_metre: float = 4.0,
    style: str | None = None,
    palette: str | Path | None = None,
    formats: Sequence[str] = (),
    mc_version: str = "1.20.1",
    known: tuple[str, float] | None = None,
    known_points: tuple[str, str, float] | None = None,
    fov_deg: float | None = None,
    plan: str | Path | None = None,
    depth_model: str = "",
    semantics: str = "auto",
    predictor: str = "depth",
    predictions: str | Path | None = None,
    convention: str = "",
    classes: str | Path = "",
    labeller: str = "auto",
    start: str | None = None,
    follow: bool = False,
    follow_idle_s: float = 60.0,
    settings: Settings | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> Run:
    """Convert a capture of a room to a Minecraft world with a report (Algorithm 1 of the paper).

    Call the function again with the same arguments to resume an interrupted run after its last
    completed stage.

    Args:
        capture: Photos, a video, the export of a scanning app, RGB-D frames, a mesh, a point cloud
            or a RoomPlan file. ``docs/reference/capture-formats.md`` lists all formats.
        out: Output folder.
        labels: Folder with one 2D label image per frame.
        method: ``best``, or ``paper`` to use only the steps in the paper.
        voxel_m: Cell size in metres.
        blocks_per_metre: Scale of the world.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: Additional file formats to write, such as ``("litematic", "glb")``.
        mc_version: Minecraft version of the world.
        known: Known length that sets the scale of photos, such as ``("table height", 0.72)``.
        known_points: Two pixels, such as ``"a.jpg:120,80"``, and the distance between them in
            metres.
        fov_deg: Vertical field of view in degrees for a single photo without EXIF data.
        plan: RoomPlan file of the same room to use as additional evidence.
        depth_model: Depth estimation network, such as ``hf:ORG/NAME``.
        semantics: Segmentation network that names what images show: ``auto`` or ``nyu`` for the
            built-in one, ``generated`` for one that saw generated rooms alone, ``none``, or an id
            such as ``hf:ORG/NAME``.
        predictor: ``depth``, or ``mono:FILE.onnx`` for a monocular occupancy network.
        predictions: Grids that another network predicted: a folder with one file per view, or one
            file for the whole scene. ``docs/reference/prediction-files.md`` describes the files.
        convention: Axes of the predictions: ``w2m``, ``monoscene``, ``iso``, ``embodiedocc`` or
            ``sscnet``. Detected where the files leave no doubt.
        classes: Class ids of the predictions: ``nyu12``, ``embodied``, ``occscannet`` or a YAML
            file. Detected by default.
        labeller: ``auto``, ``completion``, ``votes`` or ``geometric``.
        start: Stage to restart from. Requires an output folder with an earlier run.
        follow: Watch a capture that is still being recorded until a file named ``done`` appears.
        follow_idle_s: Seconds to wait for a new frame before the capture is considered complete.
        settings: Further parameters, such as ``{"find.cluster_radius": 3}``.
        force: Write into a folder that contains other files, the reconstruction of another
            capture, or edits saved in SceneForge.
        progress: Callback that receives the stage, the number of completed steps, the total number
            of steps and a note.

    Returns:
        The run with its room, objects, world and report.

    Raises:
        UsageError: If an argument is invalid, or something in the folder would be lost without
            ``force``.
        ConflictError: If another process writes the folder.
        CaptureError: If the capture cannot be used.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> run = w2m.reconstruct(scan, tmp / "out")
        >>> run.objects[0].name, run.world.is_dir()
        ('...', True)
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.reconstruction.parameters import Parameters, with_method
    from world2minecraft.reconstruction.run_folder import RUN

    base = Parameters(
        voxel_m,
        predictor=predictor,
        labeller=labeller,
        known=known,
        known_points=known_points,
        depth_model=depth_model,
        plan="" if plan is None else str(plan),
    )
    network = None if semantics == "auto" else semantics
    named = {"occupy.semantics": network, "capture.fov_deg": fov_deg}
    given = {key: value for key, value in named.items() if value is not None}
    given |= _prediction_settings(predictions, convention, classes)
    options = BuildOptions(
        blocks_per_metre, style, palette, formats, mc_version, given | dict(settings or {})
    )
    chosen = options.parameters(with_method(base, method))
    _check_stage(start, follow, chosen)
    needs_frames = {"start": start, "labels": labels, "follow": follow}
    place, folder = Path(capture), Path(out)
    with output_folder(folder, RUN, "reconstructed", force=force, source=place):
        if not _build_lone_plan(place, folder, chosen, needs_frames, progress):
            label_folder = None if labels is None else Path(labels)
            idle_s = follow_idle_s if follow else None
            _reconstruct_frames(place, folder, chosen, start, label_folder, idle_s, force, progress)
    return Run(folder)


def _reconstruct_frames(
    capture: Path,
    out: Path,
    chosen: "Parameters",
    start: str | None,
    labels: Path | None,
    idle_s: float | None,
    force: bool,
    progress: Progress,
) -> None:
    """Reconstruct frames, after following their recording unless ``idle_s`` is None."""
    from world2minecraft.core.precompile import compile_first
    from world2minecraft.reconstruction import online
    from world2minecraft.runs import run_capture

    _check_replaced(capture, out, start, force)
    if idle_s is not None:
        compiled = compile_first(progress)
        online.follow(capture, out, chosen, labels=labels, idle_s=idle_s, progress=compiled)
    run_capture(capture, out, chosen, start, labels, progress)


def _check_replaced(capture: Path, out: Path, start: str | None, force: bool) -> None:
    """Check that no finished run of another capture and no saved edits are lost without ``force``.

    With ``force``, a copy of the other capture in the output folder is removed too.

    Raises:
        UsageError: If something would be lost.
    """
    import shutil

    from world2minecraft.core.errors import UsageError
    from world2minecraft.reconstruction.run_folder import is_run_of_another
    from world2minecraft.sceneforge.document.document_metadata import holds_saved_edits

    if start is None and capture.exists() and is_run_of_another(capture, out):
        if not force:
            raise UsageError(
                f"{out} contains the reconstruction of another capture, or of this one before its "
                "files changed; choose another folder, or use --force to replace it"
            )
        copy = out / "capture"
        if copy.is_dir() and not capture.resolve().is_relative_to(copy.resolve()):
            shutil.rmtree(copy)
    if start not in ("build", "report") and not force and holds_saved_edits(out):
        raise UsageError(
            f"{out} contains edits saved in SceneForge, which would be lost; choose another "
            "folder, keep them with start 'build' (--from build), or use --force"
        )


def build(
    source: "Run | str | Path",
    out: str | Path,
    *,
    blocks_per_metre: float = 4.0,
    style: str | None = None,
    palette: str | Path | None = None,
    formats: Sequence[str] = (),
    mc_version: str = "1.20.1",
    classes: str | Path = "",
    settings: Settings | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> Run:
    """Build a new world from a run or an occupancy grid.

    The objects and placements of a run are used unchanged. For an occupancy grid, objects are
    detected and matched with furniture first. If the build fails, the folder is unchanged.

    Args:
        source: Run, run folder, ``room.npz``, ``occ.json``, or a ``.npy`` file of class ids [X, Y,
            Z].
        out: Output folder. Must differ from the source folder.
        blocks_per_metre: Scale of the world.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: Additional file formats to write, such as ``("litematic", "glb")``.
        mc_version: Minecraft version of the world.
        classes: Class ids of an occupancy grid: ``nyu12`` (the default), ``embodied`` (12 is
            empty), ``occscannet`` or a YAML file of ids and names.
        settings: Further parameters, such as ``{"build.ceiling": "glass"}``.
        force: Write into a folder that contains other files.
        progress: Callback that reports the progress of each stage.

    Raises:
        UsageError: If an argument is invalid, or the folder contains other files without ``force``.
        ConflictError: If another process writes the folder.
        InputError: If the source cannot be read.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> smaller = w2m.build(run, tmp / "small", blocks_per_metre=2)
        >>> smaller.blocks.blocks_per_metre
        2.0
    """
    from world2minecraft.reconstruction.build_without_capture import rebuild

    options = BuildOptions(blocks_per_metre, style, palette, formats, mc_version, settings)
    chosen = options.parameters()
    rebuild(path_of(source), Path(out), chosen, progress, str(classes), force)
    return Run(Path(out))


def path_of(source: "Run | str | Path") -> Path:
    """Return the folder of a run, or a given path unchanged."""
    return source.folder if isinstance(source, Run) else Path(source)


def _checked_palette(palette: str | Path | None) -> str | None:
    """Return the name of a palette or the path of its file after loading it once as a check."""
    if palette is None:
        return None
    from world2minecraft.construction.palettes import load_palette

    load_palette(str(palette))
    return str(Path(palette).resolve()) if Path(palette).is_file() else str(palette)


def _prediction_settings(
    predictions: str | Path | None, convention: str, classes: str | Path
) -> dict[str, str]:
    """Return the settings of saved predictions, without those that are not given."""
    settings = {
        "predictions.path": "" if predictions is None else str(predictions),
        "predictions.convention": convention,
        "predictions.classes": str(classes),
    }
    return {key: value for key, value in settings.items() if value}


def _check_stage(start: str | None, follow: bool, chosen: "Parameters") -> None:
    """Raise UsageError if a stage is unknown, or if options cannot be combined."""
    from world2minecraft.reconstruction.pipeline import STAGES

    path = chosen.predictions.path
    if follow and path:
        raise UsageError("follow cannot be combined with predictions; omit one of them")
    if not path and start is None and chosen.predictions != type(chosen.predictions)():
        raise UsageError(
            "classes and convention describe predictions; add some (--predictions DIR)"
        )
    if follow and start is not None:
        raise UsageError("follow cannot be combined with a start stage (--from); omit one of them")
    stages = (*STAGES, "report")
    if start is not None and start not in stages:
        raise UnknownNameError("stage", start, stages)


def _build_lone_plan(
    capture: Path,
    out: Path,
    chosen: "Parameters",
    needs_frames: dict[str, Any],
    progress: Progress,
) -> bool:
    """Build a RoomPlan without frames, and return whether the capture is a RoomPlan.

    Raises:
        UsageError: If arguments are given that require frames.
    """
    from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
    from world2minecraft.reconstruction.opening import scene_name
    from world2minecraft.runs import run_plan

    plan = find_lone_roomplan(capture)
    if plan is None:
        return False
    given = needs_frames | {"predictions": chosen.predictions.path}
    if any(given.values()):
        names = [name for name, value in given.items() if value]
        options = " and ".join(f"--{'from' if name == 'start' else name}" for name in names)
        raise UsageError(f"{capture} is a RoomPlan without frames; omit {options}")
    run_plan(plan, out, chosen, progress, scene_name(capture))
    return True


def blocks_of(
    source: "Run | str | Path", options: BuildOptions, progress: Progress = no_progress
) -> "BlockVolume":
    """Return the blocks that ``build`` would write, without writing any files.

    Raises:
        UsageError: If an option is invalid.
        InputError: If the source cannot be read.
    """
    from world2minecraft.reconstruction.build_without_capture import blocks_of as read_or_build

    chosen = options.parameters()
    return read_or_build(path_of(source), chosen, progress, str(options.classes))
