"""The public Python packages that write and read blocks, as rivals of ``bench_minecraft``.

Each is used block by block, as its documentation shows; none of them has another interface.
litemapy is not a development package. It takes part where it can be imported: ``pip install
--no-deps --target FOLDER litemapy``, and FOLDER in ``PYTHONPATH``.
"""

from importlib.util import find_spec
from pathlib import Path

import anvil
import mcschematic
import nbtlib
import numpy as np
from nbtlib import tag

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.block_states import parse_state

HAS_LITEMAPY = find_spec("litemapy") is not None


def blocks_of(volume: BlockVolume) -> list[tuple[tuple[int, int, int], str]]:
    """The blocks that are not air: place and state."""
    cells = np.argwhere(volume.states)
    numbers = volume.states[tuple(cells.T)].tolist()
    places = [(x, y, z) for x, y, z in cells.tolist()]
    return [(place, volume.palette[n]) for place, n in zip(places, numbers, strict=True)]


def anvil_write(volume: BlockVolume, path: Path) -> None:
    region = anvil.EmptyRegion(0, 0)
    blocks = {state: _anvil_block(state) for state in volume.palette}
    for place, state in blocks_of(volume):
        region.set_block(blocks[state], *place)
    region.save(str(path))


def _anvil_block(state: str) -> anvil.Block:
    parsed = parse_state(state)
    return anvil.Block(*parsed.name.split(":"), properties=dict(parsed.properties))


def anvil_read(path: Path, shape: tuple[int, int, int]) -> int:
    region = anvil.Region.from_file(str(path))
    count = 0
    for x in range(shape[0] // 16):
        for z in range(shape[2] // 16):
            chunk = region.get_chunk(x, z)
            for section in range(shape[1] // 16):
                count += sum(1 for _ in chunk.stream_blocks(section=section))
    return count


def mcschematic_write(volume: BlockVolume, folder: Path) -> None:
    schematic = mcschematic.MCSchematic()
    for place, state in blocks_of(volume):
        schematic.setBlock(place, state)
    schematic.save(str(folder), "rival", mcschematic.Version.JE_1_20_1)


def mcschematic_read(path: Path) -> None:
    mcschematic.MCSchematic(str(path))


def nbtlib_structure_write(volume: BlockVolume, path: Path) -> None:
    blocks = [
        tag.Compound({"pos": tag.List[tag.Int](place), "state": tag.Int(number)})
        for place, number in np.ndenumerate(volume.states)
    ]
    tree = {
        "DataVersion": tag.Int(3465),
        "size": tag.List[tag.Int](volume.states.shape),
        "palette": tag.List[tag.Compound](map(_entry, volume.palette)),
        "blocks": tag.List[tag.Compound](blocks),
        "entities": tag.List[tag.Compound]([]),
    }
    nbtlib.File(tree).save(path, gzipped=True)


def _entry(state: str) -> tag.Compound:
    parsed = parse_state(state)
    properties = {key: tag.String(value) for key, value in parsed.properties}
    return tag.Compound({"Name": tag.String(parsed.name), "Properties": tag.Compound(properties)})


def nbtlib_structure_read(path: Path) -> np.ndarray:
    root = nbtlib.load(path)
    states = np.zeros([int(side) for side in root["size"]], np.uint16)
    for block in root["blocks"]:
        x, y, z = block["pos"]
        states[x, y, z] = block["state"]
    return states


def nbtlib_litematic_write(volume: BlockVolume, path: Path) -> None:
    bits = max(2, (len(volume.palette) - 1).bit_length())
    cells = volume.states.transpose(1, 2, 0).ravel().tolist()
    words = [0] * -(-len(cells) * bits // 64)
    for index, number in enumerate(cells):
        word, shift = divmod(index * bits, 64)
        words[word] |= number << shift & (1 << 64) - 1
        if shift + bits > 64:
            words[word + 1] |= number >> (64 - shift)
    region = {
        "Position": tag.Compound({axis: tag.Int(0) for axis in "xyz"}),
        "Size": tag.Compound(
            {axis: tag.Int(n) for axis, n in zip("xyz", volume.states.shape, strict=True)}
        ),
        "BlockStatePalette": tag.List[tag.Compound](map(_entry, volume.palette)),
        "BlockStates": tag.LongArray(np.array(words, np.uint64).view(np.int64)),
    }
    regions = tag.Compound({"a": tag.Compound(region)})
    nbtlib.File({"Version": tag.Int(6), "Regions": regions}).save(path, gzipped=True)


def nbtlib_litematic_read(path: Path) -> list[int]:
    (region,) = nbtlib.load(path)["Regions"].values()
    bits = max(2, (len(region["BlockStatePalette"]) - 1).bit_length())
    words = np.array(region["BlockStates"]).astype(np.int64).view(np.uint64).tolist()
    mask, cells = (1 << bits) - 1, []
    count = int(np.prod([int(region["Size"][axis]) for axis in "xyz"]))
    for index in range(count):
        word, shift = divmod(index * bits, 64)
        value = words[word] >> shift
        if shift + bits > 64:
            value |= words[word + 1] << (64 - shift)
        cells.append(value & mask)
    return cells


def nbtlib_schem_read(path: Path) -> list[int]:
    root = nbtlib.load(path)
    cells, value, shift = [], 0, 0
    for byte in np.array(root["Blocks"] if "Blocks" in root else root["BlockData"]).tolist():
        value |= (byte & 127) << shift
        shift += 7
        if byte >= 0:
            cells.append(value)
            value, shift = 0, 0
    return cells


def nbtlib_schematic_read(path: Path, names: dict[tuple[int, int], str]) -> list[str]:
    root = nbtlib.load(path)
    numbers, values = np.array(root["Blocks"]).tolist(), np.array(root["Data"]).tolist()
    return [names[number & 255, value] for number, value in zip(numbers, values, strict=True)]


def litemapy_write(volume: BlockVolume, path: Path) -> None:
    import litemapy

    region = litemapy.Region(0, 0, 0, *volume.states.shape)
    states = {}
    for state in volume.palette:
        parsed = parse_state(state)
        states[state] = litemapy.BlockState(parsed.name, **dict(parsed.properties))
    for place, state in blocks_of(volume):
        region[place] = states[state]
    region.as_schematic(name="rival").save(str(path))


def litemapy_read(path: Path) -> int:
    import litemapy

    (region,) = litemapy.Schematic.load(str(path)).regions.values()
    return sum(region[place].id != "minecraft:air" for place in region.block_positions())
