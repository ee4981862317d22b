"""A live walk and live answers by a real model server: LLaMA-Factory's, with the tiny model.

The model is of chance and says nothing of sense. What is held here is that the server's protocol,
pictures and all, is ours; that what cannot be read is INVALID, asked again a bounded number of
times; and that no move was made that was not said.
"""

import os
import socket
import subprocess
import time
import urllib.error
import urllib.request

import pytest
from tests.navigation.small_flat import write_flat
from tests.navigation.vln_sets import small_set
from tests.trainers.test_trainers import HERE, python_of, run

from world2minecraft.external_models.chat_client import open_chat
from world2minecraft.external_models.reply_cache import ReplyStore
from world2minecraft.navigation.agents import VlmAgent
from world2minecraft.navigation.agents.question_answering import VlmAnswerer
from world2minecraft.navigation.records import read_items
from world2minecraft.navigation.running.episode_runner import walk_episode
from world2minecraft.navigation.running.item_evaluation import evaluate
from world2minecraft.navigation.running.sentence_goals import GoalRequest, episode_of_sentence
from world2minecraft.navigation.running.simulator import SceneSimulator
from world2minecraft.navigation.running.trace import TraceWriter, read_trace
from world2minecraft.navigation.scene import camera_of, open_scene

pytestmark = pytest.mark.trainers

START_S = 900.0  # Importing it alone takes 20 s of an idle core.


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """The address of LLaMA-Factory's server with the tiny model."""
    room = tmp_path_factory.mktemp("live")
    model = room / "tiny"
    run("llamafactory", room, HERE / "tiny_qwen.py", model)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    words = ["--model_name_or_path", model, "--template", "qwen2_vl", "--infer_dtype", "float32"]
    words += ["--infer_backend", "huggingface", "--image_max_pixels", str(16 * 784)]
    quiet = {"PYTHONPATH": "", "OMP_NUM_THREADS": "1", "HF_HUB_OFFLINE": "1"}
    with (room / "server.log").open("w") as log:
        process = subprocess.Popen(
            [python_of("llamafactory"), HERE / "run_api.py", *map(str, words)],
            env={**os.environ, **quiet, "API_PORT": str(port), "API_HOST": "127.0.0.1"},
            stdout=log,
            stderr=log,
        )
    address = f"http://127.0.0.1:{port}/v1"
    try:
        _wait(address, process, room / "server.log")
        yield address
    finally:
        process.terminate()
        process.wait(30)


def _wait(address, process, log):
    end = time.monotonic() + START_S
    while time.monotonic() < end:
        assert process.poll() is None, log.read_text()[-3000:]
        try:
            urllib.request.urlopen(f"{address}/models", timeout=5).close()
            return
        except (OSError, urllib.error.URLError):
            time.sleep(1)
    raise AssertionError(f"no answer in {START_S:g} s: {log.read_text()[-3000:]}")


def chat_at(server, folder):
    return open_chat(
        server, store=ReplyStore(folder / "replies.jsonl"), max_tokens=24, timeout_s=300.0
    )


def test_a_walk_by_a_live_model(server, tmp_path):
    scene = open_scene(write_flat(tmp_path / "flat"))
    ground = SceneSimulator(scene, camera=camera_of(224, 224, 79.0))
    chat = chat_at(server, tmp_path)
    agent = VlmAgent(chat, history=1)
    episode = episode_of_sentence(scene, GoalRequest("Go to the piano", max_steps=4))
    begin = time.monotonic()
    walk = walk_episode(ground, episode, agent, observers=[TraceWriter(tmp_path)])
    took_s = time.monotonic() - begin
    _, *decisions, last = read_trace(tmp_path / "trace.jsonl")
    assert walk.failed == 0 and walk.decisions == len(decisions) <= 4
    assert walk.invalid == sum(one["outcome"] == "invalid" for one in decisions)
    for one in decisions:
        assert one["outcome"] in ("moves", "invalid") and len(one["told"]["tries"]) <= 5
        assert bool(one["made"]) == (one["outcome"] == "moves")
    told = chat.ledger.to_json()
    assert told["calls"] == len((tmp_path / "replies.jsonl").read_text().splitlines())
    assert told["prompt_tokens"] > 100 * told["calls"]  # The server counts words and pictures.
    print(
        f"{walk.decisions} decisions, {walk.invalid} invalid, {last['end']}, "
        f"{told['calls']} calls, {told['prompt_tokens'] / told['calls']:.0f} tokens a question, "
        f"{took_s:.1f} s"
    )


def test_answers_by_a_live_model(server, tmp_path):
    folder = small_set(tmp_path / "set", width=224, height=224)
    chat = chat_at(server, tmp_path)
    items = [item for item in read_items(folder) if item.task == "next_view"][:2]
    found = evaluate(items, VlmAnswerer(chat, folder, max_px=16 * 784))
    assert all(one.answer.outcome in ("answered", "invalid") for one in found)
    assert chat.ledger.to_json()["calls"] <= 3 * len(items) + 3
    print([one.answer.outcome for one in found], chat.ledger.to_json())
