"""The walks of a data set and the instructions that people write for them.

Instructions are stored in a JSON Lines file that ``w2m vln build`` imports. Each line is an object
{trajectory_id, annotator_id, instruction, language, level}. Lines are only ever appended. A walk
may have several instructions, from one or more people.
"""

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.core.files import parse_json_lines, read_bytes, write_text
from world2minecraft.core.locks import Lock, acquire_or_wait, wait_for_locks
from world2minecraft.navigation.language.human_instructions import read_annotations
from world2minecraft.navigation.language.instruction_checking import (
    check_instruction,
    goal_name,
    landmark_names_of,
)
from world2minecraft.navigation.records import ANNOTATIONS, read_trajectories
from world2minecraft.navigation.types import Trajectory

MAX_IMAGE_BYTES = 32 << 20
MAX_ANNOTATOR = 60
KEYS = {"trajectory_id", "annotator_id", "instruction", "language", "level"}
KINDS = {".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".png": "image/png"}


class AnnotationStore:
    """The walks of a data set, with the human-written instructions in its annotation file.

    Args:
        folder: Folder of the data set, with ``trajectories.jsonl`` and the images it refers to.
        out: Annotation file to write. None writes ``annotations.jsonl`` in the folder.
        force: Whether to replace an annotation file that was not written by this class.

    Raises:
        UsageError: If the annotation file contains other data, without ``force``.
        InputError: If the data set has no walks, or if a file cannot be read.
        DamagedFileError: If a line of the annotation file is invalid.
    """

    def __init__(self, folder: Path, out: Path | None = None, force: bool = False):
        self.folder, self.out = folder, out or folder / ANNOTATIONS
        if self.out.suffix.lower() == ".csv":
            raise UsageError(
                f"{self.out}: annotations are written as JSON lines; choose a name such as "
                f"{self.out.with_suffix('.jsonl').name}"
            )
        self.walks: list[Trajectory] = read_trajectories(folder)
        if not self.walks:
            raise InputError(folder, "contains no walks; create a data set with w2m vln build")
        self._number = {one.trajectory_id: n for n, one in enumerate(self.walks)}
        scenes = {one.scene_id for one in self.walks}
        self._names = {scene: landmark_names_of(self.walks, scene) for scene in sorted(scenes)}
        self._lock = threading.Lock()
        self._lines = self._read()
        if not force and self.out.exists() and not _is_plain(self.out):
            raise UsageError(
                f"{self.out} contains other data than annotations; choose another file (--out), or "
                "use --force to keep only its instructions"
            )

    def listed(self) -> list[dict[str, Any]]:
        """Return a summary of each walk, with the number of instructions written for it."""
        counts: dict[str, int] = {}
        for line in self._lines:
            counts[line["trajectory_id"]] = counts.get(line["trajectory_id"], 0) + 1
        return [
            {
                "number": number,
                "id": one.trajectory_id,
                "scene": one.scene_id,
                "frames": len(one.keyframes),
                "path_m": round(one.path_m, 1),
                "goal": goal_name(one),
                "written": counts.get(one.trajectory_id, 0),
            }
            for number, one in enumerate(self.walks)
        ]

    def walk(self, number: int) -> dict[str, Any]:
        """Return a walk: its images, the move after each image, and its instructions."""
        one = self._walk(number)
        instructions = [
            {"level": each.level, "text": each.text, "by": each.annotator or each.source}
            for each in one.instructions
        ]
        instructions += [
            {"level": line["level"], "text": line["instruction"], "by": line["annotator_id"]}
            for line in self._lines
            if line["trajectory_id"] == one.trajectory_id
        ]
        return {
            "number": number,
            "id": one.trajectory_id,
            "scene": one.scene_id,
            "goal": goal_name(one),
            "things": list(self._names[one.scene_id]),
            "path_m": round(one.path_m, 1),
            "frames": [frame.move for frame in one.keyframes],
            "told": instructions,
        }

    def image(self, number: int, frame: int) -> tuple[bytes, str]:
        """Return the bytes and the media type of an image of a walk.

        Raises:
            UsageError: If the walk has no image of this number.
            InputError: If the image file cannot be read, or is not a JPEG or PNG image.
        """
        keyframes = self._walk(number).keyframes
        if not 0 <= frame < len(keyframes):
            raise UsageError(
                f"image {frame} not found; this walk has images 0 to {len(keyframes) - 1}"
            )
        path = self.folder / keyframes[frame].image  # Checked as it was read: it stays inside.
        kind = KINDS.get(path.suffix.lower())
        if kind is None:
            raise InputError(path, "not a JPEG or PNG image")
        return read_bytes(path, MAX_IMAGE_BYTES), kind

    def check(self, number: int, level: str, text: str) -> list[dict[str, Any]]:
        """Return the problems found in an instruction, errors first."""
        one = self._walk(number)
        return [
            found._asdict()
            for found in check_instruction(text, level, one, self._names[one.scene_id])
        ]

    def add(
        self, number: int, level: str, text: str, annotator: str, language: str = "en"
    ) -> dict[str, Any]:
        """Append an instruction to the annotation file and return its line.

        Raises:
            UsageError: If ``check`` finds an error in the text, or if the annotator's name or the
                language code is invalid.
        """
        one = self._walk(number)
        wrong = [found["text"] for found in self.check(number, level, text) if found["is_wrong"]]
        if wrong:
            raise UsageError(wrong[0])
        who = " ".join(annotator.split())
        if not who or len(who) > MAX_ANNOTATOR or not who.isprintable():
            raise UsageError(f"enter an annotator name of up to {MAX_ANNOTATOR} characters")
        if not (1 < len(language) <= 20 and language.isascii() and language.isprintable()):
            raise UsageError(f"invalid language {language[:20]!r}; use a code such as en or de-AT")
        line = {
            "trajectory_id": one.trajectory_id,
            "annotator_id": who,
            "instruction": " ".join(text.split()),
            "language": language,
            "level": level,
        }
        with self._lock, self._file_lock():
            self._lines = self._read()  # Another page may have added a line.
            if line not in self._lines:
                self._lines = [*self._lines, line]
                write_text(self.out, self._text())
        return line

    def _text(self) -> str:
        return "".join(f"{json.dumps(each, ensure_ascii=False)}\n" for each in self._lines)

    @contextmanager
    def _file_lock(self) -> Iterator[None]:
        """Hold the lock of the annotation file, after other pages have released it."""
        self.out.parent.mkdir(parents=True, exist_ok=True)
        lock = Lock(self.out.with_name(f".{self.out.name}.lock"), "annotated")
        with wait_for_locks():
            acquire_or_wait(lock)
        try:
            yield
        finally:
            lock.remove()

    def _walk(self, number: int) -> Trajectory:
        if not 0 <= number < len(self.walks):
            raise UsageError(f"walk {number} not found; walks: 0 to {len(self.walks) - 1}")
        return self.walks[number]

    def _read(self) -> list[dict[str, str]]:
        if not self.out.exists():
            return []
        lines = []
        for name, instruction in read_annotations(self.out):
            if name not in self._number:
                raise InputError(self.out, f"trajectory {name!r} not found")
            line = {"trajectory_id": name, "annotator_id": instruction.annotator}
            line |= {
                "instruction": instruction.text,
                "language": instruction.language,
                "level": instruction.level,
            }
            lines.append(line)
        return lines


def _is_plain(path: Path) -> bool:
    """Return whether a file has only lines that this module writes, so that none loses a value."""
    try:
        rows = parse_json_lines(path.read_text("utf-8"), path)
    except (DamagedFileError, UnicodeDecodeError):
        return False
    return all(row.keys() <= KEYS for _, row in rows)
