"""Online mode: frames arrive one by one, and the map is available at any time.

``LiveRoom`` is given views; ``follow`` watches a growing capture folder. The room is located in the
frames again whenever their number has doubled, by the stages of the batch mode, and the map is
rebuilt from all frames. In between, each frame is fused as it arrives. The total work is about
twice that of the batch mode for any number of frames. The final result is that of ``reconstruct``.
"""

import io
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture import open_scan, realign, write_plain
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.view_stream import read_view
from world2minecraft.construction import build_volume
from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.core.files import read_json, write_bytes, write_json
from world2minecraft.core.output_folders import check_writable
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import FusedEvidence, Scan, View
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.reconstruction.file_stages import label_grid
from world2minecraft.reconstruction.fusion import EvidenceMap, extract_grid, remove_floaters
from world2minecraft.reconstruction.occupancy import predictor
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct
from world2minecraft.reconstruction.registration import apply_corrections, register
from world2minecraft.rendering.preview import preview

FIRST_PLACING = 4  # Fewer frames rarely show two walls and a floor.
POLL_S = 1.0
SHOW_S = 5.0
IDLE_S = 60.0
DONE_FILE = "done"  # Written to the capture after the last frame.
PREVIEW_PX = (960, 720)


class LiveMap:
    """The map of the frames so far, in the frame of the latest room location."""

    def __init__(self, parameters: Parameters):
        self.parameters = parameters
        self.scan: Scan | None = None
        self.frames = 0
        self._next = FIRST_PLACING
        self._predictor = predictor(parameters.predictor, parameters.occupy)
        self._map = EvidenceMap(np.eye(4), parameters.fuse)

    @property
    def due(self) -> bool:
        """Whether the room should be located again before more frames are added."""
        return self.frames >= self._next

    def add(self, view: View) -> None:
        """Fuse a view into the current map."""
        self.frames += 1
        placed = np.eye(4) if self.scan is None else self.scan.scan_to_room
        for item in self._predictor.predict(_scan_of(view, placed)):
            self._map.add(item)

    def place(self, capture: Path, labels: Path | None = None) -> bool:
        """Locate the room in the frames of a capture so far, and fuse all frames in its frame.

        Returns:
            Whether the room was found; otherwise the map is not changed.
        """
        self._next = 2 * max(self.frames, FIRST_PLACING // 2)
        try:
            scan = open_registered(capture, self.parameters, labels)
        except InputError:
            return False
        map_ = EvidenceMap(scan.scan_to_room, self.parameters.fuse)
        for item in self._predictor.predict(scan):
            map_.add(item)
        self.scan, self._map = scan, map_
        return True

    def fused(self) -> FusedEvidence:
        """Return the current map; before the room is located, it is in the frame of the scan.

        Raises:
            CaptureError: If no frame has evidence yet.
        """
        return self._map.fused()


class LiveRoom:
    """A reconstruction that is given its views one by one.

    The frames are stored in ``out/frames`` as a capture with lossless depth, so the memory does not
    depend on their number and the final result can be computed from all frames.
    """

    def __init__(self, out: Path, parameters: Parameters | None = None):
        """Start a room.

        Args:
            out: Output folder; created if missing.
            parameters: Parameters of ``reconstruct``.

        Raises:
            OutputError: If the folder cannot be written.
            UsageError: If the folder already contains frames.
        """
        self.out, self.parameters = Path(out), parameters or Parameters()
        self.frames_folder = self.out / "frames"
        if self.frames_folder.exists():
            raise UsageError(
                f"{self.frames_folder} contains frames of another run; remove the folder"
            )
        check_writable(self.out)
        self._live = LiveMap(self.parameters)
        self._stated: dict[str, Any] = {}
        self._entries: list[dict[str, Any]] = []
        self._names: set[str] = set()

    def add(self, view: View) -> None:
        """Store a view and fuse it.

        Raises:
            UsageError: If a view with this name was already added.
            OutputError: If the view cannot be stored.
        """
        if view.name in self._names:
            raise UsageError(f"view names must be unique, but {view.name!r} was already added")
        self._names.add(view.name)
        self._keep(view)
        self._live.add(view)
        if self._live.due:
            self._write_capture()
            self._live.place(self.frames_folder)

    def fused(self) -> FusedEvidence:
        """Return the current map.

        Raises:
            CaptureError: If no view has evidence yet.
        """
        return self._live.fused()

    def show(self) -> None:
        """Write ``room.npz`` and ``preview.png`` of the current map."""
        show(self._live, self.out)

    def finish(self, progress: Progress = no_progress) -> Scan:
        """Run the batch mode on all frames and replace the intermediate results.

        Raises:
            CaptureError: If the frames cannot be used.
            OutputError: If the folder cannot be written.
        """
        self._write_capture()
        return reconstruct(self.frames_folder, self.out, self.parameters, progress=progress)

    def _keep(self, view: View) -> None:
        """Write the images of a view and record its entry for ``capture.json``."""
        write_plain(self.frames_folder, [view], depth_unit="m")
        stated = read_json(self.frames_folder / "capture.json")
        (entry,) = stated.pop("frames")
        self._stated = self._stated or stated
        # Values that differ from those of the first view are stated in the entry of this view.
        entry |= {key: value for key, value in stated.items() if self._stated.get(key) != value}
        self._entries.append(entry)

    def _write_capture(self) -> None:
        write_json(self.frames_folder / "capture.json", self._stated | {"frames": self._entries})


def open_registered(capture: Path, chosen: Parameters, labels: Path | None) -> Scan:
    """Open a capture as a registered and aligned scan, by the stages of the batch mode.

    Raises:
        CaptureError: If the capture cannot be used.
    """
    options = {"voxel_m": chosen.voxel_m, "labels": labels, "options": chosen.capture}
    scan = open_scan(capture, **options)
    found = register(scan, chosen.register)
    return realign(apply_corrections(scan, found.corrections), found.surface)


def show(live: LiveMap, out: Path) -> None:
    """Write ``room.npz`` and ``preview.png`` of a map, each atomically.

    Objects are not replaced by furniture yet; their cells are built instead.

    Raises:
        CaptureError: If no frame has evidence yet.
        OutputError: If the folder cannot be written.
    """
    chosen, evidence = live.parameters, live.fused()
    grid = label_grid(remove_floaters(extract_grid(evidence), chosen.clean), evidence, chosen)
    write_room(out / "room.npz", grid, evidence.scan_to_room)
    volume = build_volume(
        grid, (), (), blocks_per_metre=chosen.blocks_per_metre, parameters=chosen.build
    )
    picture = io.BytesIO()
    Image.fromarray(preview(volume, *PREVIEW_PX)).save(picture, "PNG")
    write_bytes(out / "preview.png", picture.getvalue())


class Follower:
    """Reads the new frames of a growing capture folder."""

    def __init__(self, capture: Path, chosen: Parameters, labels: Path | None = None):
        self.capture, self.labels = capture, labels
        self.live = LiveMap(chosen)
        self._every = parse_options(chosen.capture).every or 1
        self._read: set[str] = set()

    def poll(self) -> int:
        """Fuse the new frames and return their number.

        A frame that cannot be read yet, because it is still being written, is tried again at the
        next call.
        """
        new = 0
        for frame in self._new_frames():
            if self.live.scan is not None and not self._fuse(frame):
                continue
            self._read.add(frame.name)
            new += 1
        self.live.frames = len(self._read)
        if new and self.live.due and self.live.place(self.capture, self.labels):
            # Frames that came since the folder was listed are in the map already.
            self._read |= set(self.live.scan.frames_used) if self.live.scan else set()
        return new

    def _new_frames(self) -> list[FrameFiles]:
        try:
            frames = find_capture(self.capture).frames[:: self._every]
        except InputError:
            return []
        return [
            frame
            for frame in frames
            if frame.name not in self._read and not frame.problem and frame.depth_path
        ]

    def _fuse(self, frame: FrameFiles) -> bool:
        """Fuse a frame with the depth encoding found at the latest room location."""
        encoding = getattr(_innermost(self.live.scan), "encoding", None)
        if encoding is None:
            return False
        try:
            view = read_view(frame, encoding)
        except InputError:
            return False
        self.live.add(view)
        return True


def follow(
    capture: Path,
    out: Path,
    parameters: Parameters | None = None,
    *,
    labels: Path | None = None,
    idle_s: float = IDLE_S,
    show_s: float = SHOW_S,
    poll_s: float = POLL_S,
    progress: Progress = no_progress,
    wait: Callable[[float], None] = time.sleep,
    clock: Callable[[], float] = time.monotonic,
) -> int:
    """Watch a growing capture folder and keep ``room.npz`` and ``preview.png`` up to date.

    The function returns when a file named ``done`` appears in the folder, on Ctrl-C, or after
    ``idle_s`` without new frames. The caller then runs the batch mode.

    Args:
        capture: Capture folder; may be empty or missing at first.
        out: Output folder.
        parameters: Parameters of ``reconstruct``.
        labels: Folder of 2D label images.
        idle_s: Seconds without a new frame after which watching ends.
        show_s: Minimum number of seconds between two previews.
        poll_s: Seconds between two checks of the folder.
        progress: Callback for progress, called with the stage ``follow`` of unknown length.
        wait: Function that sleeps for a number of seconds.
        clock: Function that returns the time in seconds.

    Returns:
        The number of frames read.

    Raises:
        OutputError: If ``out`` cannot be written.
    """
    check_writable(out)
    follower = Follower(capture, parameters or Parameters(), labels)
    last_new, last_shown, stale = clock(), -np.inf, False
    frames = 0
    try:
        while True:
            done = (
                capture / DONE_FILE
            ).exists()  # Checked first, so that all earlier frames are read.
            new = follower.poll()
            frames += new
            if new:
                last_new, stale = clock(), True
                progress("follow", frames, 0, f"{frames} frames")
            if stale and follower.live.scan is not None and clock() - last_shown >= show_s:
                show(follower.live, out)
                last_shown, stale = clock(), False
            if done or clock() - last_new >= idle_s:
                return frames
            wait(poll_s)
    except KeyboardInterrupt:
        return frames


def _scan_of(view: View, scan_to_room: np.ndarray) -> Scan:
    """Return a scan of a single view, as input of predictors."""
    return Scan([view], scan_to_room, np.ones(3), (view.name,))


def _innermost(scan: Scan | None) -> Any:
    """Return the stream of a scan as read from disk, without corrections of its views."""
    views: Any = None if scan is None else scan.views
    while hasattr(views, "views"):
        views = views.views
    return views
