"""Agents decide as they should, and a model's words become moves only where they say so."""

import json

import pytest
from open_field import OpenField, an_episode
from tests.external_models.scripted_server import MEGABYTE, Answer, scripted
from tests.external_models.test_chat_client import model_at

from world2minecraft.core.errors import BudgetError, ServerError, UsageError
from world2minecraft.external_models.chat_costs import Ledger
from world2minecraft.external_models.structured_replies import UnreadableError
from world2minecraft.navigation.agents import AGENTS, Decision, VlmAgent, make_agent
from world2minecraft.navigation.agents.action_format import SCHEMA, parse_step
from world2minecraft.navigation.agents.vlm_agent import facing, relative_m, trail_text
from world2minecraft.navigation.running.episode_runner import walk_episode
from world2minecraft.navigation.types import Move, Stance

F, L, R, S = Move.FORWARD, Move.LEFT, Move.RIGHT, Move.STOP


def step(*actions, done=False, thought="I see the post.", **more):
    told = {"thought": thought, "progress": "on the way", "actions": list(actions), "done": done}
    return json.dumps(told | more)


READ = [
    (step("FORWARD", "LEFT"), (F, L)),
    (step("STOP", done=True), (S,)),
    ("```json\n" + step("RIGHT") + "\n```", (R,)),
    ('{"actions": "FORWARD, FORWARD"}', (F, F)),
    ('{"actions": ["move forward", "turn left"]}', (F, L)),
    ("FORWARD", (F,)),
    ("FORWARD FORWARD LEFT", (F, F, L)),
    ("turn left, then move forward.", (L, F)),
    ("Thought: the door is open.\nActions: [RIGHT, FORWARD]", (R, F)),
    ("<think>left or right?</think><answer>turn right</answer>", (R,)),
    ("↑↑".replace("↑", "↑ ") + "←", (F, F, L)),
]


@pytest.mark.parametrize(("text", "moves"), READ)
def test_what_a_reply_says_is_read(text, moves):
    assert parse_step(text).moves == moves


UNREADABLE = [
    "",
    "I would go forward, then turn left at the door.",
    "You should not go FORWARD.",
    "JUMP",
    step("FORWARD", "JUMP"),
    step(),
    step("FORWARD", "FORWARD", "FORWARD", "FORWARD", "FORWARD"),
    step("STOP", "FORWARD"),
    step("FORWARD", done=True),
    step("FORWARD", done="yes"),
    '{"actions": [1]}',
    '{"actions": null}',
    '{"thought": "FORWARD"}',
    step("FORWARD") + step("LEFT"),
    "Actions: FORWARD or LEFT",
]


@pytest.mark.parametrize("text", UNREADABLE)
def test_what_a_reply_does_not_say_is_not_guessed(text):
    with pytest.raises(UnreadableError):
        parse_step(text)


def test_a_reply_of_more_moves_than_were_asked_is_no_step():
    with pytest.raises(UnreadableError, match="the reply contains 2 actions; expected 1 to 1"):
        parse_step(step("FORWARD", "LEFT"), max_moves=1)


def test_the_schema_is_one_that_strict_servers_take():
    assert SCHEMA["required"] == list(SCHEMA["properties"])
    assert SCHEMA["additionalProperties"] is False
    assert "maxItems" not in SCHEMA["properties"]["actions"]


def test_where_one_was_is_told_from_the_start():
    start = Stance(10.0, 64.0, 10.0, 90.0)  # Looks west, to -x; north, -z, is right.
    assert relative_m(start, Stance(8.0, 64.0, 9.0), 0.5) == (1.0, 0.5)
    assert facing(start, Stance(0, 0, 0, 0.0)) == "90 degrees left of the start"
    assert facing(start, Stance(0, 0, 0, -90.0)) == "back"
    text = trail_text([start, Stance(8.0, 64.0, 10.0, 90.0)], 0.5)
    assert text.splitlines() == [
        "Place 0: at the start (move 0)",
        "Place 1: 1 m ahead of the start (move 1)",
        "You are 1 m ahead of the start and look as at the start.",
    ]


def test_a_long_trail_is_told_in_few_places():
    stances = [Stance(0.0, 64.0, float(n), 0.0) for n in range(200)]
    lines = trail_text(stances, 1.0).splitlines()
    assert len(lines) == 13 and lines[-2] == "Place 11: 199 m ahead of the start (move 199)"


def test_a_decision_has_moves_or_says_why_not():
    with pytest.raises(ValueError, match="a decision with outcome"):
        Decision((), outcome="moves")
    with pytest.raises(ValueError, match="a decision with outcome"):
        Decision((F,), outcome="invalid")
    with pytest.raises(ValueError, match="STOP must be the last move"):
        Decision((S, F))


def test_the_oracle_arrives_and_stop_stays():
    walks = {
        name: walk_episode(OpenField(), an_episode(), AGENTS.load(name)())
        for name in AGENTS.names()
        if name != "human"
    }
    for name in ("oracle", "shortest"):
        assert walks[name].end == "stopped" and walks[name].score.success == (True,) * 4, name
        assert walks[name].score.spl > 0.9
    assert walks["stop"].steps == 1 and walks["stop"].score.ne_m == 3.0
    assert walks["forward"].end == "out of steps"
    again = walk_episode(OpenField(), an_episode(), AGENTS.load("random")())
    assert again.stances == walks["random"].stances
    other = walk_episode(OpenField(), an_episode(), AGENTS.load("random")(), seed=1)
    assert other.stances != again.stances


def test_forward_stops_at_a_wall():
    walk = walk_episode(OpenField(), an_episode(yaw_deg=-90.0), AGENTS.load("forward")())
    assert walk.end == "stopped" and walk.score.collisions == 1
    assert walk.stances[-1].x == 4.0


def test_the_blind_are_not_drawn_for():
    field = OpenField()
    walk_episode(field, an_episode(), AGENTS.load("oracle")())
    assert field.views == 0


def walk_with(server, *, episode=None, **options):
    agent = VlmAgent(model_at(server), **options)
    return walk_episode(OpenField(), an_episode() if episode is None else episode, agent)


def test_a_model_walks_by_its_words_alone():
    turn, walk_on = step("LEFT", "LEFT", "LEFT"), step("FORWARD", "FORWARD", "FORWARD", "FORWARD")
    script = [turn, turn, walk_on, walk_on, walk_on, step("STOP", done=True)]
    with scripted(script) as server:
        walk = walk_with(server)
        assert len(server.requests) == 6
    assert [move for move, _ in walk.made] == [L] * 6 + [F] * 12
    assert (walk.end, walk.steps, walk.decisions, walk.invalid) == ("stopped", 19, 6, 0)
    assert walk.score.success == (True,) * 4 and walk.score.spl == pytest.approx(1.0)


def test_what_a_model_is_shown():
    with scripted([step("FORWARD")]) as server:
        walk_with(server, episode=an_episode(max_steps=5), history=2, map_kind="text")
        sent = server.requests
    assert "RIGHT to the right" in sent[0]["messages"][0]["content"]
    pictures = [sum(part["type"] == "image_url" for part in one["messages"][1]["content"])
                for one in sent]  # fmt: skip
    assert pictures == [1, 2, 3, 3, 3]
    told = sent[3]["messages"][1]["content"][0]["text"]
    assert told.splitlines()[:4] == [
        "Instruction: Go to the post",
        "Moves so far: 3 of at most 5.",
        "Your last moves: FORWARD, FORWARD, FORWARD.",
        "Progress, in your words: on the way",
    ]
    assert "You are 0.75 m ahead of the start and look as at the start." in told


def test_a_collision_is_told_and_ends_the_chunk():
    with scripted([step("FORWARD", "FORWARD", "FORWARD", "FORWARD")]) as server:
        walk = walk_with(server, episode=an_episode(yaw_deg=90.0, max_steps=6))
        told = server.requests[2]["messages"][1]["content"][0]["text"]
    assert [collided for _, collided in walk.made] == [False] * 4 + [True, True]
    assert "FORWARD (blocked: you did not get ahead)." in told


BAD = {
    "prose": "I go towards the post.",
    "an unknown action": step("JUMP"),
    "a megabyte": MEGABYTE,
    "nothing": "",
}


@pytest.mark.parametrize("answer", BAD.values(), ids=BAD)
def test_a_model_that_says_nothing_usable_never_moves(answer):
    with scripted([answer]) as server:
        walk = walk_with(server)
        assert len(server.requests) == 9  # Three decisions of one question and two repairs.
    assert (walk.end, walk.made, walk.invalid, walk.steps) == ("gave up", (), 3, 3)
    assert walk.score.success == (False,) * 4


def test_a_model_hears_why_it_did_not_move():
    with scripted(["Hm."] * 3 + [step("STOP", done=True)]) as server:
        walk = walk_with(server)
        told = server.requests[3]["messages"][1]["content"][0]["text"]
    assert (walk.end, walk.invalid) == ("stopped", 1)
    assert (
        "Your last reply could not be used, and you did not move: 'Hm' is not a valid action"
    ) in told


def test_a_server_that_stays_busy_fails_without_a_move():
    with scripted([Answer(503, b"")]) as server:
        walk = walk_with(server)
        assert len(server.requests) == 9  # Three decisions, each asked three times.
    assert (walk.end, walk.failed, walk.invalid, walk.made) == ("gave up", 3, 0, ())


def test_wrong_keys_and_spent_budgets_end_the_run():
    with (
        scripted([Answer(401, b"no")]) as server,
        pytest.raises(ServerError, match=("returned HTTP status 401")),
    ):
        walk_with(server)
    with scripted([step("FORWARD")]) as server:
        agent = VlmAgent(model_at(server, ledger=Ledger(max_calls=3)))
        with pytest.raises(BudgetError, match="3 calls have been made"):
            walk_episode(OpenField(), an_episode(), agent)
        assert len(server.requests) == 3


def test_agents_are_known_by_name():
    def no_chat():
        raise AssertionError("no model was named")

    assert make_agent("stop", no_chat).name == "stop"
    with pytest.raises(UsageError, match="no agent is named 'oracl'; did you mean 'oracle'"):
        make_agent("oracl", no_chat)
    for wrong in ({"chunk": 5}, {"history": 9}, {"map_kind": "globe"}):
        with scripted([""]) as server, pytest.raises(UsageError):
            VlmAgent(model_at(server), **wrong)
