"""Repair of a navigation set: images, generated scenes and records are made again from the seed.

Images are rendered again from the stances in the records. Damaged records are built again with the
whole set, in a draft folder. A file is replaced only by one with the listed checksum.
"""

import os
import shutil
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from world2minecraft import __version__
from world2minecraft.core.checksums import (
    CHECKSUMS,
    FileSum,
    RepairReport,
    read_checksums,
    sums_of_files,
    write_checksums,
)
from world2minecraft.core.errors import DamagedFileError, OutputError, World2MinecraftError
from world2minecraft.core.files import read_json, write_bytes
from world2minecraft.core.locks import folder_lock
from world2minecraft.core.output_folders import DRAFT, check_writable
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.navigation.data.generated_scenes import make_scenes
from world2minecraft.navigation.data.picture_store import vln_camera
from world2minecraft.navigation.data.scene_items import render_pictures
from world2minecraft.navigation.data.set_building import BuildRule, build_navigation_set
from world2minecraft.navigation.data.set_files import (
    LISTED,
    RECORDS,
    SetReport,
    pictures_of,
    verify_set,
    write_card,
)
from world2minecraft.navigation.records import (
    ABOUT,
    CARD,
    IMAGES,
    SCENES_FOLDER,
    resolve_scene_path,
)
from world2minecraft.navigation.scene import open_scene
from world2minecraft.navigation.types import Stance

MEASURED = "run.json"  # The times of a generated scene, which differ between runs.
BUILD_RULE = TypeAdapter(BuildRule)


def repair_set(
    folder: str | Path, workers: int = 1, progress: Progress = no_progress
) -> RepairReport:
    """Make the damaged and missing files of a set again from its options and seed.

    Args:
        folder: The folder of the set.
        workers: The number of processes.
        progress: Called after each part of the work.

    Raises:
        InputError: If the folder is not a navigation set.
        ConflictError: If another process writes the set.
        OutputError: If the folder cannot be written.
    """
    root = Path(folder)
    found = verify_set(root, progress)
    if not found.faults and found.has_valid_list:
        return RepairReport()
    check_writable(root)
    with folder_lock(root, "repaired"):
        draft = root / DRAFT
        shutil.rmtree(draft, ignore_errors=True)
        try:
            draft.mkdir()
            return _Repair(root, draft, found, workers, progress).run()
        except OSError as error:
            reason = f"cannot be written: {error.strerror or error}"
            raise OutputError(root, reason) from error
        finally:
            shutil.rmtree(draft, ignore_errors=True)


@dataclass(eq=False)
class _Repair:
    """A repair in progress. The files that are made again are in the draft."""

    root: Path
    draft: Path
    found: SetReport
    workers: int
    progress: Progress

    def run(self) -> RepairReport:
        """Make the damaged files again, put them back, and name the others."""
        sums = _wanted_sums(self.root, self.found)
        damaged, repaired = {*self.found.missing, *self.found.changed}, set[str]()
        about = {} if ABOUT in damaged else _description(self.root)
        reasons: list[str] = []
        for make in (self._make_scenes, self._make_pictures, self._make_records):
            rest = damaged - repaired
            try:
                make(about, rest)
            except World2MinecraftError as error:
                reasons.append(str(error))
            sums |= self._measured(rest)
            repaired |= _put_back(self.root, self.draft, rest, sums)
        left = [f"{name}: {_advice(name, reasons, about)}" for name in sorted(damaged - repaired)]
        if not self.found.has_valid_list and not left:
            write_checksums(self.root, sums_of_files(self.root, LISTED))
            repaired.add(CHECKSUMS)
        elif any(name.endswith(f"/{MEASURED}") for name in repaired):
            write_checksums(self.root, sums)
        extra = [f"{name}: unexpected file; move it away or delete it" for name in self.found.extra]
        return RepairReport(tuple(sorted(repaired)), (*left, *extra))

    def _make_scenes(self, about: dict[str, Any], damaged: Collection[str]) -> None:
        """Generate the scenes again that have damaged files."""
        names = {name.split("/")[1] for name in damaged if name.startswith(f"{SCENES_FOLDER}/")}
        if names and about:
            rule = _rule_of(self.root, about)
            folder, seed = self.draft / SCENES_FOLDER, rule.work.seed
            numbers = rule.rooms, rule.houses
            make_scenes(folder, *numbers, seed, self.workers, self.progress, only=names)

    def _make_records(self, about: dict[str, Any], damaged: Collection[str]) -> None:
        """Build the set again if a record is damaged, or an image that no record names."""
        if CARD in damaged and about:
            write_card(self.draft, about)
        kinds = {name.partition("/")[0] for name in damaged}
        if not about or not kinds & {*RECORDS.values(), IMAGES}:
            return
        paths = {str(resolve_scene_path(one["path"], self.root)): one["path"]
                 for one in about["scenes"]}  # fmt: skip
        rule = _rule_of(self.root, about)
        build_navigation_set(
            list(paths), self.draft, rule, self.progress, self.workers, recorded=paths
        )

    def _make_pictures(self, about: dict[str, Any], damaged: Collection[str]) -> None:
        """Render images again from the stances in the records."""
        wanted = {name for name in damaged if name.startswith(f"{IMAGES}/")}
        if not wanted or not about:
            return
        stances: dict[str, dict[str, Stance]] = {}
        for name, _, scene_id, stance in pictures_of(self.root):
            if name in wanted and stance is not None:
                stances.setdefault(scene_id, {})[name] = stance
        camera = vln_camera(*_rule_of(self.root, about).work.size_px)
        paths = {one["scene_id"]: one["path"] for one in about["scenes"]}
        for done, (scene_id, own) in enumerate(stances.items()):
            self.progress("images", done, len(stances), scene_id)
            scene = open_scene(resolve_scene_path(paths[scene_id], self.root))
            for name, stance in own.items():
                write_bytes(self.draft / name, render_pictures(scene, camera, [stance])[0].jpeg)
        self.progress("images", len(stances), len(stances))

    def _measured(self, damaged: Collection[str]) -> dict[str, FileSum]:
        """Return the new checksums of files with measured times."""
        return sums_of_files(self.draft, [one for one in damaged if one.endswith(f"/{MEASURED}")])


def _wanted_sums(root: Path, found: SetReport) -> dict[str, FileSum]:
    """Return the listed checksums of a set, or those of the images in its records."""
    if found.has_valid_list:
        return read_checksums(root)
    return {name: FileSum(-1, sha256) for name, sha256, *_ in pictures_of(root) if sha256}


def _description(root: Path) -> dict[str, Any]:
    about = read_json(root / ABOUT) if (root / ABOUT).is_file() else {}
    return about if isinstance(about, dict) and "build" in about else {}


def _rule_of(root: Path, about: dict[str, Any]) -> BuildRule:
    """Return the options that a set was built with.

    Raises:
        DamagedFileError: If they are not valid.
    """
    try:
        facts = {"composition": about["composition"], "streams": about["streams"]}
        return BUILD_RULE.validate_python({**about["build"], **facts, "work": about["rule"]})
    except (KeyError, TypeError, ValidationError, World2MinecraftError) as error:
        raise DamagedFileError(root / ABOUT, "contains no valid options of the set") from error


def _put_back(
    root: Path, draft: Path, names: Collection[str], wanted: Mapping[str, FileSum]
) -> set[str]:
    """Move files with their wanted checksums from the draft into the set."""
    made = sums_of_files(draft, sorted(names))
    good = {name for name, one in made.items() if one.sha256 == wanted[name].sha256}
    for name in sorted(good):
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(draft / name, root / name)
    return good


def _advice(name: str, reasons: Sequence[str], about: dict[str, Any]) -> str:
    """Return why a file cannot be made again, and what to do."""
    if name == ABOUT:
        what = "contains the options of the set; restore it from a copy, or repeat"
        return f"{what} the w2m vln build command in a new folder"
    if reasons:
        return f"cannot be made again: {reasons[-1]}"
    made_by = about.get("version", "the version that built it")
    return (
        f"cannot be made again by world2minecraft {__version__}; use {made_by}, restore it from a "
        "copy, or build and reword the set again"
    )
