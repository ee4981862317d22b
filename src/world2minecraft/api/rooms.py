"""Rooms: reconstruct one from a capture, and build it at any scale and in any style."""

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
    """How a room becomes blocks; every function that builds takes these by name.

    Attributes:
        blocks_per_metre: the scale: 1 is true size, 4 shows furniture, 12.5 is a block per cell.
        style: ``blocks``, ``display`` (block display entities, finer) or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: further files of the build, such as ``("litematic", "glb")``.
        mc_version: the game version that the files are written for.
        settings: further parameters by their keys, such as ``{"build.ceiling": "glass"}``;
            ``w2m.settings()`` lists them all.
    """

    blocks_per_metre: float = 4.0
    style: str | None = None
    palette: str | Path | None = None
    formats: Sequence[str] = ()
    mc_version: str = "1.20.1"
    settings: Settings | None = None

    def parameters(self, base: "Parameters | None" = None) -> "Parameters":
        """Return ``base``, or the defaults, with these options.

        Raises:
            UsageError: a value is out of range. UnknownNameError: a style, a palette, a format or
            a setting is not known. InputError: the palette's file cannot be read.
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
    semantics: str = "",
    predictor: str = "depth",
    labeller: str = "auto",
    start: str | None = None,
    follow: bool = False,
    follow_idle_s: float = 60.0,
    settings: Settings | None = None,
    progress: Progress = no_progress,
) -> Run:
    """Turn a capture of a room into a Minecraft world, with a report (Algorithm 1 of the paper).

    A run that was interrupted continues after its last finished stage when it is called again
    with the same arguments.

    Args:
        capture: photos, a video, the export of a scanning app, RGB-D frames, a mesh, a point cloud
            or a RoomPlan; ``docs/captures.md`` lists them.
        out: the folder to write.
        labels: a folder of 2D label images, one for each frame.
        method: ``best``, or ``paper`` for the steps of the paper alone.
        voxel_m: the side of a cell in metres.
        blocks_per_metre: the scale of the world.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: further files of the build, such as ``("litematic", "glb")``.
        mc_version: the game version that the world is written for.
        known: a length that gives photos their scale, such as ``("table height", 0.72)``.
        known_points: two pixels, such as ``"a.jpg:120,80"``, and the metres between them.
        fov_deg: the vertical field of view of a single photo, where it has no EXIF.
        plan: a RoomPlan of the same room, as further evidence.
        depth_model: a network for the depth of pictures, such as ``hf:ORG/NAME``.
        semantics: a segmentation network, such as ``hf:ORG/NAME``.
        predictor: ``depth``, or ``mono:FILE.onnx`` for a monocular occupancy network.
        labeller: ``auto``, ``completion``, ``votes`` or ``geometric``.
        start: the stage to start from, in a folder that holds an earlier run.
        follow: watch a capture that still grows, until a file named ``done`` appears.
        follow_idle_s: the seconds without a new frame after which following ends.
        settings: further parameters, such as ``{"find.cluster_radius": 3}``.
        progress: called at each step with the stage, the steps done, all steps and a note.

    Returns:
        The run: its room, objects, world and report.

    Raises:
        UsageError: an argument is wrong. CaptureError: the capture cannot be used.
        OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> run = w2m.reconstruct(scan, tmp / "out")
        >>> run.objects[0].name, run.world.is_dir()
        ('...', True)
    """
    from world2minecraft.reconstruction.parameters import Parameters, with_method
    from world2minecraft.runs import run_capture

    base = Parameters(
        voxel_m,
        predictor=predictor,
        labeller=labeller,
        known=known,
        known_points=known_points,
        depth_model=depth_model,
        plan="" if plan is None else str(plan),
    )
    named = {"occupy.semantics": semantics or None, "capture.fov_deg": fov_deg}
    given = {key: value for key, value in named.items() if value is not None}
    options = BuildOptions(
        blocks_per_metre, style, palette, formats, mc_version, given | dict(settings or {})
    )
    chosen = options.parameters(with_method(base, method))
    _check_stage(start, follow)
    place, folder = Path(capture), Path(out)
    label_folder = None if labels is None else Path(labels)
    needs_frames = {"start": start, "labels": labels, "follow": follow}
    if _build_lone_plan(
        place, folder, chosen, [name for name in needs_frames if needs_frames[name]], progress
    ):
        return Run(folder)
    if follow:
        from world2minecraft.reconstruction import online

        online.follow(
            place, folder, chosen, labels=label_folder, idle_s=follow_idle_s, progress=progress
        )
    run_capture(place, folder, chosen, start, label_folder, progress)
    return Run(folder)


def build(
    source: "Run | str | Path",
    out: str | Path,
    *,
    blocks_per_metre: float = 4.0,
    style: str | None = None,
    palette: str | Path | None = None,
    formats: Sequence[str] = (),
    mc_version: str = "1.20.1",
    settings: Settings | None = None,
    progress: Progress = no_progress,
) -> Run:
    """Build a world of its own from a run or from an occupancy grid.

    A run is built from its objects and placements as they are. Of a grid alone the objects are
    detected and matched first.

    Args:
        source: a run or its folder; or ``room.npz``, ``occ.json``, or a ``.npy`` of class ids
            [X, Y, Z].
        out: the folder to write, another than the source.
        blocks_per_metre: the scale of the world.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: further files of the build, such as ``("litematic", "glb")``.
        mc_version: the game version that the world is written for.
        settings: further parameters, such as ``{"build.ceiling": "glass"}``.
        progress: called at each step.

    Raises:
        UsageError: an argument is wrong. InputError: the source cannot be read.
        OutputError: the folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> smaller = w2m.build(run, tmp / "small", blocks_per_metre=2)
        >>> smaller.blocks.blocks_per_metre
        2.0
    """
    from world2minecraft.reconstruction.build_without_capture import rebuild

    options = BuildOptions(blocks_per_metre, style, palette, formats, mc_version, settings)
    rebuild(path_of(source), Path(out), options.parameters(), progress)
    return Run(Path(out))


def path_of(source: "Run | str | Path") -> Path:
    """Return the folder of a run, or the path that was given."""
    return source.folder if isinstance(source, Run) else Path(source)


def _checked_palette(palette: str | Path | None) -> str | None:
    """Return a palette's name or the path of its file; read it once, to find faults early."""
    if palette is None:
        return None
    from world2minecraft.construction.palettes import load_palette

    load_palette(str(palette))
    return str(Path(palette).resolve()) if Path(palette).is_file() else str(palette)


def _check_stage(start: str | None, follow: bool) -> None:
    """Raise UsageError, before any work, where a stage is not known or cannot be started from."""
    from world2minecraft.reconstruction.pipeline import STAGES

    if follow and start is not None:
        raise UsageError("--follow reads a whole capture; leave out --from")
    stages = (*STAGES, "report")
    if start is not None and start not in stages:
        raise UnknownNameError("stage", start, stages)


def _build_lone_plan(
    capture: Path,
    out: Path,
    chosen: "Parameters",
    needs_frames: list[str],
    progress: Progress,
) -> bool:
    """Build a RoomPlan that has no frames; return whether the capture is one.

    Raises:
        UsageError: arguments are given that need frames.
    """
    from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
    from world2minecraft.reconstruction.opening import scene_name
    from world2minecraft.runs import run_plan

    plan = find_lone_roomplan(capture)
    if plan is None:
        return False
    if needs_frames:
        options = " and ".join(f"--{'from' if one == 'start' else one}" for one in needs_frames)
        raise UsageError(f"{capture} is a RoomPlan and has no frames; leave out {options}")
    run_plan(plan, out, chosen, progress, scene_name(capture))
    return True


def blocks_of(
    source: "Run | str | Path", options: BuildOptions, progress: Progress = no_progress
) -> "BlockVolume":
    """Return the blocks that ``build`` would write; nothing is written.

    Raises:
        UsageError: an option is wrong. InputError: the source cannot be read.
    """
    from world2minecraft.reconstruction.build_without_capture import blocks_of as read_or_build

    return read_or_build(path_of(source), options.parameters(), progress)
