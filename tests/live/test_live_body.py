"""A player on a real server walks as our physics say, and the environment runs by it.

Opt-in: ``make test-live``, or ``make test-server`` for this alone.
"""

import json
import shutil
import subprocess
import sys
import time
from contextlib import contextmanager
from urllib.error import URLError
from urllib.parse import quote
from urllib.request import urlopen

import numpy as np
import pytest
from mineflayer_rules import mineflayer_rules
from test_live_walk import HERE, free_port, node
from tests.navigation.small_flat import SPAWN as FLAT_START
from tests.navigation.small_flat import write_flat

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.jit import user_cache_dir
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.block_states import complete, parse_state
from world2minecraft.minecraft.physics import BlockWorld, Keys, find_standing_place, step
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.world_writer import write_world
from world2minecraft.navigation.server.player import join

pytestmark = pytest.mark.live
__all__ = ["node"]  # A fixture.

VERSIONS = ["1.20.1", "1.21.4"]
COUNTS = {"1.20.1": 50, "1.21.4": 10}
LIMIT_S = 900
NEAR = 0.1  # Blocks.
SAME = 1e-4
START = (0.5, 67.0, 0.5)
FLAGS = ("forward", "back", "left", "right", "jump", "sneak", "sprint")
SHAPES = (
    "oak_slab", "oak_stairs[facing=west]", "oak_stairs[facing=south]", "oak_fence", "white_carpet",
    "stone", "stone", "oak_trapdoor[half=bottom,open=false]", "oak_door[facing=south]",
    "glass_pane[north=true,south=true]", "red_bed[facing=east,part=foot]", "oak_pressure_plate",
    "chest[facing=north]", "flower_pot", "lantern", "anvil", "cauldron", "hopper", "lectern",
    "end_rod", "snow[layers=3]", "iron_bars[east=true,west=true]", "oak_slab[type=top]",
    "cobblestone_wall", "bell",
)  # fmt: skip


def crowded_room(things: int) -> BlockVolume:
    """A room of 24 x 24 blocks with blocks of many shapes at random."""
    names = ["oak_planks", "white_concrete", *dict.fromkeys(SHAPES)]
    palette = (AIR, *(str(complete(parse_state(name))) for name in names))
    states = np.zeros((26, 7, 26), np.uint16)
    states[:, 1:], states[1:-1, 1:-1, 1:-1] = 2, 0
    states[:, 0] = 1
    random = np.random.default_rng(3)
    for _ in range(things):
        x, z = random.integers(1, 25, 2)
        y = 1 + int(random.random() < 0.15)
        states[x, y, z] = 1 + names.index(SHAPES[random.integers(len(SHAPES))])
    empty = np.zeros(states.shape, np.uint8)
    to_room = block_to_room(np.zeros(2), 1.0)
    return BlockVolume(states, palette, empty, empty.astype(np.uint16), (-13, 63, -13), to_room)


class Server:
    """A server that can be asked where a player is."""

    def __init__(self, plan):
        self.plan, self.address = plan, f"127.0.0.1:{plan['port']}"

    def ask(self, **question):
        text = quote(json.dumps(question))
        with urlopen(f"http://127.0.0.1:{self.plan['control']}/{text}", timeout=20) as answer:
            return json.loads(answer.read())


@contextmanager
def serving(world, version, start, environment):
    """A server on a world that was just written."""
    plan = {"world": str(world), "version": version, "port": free_port(),
            "control": free_port(), "limit_s": LIMIT_S, "start": start}  # fmt: skip
    path = world.parent / "plan.json"
    path.write_text(json.dumps(plan))
    command = ["node", str(HERE / "body_server.js"), str(path)]
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL}
    with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, **pipes) as process:
        try:
            running = Server(plan)
            wait_for(running, process)
            yield running
        finally:
            process.kill()


@pytest.fixture(params=VERSIONS)
def crowd(request, node, tmp_path):
    """A server on the crowded room."""
    world, version = tmp_path / "world", game_version(request.param)
    options = {"name": "live", "spawn": START, "spawn_yaw_deg": 0.0}
    write_world(crowded_room(110), world, **options, version=version)
    with serving(world, request.param, START, node) as running:
        yield running


@pytest.fixture(params=VERSIONS)
def flat_server(request, node, tmp_path):
    """A server on the small flat of the tests of navigation, and the flat's folder."""
    folder = write_flat(tmp_path / "flat")
    shutil.copytree(folder / "world", tmp_path / "copy")  # The server writes into its folder.
    with serving(tmp_path / "copy", request.param, FLAT_START, node) as running:
        yield running, folder


def wait_for(running, process):
    for _ in range(300):
        if process.poll() is not None:
            pytest.fail(process.stderr.read()[-3000:].decode())
        try:
            running.ask(where="nobody")
        except URLError:
            time.sleep(0.2)
        else:
            return
    pytest.fail("the server does not answer")


def random_keys(number: int, ticks: int) -> list[Keys]:
    """Keys at random, held for 2 to 13 ticks; ahead more often than not."""
    random = np.random.default_rng([7, number])
    held = []
    while len(held) < ticks:
        flags = {one: bool(random.random() < (0.6 if one == "forward" else 0.2)) for one in FLAGS}
        keys = Keys(**flags, yaw_deg=round(float(random.uniform(-180, 180)), 1))
        held += [keys] * int(random.integers(2, 14))
    return held[:ticks]


def recorded(body):
    """The keys that a body is told to hold from now on, in a list."""
    held, hold = [], body.hold

    def holding(keys, pitch_deg=0.0):
        held.extend(keys)
        return hold(keys, pitch_deg)

    body.hold = holding
    return held


@pytest.fixture
def say(capsys):
    """Prints what was measured, also where tests are quiet."""

    def saying(text):
        with capsys.disabled():
            sys.stdout.write(f"\n{text}\n")

    return saying


def apart(one, two):
    return float(np.linalg.norm(np.subtract(one, two)))


def walked(world, body, keys):
    for one in keys:
        body = step(world, body, one)
    return body


def crowded_walks(crowd, count):
    """Walk by random keys on a server; return where one began, the keys, and where one ended."""
    with join(crowd.address, folder=user_cache_dir() / "live-test") as body:
        volume, room = body.read([-14, 62, -14, 14, 71, 14]), crowded_room(110)
        inner = np.array(volume.palette)[volume.states][1:-1, 1:8, 1:-1]
        assert (inner == np.array(room.palette)[room.states]).all()
        world, walks = BlockWorld.of_volume(volume), []
        for number in range(count):
            x, z = np.random.default_rng([8, number]).uniform(-11, 11, 2)
            start = body.place(find_standing_place(world, (float(x), 64.0, float(z))))
            keys = random_keys(number, 60)
            end = body.hold(keys)[-1].position
            assert body.corrections == 0
            assert apart(end, crowd.ask(where=body.name)) < 1e-6  # The server holds the same.
            walks.append((start._replace(on_ground=True), keys, end))
    return world, walks


def told(gaps):
    near = sum(one < NEAR for one in gaps)
    figures = f"median {np.median(gaps):.1e}, worst {max(gaps):.1e}"
    return f"{near} of {len(gaps)} end within {NEAR} block of ours ({figures})"


def test_a_body_on_a_server_ends_where_ours_does(crowd, say):
    """Walks of 60 ticks by random keys, jumps and sneaking among them, in a room full of shapes."""
    version = crowd.plan["version"]
    world, walks = crowded_walks(crowd, COUNTS[version])
    gaps = [apart(end, walked(world, start, keys).position) for start, keys, end in walks]
    say(f"{version}, keys: {told(gaps)}")
    assert max(gaps) < NEAR  # What was promised,
    assert max(gaps) < SAME  # and what is so.


def test_plain_mineflayer_departs_from_the_game_by_three_rules(crowd, say, monkeypatch):
    """Without ``game_rules.mjs`` a few walks end elsewhere: by three rules, and nothing else."""
    monkeypatch.setenv("W2M_PLAIN_MINEFLAYER", "1")
    version = crowd.plan["version"]
    world, walks = crowded_walks(crowd, COUNTS[version])
    gaps = [apart(end, walked(world, start, keys).position) for start, keys, end in walks]
    with mineflayer_rules(world):
        twins = [apart(end, walked(world, start, keys).position) for start, keys, end in walks]
    say(f"{version}, keys, plain mineflayer: {told(gaps)}; by its rules {told(twins)}")
    assert max(twins) < SAME


def test_moves_of_the_environment_end_where_ours_do(flat_server, say):
    """Walks of 6 random moves: turns by 15 degrees, steps of half a block, in a furnished flat."""
    from world2minecraft.navigation.environment.observations import Eyes
    from world2minecraft.navigation.server.env import ServerEnv
    from world2minecraft.navigation.types import Move

    server, folder = flat_server
    version = server.plan["version"]
    gaps, contrasts = [], []
    with join(server.address, folder=user_cache_dir() / "live-test") as body:
        env = ServerEnv(body, labels=folder, eyes=Eyes(64, 64))
        world = BlockWorld.of_volume(env.scene.volume)
        held = recorded(body)
        for number in range(COUNTS[version]):
            seen, _ = env.reset(seed=number)
            contrasts.append(seen["rgb"].std())
            ours = body.body._replace(on_ground=True)
            held.clear()
            random = np.random.default_rng([9, number])
            for _ in range(6):
                env.step(int(random.choice([1, 1, 1, 1, 2, 3])))
            gaps.append(apart(env.controller.stance.feet, walked(world, ours, held).position))
            assert apart(env.controller.stance.feet, server.ask(where=body.name)) < 1e-6
        info = env.step(int(Move.STOP))[4]
        assert info["score"]["steps"] == 7
    say(f"{version}, moves: {told(gaps)}")
    assert max(gaps) < SAME
    assert max(contrasts) > 20  # One looks at walls too.


def test_an_oracle_reaches_the_piano_on_a_server(flat_server):
    from world2minecraft.navigation.agents import make_agent
    from world2minecraft.navigation.running.episode_runner import walk_episode
    from world2minecraft.navigation.running.sentence_goals import GoalRequest, episode_of_sentence
    from world2minecraft.navigation.server.streamed_scene import ServerSimulator, open_server_scene

    server, folder = flat_server
    with join(server.address, folder=user_cache_dir() / "live-test") as body:
        scene = open_server_scene(body, labels=folder)
        episode = episode_of_sentence(scene, GoalRequest("Go to the piano"))
        walk = walk_episode(ServerSimulator(scene), episode, make_agent("oracle", None))
    assert walk.end == "stopped" and walk.score.ne_m < 0.5


def test_the_eyes_see_what_is_built_while_one_looks(crowd):
    from world2minecraft.navigation.server.streamed_scene import open_server_scene

    with join(crowd.address, folder=user_cache_dir() / "live-test") as body:
        body.place((0.5, 64.0, 0.5))
        scene = open_server_scene(body, box=(-14, 62, -14, 14, 71, 14))
        before = scene.live.volume_states[0].copy()
        at = (2, 66, 2)
        crowd.ask(block="gold_block", at=at)
        for _ in range(40):
            body.hold([Keys()])
            if body.changes:
                break
        assert scene.render_scene
        states, palette = scene.live.volume_states
        cells = np.argwhere(states != before)
        assert [tuple((cell + scene.volume.corner).tolist()) for cell in cells] == [at]
        assert palette[states[tuple(cells[0])]] == "minecraft:gold_block"
