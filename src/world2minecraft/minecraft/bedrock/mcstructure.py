"""Reading and writing of Bedrock structure files (``.mcstructure``).

A structure file is uncompressed little-endian NBT. It contains the size, two layers of palette
indices in the order x, y, z (z varies fastest; -1 leaves the existing block), a palette of block
names and states, and block entities by cell index. The second layer contains the water of
waterlogged blocks. Java entities are not converted.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, UsageError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.types import AIR, BlockEntity, BlockVolume
from world2minecraft.minecraft.bedrock.block_entities import (
    bedrock_data,
    is_in_state,
    java_data,
    java_from_entry,
    java_state,
    palette_entry,
)
from world2minecraft.minecraft.bedrock.nbt_little_endian import read_little, write_little
from world2minecraft.minecraft.bedrock.states import changed_properties, java_to_bedrock
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.file_format import FileFormat, Losses, WriteOptions
from world2minecraft.minecraft.nbt import NbtLimits
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.unlabelled_volume import (
    build_palette,
    check_size,
    invalid_file,
    unlabelled_volume,
)

FORMAT_VERSION = 1
MAX_BYTES = 96 << 20  # 12 million blocks, eight bytes each; the numbers are read in place.
LIMITS = NbtLimits(bytes=MAX_BYTES)
WATER = "minecraft:water[level=0]"
# Plants whose stems are blocks of their own in Java, and the direction in which they grow.
GROWING = {"cave_vines": -1, "weeping_vines": -1, "kelp": 1, "twisting_vines": 1}
IN_WATER = ("kelp", "kelp_plant", "seagrass", "tall_seagrass", "bubble_column")
NOTHING = -1


def write_mcstructure(volume: BlockVolume, path: str | Path, losses: Losses | None = None) -> None:
    """Write a volume as a structure file for Bedrock 1.20 and later.

    The volume's corner is written as ``structure_world_origin``. Blocks that do not exist in
    Bedrock Edition become air. They are counted by name in ``losses``, and so is each property of a
    block that is not the same when the file is read back.

    Raises:
        UsageError: If the volume is empty, or larger than the reader accepts.
        OutputError: If the file cannot be written.
    """
    counted = Losses() if losses is None else losses
    if not volume.states.size or volume.states.size * 8 > MAX_BYTES - (1 << 20):
        raise UsageError(
            f"a .mcstructure file must have 1 to 12 million blocks, got {volume.states.size:,}"
        )
    palette, numbers, is_wet = _bedrock_palette(volume.palette)
    cells = np.ascontiguousarray(volume.states).ravel()  # x, y, z with z fastest, as ours are.
    water = palette.index(palette_entry(*_bedrock(WATER)))
    tree = {
        "format_version": FORMAT_VERSION,
        "size": np.array(volume.states.shape, np.int32),
        "structure": {
            "block_indices": [
                numbers[cells],
                np.where(is_wet, water, NOTHING).astype(np.int32)[cells],
            ],
            "entities": [],
            "palette": {
                "default": {
                    "block_palette": palette,
                    "block_position_data": _position_data(volume),
                }
            },
        },
        "structure_world_origin": np.array(volume.corner, np.int32),
    }
    _count_losses(volume, _volume_of(tree, Path(path), Losses()), counted)
    write_bytes(path, write_little(tree))


def read_mcstructure(path: str | Path, losses: Losses | None = None) -> BlockVolume:
    """Read a structure file of Bedrock 1.17 to 1.26 as a volume without labels.

    The scale of the volume is one block per metre. Blocks that do not exist in Java Edition keep
    their Bedrock names and are counted in ``losses``.

    Raises:
        InputError: If the file is not found.
        DamagedFileError: If the file is not a valid structure.
        LimitError: If the file exceeds the size limit.
    """
    counted, source = Losses() if losses is None else losses, Path(path)
    tree = read_little(read_bytes(source, MAX_BYTES), source, LIMITS)
    try:
        return _volume_of(tree, source, counted)
    except MALFORMED as error:
        raise invalid_file(source, "a valid Bedrock structure", error) from error


class McstructureFormat(FileFormat):
    """The Bedrock structure format, ``.mcstructure``."""

    suffix = ".mcstructure"

    def read(self, path: Path, losses: Losses) -> BlockVolume:
        """Read a Bedrock structure file."""
        return read_mcstructure(path, losses)

    def write(self, volume: BlockVolume, path: Path, options: WriteOptions, losses: Losses) -> None:
        """Write a Bedrock structure file. The Java version in ``options`` is ignored."""
        write_mcstructure(volume, path, losses)


# Writing.


def _bedrock(state: str) -> tuple[str, dict[str, Any]]:
    """Return the Bedrock block of a Java state, or air if there is none."""
    return java_to_bedrock(state) or ("minecraft:air", {})


def _bedrock_palette(
    states: Iterable[str],
) -> tuple[list[dict[str, Any]], np.ndarray, np.ndarray]:
    """Return the palette, the index of each state, int32 [P], and which states contain water."""
    number_of: dict[str, int] = {}
    palette: list[dict[str, Any]] = []
    numbers, is_wet = [], []
    for state in [*states, WATER]:
        name, values = _bedrock(state)
        key = f"{name}{sorted(values.items())}"
        if key not in number_of:
            number_of[key] = len(palette)
            palette.append(palette_entry(name, values))
        numbers.append(number_of[key])
        parsed = parse_state(state)
        in_water = parsed.name.partition(":")[2] in IN_WATER
        is_wet.append(in_water or parsed.get("waterlogged") == "true")
    return palette, np.array(numbers[:-1], np.int32), np.array(is_wet[:-1], bool)


def _position_data(volume: BlockVolume) -> dict[str, Any]:
    """Return the block entities by cell index."""
    held = {entity.block_pos: (entity.id, entity.nbt) for entity in volume.block_entities}
    speaking = [n for n, state in enumerate(volume.palette) if bedrock_data(state)]
    cells = {tuple(cell) for cell in np.argwhere(np.isin(volume.states, speaking)).tolist()}
    for place in held:
        cell = tuple(int(a) - b for a, b in zip(place, volume.corner, strict=True))
        if all(0 <= c < side for c, side in zip(cell, volume.states.shape, strict=True)):
            cells.add(cell)
    result = {}
    for cell in sorted(cells):
        x, y, z = (c + low for c, low in zip(cell, volume.corner, strict=True))
        state = volume.palette[volume.states[cell]]
        data = bedrock_data(state, held.get((x, y, z)), (x, y, z))
        if data is not None:
            number = np.ravel_multi_index(cell, volume.states.shape)
            result[str(int(number))] = {"block_entity_data": data}
    return result


def _count_losses(volume: BlockVolume, back: BlockVolume, losses: Losses) -> None:
    """Count what differs in ``back``, the volume that is read from what was written."""
    pairs = volume.states.astype(np.int64) * len(back.palette) + back.states
    codes, counts = np.unique(pairs, return_counts=True)
    for code, count in zip(codes.tolist(), counts.tolist(), strict=True):
        state, again = (
            volume.palette[code // len(back.palette)],
            back.palette[code % len(back.palette)],
        )
        name = parse_state(state).name
        if java_to_bedrock(state) is None:
            losses.add(f"blocks of {name}, which Bedrock does not have", count)
        for key in changed_properties(state, again) if java_to_bedrock(state) else ():
            losses.add(f"{key} of {name}, which Bedrock does not keep", count)
    state_at = _states_by_place(volume)
    for entity in volume.block_entities:
        data = bedrock_data(state_at.get(entity.block_pos, AIR), (entity.id, entity.nbt))
        if data is None and entity.nbt:
            losses.add(f"block entity data ({entity.id.removeprefix('minecraft:')})")
    losses.add("entities", len(volume.entities))


def _states_by_place(volume: BlockVolume) -> dict[tuple[int, int, int], str]:
    """Return the block states at the positions of block entities."""
    result = {}
    for entity in volume.block_entities:
        cell = tuple(int(a) - b for a, b in zip(entity.block_pos, volume.corner, strict=True))
        if all(0 <= c < side for c, side in zip(cell, volume.states.shape, strict=True)):
            result[entity.block_pos] = volume.palette[volume.states[cell]]
    return result


# Reading.


def _volume_of(tree: Mapping[str, Any], source: Path, losses: Losses) -> BlockVolume:
    shape = check_size(tree["size"], source)
    structure = tree["structure"]
    layers = [np.asarray(layer) for layer in structure["block_indices"]]
    count = int(np.prod(shape))
    if not layers or any(layer.shape != (count,) for layer in layers[:2]):
        raise DamagedFileError(
            source, f"declares {count:,} blocks, but a block layer has a different length"
        )
    held = structure["palette"]["default"]
    entries = held["block_palette"]
    if any(layer.size and not -1 <= layer.min() <= layer.max() < len(entries) for layer in layers):
        raise DamagedFileError(source, "contains a block index that is not in its palette")
    texts = [_java_text(entry, source) for entry in entries]
    _count_unknown(entries, layers[0], losses)
    x, y, z = (int(value) for value in tree.get("structure_world_origin", (0, 0, 0)))
    wet = _wet_cells(layers, texts)
    names = [*texts, AIR]  # -1 is the last: what a structure leaves alone is air here.
    placed = _with_data(held.get("block_position_data", {}), layers[0], names, shape, source)
    every = {*names, *(_is_wet(text) for text in names), *(state for state, _ in placed.values())}
    every |= {_is_wet(state) for state, _ in placed.values()}
    palette, number_of = build_palette(every, source)
    ours = np.array([number_of[text] for text in names], np.uint16)
    in_water = np.array([number_of[_is_wet(text)] for text in names], np.uint16)
    states = np.where(wet, in_water[layers[0]], ours[layers[0]]).reshape(shape)
    block_entities = []
    for number, (state, data) in sorted(placed.items()):
        cell = np.unravel_index(number, shape)
        states[cell] = number_of[_is_wet(state) if wet[number] else state]
        java = java_data(data)
        if not is_in_state(data):
            losses.add(f"block entity data ({str(data.get('id'))[:30]})")
        if java is not None:
            place = tuple(int(c) + low for c, low in zip(cell, (x, y, z), strict=True))
            block_entities.append(BlockEntity(place, *java))  # type: ignore[arg-type]
    losses.add("entities", len(structure.get("entities", [])))
    # What Bedrock leaves to its neighbours a Java file must state.
    states, palette = update_connections(*_with_stems(states, palette))
    return _trim_palette(states, palette, (x, y, z), block_entities)


def _with_stems(states: np.ndarray, palette: tuple[str, ...]) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return the states with the stems of growing plants, which Bedrock does not tell from tips."""
    names = [state.partition("[")[0].removeprefix("minecraft:") for state in palette]
    states, result = states.copy(), list(palette)
    for tip, grows in GROWING.items():
        kinds = [n for n, name in enumerate(names) if name in (tip, f"{tip}_plant")]
        if not kinds:
            continue
        is_plant = np.pad(np.isin(states, kinds), ((0, 0), (1, 1), (0, 0)))
        has_next = is_plant[:, 1 + grows : 1 + grows + states.shape[1]]
        for number in [n for n in kinds if names[n] == tip]:
            berries = parse_state(palette[number]).get("berries")
            stem = f"minecraft:{tip}_plant" + (f"[berries={berries}]" if berries else "")
            if stem not in result:
                result.append(stem)
            states[has_next & (states == number)] = result.index(stem)
    return states, tuple(result)


def _trim_palette(
    states: np.ndarray,
    palette: tuple[str, ...],
    corner: tuple[int, int, int],
    block_entities: list[BlockEntity],
) -> BlockVolume:
    """Return a volume whose palette contains only air and the states that occur."""
    used = sorted({0, *np.unique(states).tolist()})
    lookup = np.zeros(len(palette), np.uint16)
    lookup[used] = np.arange(len(used))
    names = tuple(palette[number] for number in used)
    return unlabelled_volume(lookup[states], names, corner, block_entities)


def _java_text(entry: Mapping[str, Any], source: Path) -> str:
    """Return the Java state of a palette entry. An unknown block keeps its Bedrock name."""
    found = java_from_entry(entry)
    if found is not None:
        return found
    try:
        return str(parse_state(str(entry["name"])))
    except UsageError as error:
        raise DamagedFileError(source, f"contains an invalid palette entry: {error}") from error


def _count_unknown(entries: list[Any], cells: np.ndarray, losses: Losses) -> None:
    counts = np.bincount(cells[cells >= 0], minlength=len(entries))
    for entry, count in zip(entries, counts.tolist(), strict=True):
        if java_from_entry(entry) is None:
            losses.add(f"blocks of {str(entry['name'])[:60]}, which Java does not have", count)


def _wet_cells(layers: list[np.ndarray], texts: list[str]) -> np.ndarray:
    """Return which cells have water in the second layer, as bool [N]."""
    if len(layers) < 2:
        return np.zeros(len(layers[0]), bool)
    is_water = np.array([text.startswith("minecraft:water[") for text in texts] + [False])
    return is_water[layers[1]]


def _is_wet(state: str) -> str:
    """Return the waterlogged state of a block if it has one."""
    parsed = complete(parse_state(state))
    return str(parsed.having(waterlogged="true")) if parsed.get("waterlogged") else state


def _with_data(
    stated: Mapping[str, Any], cells: np.ndarray, names: list[str], shape: Any, source: Path
) -> dict[int, tuple[str, Mapping[str, Any]]]:
    """Return the state and data of the cells whose block entity determines the state."""
    result = {}
    for key, row in stated.items():
        if not key.isdecimal() or int(key[:12]) >= len(cells):
            raise DamagedFileError(
                source, f"contains block entity data for the invalid block index {key[:20]!r}"
            )
        data = row.get("block_entity_data") if isinstance(row, Mapping) else None
        if isinstance(data, Mapping):
            result[int(key)] = (java_state(names[cells[int(key)]], data), data)
    return result
