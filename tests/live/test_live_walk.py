"""A real server loads a world that the program wrote, and a real player walks in it.

Opt-in: ``make test-live``. It needs Node 18 or newer and npm, which fetches about 500 MB once.
"""

import json
import os
import shutil
import socket
import subprocess
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.jit import user_cache_dir
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.nbt import read_nbt, unpack
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.world_writer import read_world, write_world

pytestmark = pytest.mark.live

HERE = Path(__file__).parent
LIMIT_S = 90
CORNER = (-7, 63, -4)
START = (-5.5, 64.0, -1.5)  # In the room's west end; the way east is free up to the wall.

BLOCKS = {
    (4, 1, 5): "oak_stairs[facing=west,half=bottom]",
    (4, 1, 6): "oak_stairs[facing=north,half=bottom,shape=inner_left]",
    (6, 1, 6): "oak_fence",
    (6, 2, 6): "oak_pressure_plate",
    (8, 1, 6): "red_bed[facing=east,part=foot]",
    (9, 1, 6): "red_bed[facing=east,part=head]",
    (11, 1, 5): "red_concrete",
    (11, 2, 5): "dark_oak_slab[type=bottom]",
    (11, 1, 1): "barrel[facing=up]",
    (0, 2, 3): "glass_pane[north=true,south=true]",
    (0, 2, 4): "glass_pane[north=true,south=true]",
    (6, 4, 4): "sea_lantern",
}


def furnished_room() -> BlockVolume:
    """A room of 13 x 6 x 8 blocks over four chunks of four regions: shell, window, furniture."""
    names = ["oak_planks", "white_concrete", *dict.fromkeys(BLOCKS.values())]
    palette = (AIR, *(str(complete(parse_state(name))) for name in names))
    states = np.zeros((13, 6, 8), np.uint16)
    states[:, 1:], states[1:-1, 1:-1, 1:-1] = 2, 0
    states[:, 0] = 1
    for cell, name in BLOCKS.items():
        states[cell] = 1 + names.index(name)
    empty = np.zeros(states.shape, np.uint8)
    to_room = block_to_room(np.array([0.0, 2.0]), 1.0)
    return BlockVolume(states, palette, empty, empty.astype(np.uint16), CORNER, to_room)


@pytest.fixture(scope="module")
def node() -> dict[str, str]:
    """An environment in which node finds the two packages, kept in the user's cache folder."""
    if not shutil.which("node") or not shutil.which("npm"):
        pytest.skip("node and npm are not installed")
    folder = user_cache_dir() / "live-test"
    folder.mkdir(parents=True, exist_ok=True)
    stated = (HERE / "package.json").read_text()
    done = folder / "installed.json"
    if not done.is_file() or done.read_text() != stated:
        (folder / "package.json").write_text(stated)
        command = ["npm", "install", "--ignore-scripts", "--no-audit", "--no-fund"]
        result = subprocess.run(
            command, cwd=folder, check=False, capture_output=True, text=True, timeout=900
        )
        if result.returncode:
            pytest.skip(f"npm could not fetch the server: {result.stderr.strip()[-300:]}")
        done.write_text(stated)
    return {**os.environ, "NODE_PATH": str(folder / "node_modules")}


def run_node(script: Path, arguments: list[Path], environment: dict[str, str]) -> None:
    command = ["node", str(script), *map(str, arguments)]
    done = subprocess.run(
        command, check=False, capture_output=True, text=True, timeout=LIMIT_S + 30, env=environment
    )
    assert done.returncode == 0, done.stderr[-3000:]


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.mark.parametrize("version", ["1.20.1", "1.21.4"])
def test_a_player_finds_the_blocks_and_walks_across_the_floor(version, node, tmp_path):
    room = furnished_room()
    world = tmp_path / "world"
    write_world(
        room,
        world,
        name="live",
        spawn=START,
        spawn_yaw_deg=-90.0,
        version=game_version(version),
    )
    copy = tmp_path / "copy"  # The server writes into the folder that it is given.
    shutil.copytree(world, copy)
    cells = [cell for cell in np.ndindex(room.states.shape) if cell[1] < 5 or room.states[cell]]
    plan = {
        "world": str(copy),
        "version": version,
        "port": free_port(),
        "limit_s": LIMIT_S,
        "blocks": [[int(v) for v in np.add(cell, CORNER)] for cell in cells],
        "start": START,
        "yaw": -np.pi / 2,  # East, as the bot counts.
        "walk_s": 4,
        "answer": str(tmp_path / "answer.json"),
    }
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    run_node(HERE / "walk.js", [tmp_path / "plan.json"], node)
    said = json.loads((tmp_path / "answer.json").read_text())
    expected = [room.palette[room.states[cell]] for cell in cells]
    differing = [
        (cell, wanted, seen)
        for cell, wanted, seen in zip(cells, expected, said["seen"], strict=True)
        if seen != wanted
    ]
    assert not differing
    # The floor carries the player from the start to the east wall, 0.3 blocks before it.
    assert said["from"] == pytest.approx(list(START), abs=0.2)
    assert said["to"][0] == pytest.approx(CORNER[0] + 12 - 0.3, abs=0.02)
    assert said["to"][2] == pytest.approx(START[2], abs=0.2)
    assert said["heights"] == pytest.approx([64.0] * len(said["heights"]), abs=0.01)


def test_a_world_that_the_server_saved_again_reads_back(node, tmp_path):
    script = """
    const registry = require('prismarine-registry')('1.20.1')
    const Anvil = require('prismarine-provider-anvil').Anvil(registry)
    const fs = require('fs')
    async function main () {
      const from = new Anvil(process.argv[2]), to = new Anvil(process.argv[3])
      for (const [x, z] of [[-1, -1], [-1, 0], [0, -1], [0, 0]]) {
        await to.save(x, z, await from.load(x, z))
      }
      await from.close(); await to.close()
    }
    main().catch(error => { console.error(error); process.exit(1) })
    """
    room = furnished_room()
    world = tmp_path / "world"
    write_world(room, world, name="live", spawn=START, spawn_yaw_deg=0.0)
    again = tmp_path / "again"
    (again / "region").mkdir(parents=True)
    shutil.copy(world / "level.dat", again / "level.dat")
    (tmp_path / "save.js").write_text(script)
    run_node(tmp_path / "save.js", [world / "region", again / "region"], node)
    found = read_world(again)
    data = (again / "level.dat").read_bytes()
    assert read_nbt(unpack(data, again), again)[1]["Data"]["LevelName"] == "live"
    np.testing.assert_array_equal(
        np.array(found.palette)[found.states], np.array(room.palette)[room.states]
    )
