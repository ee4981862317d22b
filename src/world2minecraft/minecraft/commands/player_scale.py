"""Data pack functions that scale the player to the size of a room.

The game has attributes for body scale and step height since 1.20.5, and renamed them in 1.21.2. A
function with an unknown attribute fails to load, so an overlay for each range of versions contains
the matching names. Older games run a function that only prints a message.
"""

import io
import json
import zipfile
from collections.abc import Mapping
from typing import Any

from world2minecraft.core.files import FIXED_DATE
from world2minecraft.minecraft.versions import GameVersion, game_versions

NAMESPACE = "w2m"
FOLDERS = ("function", "functions")  # From 1.21 on, and before.
STEP_BLOCKS = 0.6
SCALE_LIMITS = (0.0625, 16.0)
STEP_LIMITS = (0.0, 10.0)
FIRST_SCALE_FORMAT = 41  # 1.20.5
PLAIN_NAMES_FORMAT = 57  # 1.21.2
# A click on a plaque switches between the two sizes. A tag stores the current one; the functions
# set it too, so that a click also works after a typed command.
_TOGGLE = """\
tag @s[tag=w2m.human_size] add w2m.back
execute if entity @s[tag=w2m.back] run function w2m:game_size
execute unless entity @s[tag=w2m.back] run function w2m:human_size
tag @s[tag=w2m.back] remove w2m.back
"""


def size_pack(blocks_per_metre: float) -> bytes:
    """Return a zipped data pack with functions that change the player's size.

    The functions are ``w2m:human_size``, ``w2m:game_size`` and ``w2m:toggle_size``. The pack works
    in every known game.

    Args:
        blocks_per_metre: The scale of the room, by which the player is enlarged.
    """
    files = {"pack.mcmeta": pack_mcmeta("The player's size for this room")}
    files |= size_functions(blocks_per_metre)
    return pack_zip(files)


def size_functions(blocks_per_metre: float) -> dict[str, str]:
    """Return the contents of the size functions by path in the pack, including the overlays."""
    scale = min(max(blocks_per_metre, SCALE_LIMITS[0]), SCALE_LIMITS[1])
    step = min(max(STEP_BLOCKS * scale, STEP_LIMITS[0]), STEP_LIMITS[1])
    text = "Minecraft 1.20.5 or later is required to change the player's size."
    line = f"tellraw @s {json.dumps({'text': text})}\n"
    files = {}
    sizes = (("human_size", (scale, step), "add"), ("game_size", (1.0, STEP_BLOCKS), "remove"))
    for name, values, tagged in sizes:
        files |= function_files(NAMESPACE, name, line)
        for overlay, prefix in (("scale_old_names", "generic."), ("scale_plain_names", "")):
            commands = "".join(
                f"attribute @s minecraft:{prefix}{attribute} base set {value:g}\n"
                for attribute, value in zip(("scale", "step_height"), values, strict=True)
            )
            commands += f"tag @s {tagged} {NAMESPACE}.human_size\n"
            for path, held in function_files(NAMESPACE, name, commands).items():
                files[f"{overlay}/{path}"] = held
    return files | function_files(NAMESPACE, "toggle_size", _TOGGLE)


def function_files(namespace: str, name: str, commands: str) -> dict[str, str]:
    """Return one function under both the old and the new name of the function folder."""
    return {f"data/{namespace}/{folder}/{name}.mcfunction": commands for folder in FOLDERS}


def pack_mcmeta(description: str, version: GameVersion | None = None) -> str:
    """Return a ``pack.mcmeta`` with the size overlays that every known game version accepts.

    Games up to 1.20.1 read only ``pack_format``, games up to 1.21.8 read ``supported_formats``, and
    later games read ``min_format`` and ``max_format``. If older games are supported, the latest
    games also require the old keys with the same bounds.
    """
    first, last = game_versions()[0], game_versions()[-1]
    entries = [
        _overlay("scale_old_names", FIRST_SCALE_FORMAT, PLAIN_NAMES_FORMAT - 1),
        _overlay("scale_plain_names", PLAIN_NAMES_FORMAT, last.pack_format),
    ]
    pack = {
        "description": description,
        "pack_format": (version or first).pack_format,
        **_bounds("supported_formats", first.pack_format, last.pack_format),
    }
    return json.dumps({"pack": pack, "overlays": {"entries": entries}}, indent=1) + "\n"


def pack_zip(files: Mapping[str, str | bytes]) -> bytes:
    """Return a zip archive of text and binary files whose bytes depend only on the files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, FIXED_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            held = files[name]
            data = held.encode() if isinstance(held, str) else held
            archive.writestr(entry, data, compresslevel=6)
    return buffer.getvalue()


def _overlay(directory: str, low: int, high: int) -> dict[str, Any]:
    return {"directory": directory, **_bounds("formats", low, high)}


def _bounds(key: str, low: int, high: int) -> dict[str, Any]:
    return {
        key: {"min_inclusive": low, "max_inclusive": high},
        "min_format": low,
        "max_format": high,
    }
