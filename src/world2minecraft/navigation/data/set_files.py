"""The files of a navigation set: its card for Hugging Face, their list, and their verification."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.checksums import (
    CHECKSUMS,
    compare_files,
    read_checksums,
    sum_of_file,
    sums_of_files,
    write_checksums,
)
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import read_json, write_text
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.whole_reads import unchanged
from world2minecraft.navigation.records import (
    ABOUT,
    ANNOTATIONS,
    CARD,
    EPISODES,
    IMAGES,
    ITEMS,
    REPLIES_FOLDER,
    SCENES_FOLDER,
    TRAJECTORIES,
    read_episodes,
    read_items,
    read_trajectories,
)
from world2minecraft.navigation.types import Stance

RECORDS = {"items": ITEMS, "trajectories": TRAJECTORIES, "episodes": EPISODES}
LISTED = (ABOUT, CARD, *RECORDS.values(), IMAGES, SCENES_FOLDER)


@dataclass(frozen=True)
class SetReport:
    """The result of verifying a navigation set.

    Attributes:
        items: The number of items, or 0 if they cannot be read.
        files: The number of listed files. 0 if the set has no valid list, as those of former
            versions; then its records are read, and images are checked by their checksums there.
        bytes: The total size of the listed files.
        faults: Descriptions of the errors found; empty if the set is valid.
        missing: The names of files that do not exist.
        changed: The names of files with other contents.
        extra: The names of unexpected files.
        has_valid_list: Whether ``checksums.json`` exists and is valid.
    """

    items: int
    files: int
    bytes: int
    faults: tuple[str, ...]
    missing: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()
    has_valid_list: bool = True


def finish_set(folder: Path, home: Path | None = None) -> None:
    """Write the card of a set and the list of all its files.

    Args:
        folder: The folder with the records and images.
        home: The folder with the scenes that were generated for the set, if it is another one.

    Raises:
        OutputError: If a file cannot be written.
    """
    write_card(folder, read_json(folder / ABOUT))
    sums = sums_of_files(folder, LISTED)
    if home is not None and home != folder:
        sums |= sums_of_files(home, (SCENES_FOLDER,))
    write_checksums(folder, sums)


def write_card(folder: Path, about: dict[str, Any]) -> None:
    """Write the card of a set, by which Hugging Face reads its records as three tables."""
    table = "  - config_name: {}\n    data_files:\n      - split: full\n        path: {}\n"
    configs = "".join(table.format(*names) for names in RECORDS.items())
    first = configs.replace("items\n", "items\n    default: true\n", 1)
    write_text(
        folder / CARD,
        f"---\nconfigs:\n{first}---\n# MinecraftVLN navigation set\n\n"
        f"{about['items']:,} items of {len(about['scenes'])} scenes, created with "
        f"world2minecraft {about['version']}.\n\n"
        "The tables are items (questions), trajectories and episodes. Their column `split` is\n"
        "train, val_seen or val_unseen; images are paths in this folder. Check the files with\n"
        "`w2m vln verify`.\n",
    )


def update_list(folder: Path, draft: Path) -> None:
    """Write the list of a set into a draft that replaces its records.

    A set of a former version stays without a list.
    """
    if not (folder / CHECKSUMS).is_file() and not _states_list(folder):
        return
    sums = (
        read_checksums(folder) if (folder / CHECKSUMS).is_file() else sums_of_files(folder, LISTED)
    )
    write_checksums(draft, {**sums, **sums_of_files(draft, RECORDS.values())})


def check_records(folder: Path) -> None:
    """Check that the records of a set have not changed since they were written.

    Raises:
        DamagedFileError: If the list or a record file has changed.
    """
    sums = read_checksums(folder) if (folder / CHECKSUMS).is_file() else {}
    for name in RECORDS.values():
        if name in sums and (folder / name).is_file() and sum_of_file(folder / name) != sums[name]:
            raise DamagedFileError(
                folder / name,
                f"has changed since it was written; repair it with w2m vln verify {folder} "
                f"--repair, or delete {CHECKSUMS} to accept it",
            )


def verify_set(folder: str | Path, progress: Progress = no_progress) -> SetReport:
    """Read all files of a set and compare them with its list.

    Args:
        folder: The folder of the set.
        progress: Called after each file.

    Raises:
        InputError: If the folder is not a navigation set.
        DamagedFileError: If a set without a list has an invalid record.
        ConflictError: If another process changes the set meanwhile.
    """
    root = Path(folder)
    with unchanged(root):
        return _verify(root, progress)


def _verify(root: Path, progress: Progress) -> SetReport:
    if not (root / CHECKSUMS).is_file():
        fault = (f"{CHECKSUMS}: missing",) if _states_list(root) else ()
        return _verify_unlisted(root, fault, progress)
    try:
        sums = read_checksums(root)
    except DamagedFileError as error:
        return _verify_unlisted(root, (f"{CHECKSUMS}: {error.reason}",), progress)
    if ITEMS not in sums:
        raise InputError(root, f"not a navigation set: {CHECKSUMS} does not list {ITEMS}")
    found = compare_files(root, sums, _is_own, progress)
    is_readable = ITEMS not in found.damaged
    return SetReport(
        items=len(read_items(root)) if is_readable else 0,
        files=len(sums),
        bytes=sum(one.size for one in sums.values()),
        faults=tuple(found.faults()),
        missing=found.missing,
        changed=found.changed,
        extra=found.extra,
    )


def pictures_of(folder: Path) -> Iterator[tuple[str, str, str, Stance | None]]:
    """Yield the name, SHA-256, scene ID and stance of the images that the records of a set name.

    Raises:
        InputError: If a record file cannot be read.
    """
    items = read_items(folder)
    for walk in read_trajectories(folder):
        for one in walk.keyframes:
            yield one.image, one.sha256, walk.scene_id, one.stance
    for item in items:
        for option in item.options:
            if option.image:
                sha256 = item.sha256.get(option.image, "")
                yield option.image, sha256, _scene_of(option.image, item.scene_id), option.stance
        for image in (*item.history, item.current):
            yield image, item.sha256.get(image, ""), item.scene_id, None


def _scene_of(image: str, scene_id: str) -> str:
    """Return the scene of an image, which in wrong answers may be another one."""
    parts = image.split("/")
    return parts[1] if len(parts) > 2 and parts[0] == IMAGES else scene_id


def _verify_unlisted(root: Path, faults: tuple[str, ...], progress: Progress) -> SetReport:
    """Verify a set without a valid list: its records, and the images that they name."""
    sums = {name: sha256 for name, sha256, *_ in pictures_of(root) if sha256}
    read_episodes(root) if (root / EPISODES).is_file() else None
    missing, changed = [], []
    for done, (name, sha256) in enumerate(sorted(sums.items())):
        progress("verify", done, len(sums), name)
        if not (root / name).is_file():
            missing.append(name)
        elif sum_of_file(root / name).sha256 != sha256:
            changed.append(name)
    progress("verify", len(sums), len(sums))
    found = [*(f"{name}: missing" for name in missing), *(f"{name}: changed" for name in changed)]
    return SetReport(
        items=len(read_items(root)),
        files=0,
        bytes=0,
        faults=(*faults, *found),
        missing=tuple(missing),
        changed=tuple(changed),
        has_valid_list=False,
    )


def _is_own(name: str) -> bool:
    return name == ANNOTATIONS or name.startswith(f"{REPLIES_FOLDER}/")


def _states_list(folder: Path) -> bool:
    """Return whether the description of a set states that it has a list of files."""
    try:
        about = read_json(folder / ABOUT)
    except InputError:
        return False
    return isinstance(about, dict) and bool(about.get("checksums"))
