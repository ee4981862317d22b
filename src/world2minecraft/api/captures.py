"""Inspect and segment captures before a reconstruction, and join finished runs to a home."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.api.results import Run
from world2minecraft.api.rooms import BuildOptions, Settings, path_of
from world2minecraft.core.errors import OutputError, UnknownNameError, UsageError
from world2minecraft.core.output_folders import FolderKind
from world2minecraft.core.progress import Progress, no_progress

if TYPE_CHECKING:
    from world2minecraft.capture import CaptureSummary
    from world2minecraft.formats.roomplan import CapturedPlan
    from world2minecraft.reconstruction.recognition.label_folder import LabelledFolder


LABELS = FolderKind({}, ("*.png", "*.overlay.jpg"))
SHOWN_CLASSES = 6


@dataclass(frozen=True, eq=False)
class CaptureReport:
    """The contents and shortcomings of a capture, with the command that reconstructs it.

    Attributes:
        path: Path of the capture.
        summary: Frames, cameras, depth and poses. None for a RoomPlan without frames.
        plan: The RoomPlan. None unless the capture is a RoomPlan without frames.
    """

    path: Path
    summary: "CaptureSummary | None" = None
    plan: "CapturedPlan | None" = None

    @property
    def lines(self) -> list[str]:
        """The report as lines of text, ending with the command that reconstructs the capture."""
        from world2minecraft.capture.summary import roomplan_lines, summary_lines

        if self.plan is not None:
            return roomplan_lines(self.path, self.plan)
        return [] if self.summary is None else summary_lines(self.summary)

    def to_json(self) -> dict[str, Any]:
        """Return the report as JSON values."""
        from world2minecraft.capture.summary import summary_to_json

        return {"lines": self.lines} if self.summary is None else summary_to_json(self.summary)

    def save_picture(self, path: str | Path, replace: bool = True) -> Path:
        """Write a PNG overview with sample frames, camera positions and a preliminary floor plan.

        Args:
            path: Image file to write.
            replace: Whether to replace an existing file that is not such an overview.

        Raises:
            UsageError: If the capture is a RoomPlan without frames.
            OutputError: If the file cannot be written, or exists and must not be replaced.
        """
        from world2minecraft.capture.poster import is_poster, poster_png
        from world2minecraft.core.files import write_bytes

        place = Path(path)
        if self.summary is None:
            raise UsageError(
                f"{self.path} is a RoomPlan without frames, so it has no overview image"
            )
        if not replace and place.exists() and not is_poster(place):
            raise OutputError(place, "already exists and was not written by w2m scan")
        write_bytes(place, poster_png(self.summary))
        return place

    def __str__(self) -> str:
        return "\n".join(self.lines)


@dataclass(frozen=True, eq=False)
class CaptureLabels:
    """The label images that were written for a capture, with the command that uses them.

    Attributes:
        capture: Path of the capture.
        network: Name of the network.
        written: Folder, names of the labelled and of the skipped frames, and shares of the classes.
    """

    capture: Path
    network: str
    written: "LabelledFolder"

    @property
    def next_command(self) -> str:
        """The command that reconstructs the capture with its label images."""
        from world2minecraft.capture.summary import shell_command

        words = ["w2m", "reconstruct", str(self.capture), "--out", "OUT"]
        return shell_command([*words, "--labels", str(self.written.folder)])

    @property
    def lines(self) -> list[str]:
        """The result as lines of text, ending with the command that uses the label images."""
        count, skipped = len(self.written.names), self.written.skipped
        named = [(name, share) for name, share in self.written.shares.items() if name != "unknown"]
        most = ", ".join(f"{name} {share:.0%}" for name, share in named[:SHOWN_CLASSES])
        return [
            *(f"skipped {name}: {reason}" for name, reason in skipped),
            f"{self.written.folder}: {count} label image{'s' * (count != 1)}"
            + (f"; {most}" if most else "; all pixels are unknown"),
            f"next: {self.next_command}",
        ]

    def to_json(self) -> dict[str, Any]:
        """Return the result as JSON values."""
        return {
            "folder": str(self.written.folder),
            "network": self.network,
            "frames": list(self.written.names),
            "skipped": [list(row) for row in self.written.skipped],
            "shares": self.written.shares,
            "next": self.next_command,
        }

    def __str__(self) -> str:
        return "\n".join(self.lines)


def inspect_capture(capture: str | Path, *, settings: Settings | None = None) -> CaptureReport:
    """Report the contents and shortcomings of a capture within seconds, without reconstructing it.

    Args:
        capture: Photos, a video, the export of a scanning app, RGB-D frames, a mesh, a point cloud
            or a RoomPlan file.
        settings: Options of the capture reader, such as ``{"capture.depth_unit": "mm"}``.

    Raises:
        UsageError: If a setting is invalid.
        CaptureError: If the capture cannot be read.

    Example:
        >>> import world2minecraft as w2m
        >>> report = w2m.inspect_capture(scan)
        >>> report.summary.usable
        12
        >>> print(report)
        /...: posed RGB-D frames (plain), 12 of 12 frames usable
        ...
    """
    from world2minecraft.capture import describe_capture
    from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
    from world2minecraft.formats.roomplan import read_roomplan

    place = Path(capture)
    options = _reader_options(settings)
    plan = find_lone_roomplan(place)
    if plan is not None:
        return CaptureReport(place, plan=read_roomplan(plan))
    return CaptureReport(place, describe_capture(place, options=options))


def segment_capture(
    capture: str | Path,
    out: str | Path,
    *,
    semantics: str = "nyu",
    min_probability: float = 0.0,
    overlay: bool = False,
    force: bool = False,
    settings: Settings | None = None,
    progress: Progress = no_progress,
) -> CaptureLabels:
    """Write a label image for each colour image of a capture, with or without camera poses.

    Each label image ``NAME.png`` has the name of its frame and the size of the colour image, uint8
    with NYU40 ids from 1 to 40, and 0 for unknown. The folder can be passed to ``reconstruct`` as
    ``labels``.

    Args:
        capture: Photos, a video, the export of a scanning app or RGB-D frames.
        out: Output folder.
        semantics: ``nyu``, or ``generated`` for the network trained on generated rooms alone.
        min_probability: Pixels whose most likely class is less likely than this are unknown, 0 to
            1.
        overlay: Whether to write ``NAME.overlay.jpg`` as well: the image in the colours of its
            classes, with a legend.
        force: Whether to write into a folder that contains files, and replace those of the same
            names.
        settings: Options of the capture reader, such as ``{"capture.every": "10"}``.
        progress: Callback that reports the progress.

    Returns:
        The names of the labelled and of the skipped frames, and the shares of the classes.

    Raises:
        UsageError: If an argument is invalid, or the folder contains files without ``force``.
        UnknownNameError: If the network is unknown.
        CaptureError: If the capture cannot be read or has no colour images.
        OutputError: If a file cannot be written.

    Example:
        >>> from world2minecraft.api.captures import segment_capture
        >>> segment_capture(scan, tmp / "labels", semantics="ade")
        Traceback (most recent call last):
        ...
        world2minecraft.core.errors.UnknownNameError: no network is named 'ade'; ...
    """
    from world2minecraft.capture.options import parse_options
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.reconstruction.recognition.label_folder import write_label_images
    from world2minecraft.reconstruction.recognition.segmentation import (
        GENERATED_WEIGHTS,
        WEIGHTS,
        SegmentationModel,
    )

    weights = {"nyu": WEIGHTS, "generated": GENERATED_WEIGHTS}
    if semantics not in weights:
        raise UnknownNameError("network", semantics, weights)
    if not 0 <= min_probability <= 1:
        raise UsageError(
            f"min_probability (--min-probability) must be from 0 to 1, got {min_probability}"
        )
    options = parse_options(_reader_options(settings))
    source, place = Path(capture), Path(out)
    _check_no_roomplan(source)
    with output_folder(place, LABELS, "written", force=force, keep=False):
        written = write_label_images(
            source,
            place,
            SegmentationModel(weights[semantics]),
            network=semantics,
            options=options,
            min_probability=min_probability,
            overlay=overlay,
            progress=progress,
        )
    return CaptureLabels(source, semantics, written)


def _reader_options(settings: Settings | None) -> Mapping[str, str]:
    """Return the options of the capture reader in settings by key."""
    from world2minecraft.reconstruction.parameters import Parameters, with_settings

    chosen = [f"{key}={value}" for key, value in (settings or {}).items()]
    return with_settings(Parameters(), chosen).capture


def _check_no_roomplan(capture: Path) -> None:
    """Raise CaptureError if a capture is a RoomPlan without frames."""
    from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
    from world2minecraft.core.errors import CaptureError

    if find_lone_roomplan(capture) is not None:
        raise CaptureError(
            capture,
            "is a RoomPlan without frames, which has no pictures to segment; w2m reconstruct "
            "builds it as measured",
        )


def join_rooms(
    rooms: Sequence[Run | str | Path],
    out: str | Path,
    *,
    places: Sequence[str] = (),
    blocks_per_metre: float = 4.0,
    style: str | None = None,
    palette: str | Path | None = None,
    formats: Sequence[str] = (),
    mc_version: str = "1.20.1",
    settings: Settings | None = None,
    force: bool = False,
    progress: Progress = no_progress,
) -> Run:
    """Join finished runs of single rooms to one home with one world.

    The first room keeps its position. Each further room is placed where one of its doors meets a
    door of the same width and height in a room that is already placed, with a wall between the
    doors. Rooms are rotated by quarter turns and moved by whole cells, so no room is resampled.

    Args:
        rooms: At least two runs or run folders.
        out: Output folder.
        places: Positions of rooms that should not be placed automatically, as ``NAME=X,Y,TURNS``:
            metres in the frame of the first room, and quarter turns.
        blocks_per_metre: Scale of the world.
        style: ``blocks``, ``display`` or ``voxels``.
        palette: ``vanilla``, the palette of a mod, or a YAML file.
        formats: Additional file formats to write, such as ``("litematic", "glb")``.
        mc_version: Minecraft version of the world.
        settings: Further parameters by key.
        force: Write into a folder that contains other files.
        progress: Callback that reports the progress of each stage.

    Returns:
        The run of the home.

    Raises:
        UsageError: If an argument is invalid, if a room fits in no position or in several, or if
            the folder contains other files without ``force``.
        ConflictError: If another process writes the folder.
        InputError: If a run cannot be read.
        OutputError: If the output folder cannot be written.

    Example:
        >>> import world2minecraft as w2m
        >>> w2m.join_rooms([run], tmp / "home")
        Traceback (most recent call last):
        ...
        world2minecraft.core.errors.UsageError: expected 2 to 50 finished runs to join, got 1
    """
    from world2minecraft.core.output_folders import output_folder
    from world2minecraft.evaluation.report import write_brief_report
    from world2minecraft.reconstruction.homes import join
    from world2minecraft.reconstruction.run_folder import RUN

    options = BuildOptions(blocks_per_metre, style, palette, formats, mc_version, settings)
    folders, folder = [path_of(room) for room in rooms], Path(out)
    with output_folder(folder, RUN, "joined", force=force, keep=False):
        scan = join(folders, folder, options.parameters(), places, progress)
        progress("report", 0, 1)
        write_brief_report(folder, scan, _report_links(folders, folder))
        progress("report", 1, 1)
    return Run(folder)


def _report_links(rooms: Sequence[Path], out: Path) -> list[tuple[str, str]]:
    """Return the name of each room that has a report, and its address relative to the home's."""
    links = []
    for folder in rooms:
        page = folder / "report.html"
        if page.is_file():
            try:
                address = os.path.relpath(page.resolve(), out.resolve())
            except ValueError:  # Windows: on another drive.
                address = page.resolve().as_uri()
            links.append((folder.resolve().name, address.replace(os.sep, "/")))
    return links
