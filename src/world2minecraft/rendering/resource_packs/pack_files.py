"""Files of resource packs, single or stacked, of which the highest pack with a name is used.

A pack is a folder, a zip or a jar. Nothing is extracted to disk, and file names in a pack are only
used as keys, so that they cannot lead out of it. Sizes are checked before data is read. A file that
cannot be read is recorded in ``problems``, and the next pack is used.
"""

import json
import os
import re
import stat
import zipfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from world2minecraft.core.archives import UNREADABLE
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError
from world2minecraft.core.files import read_bytes
from world2minecraft.rendering.resource_packs.json_validation import as_number, parse_resource_name

MAX_FILES = 400_000  # A client jar has about 30,000; a large pack of mods 150,000.
MAX_DIRECTORY_BYTES = 128 << 20  # Maximum size of a zip file's directory.
MAX_RATIO = 200  # Unpacked to packed, of files over a megabyte; JSON packs to a thirtieth.
_END, _END_64, _LOCATOR_64 = b"PK\x05\x06", b"PK\x06\x06", b"PK\x06\x07"
_LOOKS = re.compile(r"assets/[^/]+/(blockstates|models|textures)/.")
_KEPT = re.compile(r"(?:.*/)?(?:assets/[^/]+/(?:blockstates|models|textures)/.*|pack\.mcmeta)")
WHAT_A_PACK_IS = (
    "a pack is a folder, zip or jar that contains assets/minecraft/textures, models or "
    "blockstates, such as resourcepacks/MyPack.zip or versions/1.21.4/1.21.4.jar"
)
MAX_JSON_BYTES = 4 << 20  # The largest models of mods have some hundred kilobytes.
MAX_TOTAL_JSON_BYTES = 256 << 20  # The game's models and blockstates have 10 MB together.
MAX_PROBLEMS = 48  # What one can still read; the rest is counted.
# The format of resource packs whose rules are followed, that of 1.21.11: it chooses overlays.
RESOURCE_FORMAT = 75


@dataclass(frozen=True, eq=False)
class PackFiles:
    """The files of a pack: their ``names``, and ``read(name, most_bytes)`` for their bytes."""

    label: str
    names: frozenset[str]
    read: Callable[[str, int], bytes]


def open_pack(path: str | Path) -> PackFiles:
    """Open a resource pack, or the jar of a client or mod.

    Raises:
        InputError: If the path does not exist.
        DamagedFileError: If the path is not a resource pack. The message describes a valid pack.
        LimitError: If the pack contains too many files.
    """
    source = Path(path)
    if source.is_dir():
        files = _folder(source)
    elif source.is_file():
        files = _zip(source)
    else:
        raise InputError(source, f"not found; {WHAT_A_PACK_IS}")
    return _at_its_root(files, source)


def _folder(folder: Path) -> PackFiles:
    """List a folder's plain files; links are left out, as they may lead anywhere."""
    names: set[str] = set()
    seen = 0
    for parent, folders, files in os.walk(folder):
        folders.sort()
        seen += len(files) + len(folders)
        if seen > MAX_FILES:
            raise LimitError(
                folder,
                f"contains more than {MAX_FILES:,} files; give the path of a single pack in it",
            )
        inner = Path(parent).relative_to(folder).as_posix()
        for file in files:
            name = file if inner == "." else f"{inner}/{file}"
            if _KEPT.fullmatch(name) and _is_plain(Path(parent, file)):
                names.add(name)
    return PackFiles(
        folder.name, frozenset(names), lambda name, most: read_bytes(folder / name, most)
    )


def _is_plain(path: Path) -> bool:
    """Return whether a path is a file, and no link or pipe."""
    try:
        return stat.S_ISREG(path.lstat().st_mode)
    except OSError:
        return False


def _zip(path: Path) -> PackFiles:
    """List a zip's files, its own directory's size checked before it is read."""
    try:
        if _directory_bytes(path) > MAX_DIRECTORY_BYTES:
            raise LimitError(path, f"contains more than {MAX_FILES:,} files, which is the limit")
        archive = zipfile.ZipFile(path)
    except UNREADABLE as error:
        raise DamagedFileError(path, f"not a readable zip file ({error})") from error
    entries = {one.filename: one for one in archive.infolist() if not one.is_dir()}
    if len(entries) > MAX_FILES:
        raise LimitError(path, f"contains {len(entries):,} files, the limit is {MAX_FILES:,}")

    def read(name: str, most_bytes: int) -> bytes:
        return _unpacked(archive, entries[name], most_bytes)

    kept = frozenset(name for name in entries if _KEPT.fullmatch(name))
    return PackFiles(path.name, kept, read)


def _directory_bytes(path: Path) -> int:
    """Return the size that a zip says of its list of files, the larger of what it says twice."""
    with path.open("rb") as stream:
        size = stream.seek(0, os.SEEK_END)
        start = stream.seek(max(0, size - 65_535 - 22 - 76))  # A comment, and three records.
        tail = stream.read()
        at = tail.rfind(_END)
        if at < 0 or at + 22 > len(tail):
            raise zipfile.BadZipFile("end-of-archive record not found")
        sizes = [int.from_bytes(tail[at + 12 : at + 16], "little")]
        locator = tail[max(0, at - 20) : at]
        if locator.startswith(_LOCATOR_64):
            sizes = []
            for place in (start + at - 76, int.from_bytes(locator[8:16], "little")):
                stream.seek(min(max(place, 0), size))
                record = stream.read(56)
                if record.startswith(_END_64):
                    sizes.append(int.from_bytes(record[40:48], "little"))
    return max(sizes, default=0)


def _unpacked(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, most_bytes: int) -> bytes:
    """Return the bytes of a zip's file, or raise ValueError over one that is a trap or damaged."""
    size, packed = entry.file_size, max(entry.compress_size, 1)
    if size > most_bytes:
        raise ValueError(f"file has {size:,} bytes, the limit is {most_bytes:,}")
    if size > 1 << 20 and size / packed > MAX_RATIO:
        raise ValueError(f"compression ratio {size // packed:,} is implausibly high")
    if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError("unsupported compression method")
    try:
        with archive.open(entry) as stream:
            return stream.read(most_bytes)
    except UNREADABLE as error:
        raise ValueError(f"cannot be unpacked ({error})") from error


def _at_its_root(files: PackFiles, source: Path) -> PackFiles:
    """Return the files with names from the folder that holds ``assets``, one deeper at most."""
    if any(_LOOKS.match(name) for name in files.names):
        return files
    tops = {name.partition("/")[0] for name in files.names}
    inner = sorted(
        top for top in tops if any(_LOOKS.match(name[len(top) + 1 :]) for name in files.names)
    )
    if len(inner) == 1 and not source.is_dir():  # Zipped with the folder around it.
        skip = len(inner[0]) + 1
        names = frozenset(name[skip:] for name in files.names if name.startswith(inner[0] + "/"))
        return PackFiles(files.label, names, lambda n, most: files.read(f"{inner[0]}/{n}", most))
    raise DamagedFileError(source, f"not a resource pack{_hint(source, inner)}; {WHAT_A_PACK_IS}")


def _hint(source: Path, inner: list[str]) -> str:
    """Return what the path seems to be instead, for the message."""
    if inner:
        return f", but contains one: use {source / inner[0]}"
    if not source.is_dir():
        return ""
    packs = sorted(one.name for one in source.iterdir() if one.suffix in (".zip", ".jar"))
    if packs:
        return f", but contains {len(packs)}: use one, such as {source / packs[0]}"
    if (source / "manifest.json").is_file():
        return ", but a pack for Bedrock Edition, which is not supported"
    return ", but a data pack" if (source / "data").is_dir() else ""


class PackStack:
    """The files of several packs.

    ``problems`` contains the first problems as short sentences, and ``problem_count`` counts all.
    """

    def __init__(self, paths: Sequence[str | Path]):
        """Open the packs. The last pack has the highest priority.

        Raises:
            InputError: If a pack does not exist or is not a resource pack.
        """
        self.problems: list[str] = []
        self.problem_count = 0
        self._known: set[str] = set()
        self._json: dict[str, Any] = {}
        self._json_bytes = 0
        self._layers: list[tuple[PackFiles, str]] = []  # Each pack and a folder in it, top first.
        for pack in reversed([open_pack(path) for path in paths]):
            self._layers += [(pack, folder) for folder in (*self._overlays(pack), "")]

    def has(self, name: str) -> bool:
        """Return whether any pack has a file of this name."""
        return any(folder + name in pack.names for pack, folder in self._layers)

    def pictures(self) -> list[str]:
        """Return the names of all block textures in any pack and namespace, sorted."""
        names = {
            name.removeprefix(folder)
            for pack, folder in self._layers
            for name in pack.names
            if name.startswith(folder) and name.endswith(".png") and "/textures/block/" in name
        }
        return sorted(name for name in names if name.startswith("assets/"))

    def versions(self, name: str, most_bytes: int) -> Iterator[tuple[str, bytes]]:
        """Yield (location, bytes) of a file in each pack that has it, highest pack first."""
        for pack, folder in self._layers:
            if folder + name in pack.names:
                where = f"{folder}{name} of {pack.label}"
                try:
                    yield where, pack.read(folder + name, most_bytes)
                except InputError as error:
                    self.note(f"{where}: {error.reason}")
                except ValueError as error:
                    self.note(f"{where}: {error}")

    def object(self, name: str) -> dict[str, Any] | None:
        """Return the JSON object in a file, or None if no pack has a readable one."""
        if name not in self._json:
            self._json[name] = None
            for where, data in self.versions(name, MAX_JSON_BYTES):
                value = self._parsed(where, data)
                if value is not None:
                    self._json[name] = value
                    break
        return self._json[name]

    def note(self, problem: str) -> None:
        """Record a problem once."""
        if problem not in self._known:
            self.problem_count += 1
            if len(self.problems) < MAX_PROBLEMS:
                self.problems.append(problem)
                self._known.add(problem)

    def _parsed(self, where: str, data: bytes) -> dict[str, Any] | None:
        self._json_bytes += len(data)
        if self._json_bytes > MAX_TOTAL_JSON_BYTES:
            self.note(
                f"more than {MAX_TOTAL_JSON_BYTES:,} bytes of JSON in total; "
                "the remaining files are ignored"
            )
            return None
        try:
            value = json.loads(data.decode("utf-8-sig"))
        except (ValueError, RecursionError) as error:
            reason = str(error) if isinstance(error, ValueError) else "nested too deeply"
            self.note(f"{where}: invalid JSON ({reason})")
            return None
        if not isinstance(value, dict):
            self.note(f"{where}: must contain a JSON object")
            return None
        return value

    def _overlays(self, pack: PackFiles) -> list[str]:
        """Return the folders of a pack that lie over it in this format, the highest first."""
        if "pack.mcmeta" not in pack.names:
            return []
        try:
            root = self._parsed("pack.mcmeta", pack.read("pack.mcmeta", MAX_JSON_BYTES)) or {}
            entries = root.get("overlays", {}).get("entries", [])
            chosen = [_entry_folder(entry) for entry in entries if _is_for_now(entry)]
        except (ValueError, AttributeError, TypeError, InputError) as error:
            self.note(f"pack.mcmeta of {pack.label}: cannot read overlays ({error})")
            return []
        return chosen[::-1]


def _entry_folder(entry: dict[str, Any]) -> str:
    return parse_resource_name(entry.get("directory", ""), "overlay")[1] + "/"


def _is_for_now(entry: dict[str, Any]) -> bool:
    """Return whether an overlay is for ``RESOURCE_FORMAT``, by any of the ways to say so."""
    formats = entry.get("formats")
    if isinstance(formats, dict):
        low, high = formats.get("min_inclusive", 0), formats.get("max_inclusive", 9999)
    elif isinstance(formats, list):
        low, high = formats
    elif formats is not None:
        low = high = formats
    else:
        low, high = entry.get("min_format", 0), entry.get("max_format", 9999)
    low, high = (one[0] if isinstance(one, list) and one else one for one in (low, high))
    return as_number(low, "format") <= RESOURCE_FORMAT <= as_number(high, "format")
