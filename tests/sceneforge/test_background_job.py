"""Long questions and plans run beside the edits: the same answers, and nobody waits for them."""

import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from forge_serving import client, heard, paint, served, small_editor, tab

from world2minecraft.editing.scene.repair import Smooth
from world2minecraft.sceneforge import session
from world2minecraft.sceneforge.queries import Floaters

SHAPE = (40, 30, 24)


def flat(*cell) -> int:
    return int(np.ravel_multi_index(cell, SHAPE))


@pytest.fixture
def server():
    with served(small_editor(SHAPE)) as server:
        yield server


@pytest.fixture
def script(server):
    with client(server) as script:
        yield script


@pytest.fixture
def large(monkeypatch):
    """Every scene counts as large."""
    monkeypatch.setattr(session, "QUICK_CELLS", 0)


@pytest.fixture
def held(monkeypatch):
    """Return two events: looking for floaters has begun, and it may end."""
    begun, may_end = threading.Event(), threading.Event()
    answer = Floaters.answer

    def slow(self, editor):
        begun.set()
        assert may_end.wait(20)
        return answer(self, editor)

    monkeypatch.setattr(Floaters, "answer", slow)
    yield begun, may_end
    may_end.set()


@pytest.mark.parametrize("name", ["floaters", "holes", "doubtful"])
def test_the_answers_are_those_of_a_small_scene(script, monkeypatch, name):
    script.post("/api/do", json=paint(flat(6, 6, 4)))
    small = script.post(f"/api/ask/{name}", json={}).json()
    monkeypatch.setattr(session, "QUICK_CELLS", 0)
    assert script.post(f"/api/ask/{name}", json={}).json() == small
    assert small or name == "holes"


def test_progress_of_a_question_is_sent_to_every_tab(server, script, large):
    with tab(server) as socket_:
        script.post("/api/ask/holes", json={})
        told = []
        while not told or told[-1]["state"] == "running":
            told.append(heard(socket_))
    assert {one["title"] for one in told} == {"Finding holes"}
    assert told[-1]["state"] == "done" and told[-1]["result"] is None
    stages = [one["stage"] for one in told]
    assert list(dict.fromkeys(stages)) == ["", "scene", "planes"]


def test_an_edit_does_not_wait_for_a_question(server, script, large, held):
    begun, may_end = held
    with ThreadPoolExecutor(1) as beside, client(server) as other:
        asked = beside.submit(other.post, "/api/ask/floaters", json={})
        assert begun.wait(20)
        assert script.post("/api/do", json=paint(5)).json()["rev"] == 1
        assert not asked.done()
        may_end.set()
        assert asked.result(20).json() == []


def test_a_question_is_cancelled(server, script, large, held):
    begun, may_end = held
    with ThreadPoolExecutor(1) as beside, client(server) as other:
        asked = beside.submit(other.post, "/api/ask/floaters", json={})
        assert begun.wait(20)
        (job,) = server.session.jobs.states()
        assert script.post(f"/api/jobs/{job['id']}/cancel").status_code == 200
        may_end.set()
        answer = asked.result(20)
    assert (answer.status_code, answer.json()) == (
        400,
        {"error": "Finding floaters: cancelled"},
    )


def test_a_plan_is_done_where_its_cells_are_what_they_were(server, script, large, monkeypatch):
    """A lone bump goes; one that was painted over meanwhile stays, and the plan is refused."""
    table = [[flat(x, y, 3), 1] for x in range(3, 9) for y in range(2, 8)]
    bump = flat(6, 5, 4)
    script.post("/api/do", json=paint(0) | {"cells": [*table, [bump, 1]]})
    begun, may_end = threading.Event(), threading.Event()
    plan = Smooth.plan

    def slow(self, draft, tools):
        begun.set()
        assert may_end.wait(20)
        return plan(self, draft, tools)

    monkeypatch.setattr(Smooth, "plan", slow)
    with ThreadPoolExecutor(1) as beside, client(server) as other:
        asked = beside.submit(other.post, "/api/do", json={"op": "smooth"})
        assert begun.wait(20)
        rev = script.post("/api/do", json=paint(bump, 1, class_id=5)).json()["rev"]
        may_end.set()
        answer = asked.result(20)
    assert answer.status_code == 400 and "changed since" in answer.json()["error"]
    assert server.session.rev == rev
    assert script.post("/api/do", json={"op": "smooth"}).json()["rev"] == rev + 1
    assert server.session.document.draft.labels.ravel()[bump] == 0
