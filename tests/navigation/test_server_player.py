"""A body on a server, played by a process that behaves, or does not."""

import os
import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from small_flat import SPAWN, flat_volume

from world2minecraft.core.errors import InputError, ServerError, UsageError
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.physics import Body, BoxWorld, Keys, step
from world2minecraft.navigation.environment.observations import Eyes
from world2minecraft.navigation.server import mineflayer_install as installing
from world2minecraft.navigation.server import player as body_module
from world2minecraft.navigation.server.actions import forward_keys
from world2minecraft.navigation.server.env import ServerEnv
from world2minecraft.navigation.server.player import JsonLineProcess, ServerPlayer, join
from world2minecraft.navigation.server.streamed_blocks import MAX_CELLS, checked_box, state_of
from world2minecraft.navigation.server.streamed_scene import open_server_scene
from world2minecraft.navigation.types import Move

HERE = Path(__file__).parent
SMALL = Eyes(width_px=32, height_px=32)
AHEAD = [Keys(forward=True, yaw_deg=-90.0)] * 4
BOX = (-1, 63, -1, 20, 72, 11)


def fake(mode="honest") -> ServerPlayer:
    paths = os.pathsep.join([str(HERE), *sys.path])
    environment = {**os.environ, "PYTHONPATH": paths}
    bridge = JsonLineProcess([sys.executable, str(HERE / "fake_body.py"), mode], HERE, environment)
    told = bridge.ask("join", 60, name="w2m_walker")
    return ServerPlayer(bridge, "localhost:25565", told)


@pytest.fixture
def honest():
    with fake() as body:
        yield body


def test_a_body_walks_as_the_physics_do(honest):
    world = BoxWorld([[-99, 64, -99, 99, 65, 99]])
    assert honest.place(SPAWN).position == SPAWN
    ours = Body(SPAWN, on_ground=True)
    for theirs in honest.hold(AHEAD):
        ours = step(world, ours, AHEAD[0])
        assert np.allclose(theirs.position, ours.position, atol=1e-12)
    assert honest.settle().velocity[0] == 0 and honest.body.on_ground


def test_the_blocks_of_a_server_are_those_that_stand_there(honest):
    volume = honest.read(BOX)
    truth = flat_volume()[0]
    names = np.array(volume.palette)[volume.states]
    assert (names[1:20, 1:8, 1:11] == np.array(truth.palette)[truth.states]).all()
    assert volume.corner == BOX[:3]
    rest = volume.states.copy()
    rest[1:20, 1:8, 1:11] = 0
    assert not rest.any()


@pytest.mark.parametrize(
    ("mode", "text"),
    [
        ("dead", "the player process has exited; last error output: out of memory"),
        ("huge", "a reply of the player process exceeds 8,388,608 bytes"),
        ("junk", "a reply of the player process is not a JSON object"),
        ("a list", "a reply of the player process is not a JSON object"),
        ("refuses", "hold: keys are held [31malready"),
        ("liar", "the player process reported an unexpected number of ticks"),
        ("not a number", "the player process sent a position that is not a number"),
    ],
)
def test_what_a_body_says_is_not_trusted(mode, text):
    with fake(mode) as body, pytest.raises(ServerError) as caught:
        body.hold(AHEAD)
    assert str(caught.value) == text


def test_a_silent_body_is_not_waited_for(monkeypatch):
    monkeypatch.setattr(body_module, "SLACK_S", 0.2)
    with fake("silent") as body:
        with pytest.raises(ServerError, match="hold: no reply within 1.2 s"):
            body.hold(AHEAD)
        with pytest.raises(ServerError, match="hold: no reply"):
            body.hold(AHEAD)  # It is gone, and stays so.


def test_answers_that_nobody_asked_for_are_passed_over():
    with fake("chatty") as body:
        assert len(body.hold(AHEAD)) == 4


@pytest.mark.parametrize(
    ("mode", "text"),
    [
        ("far away", "the server has not sent the blocks around -1 -1; move the player closer, "
         "choose a smaller box, or raise view-distance in server.properties"),
        ("bomb", "expected 9 blocks of a chunk, but the server sent another number"),
        ("too long", "expected 9 blocks of a chunk, but the server sent another number"),
        ("odd names", "the server sent a block state that cannot be parsed"),
    ],
)  # fmt: skip
def test_blocks_that_cannot_be_are_refused(mode, text):
    with fake(mode) as body, pytest.raises(ServerError) as caught:
        body.read(BOX)
    assert str(caught.value) == text


def test_a_player_who_may_not_teleport_is_told_what_to_say():
    with fake("no operator") as body, pytest.raises(ServerError) as caught:
        body.place((9.0, 65.0, 3.0))
    assert str(caught.value) == (
        "the server did not move the player to 9.0 65.0 "
        "3.0; run 'op w2m_walker' on the server console"
    )


def test_a_server_that_moves_one_to_its_spawn_late_is_told_again():
    with fake("late") as body:
        assert body.place((6.0, 65.0, 5.0)).position == (6.0, 65.0, 5.0)
    with fake("stubborn") as body, pytest.raises(ServerError) as caught:
        body.place((6.0, 65.0, 5.0))
    assert str(caught.value) == (
        "the server moved the player away from the requested position, to 3.0 3.0"
    )


def test_boxes_are_cut_to_what_can_be_read():
    assert checked_box([0, 0, 0, 1, 2, 3]) == (0, 0, 0, 1, 2, 3)
    for wrong in ([0, 0, 0, 0, 2, 3], [0, 0, 0, 1, 2], [0, 0, 0, 1e9, 1, 1]):
        with pytest.raises(UsageError, match="a box must be x0 y0 z0"):
            checked_box(wrong)
    with pytest.raises(UsageError, match=f"at most {MAX_CELLS:,} blocks"):
        checked_box([0, 0, 0, 300, 300, 300])


def test_states_are_named_as_volumes_name_them():
    assert state_of("minecraft:cave_air", 3700) == "minecraft:air"
    assert state_of("minecraft:short_grass", 3700) == "minecraft:grass"
    stairs = state_of("oak_stairs[half=top,facing=east]", 3465)
    assert stairs == str(parse_state(stairs))
    for wrong in (None, 7, "Stone", "stone[", "x" * 2000):
        with pytest.raises(ServerError):
            state_of(wrong, 3465)


@pytest.mark.parametrize("length", [0.25, 0.5, 1.0, 2.0, 3.125])
@pytest.mark.parametrize("yaw_deg", [0.0, 135.0])
def test_keys_lead_as_far_as_a_step_is_long(length, yaw_deg):
    world, body = BoxWorld([[-9, -1, -9, 9, 0, 9]]), Body((0.0, 0.0, 0.0), on_ground=True)
    for keys in forward_keys(length, yaw_deg):
        body = step(world, body, keys)
    assert np.hypot(body.position[0], body.position[2]) == pytest.approx(length, abs=0.03)
    assert body.velocity[0] == body.velocity[2] == 0


def an_env(flat_path, mode="honest", **options):
    body = fake(mode)
    return body, ServerEnv(
        body, labels=flat_path, eyes=SMALL, span_m=(1.0, 9.0), **options
    )  # fmt: skip


def test_the_environment_is_clean_and_its_walker_is_the_games(flat_path):
    body, env = an_env(flat_path)
    with body:
        assert env.scene.scale == pytest.approx(1.0)
        assert env.scene.blocks_per_metre == 2
        assert {one.noun for one in env.scene.landmarks} >= {"upright piano"}
        assert env.scene.start.feet == SPAWN
        check_env(env, skip_render_check=True)


def test_an_oracles_moves_lead_to_the_goal_by_keys(flat_path):
    body, env = an_env(flat_path)
    with body:
        env.reset(seed=3, options={"goal": "piano"})
        info = {}
        for move in env.episode.moves:
            _, _, over, _, info = env.step(int(move))
        assert over and info["success"]
        assert info["score"]["spl"] > 0.8


def test_a_wall_is_a_collision_and_a_turn_is_none(flat_path):
    body, env = an_env(flat_path)
    with body:
        env.reset(seed=0)
        told = [env.step(int(Move.FORWARD))[4]["collided"] for _ in range(40)]
        assert told[-1] and not env.step(int(Move.LEFT))[4]["collided"]


def test_keys_are_held_on_the_server(flat_path):
    body, env = an_env(flat_path, actions="continuous")
    with body:
        env.reset(seed=0)
        start = np.array(env.controller.stance.feet)
        keys = np.array([1, 0, 0, 0, 0, 0, 0], np.int8)
        action = {"keys": keys, "camera": np.zeros(2, np.float32), "stop": 0}
        env.step(action)
        assert np.linalg.norm(np.array(env.controller.stance.feet) - start) == pytest.approx(0.098)
        assert env.step({**action, "stop": 1})[2]


@pytest.mark.parametrize("mode", ["builder", "flood"])
def test_the_eyes_see_what_others_build(flat_path, mode):
    """One block by its change; or, where there are too many changes to list, by reading again."""
    with fake(mode) as body:
        scene = open_server_scene(body, labels=flat_path)
        before = scene.render_scene
        old = scene.live.volume_states[0].copy()
        while not (body.changes or body.has_many_changes):
            body.hold([Keys()])
        assert scene.render_scene is not before
        states, palette = scene.live.volume_states
        cells = np.argwhere(states != old)
        assert [tuple(cell + scene.volume.corner) for cell in cells] == [(5, 66, 5)]
        built = "minecraft:gold_block" if mode == "builder" else "minecraft:oak_planks"
        assert palette[states[tuple(cells[0])]] == built


def test_without_labels_blocks_tell_what_they_are(honest):
    scene = open_server_scene(honest, box=BOX)
    assert scene.blocks_per_metre == 1 and scene.body == 1
    assert scene.scene_id == "server_localhost_25565"
    assert scene.layouts == ()


def test_labels_of_other_blocks_are_refused(honest, flat_path, tmp_path):
    with pytest.raises(InputError, match="does not contain scene.json"):
        open_server_scene(honest, labels=tmp_path)
    with pytest.raises(UsageError, match="the labels already define the scale"):
        open_server_scene(honest, labels=flat_path, blocks_per_metre=2)
    with pytest.raises(InputError, match="only air"):
        open_server_scene(honest, box=(100, 64, 100, 110, 70, 110))


@pytest.mark.parametrize(
    ("address", "options", "text"),
    [
        ("local host", {},
         "the server address must be HOST:PORT, such as localhost:25565, got 'local host'"),
        ("localhost:0", {},
         "the server address must be HOST:PORT, such as localhost:25565, got 'localhost:0'"),
        ("localhost", {"name": "a;b"},
         "a player name must be 3 to 16 letters, digits or underscores, got 'a;b'"),
        ("localhost", {"version": "newest"}, "the version must have the form 1.20.1, got 'newest'"),
    ],
)  # fmt: skip
def test_wrong_options_are_refused_before_anything_starts(address, options, text):
    with pytest.raises(UsageError) as caught:
        join(address, **options)
    assert str(caught.value) == text


def test_nothing_is_fetched_unasked(monkeypatch, tmp_path):
    monkeypatch.setattr(installing, "user_cache_dir", lambda: tmp_path)
    with pytest.raises(UsageError) as caught:
        join("localhost")
    assert str(caught.value) == (
        "playing on a server requires mineflayer; install it once with w2m vln server --install"
    )
    assert not list(tmp_path.iterdir())


def test_the_verb_tells_what_is_missing(monkeypatch, tmp_path, capsys):
    from world2minecraft import cli

    monkeypatch.setattr(installing, "user_cache_dir", lambda: tmp_path)
    assert cli.run(["vln", "server"]) == 2
    assert "install it once with w2m vln server --install" in capsys.readouterr().err
    monkeypatch.setattr(installing.shutil, "which", lambda name: None)
    assert cli.run(["vln", "server", "--install"]) == 2
    assert "Node.js not found; install version 18 or newer" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_an_interrupted_install_is_none(monkeypatch, tmp_path):
    """What npm leaves half done is not taken for whole, and its last words are told."""
    npm = tmp_path / "npm"
    npm.write_text("#!/bin/sh\nmkdir node_modules\necho no network >&2\nexit 1\n")
    npm.chmod(0o755)
    monkeypatch.setattr(installing, "user_cache_dir", lambda: tmp_path / "cache")
    monkeypatch.setattr(installing, "node", lambda: "node")
    monkeypatch.setattr(installing.shutil, "which", lambda name: str(npm))
    with pytest.raises(ServerError, match="npm could not install mineflayer: no network"):
        installing.install()
    assert not installing.is_installed()
    npm.write_text("#!/bin/sh\ntest -f package-lock.json && test $1 = ci\n")
    assert installing.install() == installing.body_folder()


def test_it_is_an_environment_of_gymnasium():
    spec = gymnasium.spec("world2minecraft/MinecraftVLN-Server-v0")
    assert spec.entry_point == "world2minecraft.navigation.server.env:ServerEnv"
    with pytest.raises(UsageError, match="the option 'scene' is not available"):
        ServerEnv("localhost", scene="x")


def test_a_walk_on_a_server_is_run_and_scored_as_any(flat_path):
    from world2minecraft.navigation.agents import make_agent
    from world2minecraft.navigation.running.episode_runner import walk_episode
    from world2minecraft.navigation.running.sentence_goals import GoalRequest, episode_of_sentence
    from world2minecraft.navigation.server.streamed_scene import ServerSimulator

    with fake() as body:
        scene = open_server_scene(body, labels=flat_path)
        episode = episode_of_sentence(scene, GoalRequest("Go to the piano"))
        assert episode.scene == str(flat_path)
        for name in ("oracle", "shortest"):
            agent = make_agent(name, None)
            walk = walk_episode(ServerSimulator(scene), episode, agent)
            assert walk.end == "stopped" and walk.score.ne_m < 1.0, name
            assert walk.stances[-1].feet == body.body.position  # For real, not in thought alone.
            assert walk.score.length_m < 2 * walk.score.shortest_m
        assert body._bridge.ask("where", 5)["places"] == 2  # Each walk begins once.
