"""The folder of a reconstruction, with its finished stages and their times.

``manifest.json`` contains all inputs that determine the result (input hashes, parameters, versions,
seed) and the finished stages; a run with the same manifest continues after the last of them.
``run.json`` contains values that differ between runs (times, memory, machine) and is never read.
"""

import hashlib
import platform
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

try:
    import resource
except ImportError:  # Windows has none.
    resource = None

from world2minecraft.core.errors import DamagedFileError, InputError, OutputError, UnknownNameError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.output_folders import FolderKind, check_writable

# What marks the folder of a run, and what commands write there.
RUN = FolderKind(
    markers={"manifest.json": "program", "build/scene.json": ""},
    names=(
        "build", "capture", "centers.json", "centers.npz", "evidence.npz", "layout.json",
        "manifest.json", "names.npz", "objects.json", "occ.json", "placements.json", "poses.npz",
        "preview.png", "repairs.json", "report.html", "report.json", "room.npz", "run.json",
        "scan.json",
    ),
    in_place=True,
)  # fmt: skip
BUILT_FROM = ("room.npz", "objects.json", "placements.json")  # Files from which a world is built.


class RunFolder:
    """The state of a run: its folder, its manifest and its times."""

    def __init__(self, folder: Path, stages: Sequence[str], start: str | None = None):
        """Inspect the folder; no file is written before ``begin``.

        Args:
            folder: Folder of the run.
            stages: All stages in order.
            start: Stage to start at. None continues an interrupted run after its last finished
                stage and starts other runs at the first stage.

        Raises:
            OutputError: If the folder is a file.
            UnknownNameError: If ``start`` is not one of ``stages``.
        """
        if start is not None and start not in stages:
            raise UnknownNameError("stage", start, stages)
        if folder.exists() and not folder.is_dir():
            raise OutputError(folder, "is a file; the output must be a folder")
        self.folder = folder
        self.stages = tuple(stages)
        self.start = start
        self._manifest: dict[str, Any] = {}
        self._seconds: dict[str, float] = {}
        self.finished: list[str] = []

    def begin(self, manifest: Mapping[str, Any]) -> None:
        """Create the folder and determine the first stage to run.

        Args:
            manifest: Inputs that determine the result.

        Raises:
            OutputError: If the folder is a file, is full or is not writable.
            InputError: If the start stage requires files of a stage that has not been completed.
        """
        self._manifest = dict(manifest)
        check_writable(self.folder)
        done = self._finished_before()
        if self.start is None:
            done = [] if len(done) == len(self.stages) else done
        else:
            wanted = list(self.stages[: self.stages.index(self.start)])
            missing = [stage for stage in wanted if stage not in self._recorded()]
            if missing:
                raise InputError(
                    self.folder,
                    f"the stage {missing[0]!r} has not been completed; omit the start stage "
                    "(--from)",
                )
            done = wanted
        self.finished = done
        self._save()

    def needs(self, stage: str) -> bool:
        """Return whether a stage must be run instead of being read from its files."""
        return stage not in self.finished

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Measure the time of a stage, and record the stage as finished if its block succeeds."""
        with self.timed(name):
            yield
        if name not in self.finished:
            self.finished.append(name)
        self._save()

    @contextmanager
    def timed(self, name: str) -> Iterator[None]:
        """Add the duration of a block to the time of a stage without writing a file."""
        begun = time.perf_counter()
        yield
        seconds = self._seconds.get(name, 0.0) + time.perf_counter() - begun
        self._seconds[name] = round(seconds, 3)

    def path(self, name: str) -> Path:
        """Return the path of a file of the run."""
        return self.folder / name

    def _save(self) -> None:
        write_json(self.path("manifest.json"), self._manifest | {"finished": self.finished})
        write_json(
            self.path("run.json"),
            {
                "stage_s": self._seconds,
                "peak_memory_mb": peak_memory_mb(),
                "machine": platform.platform(),
                "cores": usable_cores(),
            },
        )

    def _recorded(self) -> list[str]:
        """The finished stages of an earlier run, whatever its parameters."""
        finished = finished_stages(self.folder)
        return [stage for stage in self.stages if stage in finished]

    def _finished_before(self) -> list[str]:
        """The finished stages of an earlier run with the same manifest."""
        path = self.path("manifest.json")
        if not path.is_file():
            return []
        try:
            old = read_json(path)
        except DamagedFileError:
            return []
        same = isinstance(old, dict) and {**old, "finished": None} == {
            **self._manifest,
            "finished": None,
        }
        return self._recorded() if same else []


def finished_stages(folder: Path) -> list[str]:
    """Return the finished stages of a run, or an empty list if its manifest cannot be read."""
    path = folder / "manifest.json"
    try:
        stated = read_json(path) if path.is_file() else None
    except DamagedFileError:
        return []
    finished = stated.get("finished") if isinstance(stated, dict) else None
    return [str(name) for name in finished] if isinstance(finished, list) else []


def is_run_of_another(capture: Path, folder: Path) -> bool:
    """Return whether a folder contains the run of a capture with other files."""
    path = folder / "manifest.json"
    if "furnish" not in finished_stages(folder):
        return False
    stated = read_json(path).get("capture")
    return stated is not None and stated != hash_capture(capture, without=folder)


def check_finished(folder: Path) -> None:
    """Check that a folder contains a run from which a world can be built.

    Raises:
        InputError: If a file is missing, or if the run was interrupted and its furniture is that of
            an earlier run.
    """
    missing = [name for name in BUILT_FROM if not (folder / name).is_file()]
    if missing:
        raise InputError(
            folder,
            f"is not a finished run: {missing[0]} not found; "
            f"run w2m reconstruct CAPTURE --out {folder}",
        )
    finished = finished_stages(folder)
    if "label" in finished and "furnish" not in finished:
        raise InputError(
            folder,
            "is not a finished run: it was interrupted before the furnish stage; repeat its "
            "w2m reconstruct command to continue",
        )


def hash_capture(path: Path, without: Path | None = None) -> str:
    """Return the SHA-256 of the names and contents of all non-hidden files of a capture.

    Args:
        path: Folder or file of the capture.
        without: Folder inside the capture, such as the results, whose files are ignored.
    """
    digest = hashlib.sha256()
    names = [path] if path.is_file() else sorted(path.rglob("*"))
    results = None if without is None else without.resolve()
    if results is not None and path.resolve().is_relative_to(results):
        results = None  # The capture may be inside the folder of results.
    for name in names:
        if results is not None and name.resolve().is_relative_to(results):
            continue
        relative = name.relative_to(path) if name != path else Path(name.name)
        if name.is_file() and not any(part.startswith(".") for part in relative.parts):
            digest.update(relative.as_posix().encode() + b"\0")
            with name.open("rb") as stream:
                digest.update(hashlib.file_digest(stream, "sha256").digest())
    return digest.hexdigest()


def peak_memory_mb() -> float | None:
    """Return the peak memory of this process in megabytes, or None if it is unknown."""
    if resource is None:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return round(peak / (1 << 20 if sys.platform == "darwin" else 1 << 10), 1)
