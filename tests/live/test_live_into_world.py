"""A real server loads a world that was built into, saves it, and the blocks come out again."""

import json
import shutil

import numpy as np
import pytest
from test_live_walk import CORNER, HERE, LIMIT_S, START, free_port, furnished_room, node, run_node

from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.editing.build_into_world import build_into_world, remove_build
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.world_reader import read_world
from world2minecraft.minecraft.worlds.world_writer import write_world

pytestmark = pytest.mark.live
__all__ = ["node"]  # A fixture.

SAVE = """
const registry = require('prismarine-registry')('1.20.1')
const Anvil = require('prismarine-provider-anvil').Anvil(registry)
async function main () {
  const world = new Anvil(process.argv[2])
  for (const [x, z] of [[-1, -1], [-1, 0], [0, -1], [0, 0]]) {
    await world.save(x, z, await world.load(x, z))
  }
  await world.close()
}
main().catch(error => { console.error(error); process.exit(1) })
"""


def ground():
    """Stone of 48 x 8 x 48 blocks around the place of the room, as a world's volume."""
    states = np.ones((48, 8, 48), np.uint16)
    empty = np.zeros(states.shape, np.uint8)
    corner = (-24, 58, -24)
    palette = (AIR, "minecraft:stone")
    return BlockVolume(states, palette, empty, empty.astype(np.uint16), corner, np.eye(4))


def world_with_room(folder, version):
    options = {"name": "live", "spawn": START, "spawn_yaw_deg": -90.0}
    write_world(ground(), folder, **options, version=game_version(version))
    build_into_world(folder, furnished_room())
    return folder


def by_place(volume):
    cells = np.argwhere(volume.states)
    return {
        tuple((cell + volume.corner).tolist()): volume.palette[volume.states[tuple(cell)]]
        for cell in cells
    }


@pytest.mark.parametrize("version", ["1.20.1", "1.21.4"])
def test_a_player_finds_the_room_and_the_ground_around_it(version, node, tmp_path):
    world = world_with_room(tmp_path / "world", version)
    copy = tmp_path / "copy"  # The server writes into the folder that it is given.
    shutil.copytree(world, copy)
    expected = by_place(read_world(world))
    places = list(np.ndindex(20, 10, 16))
    places = [tuple(int(v) for v in np.add(p, np.array(CORNER) - (3, 4, 4))) for p in places]
    plan = {
        "world": str(copy),
        "version": version,
        "port": free_port(),
        "limit_s": LIMIT_S,
        "blocks": [list(place) for place in places],
        "start": START,
        "yaw": -np.pi / 2,
        "walk_s": 1,
        "answer": str(tmp_path / "answer.json"),
    }
    (tmp_path / "plan.json").write_text(json.dumps(plan))
    run_node(HERE / "walk.js", [tmp_path / "plan.json"], node)
    seen = json.loads((tmp_path / "answer.json").read_text())["seen"]
    wanted = [expected.get(place, AIR) for place in places]
    assert [pair for pair in zip(seen, wanted, strict=True) if pair[0] != pair[1]] == []


def test_blocks_come_out_of_a_world_that_another_program_saved(node, tmp_path):
    version = "1.20.1"
    world = world_with_room(tmp_path / "world", version)
    (tmp_path / "save.js").write_text(SAVE)
    run_node(tmp_path / "save.js", [world / "region"], node)
    done = remove_build(world)
    assert done.kept == 0
    assert by_place(read_world(world)) == by_place(ground())
