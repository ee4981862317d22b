"""Data packs, run by a small interpreter of the commands that they use."""

import json
import re
import zipfile
from collections import Counter

import numpy as np
import pytest
from block_volumes import furnished_volume, random_volume, state_texts, volume_of

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import AIR
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.commands import datapack
from world2minecraft.minecraft.commands.datapack import datapack_files, write_datapack
from world2minecraft.minecraft.commands.fill_boxes import MAX_FILL, cover_with_boxes
from world2minecraft.minecraft.commands.player_scale import size_functions, size_pack
from world2minecraft.minecraft.commands.writer import snbt
from world2minecraft.minecraft.nbt import Byte, Float, Long, Short
from world2minecraft.minecraft.versions import game_version, game_versions

OLD = game_version("1.20.1")


class Game:
    """Runs functions as the game does: schedules by tick, and nothing in unloaded chunks."""

    def __init__(self, files: dict[str, str], folder: str):
        self.files, self.folder = files, folder
        self.blocks: dict[tuple[int, ...], str] = {}
        self.loaded: set[tuple[int, int]] = set()
        self.asked: set[tuple[int, int]] = set()
        self.due: dict[str, int] = {}
        self.said: list[str] = []
        self.chains: list[int] = []
        self.other: list[str] = []

    def run(self, name: str, ticks: int = 400, load_after: int = 35) -> None:
        self.due[name] = 0
        for tick in range(ticks):
            if tick == load_after:
                self.loaded |= self.asked
            for function in [f for f, when in self.due.items() if when == tick]:
                del self.due[function]
                self.chains.append(0)
                self.call(function, tick)

    def call(self, function: str, tick: int) -> None:
        namespace, path = function.split(":")
        text = self.files[f"data/{namespace}/{self.folder}/{path}.mcfunction"]
        for line in text.splitlines():
            self.chains[-1] += 1
            self.command(line.split(" "), line, tick)

    def command(self, words: list[str], line: str, tick: int) -> None:
        match words:
            case ["forceload", verb, *area]:
                chunks = self.chunks(area)
                assert len(chunks) <= 256
                self.asked = self.asked | chunks if verb == "add" else self.asked - chunks
            case ["schedule", "function", name, wait, "replace"]:
                self.due[name] = tick + int(wait.removesuffix("t"))
            case ["schedule", "clear", name]:
                self.due.pop(name, None)
            case ["function", name]:
                self.call(name, tick)
            case ["execute", *rest]:
                at = rest.index("run")
                tests = [rest[i : i + 5] for i in range(0, at, 5)]
                assert all(test[:2] == ["if", "loaded"] for test in tests)
                if all((int(t[2]) >> 4, int(t[4]) >> 4) in self.loaded for t in tests):
                    self.command(rest[at + 1 :], "", tick)
            case ["setblock", x, y, z, state]:
                self.place((int(x), int(y), int(z)), state)
            case ["fill", *numbers, state]:
                self.fill([int(number) for number in numbers], state)
            case ["tellraw", "@a", *_]:
                self.said.append(json.loads(line.partition("@a ")[2])["text"])
            case _:
                self.other.append(line)

    def chunks(self, area: list[str]) -> set[tuple[int, int]]:
        x0, z0, x1, z1 = (int(value) >> 4 for value in area)
        return {(x, z) for x in range(x0, x1 + 1) for z in range(z0, z1 + 1)}

    def fill(self, numbers: list[int], state: str) -> None:
        low, high = numbers[:3], numbers[3:]
        sides = [range(a, b + 1) for a, b in zip(low, high, strict=True)]
        assert 0 < np.prod([len(side) for side in sides]) <= 32_768
        for x in sides[0]:
            for y in sides[1]:
                for z in sides[2]:
                    self.place((x, y, z), state)

    def place(self, position: tuple[int, ...], state: str) -> None:
        assert (position[0] >> 4, position[2] >> 4) in self.loaded, "the chunk is not loaded"
        if state == AIR:
            self.blocks.pop(position, None)
        else:
            self.blocks[position] = state


def blocks_of(volume) -> dict[tuple[int, ...], str]:
    texts = state_texts(volume)
    return {
        tuple(int(v) for v in cell + volume.corner): str(texts[tuple(cell)])
        for cell in np.argwhere(volume.states)
    }


@pytest.mark.parametrize("folder", ["function", "functions"])
@pytest.mark.parametrize("shape", [(20, 9, 15), (300, 3, 30), (1, 1, 1)], ids=str)
def test_build_makes_the_volume_and_clear_takes_it_away(shape, folder):
    volume = random_volume(shape, 8, (-11, 60, 5))
    game = Game(datapack_files(volume, OLD, "room"), folder)
    game.run("room:build")
    assert game.blocks == blocks_of(volume)
    assert game.said == ["room is built."]
    assert not game.due and not game.asked
    game.run("room:clear")
    assert game.blocks == {}
    assert not game.due and not game.asked


def test_long_builds_are_cut_into_parts_below_the_limit(monkeypatch):
    monkeypatch.setattr(datapack, "MAX_COMMANDS", 50)
    volume = random_volume((12, 9, 10), 8, (0, 60, 0))
    files = datapack_files(volume, OLD, "room")
    game = Game(files, "functions")
    game.run("room:build")
    assert game.blocks == blocks_of(volume)
    assert max(game.chains) <= 51
    assert sum("/build/part_" in path for path in files) == 8


def test_a_pack_stays_below_the_limits_of_the_game():
    assert datapack.MAX_COMMANDS < 65_536
    volume = volume_of(np.ones((90, 20, 200)), (AIR, "minecraft:stone"), (0, 60, 0))
    game = Game(datapack_files(volume, OLD, "room"), "function")
    game.run("room:build")
    assert len(game.blocks) == 90 * 20 * 200


def test_full_blocks_stand_before_what_hangs_on_them():
    volume = furnished_volume()
    text = datapack_files(volume, OLD, "room")["data/room/function/build/part_0.mcfunction"]
    states = [line.split(" ")[-1] for line in text.splitlines() if line.startswith(("fill", "set"))]
    is_full = [is_full_cube(state) for state in states]
    assert is_full == sorted(is_full, reverse=True)
    assert set(is_full) == {True, False}


def test_signs_and_displays_come_with_their_data():
    files = datapack_files(furnished_volume(), OLD, "room")
    text = files["data/room/function/build/part_0.mcfunction"]
    assert "data merge block 0 64 0 " in text
    summon = next(line for line in text.splitlines() if line.startswith("summon"))
    assert summon.startswith("summon minecraft:block_display -1.250000 64.500000 2.750000 {")
    assert '"Tags":["w2m_-3_63_-2"]' in summon
    assert "kill @e[tag=w2m_-3_63_-2]\n" in files["data/room/function/clear/part_0.mcfunction"]


def boxes_cover(states: np.ndarray, boxes: np.ndarray) -> np.ndarray:
    out = np.zeros(states.shape, int)
    for state, x0, y0, z0, x1, y1, z1 in boxes.tolist():
        window = out[x0 : x1 + 1, y0 : y1 + 1, z0 : z1 + 1]
        assert not window.any(), "two boxes overlap"
        window[...] = state
    return out


@pytest.mark.parametrize("limit", [1, 7, 100, MAX_FILL])
def test_boxes_cover_each_block_once_within_the_limit(limit):
    states = random_volume((14, 9, 11), 4, (0, 0, 0)).states
    boxes = cover_with_boxes(states, limit)
    np.testing.assert_array_equal(boxes_cover(states, boxes), states)
    assert np.prod(boxes[:, 4:] - boxes[:, 1:4] + 1, axis=1).max() <= limit


def test_a_plain_room_takes_few_boxes():
    states = np.zeros((20, 10, 20), np.uint16)
    states[:, 0], states[0], states[-1], states[:, :, 0], states[:, :, -1] = 1, 2, 2, 2, 2
    assert len(cover_with_boxes(states)) <= 6
    assert len(cover_with_boxes(np.zeros((3, 3, 3), np.uint16))) == 0
    assert len(cover_with_boxes(np.ones((32, 33, 32), np.uint16))) == 2


# What surrounds the commands.


def test_the_pack_says_what_it_is_for_every_game():
    meta = json.loads(datapack_files(furnished_volume(), OLD, "room")["pack.mcmeta"])
    newest = game_versions()[-1].pack_format
    assert meta["pack"]["pack_format"] == 15
    assert meta["pack"]["supported_formats"] == {"min_inclusive": 15, "max_inclusive": newest}
    assert (meta["pack"]["min_format"], meta["pack"]["max_format"]) == (15, newest)
    for entry in meta["overlays"]["entries"]:
        held = entry["formats"]
        assert (held["min_inclusive"], held["max_inclusive"]) == (
            entry["min_format"],
            entry["max_format"],
        )
        assert re.fullmatch(r"[a-z0-9_-]+", entry["directory"])


def size_commands(files: dict[str, str], version) -> str:
    """What a version of the game finds under ``w2m:human_size``, overlays applied."""
    meta = json.loads(files["pack.mcmeta"])
    folder = "function" if version.pack_format >= 45 else "functions"
    path = f"data/w2m/{folder}/human_size.mcfunction"
    text = files[path]
    for entry in meta["overlays"]["entries"] if version.pack_format >= 18 else []:
        if entry["min_format"] <= version.pack_format <= entry["max_format"]:
            text = files[f"{entry['directory']}/{path}"]
    return text


@pytest.mark.parametrize("version", game_versions(), ids=lambda version: version.name)
def test_each_game_gets_the_attributes_that_it_knows(version):
    text = size_commands(datapack_files(random_volume((3, 3, 3), 2, (0, 0, 0)), OLD, "r"), version)
    if version.data_version < 3837:
        assert "attribute" not in text and text.startswith("tellraw @s ")
    else:
        prefix = "generic." if version.data_version < 4080 else ""
        assert text == (
            f"attribute @s minecraft:{prefix}scale base set 4\n"
            f"attribute @s minecraft:{prefix}step_height base set 2.4\n"
            "tag @s add w2m.human_size\n"
        )


@pytest.mark.parametrize(
    ("blocks_per_metre", "scale", "step"), [(0.01, "0.0625", "0.0375"), (50, "16", "9.6")]
)
def test_sizes_stay_within_what_the_game_takes(blocks_per_metre, scale, step):
    text = size_functions(blocks_per_metre)[
        "scale_plain_names/data/w2m/function/human_size.mcfunction"
    ]
    assert re.findall(r"set (\S+)", text) == [scale, step]


def test_the_size_of_the_game_comes_back():
    text = size_functions(4)["scale_plain_names/data/w2m/function/game_size.mcfunction"]
    assert re.findall(r"set (\S+)", text) == ["1", "0.6"]


@pytest.mark.parametrize("overlay", ["scale_old_names/", "scale_plain_names/"])
def test_the_size_is_changed_in_turn(overlay):
    """The functions, run as the game runs them: a click makes large, the next one small again."""
    files = size_functions(4)
    tags: set[str] = set()
    sizes: list[str] = []

    def run(name):
        path = f"data/w2m/function/{name}.mcfunction"
        for line in files.get(overlay + path, files[path]).splitlines():
            words = line.replace("@s[tag=", "@s ").replace("]", "").split()
            if words[0] == "execute":
                if (words[4] in tags) == (words[1] == "if"):
                    run(words[-1].removeprefix("w2m:"))
            elif words[0] == "attribute":
                sizes.extend([words[-1]] if words[2].endswith("scale") else [])
            elif words[2] in ("add", "remove") or words[2] in tags:
                change = tags.add if "add" in words else tags.discard
                change(words[-1])

    for name in ("toggle_size", "toggle_size", "human_size", "toggle_size", "toggle_size"):
        run(name)
    assert sizes == ["4", "1", "4", "1", "4"]
    assert tags == {"w2m.human_size"}


def test_the_zip_holds_the_files_and_no_time(tmp_path):
    volume = furnished_volume()
    write_datapack(volume, tmp_path / "pack.zip", name="my_room")
    with zipfile.ZipFile(tmp_path / "pack.zip") as archive:
        held = {name: archive.read(name).decode() for name in archive.namelist()}
        assert {entry.date_time for entry in archive.infolist()} == {(2020, 1, 1, 0, 0, 0)}
    assert held == datapack_files(volume, OLD, "my_room")
    assert Counter(path.split("/")[0] for path in size_pack_paths()).keys() >= {"pack.mcmeta"}


def size_pack_paths() -> list[str]:
    import io

    with zipfile.ZipFile(io.BytesIO(size_pack(4.0))) as archive:
        return archive.namelist()


@pytest.mark.parametrize("name", ["My Room", "", "a/b", "minecraft"])
def test_a_name_that_is_no_namespace_is_refused(name):
    with pytest.raises(UsageError, match="must contain only lower-case letters"):
        datapack_files(furnished_volume(), OLD, name)


def test_names_follow_the_version():
    volume = volume_of(np.ones((1, 1, 1)), (AIR, "minecraft:grass"), (0, 0, 0))
    path = "data/r/function/build/part_0.mcfunction"
    assert "minecraft:grass\n" in datapack_files(volume, OLD, "r")[path]
    new = datapack_files(volume, game_version("1.21.4"), "r")
    assert "minecraft:short_grass\n" in new[path]
    assert json.loads(new["pack.mcmeta"])["pack"]["pack_format"] == 61


def test_nbt_as_text():
    value = {
        "b": Byte(-1),
        "s": Short(2),
        "i": 3,
        "L": Long(4),
        "f": Float(0.5),
        "d": 1.0,
        "flag": True,
        "text": 'a "quote" \\ and\na line',
        "list": [1, 2],
        "ints": np.array([1, 2], np.int32),
        "bytes": np.array([1], np.int8),
        "longs": np.array([1], np.int64),
    }
    assert snbt(value) == (
        '{"b":-1b,"s":2s,"i":3,"L":4L,"f":0.5f,"d":1.0d,"flag":1b,'
        '"text":"a \\"quote\\" \\\\ and a line","list":[1,2],'
        '"ints":[I;1,2],"bytes":[B;1b],"longs":[L;1L]}'
    )
