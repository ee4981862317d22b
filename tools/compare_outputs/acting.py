"""What a step does besides plain commands, and what is laid into its folder beforehand.

Each act is said by values alone, so that its text tells whether a kept result of it still holds.
"""

import gzip
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import threading
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Protocol

import numpy as np
from PIL import Image

HANG_S = 900.0  # No measure of speed: only what never ends is ended.


@dataclass(frozen=True)
class Place:
    """Where an act is done: the step's folder, and how to start a command with a side's code."""

    folder: Path
    start: Callable[[list[str], IO[bytes], IO[bytes]], subprocess.Popen[bytes]]
    start_script: Callable[[str, IO[bytes], IO[bytes]], subprocess.Popen[bytes]]
    stdout: IO[bytes]
    stderr: IO[bytes]

    def command(self, words: list[str]) -> int:
        """Run a command to its end and return its exit code."""
        process = self.start(words, self.stdout, self.stderr)
        return ended(process)


SPENT = threading.local()  # ``seconds`` of processor time of the processes that a thread ended.


def ended(process: subprocess.Popen[bytes]) -> int:
    """Wait for a process, at last without patience, and return its exit code."""
    until = time.monotonic() + HANG_S
    while True:
        if time.monotonic() > until:
            process.kill()
        pid, status, used = os.wait4(process.pid, os.WNOHANG)
        if pid:
            process.returncode = os.waitstatus_to_exitcode(status)
            SPENT.seconds = getattr(SPENT, "seconds", 0.0) + used.ru_utime + used.ru_stime
            return process.returncode
        time.sleep(0.02)


class Act(Protocol):
    """Something done in a step's folder; the exit code that it returns is compared."""

    def act(self, place: Place) -> int:
        """Do it."""
        ...


@dataclass(frozen=True)
class Edit:
    """Open a run in the editor, ask and do over HTTP, and end it as Ctrl+C does.

    requests: method, path and fields of each; the replies are what is printed. The method EXPORT
    has a form in place of a path, and writes a file ``exported-FORM``.
    """

    run: str
    requests: tuple[tuple[str, str, str], ...]

    def act(self, place: Place) -> int:
        """Do it."""
        log = place.folder / "forge.log"
        with log.open("wb") as stream:
            words = ["forge", self.run, "--no-browser", "--port", "0"]
            process = place.start(words, stream, place.stderr)
            try:
                address, token = _link_of(log, process)
                editor = _Editor(address, token)
                for method, path, fields in self.requests:
                    if method == "EXPORT":
                        reply = editor.exported(path, fields, place.folder)
                    else:
                        reply = _told(editor.asked(method, path, fields))
                    place.stdout.write(f"{method} {path} {fields}\n{reply}\n".encode())
            finally:
                if process.poll() is None:
                    process.send_signal(signal.SIGINT)
                    code = ended(process)
                else:
                    code = process.returncode
        log.unlink()
        return code


def _link_of(log: Path, process: subprocess.Popen[bytes]) -> tuple[str, str]:
    until = time.monotonic() + HANG_S
    while time.monotonic() < until and process.poll() is None:
        found = re.search(r"SceneForge: (http://[^/\s]+)\S*?[#?&/=](\w[\w-]{15,})", log.read_text())
        if found:
            return found[1], found[2]
        time.sleep(0.1)
    raise RuntimeError(f"the editor told no link: {log.read_text()}")


@dataclass(frozen=True)
class _Editor:
    address: str
    token: str

    def asked(self, method: str, path: str, fields: str = "") -> bytes:
        request = urllib.request.Request(
            self.address + path, fields.encode() if method == "POST" else None, method=method
        )
        request.add_header("Authorization", f"Bearer {self.token}")
        request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=HANG_S) as answer:
                return answer.read()
        except urllib.error.HTTPError as error:
            return error.read()

    def exported(self, form: str, fields: str, folder: Path) -> str:
        """Export what is edited, and wait for it."""
        told = json.dumps({"form": form} | json.loads(fields or "{}"))
        begun = json.loads(self.asked("POST", "/api/exports", told))
        until = time.monotonic() + HANG_S
        while "job" in begun and time.monotonic() < until:
            jobs = json.loads(self.asked("GET", "/api/jobs"))
            jobs = jobs if isinstance(jobs, list) else jobs["jobs"]
            job = next(one for one in jobs if one["id"] == begun["job"])
            if job["state"] == "running":
                time.sleep(0.1)
                continue
            if job["state"] != "done":
                return f"{job['state']}: {job['note']}"
            result = job["result"]
            data = self.asked("GET", f"/api/exports/files/{result.pop('id')}")
            (folder / f"exported-{form}-{result['file']}").write_bytes(data)
            return json.dumps(result, sort_keys=True)
        return json.dumps(begun)


def _told(data: bytes) -> str:
    """Return a reply as a text: JSON without times, or the sum of an array."""
    if data[:2] == b"\x1f\x8b":
        data = gzip.decompress(data)
    if data[:1] in (b"{", b"["):
        return json.dumps(_timeless(json.loads(data)), sort_keys=True)
    return f"{len(data)} bytes, {hashlib.sha256(data).hexdigest()}"


def _timeless(value: Any) -> Any:
    """Leave out what tells times."""
    if isinstance(value, dict):
        return {key: _timeless(one) for key, one in value.items() if not key.endswith("time_s")}
    return [_timeless(one) for one in value] if isinstance(value, list) else value


@dataclass(frozen=True)
class Grow:
    """Follow a capture of which a part is there at first, and the rest comes a frame at a time."""

    words: str
    source: str
    capture: str
    first: int = 6
    every_s: float = 0.3

    def act(self, place: Place) -> int:
        """Do it."""
        source, capture = place.folder / self.source, place.folder / self.capture
        capture.mkdir()
        files = sorted(one for one in source.rglob("*") if one.is_file())
        frames: dict[str, list[Path]] = {}
        for one in files:
            if found := re.match(r"frame-\d+", one.name):
                frames.setdefault(found[0], []).append(one)
            else:
                _copied(one, source, capture)
        rows = list(frames.values())
        for one in (one for row in rows[: self.first] for one in row):
            _copied(one, source, capture)
        process = place.start(self.words.split(), place.stdout, place.stderr)
        for row in rows[self.first :]:
            time.sleep(self.every_s)
            for one in row:
                _copied(one, source, capture)
        (capture / "done").touch()
        return ended(process)


def _copied(one: Path, source: Path, target: Path) -> None:
    """Copy a file to the same place under another folder, whole at once."""
    to = target / one.relative_to(source)
    to.parent.mkdir(parents=True, exist_ok=True)
    half = to.with_name(to.name + ".part")
    shutil.copyfile(one, half)
    half.replace(to)


@dataclass(frozen=True)
class Kill:
    """Start a command, and kill it when a file is there that fits a pattern with stars."""

    words: str
    file: str

    def act(self, place: Place) -> int:
        """Do it; 0 where it was killed in time."""
        process = place.start(self.words.split(), place.stdout, place.stderr)
        until = time.monotonic() + HANG_S
        while process.poll() is None and time.monotonic() < until:
            if any(place.folder.glob(self.file)):
                process.kill()
                ended(process)
                return 0
            time.sleep(0.01)
        process.kill()
        return process.wait()


@dataclass(frozen=True)
class Script:
    """Run Python against the package, written for the base: ``declared.MODULES`` mends it."""

    text: str

    def act(self, place: Place) -> int:
        """Do it."""
        return ended(place.start_script(self.text, place.stdout, place.stderr))


# ---- what is laid into a step's folder


class Given(Protocol):
    """Something that is made in a step's folder before its commands are run."""

    def put(self, target: Path, shared: Path) -> None:
        """Make it at ``target``."""
        ...


@dataclass(frozen=True)
class Frames:
    """Some frames of the shared kitchen: all of each, or its photos alone."""

    every: int = 1
    with_depth: bool = True
    with_poses: bool = True

    def put(self, target: Path, shared: Path) -> None:
        """Make it at ``target``."""
        source = shared / "redkitchen_rgbd"
        target.mkdir(parents=True)
        photos = sorted((source / "frames").glob("*.color.jpg"))[:: self.every]
        for photo in photos:
            stem = photo.name.removesuffix(".color.jpg")
            if not self.with_poses and not self.with_depth:
                shutil.copy(photo, target / f"{stem}.jpg")
                continue
            ends = ["color.jpg", *["depth.png"] * self.with_depth, *["pose.txt"] * self.with_poses]
            for end in ends:
                shutil.copy(source / "frames" / f"{stem}.{end}", target)
        if self.with_poses or self.with_depth:
            shutil.copy(source / "camera-intrinsics.txt", target)


@dataclass(frozen=True)
class Labels:
    """Made-up label images of the kitchen's frames: bands of classes, and a stripe of unknown."""

    every: int = 1

    def put(self, target: Path, shared: Path) -> None:
        """Make it at ``target``."""
        target.mkdir(parents=True)
        rows, columns = np.mgrid[:480, :640]
        labels = np.select([rows < 60, rows > 360, columns % 160 < 40], [1, 2, 255], 3)
        labels[(rows > 200) & (rows < 330) & (columns > 150) & (columns < 480)] = 8
        for photo in sorted((shared / "redkitchen_rgbd/frames").glob("*.color.jpg"))[:: self.every]:
            stem = photo.name.removesuffix(".color.jpg")
            Image.fromarray(labels.astype(np.uint8)).save(target / f"{stem}.png")


@dataclass(frozen=True)
class Shared:
    """A file or a folder of the shared real inputs."""

    path: str

    def put(self, target: Path, shared: Path) -> None:
        """Make it at ``target``."""
        target.parent.mkdir(parents=True, exist_ok=True)
        source = shared / self.path
        if source.is_dir():
            shutil.copytree(source, target)
        else:
            shutil.copy(source, target)


@dataclass(frozen=True)
class Text:
    """A file with a text."""

    text: str

    def put(self, target: Path, shared: Path) -> None:
        """Make it at ``target``."""
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(self.text, encoding="utf-8")
