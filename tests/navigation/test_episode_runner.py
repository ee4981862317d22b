"""Walks, their traces and their results on disk, on a field without a scene."""

import json

import numpy as np
import pytest
from open_field import OpenField, an_episode
from tests.external_models.scripted_server import scripted
from tests.external_models.test_chat_client import model_at

from world2minecraft.core.errors import InputError, OutputError
from world2minecraft.external_models.chat_messages import Picture
from world2minecraft.navigation.agents import AGENTS, Decision, VlmAgent
from world2minecraft.navigation.running.episode_evaluation import evaluate_agent, write_walks_result
from world2minecraft.navigation.running.episode_runner import walk_episode
from world2minecraft.navigation.running.result_tables import read_result, walks_table
from world2minecraft.navigation.running.trace import TraceWriter, read_trace
from world2minecraft.navigation.types import Move

F, L, S = Move.FORWARD, Move.LEFT, Move.STOP


class Script:
    """Decides by a list, the last one for ever."""

    name, is_privileged, is_blind = "script", False, False

    def __init__(self, *decisions):
        self.decisions, self.sights = decisions, []

    def begin(self, task):
        self.task, self.sights = task, []

    def decide(self, sight):
        self.sights.append(sight)
        return self.decisions[min(len(self.sights), len(self.decisions)) - 1]


def test_an_agent_sees_what_became_of_its_moves():
    agent = Script(Decision((F, L)), Decision((F,)), Decision((S,)))
    walk = walk_episode(OpenField(), an_episode(), agent)
    assert [sight.step for sight in agent.sights] == [0, 2, 3]
    assert [sight.done for sight in agent.sights] == [(), ((F, False), (L, False)), ((F, False),)]
    assert [sight.stance for sight in agent.sights] == [walk.stances[n] for n in (0, 2, 3)]
    assert agent.task.guide is None and agent.task.step_m == 0.25


def test_no_agent_walks_on_after_the_last_step():
    for size, chunk in ((5, (F, F)), (4, (F, F, F, F)), (1, (L, L))):
        walk = walk_episode(OpenField(), an_episode(max_steps=size), Script(Decision(chunk)))
        assert (walk.end, walk.steps, len(walk.made)) == ("out of steps", size, size)
        assert not any(walk.score.success)


def test_stop_in_the_last_step_counts():
    walk = walk_episode(OpenField(), an_episode(max_steps=2), Script(Decision((F, S))))
    assert (walk.end, walk.steps) == ("stopped", 2)


def test_silence_ends_a_walk_only_in_a_row():
    silent, one = Decision((), outcome="invalid"), Decision((F,))
    walk = walk_episode(OpenField(), an_episode(), Script(silent, silent, one, silent))
    assert (walk.end, walk.invalid, walk.steps, walk.made) == ("gave up", 5, 6, ((F, False),))


def test_a_trace_tells_all_of_a_walk(tmp_path):
    fine = json.dumps({"thought": "on", "progress": "", "actions": ["FORWARD"], "done": False})
    stop = fine.replace("FORWARD", "STOP")
    with scripted([fine, "prose", "prose", "prose", stop]) as server:
        agent = VlmAgent(model_at(server))
        walk = walk_episode(OpenField(), an_episode(), agent, observers=[TraceWriter(tmp_path)])
        asked = server.requests
    first, *decisions, last = read_trace(tmp_path / "trace.jsonl")
    assert (first["instruction"], first["agent"]) == ("Go to the post", "scripted")
    assert [one["outcome"] for one in decisions] == ["moves", "invalid", "moves"]
    assert [one["made"] for one in decisions] == [[["FORWARD", False]], [], [["STOP", False]]]
    assert decisions[0]["thought"] == "on" and len(decisions[1]["told"]["tries"]) == 3
    assert decisions[1]["told"]["raw"] == "prose"
    assert (last["end"], last["invalid"], last["steps"]) == ("stopped", 1, 3)
    assert last["score"]["ne_m"] == pytest.approx(walk.score.ne_m)
    view = Picture((tmp_path / decisions[2]["view"]).read_bytes())
    assert view.sha256 == decisions[2]["view_sha256"]
    shown = asked[-1]["messages"][1]["content"]
    assert [part["image_url"]["url"] for part in shown if "image_url" in part][-1] == view.url


def test_the_views_of_a_longer_walk_before_are_not_kept(tmp_path):
    forward, stop = Decision((F,)), Decision((S,))
    for decisions in ((forward, forward, stop), (stop,)):
        walk_episode(
            OpenField(), an_episode(), Script(*decisions), observers=[TraceWriter(tmp_path)]
        )
    assert [path.name for path in (tmp_path / "views").iterdir()] == ["0000.jpg"]
    assert len(read_trace(tmp_path / "trace.jsonl")) == 3


def test_an_unreachable_episode_is_refused_before_the_first_walk(tmp_path):
    class Walled(OpenField):
        def distance_m(self, stance, goals):
            return float("inf") if goals[0][0] > 4 else super().distance_m(stance, goals)

    agent = Script(Decision((S,)))
    episodes = [an_episode(), an_episode(name="lost", goal=(9.0, 64.0, 0.0))]
    told = "field: no path leads from the start of episode lost to its goal; if blocks have changed"
    with pytest.raises(InputError, match=told):
        evaluate_agent(episodes, lambda _: Walled(), agent, observers=lambda *_: ())
    assert not agent.sights
    with pytest.raises(InputError, match=told):
        walk_episode(Walled(), episodes[1], agent)


def test_a_trace_of_anyone_is_checked(tmp_path):
    (tmp_path / "trace.jsonl").write_text('{"a": 1}\n[1]\n')
    with pytest.raises(InputError, match="line 2 is not a JSON object"):
        read_trace(tmp_path / "trace.jsonl")
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"):
        TraceWriter(tmp_path / "file").on_begin(an_episode(), "stop")


def test_an_agent_is_evaluated_beside_stop_random_and_oracle(tmp_path):
    episodes = [an_episode(name=f"e{n}", goal=(2.0, 64.0, float(n))) for n in range(3)]
    walks, beside = evaluate_agent(
        episodes, lambda _: OpenField(), AGENTS.load("shortest")(), observers=lambda *_: ()
    )
    told = write_walks_result(tmp_path, walks, beside, {"training": "none"})
    table = walks_table([read_result(tmp_path)])
    assert [row[0] for row in table] == ["agent", "shortest", "stop", "random", "oracle"]
    assert [row[table[0].index("SR 0.5 m")] for row in table[1:]][::3] == ["100.0%", "100.0%"]
    assert table[1][1] == "3" and told["summary"]["ends"] == {"stopped": 3}
    means = np.mean([walk.score.ne_m for walk in walks])
    assert told["summary"]["ne_m"] == pytest.approx(means)
    twice = walks_table([told, told])
    assert [row[0] for row in twice[1:]] == ["shortest", "stop", "random", "oracle", "shortest"]
