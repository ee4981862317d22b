"""Packs in a stack: a file's name becomes its bytes or its JSON, from the highest that has it.

A file that cannot be read is written down in ``problems``, and the pack below is asked.
"""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import InputError
from world2minecraft.rendering.resource_packs.archive import PackFiles, open_pack
from world2minecraft.rendering.resource_packs.json_checks import number, resource

MOST_JSON_BYTES = 4 << 20  # The largest models of mods have some hundred kilobytes.
MOST_JSON_BYTES_OF_ALL = 256 << 20  # The game's models and blockstates have 10 MB together.
MOST_PROBLEMS = 48  # What one can still read; the rest is counted.
# The format of resource packs whose rules are followed, that of 1.21.11: it chooses overlays.
RESOURCE_FORMAT = 75


class Resources:
    """The files of several packs. ``problems`` holds short sentences, ``problem_count`` all."""

    def __init__(self, paths: Sequence[str | Path]):
        """Open the packs, the last above the others. Raises what ``open_pack`` raises."""
        self.problems: list[str] = []
        self.problem_count = 0
        self._known: set[str] = set()
        self._json: dict[str, Any] = {}
        self._json_bytes = 0
        self._layers: list[tuple[PackFiles, str]] = []  # Each pack and a folder in it, top first.
        for pack in reversed([open_pack(path) for path in paths]):
            self._layers += [(pack, folder) for folder in (*self._overlays(pack), "")]

    def has(self, name: str) -> bool:
        """Return whether any pack has a file of that name."""
        return any(folder + name in pack.names for pack, folder in self._layers)

    def pictures(self) -> list[str]:
        """Return the names of all pictures of blocks, sorted, of any pack and namespace."""
        names = {
            name.removeprefix(folder)
            for pack, folder in self._layers
            for name in pack.names
            if name.startswith(folder) and name.endswith(".png") and "/textures/block/" in name
        }
        return sorted(name for name in names if name.startswith("assets/"))

    def versions(self, name: str, most_bytes: int) -> Iterator[tuple[str, bytes]]:
        """Yield (where, bytes) of each pack's file of that name, the highest first."""
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
        """Return the JSON object in a file, None where no pack has one that can be read."""
        if name not in self._json:
            self._json[name] = None
            for where, data in self.versions(name, MOST_JSON_BYTES):
                value = self._parsed(where, data)
                if value is not None:
                    self._json[name] = value
                    break
        return self._json[name]

    def note(self, problem: str) -> None:
        """Write a problem down, once."""
        if problem not in self._known:
            self.problem_count += 1
            if len(self.problems) < MOST_PROBLEMS:
                self.problems.append(problem)
                self._known.add(problem)

    def _parsed(self, where: str, data: bytes) -> dict[str, Any] | None:
        self._json_bytes += len(data)
        if self._json_bytes > MOST_JSON_BYTES_OF_ALL:
            self.note(f"more than {MOST_JSON_BYTES_OF_ALL:,} bytes of JSON; the rest is left out")
            return None
        try:
            value = json.loads(data.decode("utf-8-sig"))
        except (ValueError, RecursionError) as error:
            reason = str(error) if isinstance(error, ValueError) else "it is nested too deep"
            self.note(f"{where}: is not JSON ({reason})")
            return None
        if not isinstance(value, dict):
            self.note(f"{where}: must be an object")
            return None
        return value

    def _overlays(self, pack: PackFiles) -> list[str]:
        """Return the folders of a pack that lie over it in this format, the highest first."""
        if "pack.mcmeta" not in pack.names:
            return []
        try:
            root = self._parsed("pack.mcmeta", pack.read("pack.mcmeta", MOST_JSON_BYTES)) or {}
            entries = root.get("overlays", {}).get("entries", [])
            chosen = [_folder(entry) for entry in entries if _is_for_now(entry)]
        except (ValueError, AttributeError, TypeError, InputError) as error:
            self.note(f"pack.mcmeta of {pack.label}: its overlays cannot be read ({error})")
            return []
        return chosen[::-1]


def _folder(entry: dict[str, Any]) -> str:
    return resource(entry.get("directory", ""), "overlay")[1] + "/"


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
    return number(low, "format") <= RESOURCE_FORMAT <= number(high, "format")
