"""A model that walks through an edited room: its moves, its end, its limits, and its routes."""

import json

import numpy as np
import pytest
from forge_serving import client, served
from tests.external_models.scripted_server import scripted

from world2minecraft.core.errors import InputError, UsageError
from world2minecraft.external_models.chat_transport import ENDPOINTS
from world2minecraft.navigation.agents.types import Decision
from world2minecraft.navigation.types import Move
from world2minecraft.sceneforge.agent_walks import MAX_CALLS, MAX_USD, AgentWalk, WalkAgents
from world2minecraft.sceneforge.build_preview import BlockBuild, BuildOptions, SceneSnapshot
from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import demo_room
from world2minecraft.sceneforge.walk_guide import WalkGuide

FEET_M, LOOK_M, LAMP = (1.4, 0.7, 0.0), (0.0, 1.0, 0.0), 16


def reply(*actions: str) -> str:
    """Return what a model answers to make moves."""
    done = "STOP" in actions
    told = {"thought": "I see the lamp.", "progress": "on the way", "actions": actions}
    return json.dumps({**told, "done": done})


class Script:
    """An agent that decides what is written."""

    name, is_privileged, is_blind = "script", False, False

    def __init__(self, *decisions: Decision):
        self.decisions, self.sights, self.task = list(decisions), [], None

    def begin(self, task):
        self.task = task

    def decide(self, sight):
        self.sights.append(sight)
        return self.decisions.pop(0)


@pytest.fixture(scope="module")
def guide() -> WalkGuide:
    """A guide through the demo room at 4 blocks per metre."""
    scene = SceneSnapshot.of(Editor(demo_room()))
    return WalkGuide(BlockBuild.of(scene, BuildOptions()).volume, scene.objects, scene.name)


def walk_of(guide, *decisions, sentence="go to the lamp", look=LOOK_M):
    agent = Script(*decisions)
    return agent, AgentWalk(guide, agent, sentence, FEET_M, look)


@pytest.mark.parametrize("look", [(0.0, 1.0, 0.0), (1.0, 0.0, -0.3), (-1.0, -1.0, 0.0)])
def test_an_agent_starts_where_the_person_looks(guide, look):
    agent, walk = walk_of(guide, Decision((Move.LEFT, Move.RIGHT, Move.FORWARD)), look=look)
    told = walk.decide()
    assert agent.task.instruction == "go to the lamp" and agent.task.guide is None
    assert agent.sights[0].colour.shape == (480, 640, 3)
    after = told["stances"][1]
    ahead = np.array(after["ahead_m"]) - after["feet_m"]
    flat = np.array([*look[:2], 0]) / np.hypot(*look[:2])
    assert ahead[2] == pytest.approx(0, abs=1e-3)
    assert ahead @ flat == pytest.approx(np.linalg.norm(ahead), abs=1e-3)
    went = np.array(told["stances"][2]["feet_m"]) - after["feet_m"]
    assert went @ flat == pytest.approx(0.25, abs=0.02) or np.allclose(went, 0)
    assert walk.steps == 3 and told["end"] == "" and told["goal"] is None


def test_a_collision_drops_the_other_moves_and_is_seen(guide):
    forward = Decision((Move.FORWARD,) * 4)
    agent, walk = walk_of(guide, *[forward] * 20)
    while not agent.sights or not any(hit for _, hit in agent.sights[-1].done):
        told = walk.decide()
    assert len(agent.sights[-1].done) <= 4 and told["end"] == ""


def test_stop_ends_a_walk_and_says_how_far_the_goal_is(guide):
    _, walk = walk_of(guide, Decision((Move.LEFT, Move.STOP)))
    told = walk.decide()
    assert told["end"] == "stopped" and len(told["stances"]) == 1
    goal, planned = told["goal"], guide.answer("go to the lamp", FEET_M)
    assert goal["id"] == LAMP and goal["away_m"] == pytest.approx(planned["away_m"], abs=0.3)
    _, walk = walk_of(guide, Decision((Move.STOP,)), sentence="find a place to sleep")
    assert walk.decide()["goal"] is None


def test_three_silent_decisions_or_all_steps_end_a_walk(guide):
    silent = Decision((), outcome="invalid", details={"problem": "the reply is empty"})
    _, walk = walk_of(guide, silent, Decision((Move.LEFT,)), *[silent] * 3)
    told = [walk.decide() for _ in range(5)]
    assert [one["end"] for one in told] == ["", "", "", "", "gave up"]
    assert told[0]["thought"] == "the reply is empty" and walk.steps == 5
    _, walk = walk_of(guide, *[Decision((Move.LEFT,) * 4)] * 30)
    ends = [walk.decide()["end"] for _ in range(30)]
    assert ends == [""] * 29 + ["out of steps"] and walk.steps == 120


def test_a_walk_begins_on_the_floor(guide):
    with pytest.raises(InputError, match="nobody can stand there"):
        AgentWalk(guide, Script(), "lamp", (1.4, 0.7, 30.0), LOOK_M)


def test_models_are_those_with_a_key_and_the_chosen_one(monkeypatch):
    for one in ENDPOINTS.values():
        monkeypatch.delenv(one.key_name, raising=False)
    monkeypatch.setenv("GEMINI_API_KEY", "k")
    monkeypatch.setenv("OPENAI_API_KEY", "  ")
    assert WalkAgents.configured().names == ("gemini",)
    chosen = WalkAgents.configured("openai:gpt-4.1-mini", 1)
    assert chosen == WalkAgents(("openai:gpt-4.1-mini", "gemini"), 1)
    assert WalkAgents.configured("gemini").names == ("gemini",)
    with pytest.raises(UsageError, match="no model server is named 'gemni'"):
        WalkAgents.configured("gemni")
    with pytest.raises(UsageError, match="--max-usd must be 0 or more"):
        WalkAgents(max_usd=float("nan"))


def test_every_model_has_a_limit(monkeypatch):
    monkeypatch.setenv("GEMINI_API_KEY", "k")
    agents = WalkAgents(("gemini", "http://127.0.0.1:9/v1", "gemini:gemini-unknown"))
    assert agents.open("gemini").ledger.max_usd == MAX_USD
    unknown = agents.open("gemini:gemini-unknown").ledger
    assert unknown.max_usd is None and unknown.max_calls == MAX_CALLS
    assert WalkAgents(("gemini",), 2.0).open("gemini").ledger.max_usd == 2
    with pytest.raises(UsageError, match="no model 'qwen' is configured"):
        agents.open("qwen")


def test_a_model_walks_over_http_until_it_stops(tmp_path):
    place = {"to": "go to the lamp", "feet_m": FEET_M, "look_m": LOOK_M, "blocks_per_metre": 2}
    with (
        scripted([reply("FORWARD", "LEFT"), reply("STOP")]) as model,
        served(Editor(demo_room()), home=tmp_path, agents=WalkAgents((model.url,))) as server,
        client(server) as script,
    ):

        def post(what, **fields):
            return script.post(f"/api/agents/{what}", json=fields)

        assert script.get("/api/agents").json() == {"agents": [model.url]}
        first = post("walk", agent=model.url, **place).json()["walk"]
        second = post("walk", agent=model.url, **place).json()["walk"]
        assert "this walk has ended" in post("step", walk=first).json()["error"]
        told = post("step", walk=second).json()
        assert len(told["stances"]) == 2 and told["thought"] == "I see the lamp."
        assert told["usd"] is None and told["calls"] == 1
        assert post("step", walk=second).json()["end"] == "stopped"
        assert "this walk has ended" in post("step", walk=second).json()["error"]
        for wrong, words in (
            ({"agent": "gemini"}, "no model 'gemini' is configured"),
            ({"to": 3}, "to must be 1 to 200 characters"),
            ({"feet_m": [1, "x", 2]}, "feet_m must be three numbers"),
            ({"look_m": None}, "look_m must be three numbers"),
            ({"feet_m": [10**400, 0, 0]}, "feet_m must be three numbers"),
            ({"blocks_per_metre": 10**400}, "blocks_per_metre must be a number"),
            ({"blocks_per_metre": "4"}, "blocks_per_metre must be a number"),
        ):
            answer = post("walk", **({"agent": model.url, **place} | wrong))
            assert answer.status_code == 400 and words in answer.json()["error"]
    pictures = model.requests[0]["messages"][-1]["content"]
    assert any(part["type"] == "image_url" for part in pictures)
