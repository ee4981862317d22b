"""The environment: gymnasium's own checks, seeds, rewards, scores, and errors that teach."""

import dataclasses
import subprocess
import sys
import tomllib
import warnings
from importlib import import_module
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env

from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.navigation.environment import ENV_ID
from world2minecraft.navigation.environment.env import VlnEnv
from world2minecraft.navigation.environment.observations import SENSORS, Eyes
from world2minecraft.navigation.episodes import random_episodes
from world2minecraft.navigation.records import read_episodes, write_episodes
from world2minecraft.navigation.types import Move, Stance

EYES = Eyes(32, 24)
STAND = {"keys": np.zeros(7, np.int8), "camera": np.zeros(2, np.float32), "stop": 0}


def env_of(flat, **options):
    return VlnEnv(flat, eyes=EYES, **options)


@pytest.mark.parametrize(
    "options",
    [
        {"observations": SENSORS, "render_mode": "rgb_array"},
        {"move_set": "macro", "observations": ["depth"]},
        {"actions": "continuous", "observations": ["pose"]},
    ],
)
def test_gymnasium_finds_nothing_amiss(flat_path, options):
    env = gymnasium.make(f"world2minecraft:{ENV_ID}", scene=flat_path, eyes=EYES, **options)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    env.close()


def test_one_seed_is_one_walk(flat):
    def walk(seed):
        env = env_of(flat, observations=("rgb", "pose"))
        seen, info = env.reset(seed=seed)
        env.action_space.seed(seed)
        told = [(info["episode_id"], seen["rgb"].tobytes())]
        for _ in range(12):
            seen, reward, _, _, info = env.step(int(env.action_space.sample()) or 1)
            told.append((seen["pose"].tobytes(), seen["rgb"].tobytes(), reward, info["distance_m"]))
        return told

    assert walk(5) == walk(5)
    assert walk(5) != walk(6)


def test_the_oracle_is_scored_as_one(flat):
    for episode in random_episodes(flat, 4, seed=2):
        env = env_of(flat, episodes=[episode], observations=["pose"])
        env.reset()
        rewards = []
        for move in episode.moves:
            _, reward, over, cut, info = env.step(move)
            rewards.append(reward)
        assert over and not cut and info["success"] and info["collisions"] == 0
        score = info["score"]
        assert score["success"] == (True,) * 4 and score["steps"] == len(episode.moves)
        assert score["spl"] >= 0.9 and score["ndtw"] == pytest.approx(1) and score["ne_m"] < 0.5
        # All metres nearer, the steps' price, and the prize.
        nearer = score["shortest_m"] - score["ne_m"]
        assert sum(rewards) == pytest.approx(nearer - 0.01 * len(rewards) + 2.5)


def test_an_episode_ends_once(flat):
    env = env_of(flat, observations=["pose"], max_steps=3)
    with pytest.raises(gymnasium.error.ResetNeeded, match="call reset"):
        env.step(Move.LEFT)
    env.reset(seed=0)
    ends = [env.step(Move.LEFT)[2:4] for _ in range(3)]
    assert ends == [(False, False), (False, False), (False, True)]
    assert env.episode is not None
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(Move.LEFT)
    env.reset(seed=0)
    env.step(Move.LEFT)
    _, _, over, cut, info = env.step(Move.STOP)
    assert (over, cut) == (True, False) and not info["success"] and info["score"]["steps"] == 2


def test_a_goal_is_walked_to_and_collisions_are_counted(flat):
    env = env_of(flat, observations=["instruction"])
    seen, info = env.reset(seed=1, options={"goal": "piano"})
    assert seen["instruction"] == "Go to the upright piano." and info["goal"] == "upright piano"
    for _ in range(40):
        info = env.step(Move.FORWARD)[4]
    assert info["collided"] and info["collisions"] >= 1


def test_a_run_of_moves_is_one_action(flat):
    env = env_of(flat, move_set="macro", observations=["pose"])
    env.reset(seed=3)
    before = env.controller.stance
    seen = env.step(np.array([Move.RIGHT, 5]))[0]  # Six turns of 15 degrees.
    turned = (env.controller.stance.yaw_deg - before.yaw_deg) % 360
    assert turned == pytest.approx(90) and seen["pose"][3] == pytest.approx(
        env.controller.stance.yaw_deg
    )


def test_the_games_keys_walk_at_the_games_speed(flat):
    env = env_of(flat, actions="continuous", observations=["pose"])
    env.reset(seed=0)

    env.controller.begin(Stance(3.0, 65.0, 3.0, -90.0))  # Looks east, along the room.
    ahead = {**STAND, "keys": np.array([1, 0, 0, 0, 0, 0, 0], np.int8)}
    places = [env.step(ahead)[0]["pose"][0] for _ in range(10)]
    # 4.317 m/s of a person is so many metres of the room, whatever its blocks are.
    assert (places[-1] - places[-2]) * 20 == pytest.approx(4.317, rel=4e-3)
    for _ in range(3):
        seen = env.step({**STAND, "camera": np.array([0.5, 1], np.float32)})[0]
    assert seen["pose"][3:].tolist() == pytest.approx([-22.5, 90])


def test_given_episodes_come_in_their_order(flat, tmp_path):
    episodes = random_episodes(flat, 3, seed=1)
    write_episodes(tmp_path / "episodes.jsonl", episodes)
    assert read_episodes(tmp_path) == episodes
    env = env_of(flat, episodes=tmp_path, observations=["instruction"])
    names = [env.reset()[1]["episode_id"] for _ in range(4)]
    assert names == [episodes[n].episode_id for n in (0, 1, 2, 0)]
    assert env.reset(seed=7)[1]["episode_id"] == episodes[1].episode_id
    assert env.reset(options={"episode": 2})[1]["episode_id"] == episodes[2].episode_id
    assert env.reset(options={"episode": names[1]})[1]["episode_id"] == names[1]


def test_environments_run_side_by_side(flat_path):
    vector = gymnasium.make_vec(
        f"world2minecraft:{ENV_ID}", num_envs=2, vectorization_mode="sync",
        scene=flat_path, eyes=EYES, max_steps=2, observations=["rgb", "instruction"],
    )  # fmt: skip
    seen, _ = vector.reset(seed=0)
    assert seen["rgb"].shape == (2, 24, 32, 3) and len(seen["instruction"]) == 2
    for _ in range(2):
        _, _, _, cut, info = vector.step(np.array([Move.LEFT, Move.RIGHT]))
    assert cut.all() and info["score"]["ndtw"].shape == (2,)
    vector.close()


def test_processes_side_by_side_are_told_their_instructions(flat_path):
    vector = gymnasium.make_vec(
        f"world2minecraft:{ENV_ID}", num_envs=2, vectorization_mode="async",
        vector_kwargs={"shared_memory": False}, scene=flat_path, observations=["instruction"],
    )  # fmt: skip
    seen, info = vector.reset(seed=0)
    assert seen["instruction"] == tuple(info["instruction"])
    assert all(text.startswith("Go to the ") for text in seen["instruction"])
    vector.close()


def test_a_longer_list_of_episodes_begins_with_the_shorter(flat):
    assert random_episodes(flat, 4, seed=9)[:2] == random_episodes(flat, 2, seed=9)
    assert random_episodes(flat, 2, seed=8) != random_episodes(flat, 2, seed=9)


@pytest.mark.parametrize(
    ("options", "kind", "message"),
    [
        ({"actions": "keys"}, UnknownNameError, "no action space is named 'keys'"),
        (
            {"observations": ["rbg"]},
            UnknownNameError,
            "no observation is named 'rbg'; did you mean",
        ),
        (
            {"observations": []},
            UsageError,
            ("at least one observation is required; choose from rgb, depth"),
        ),
        ({"move_set": "vln"}, UnknownNameError, "no move set is named 'vln'; did you mean"),
        ({"max_steps": 0}, UsageError, "max_steps must be 1 or more, got 0"),
        ({"success_m": 0}, UsageError, "success_m must be a positive distance in metres, got 0"),
        (
            {"span_m": (5, 2)},
            UsageError,
            ("span_m must be the shortest and longest path length in metres"),
        ),
        (
            {"body": 0.5},
            UsageError,
            ("body, box and blocks_per_metre cannot be changed for a scene that is already open"),
        ),
        (
            {"episodes": []},
            UsageError,
            ("none of the 0 episodes belongs to scene 'flat'; they belong to"),
        ),
    ],
)
def test_impossible_options_are_refused(flat, options, kind, message):
    with pytest.raises(kind, match=message):
        VlnEnv(flat, **options)


def test_what_reset_and_step_cannot_do_is_told(flat):
    env = env_of(flat, observations=["pose"])
    with pytest.raises(UnknownNameError, match="no reset option is named 'gaol'; did you mean"):
        env.reset(options={"gaol": "piano"})
    with pytest.raises(UsageError, match="the reset option 'episode' requires an episode file"):
        env.reset(options={"episode": 1})
    given = env_of(flat, observations=["pose"], episodes=random_episodes(flat, 2))
    for wanted in (2, None, 0.5):
        with pytest.raises(
            UsageError, match=f"must be an index from 0 to 1 or an episode ID, got {wanted}"
        ):
            given.reset(options={"episode": wanted})
    env.reset(seed=0)
    told = r"action must be in Discrete\(4\), got 7: 0 stop, 1 forward, 2 left, 3 right"
    with pytest.raises(UsageError, match=told):
        env.step(7)
    with pytest.raises(
        UsageError, match=("image width and height must be 1 to 4096 pixels, got 0x24")
    ):
        Eyes(0, 24)


def test_an_instruction_of_any_alphabet_is_in_its_space(flat, monkeypatch):
    """Furniture that a user added, and rooms of a plan, are called as he calls them."""
    named = [dataclasses.replace(one, name=f"Küchentisch {n}") for n, one in
             enumerate(flat.landmarks)]  # fmt: skip
    monkeypatch.setitem(vars(flat), "landmarks", tuple(named))
    env = env_of(flat, observations=["instruction"])
    seen, _ = env.reset(seed=0, options={"goal": "Küchentisch 0"})
    assert "Küchentisch 0" in seen["instruction"] and seen in env.observation_space


def test_an_episode_that_no_way_solves_is_refused_when_it_begins(flat):
    (fine,) = random_episodes(flat, 1)
    walled = dataclasses.replace(fine, episode_id="walled", start=Stance(1.0, 65.0, 60.0))
    env = env_of(flat, episodes=[walled, fine], observations=["pose"])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(type(flat), "distance_m", lambda *_: float("inf"))
        with pytest.raises(InputError, match="no path leads from the start of episode walled"):
            env.reset(seed=0)
    assert env.reset()[1]["episode_id"] == fine.episode_id


@pytest.mark.parametrize("order", ["world2minecraft, gymnasium", "gymnasium, world2minecraft"])
def test_the_package_registers_in_either_order(order):
    code = f"import {order}; print(gymnasium.spec({ENV_ID!r}).entry_point)"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "world2minecraft.navigation.environment.env:VlnEnv"


def test_importing_the_package_does_not_import_gymnasium():
    code = "import world2minecraft, sys; print('gymnasium' in sys.modules, 'numpy' in sys.modules)"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "False False"


def test_looking_for_gymnasium_does_not_stop_registration():
    code = (
        "import importlib.util, world2minecraft; importlib.util.find_spec('gymnasium')\n"
        f"import gymnasium; gymnasium.spec({ENV_ID!r}); print(gymnasium.__spec__.loader)"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "SourceFileLoader" in told.stdout


def test_the_former_id_works_with_a_warning(flat_path):
    with pytest.warns(DeprecationWarning, match="World2Minecraft-VLN-v0 is deprecated; use world2"):
        env = gymnasium.make("World2Minecraft-VLN-v0", scene=flat_path, eyes=EYES)
    assert isinstance(env.unwrapped, VlnEnv)
    assert set(env.observation_space) == {"rgb", "pose", "instruction"}, "the former default"


def test_default_spaces_suit_stable_baselines3(flat_path):
    """Its ``check_env`` takes flat dictionaries of these kinds, and no text."""
    env = gymnasium.make(ENV_ID, scene=flat_path)
    seen, info = env.reset(seed=0)
    allowed = (spaces.Box, spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)
    assert isinstance(env.observation_space, spaces.Dict)
    assert all(isinstance(one, allowed) for one in env.observation_space.values())
    assert env.action_space == spaces.Discrete(4)
    picture = env.observation_space["rgb"]
    assert picture.dtype == np.uint8 and picture.shape[2] == 3 and min(picture.shape[:2]) >= 36
    assert all(isinstance(value, np.ndarray) for value in seen.values())
    assert info["instruction"].startswith("Go to the ")
    _, reward, terminated, truncated, _ = env.step(1)
    assert [type(one) for one in (reward, terminated, truncated)] == [float, bool, bool]
    check_env(env.unwrapped)


def test_the_entry_point_of_gymnasium_is_there():
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    module, _, name = project["entry-points"]["gymnasium.envs"]["__root__"].partition(":")
    getattr(import_module(module), name)()
    assert ENV_ID in gymnasium.registry
