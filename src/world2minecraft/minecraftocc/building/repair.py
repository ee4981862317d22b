"""Repair of a data set: what its plan and seed determine is made again, and the rest is named.

The set is built again in a draft folder from hard links to its undamaged files, so only damaged
worlds, scenes and shards take time. A file is replaced only by one with the listed checksum.
"""

import json
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from world2minecraft.core.checksums import (
    CHECKSUMS,
    FileSum,
    RepairReport,
    files_in,
    read_checksums,
    sums_of_files,
    write_checksums,
)
from world2minecraft.core.errors import DamagedFileError, OutputError, World2MinecraftError
from world2minecraft.core.locks import folder_lock
from world2minecraft.core.output_folders import DRAFT, check_writable
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Camera
from world2minecraft.minecraftocc.building.build import complete_dataset
from world2minecraft.minecraftocc.building.process_registry import remove_registry, wait_for_others
from world2minecraft.minecraftocc.building.scene_survey import generate_house_world
from world2minecraft.minecraftocc.engine import Engine
from world2minecraft.minecraftocc.formats.image_conventions import NYU_CAMERA
from world2minecraft.minecraftocc.plan import DatasetPlan
from world2minecraft.minecraftocc.store.folder import (
    CARD,
    CLASSES,
    DATASET,
    INDEX,
    META,
    SCENES,
    WORLDS,
    read_meta,
)
from world2minecraft.minecraftocc.store.verify import VerifyReport, verify_store
from world2minecraft.minecraftocc.store.writer import (
    finish_store,
    read_shard,
    versions,
    write_store,
)
from world2minecraft.minecraftocc.synthetic_photos import PhotoRooms, photo_samples

PLAN = TypeAdapter(DatasetPlan)


def repair_dataset(
    folder: str | Path, engine: Engine, progress: Progress = no_progress
) -> RepairReport:
    """Make the damaged and missing files of a data set again from its plan and seed.

    Args:
        folder: Folder of a complete data set.
        engine: Engine that runs the tasks, such as a process pool.
        progress: Callback that reports progress.

    Raises:
        InputError: If the folder is not a complete data set.
        ConflictError: If another process writes the data set.
        OutputError: If the folder cannot be written.
    """
    root = Path(folder)
    found = verify_store(root, progress)
    if not found.faults and found.has_valid_list:
        return RepairReport()
    check_writable(root)
    with folder_lock(root, "repaired"):
        wait_for_others(root)
        draft = root / DRAFT
        shutil.rmtree(draft, ignore_errors=True)
        try:
            return _repair(root, draft, found, engine, progress)
        except OSError as error:
            reason = f"cannot be written: {error.strerror or error}"
            raise OutputError(root, reason) from error
        finally:
            shutil.rmtree(draft, ignore_errors=True)
            remove_registry(root)


def _repair(
    root: Path, draft: Path, found: VerifyReport, engine: Engine, progress: Progress
) -> RepairReport:
    damaged = {*found.missing, *found.changed}
    extra = [f"{name}: unexpected file; move it away or delete it" for name in found.extra]
    try:
        meta = read_meta(root, finished=False)
    except World2MinecraftError:
        what = f"{META}: contains the plan of the data set; restore it from a copy, or repeat"
        return RepairReport((), (f"{what} the w2m dataset build command in a new folder", *extra))
    if found.has_valid_list and not damaged:
        return RepairReport((), tuple(extra))
    is_former = not found.has_valid_list and not meta.get("checksums")
    if is_former and not damaged:
        _write_list(root)
        return RepairReport((CHECKSUMS,), tuple(extra))
    is_trusted = found.has_valid_list or is_former
    _link(root, draft, _intact_files(root, found, damaged, meta) if is_trusted else [])
    failure = ""
    try:
        _build_again(draft, meta, engine, progress)
    except World2MinecraftError as error:
        failure = f"cannot be made again: {error}"
    wanted = _wanted_sums(root, draft, found, meta)
    names = damaged if is_trusted else _others(root, wanted)
    repaired = _put_back(root, draft, names, wanted)
    if is_former:
        _write_list(root)
    elif not found.has_valid_list and wanted:
        os.replace(draft / CHECKSUMS, root / CHECKSUMS)
        repaired.append(CHECKSUMS)
    elif INDEX in repaired:  # Another version of pyarrow writes the same rows in other bytes.
        write_checksums(root, {**read_checksums(root), **sums_of_files(root, (INDEX,))})
    rest = (damaged if is_trusted else {CHECKSUMS}) - {*repaired}
    reason = failure or _reason(meta)
    left = [f"{name}: {reason}" for name in sorted(rest)]
    return RepairReport(tuple(sorted(repaired)), (*left, *extra))


def _intact_files(
    root: Path, found: VerifyReport, damaged: set[str], meta: dict[str, Any]
) -> list[str]:
    """Return the files of worlds, scenes and shards that have no damaged part."""
    units = {_unit_of(name) for name in damaged}
    last = (CARD, INDEX, META, *((CLASSES,) if "plan" in meta else ()))  # Never linked.
    names = read_checksums(root) if found.has_valid_list else files_in(root)
    return [
        name
        for name in names
        if _unit_of(name) not in units
        and name not in (*last, *found.extra)
        and name.partition("/")[0] in DATASET.names
    ]


def _unit_of(name: str) -> str:
    """Return what is made again together with a file: a world, a scene or a shard."""
    kind, _, rest = name.partition("/")
    if kind == WORLDS:
        return f"{WORLDS}/{rest.partition('/')[0]}"
    return f"{SCENES}/{rest.partition('.')[0]}" if kind == SCENES else name


def _link(root: Path, draft: Path, names: list[str]) -> None:
    """Link files into the draft, or copy them where the file system has no hard links."""
    draft.mkdir()
    for name in names:
        target = draft / name
        target.parent.mkdir(parents=True, exist_ok=True)
        try:
            os.link(root / name, target)
        except OSError:
            shutil.copyfile(root / name, target)


def _build_again(draft: Path, meta: dict[str, Any], engine: Engine, progress: Progress) -> None:
    """Complete the data set in the draft: from its plan, or its last files from its shards."""
    if "plan" in meta:
        plan = _plan_of(draft, meta)
        for scene in plan.scenes:
            # Its views may be intact, and are then not planned again from the world.
            if scene.house and (draft / SCENES / f"{scene.scene_id}.json").exists():
                generate_house_world(draft / scene.path, plan.recipe.seed, scene.house)
        complete_dataset(draft, plan, engine, progress)
    elif "photo_rooms" in meta:
        shutil.rmtree(draft)
        facts = dict(meta["photo_rooms"])
        words = {name: facts[name] for name in ("rooms", "images", "test_share", "seed")}
        camera = Camera(**facts["camera"]) if "camera" in facts else NYU_CAMERA
        rooms = PhotoRooms(**words, camera=camera)
        write_store(draft, photo_samples(rooms), {"photo_rooms": facts}, progress=progress)
    elif all((draft / name).is_file() for name in (*meta["shards"], CLASSES)):
        contents = (read_shard(draft, name) for name in meta["shards"])
        finish_store(draft, meta["shards"], meta, contents)


def _plan_of(draft: Path, meta: dict[str, Any]) -> DatasetPlan:
    """Return the plan of a data set.

    Raises:
        DamagedFileError: If it is not valid, or contains settings that this version does not know.
    """
    try:
        plan = PLAN.validate_python(meta["plan"])
    except (ValidationError, World2MinecraftError) as error:
        raise DamagedFileError(draft.parent / META, "contains no valid plan") from error
    if json.loads(json.dumps(plan.facts())) != meta["plan"]:
        raise DamagedFileError(draft.parent / META, "contains a plan of another version")
    return plan


def _wanted_sums(
    root: Path, draft: Path, found: VerifyReport, meta: dict[str, Any]
) -> Mapping[str, FileSum]:
    """Return the checksums that files must have to be put back.

    Those of the list of the data set, or of the draft if it contains the same samples. The index
    may be in other bytes if it describes the same samples.
    """
    try:
        made = read_checksums(draft) if read_meta(draft)["sha256"] == meta.get("sha256") else {}
    except World2MinecraftError:
        made = {}
    if not found.has_valid_list:
        return made
    return {**read_checksums(root), **{name: one for name, one in made.items() if name == INDEX}}


def _put_back(root: Path, draft: Path, names: set[str], wanted: Mapping[str, FileSum]) -> list[str]:
    """Move files with their wanted checksums from the draft into the data set."""
    made = sums_of_files(draft, sorted(names))
    repaired = [name for name in sorted(names) if name in made and made[name] == wanted.get(name)]
    for name in repaired:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(draft / name, root / name)
    return repaired


def _others(root: Path, wanted: Mapping[str, FileSum]) -> set[str]:
    """Return the names of the files that have other contents than those that were made again."""
    found = sums_of_files(root, wanted)
    return {name for name, one in wanted.items() if found.get(name) != one}


def _write_list(root: Path) -> None:
    """Write the list of a data set of a former version from the files that it contains."""
    write_checksums(root, sums_of_files(root, DATASET.names))


def _reason(meta: dict[str, Any]) -> str:
    """Return why a file cannot be made again, and what to do."""
    made_by = meta.get("versions")
    if "imported" in meta:
        return "cannot be made again; import the data set again, or restore the file from a copy"
    if made_by != versions():
        listed = ", ".join(f"{name} {one}" for name, one in dict(made_by or {}).items())
        return f"cannot be made again with other versions; repair it with {listed or 'the former'}"
    return "cannot be made again; build the data set again, or restore the file from a copy"
