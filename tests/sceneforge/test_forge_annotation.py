"""The annotation page's server: what it shows, checks and keeps, and whom it lets in."""

import json
import threading

import numpy as np
import pytest
from PIL import Image
from starlette.testclient import TestClient

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.navigation.language.human_instructions import (
    read_annotations,
    with_annotations,
)
from world2minecraft.navigation.records import read_trajectories, write_trajectories
from world2minecraft.navigation.types import Instruction, Keyframe, Stance, Trajectory
from world2minecraft.sceneforge.annotation.app import PAGE, annotation_server, build_app
from world2minecraft.sceneforge.annotation.store import AnnotationStore

TOKEN, PORT = "t" * 43, 8484
GOOD = {"number": 1, "level": "goal", "text": "Walk over to the piano, please.",
        "annotator": "Ada", "language": "en"}  # fmt: skip


def a_set(folder):
    """Two walks of three pictures."""
    walks = []
    for name in ("t0", "t1"):
        frames = []
        for number, move in enumerate(("move forward", "turn left", "stop")):
            image = f"images/flat/{name}/{number:03d}.jpg"
            (folder / image).parent.mkdir(parents=True, exist_ok=True)
            Image.fromarray(np.full((24, 32, 3), 60 * number, np.uint8)).save(folder / image)
            frames.append(Keyframe(image, Stance(number, 64, 0), move, ()))
        told = (
            Instruction("Go to the piano.", level="goal", landmarks=("upright piano",)),
            Instruction("Walk on, turn left and stop.", level="route"),
        )
        walks.append(Trajectory(name, "flat", tuple(frames), told, 2.0))
    write_trajectories(folder / "trajectories.jsonl", walks)
    return folder


@pytest.fixture
def folder(tmp_path):
    return a_set(tmp_path)


@pytest.fixture
def client(folder):
    app = build_app(AnnotationStore(folder), TOKEN, PORT)
    headers = {"authorization": f"Bearer {TOKEN}"}
    return TestClient(app, base_url=f"http://127.0.0.1:{PORT}", headers=headers)


def test_walks_are_shown_with_their_pictures(client, folder):
    listed = client.get("/api/walks").json()
    assert [one["id"] for one in listed["walks"]] == ["t0", "t1"]
    assert listed["file"] == str(folder / "annotations.jsonl")
    walk = client.get("/api/walk/1").json()
    assert walk["frames"] == ["move forward", "turn left", "stop"]
    assert walk["goal"] == "upright piano" and walk["things"] == ["upright piano"]
    image = client.get("/api/image/1/2")
    assert image.headers["content-type"] == "image/jpeg"
    assert image.content == (folder / "images/flat/t1/002.jpg").read_bytes()


def test_what_is_written_is_kept_and_imported(client, folder):
    assert client.post("/api/check", json=GOOD).json() == {"findings": []}
    assert client.post("/api/add", json=GOOD).status_code == 200
    other = {**GOOD, "level": "route", "text": "Walk a bit, turn left, stop."}
    client.post("/api/add", json=other)
    client.post("/api/add", json=other)  # Twice the same is kept once.
    found = read_annotations(folder / "annotations.jsonl")
    assert found == [
        ("t1", Instruction(GOOD["text"], "human", "goal", annotator="Ada")),
        ("t1", Instruction(other["text"], "human", "route", annotator="Ada")),
    ]
    walks = with_annotations(read_trajectories(folder), found, "annotations")
    assert [one.text for one in walks[1].instructions[2:]] == [GOOD["text"], other["text"]]
    assert client.get("/api/walks").json()["walks"][1]["written"] == 2
    again = AnnotationStore(folder)  # Another day.
    assert again.walk(1)["told"][-1] == {"level": "route", "text": other["text"], "by": "Ada"}


@pytest.mark.parametrize(
    ("changed", "error"),
    [
        ({"text": "Go to the sofa over there."},
         "the instruction must name the goal: the upright piano"),
        ({"annotator": " "}, "enter an annotator name of up to 60 characters"),
        ({"language": "x"}, "invalid language 'x'; use a code such as en or de-AT"),
        ({"level": "dance"},
         "instruction level must be one of goal, route, landmark, got 'dance'"),
        ({"number": 7}, "walk 7 not found; walks: 0 to 1"),
        ({"text": 5},
         "the body must contain an integer number and the strings level, text, annotator, "
         "language"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_refused(client, folder, changed, error):
    answer = client.post("/api/add", json={**GOOD, **changed})
    assert (answer.status_code, answer.json()) == (400, {"error": error})
    assert not (folder / "annotations.jsonl").exists()


def test_only_the_link_lets_in(folder):
    app = build_app(AnnotationStore(folder), TOKEN, PORT)
    stranger = TestClient(app, base_url=f"http://127.0.0.1:{PORT}")
    assert stranger.get("/api/walks").status_code == 403
    assert stranger.get("/").status_code == 403
    page = stranger.get(f"/?token={TOKEN}")  # The cookie is set, and the page follows.
    assert page.status_code == 200 and "Write navigation instructions" in page.text
    assert stranger.get("/annotate.js").status_code == 200
    rebound = TestClient(app, base_url="http://evil.example", headers={"authorization": TOKEN})
    assert rebound.get("/api/walks").status_code == 403


def test_a_large_body_is_not_read(client):
    answer = client.post("/api/add", json={**GOOD, "text": "x" * 100_000})
    assert answer.status_code == 413


def test_a_picture_outside_of_the_walk_is_not_there(client):
    assert client.get("/api/image/1/3").json() == {
        "error": "image 3 not found; this walk has images 0 to 2"
    }
    assert client.get("/api/image/1/-1").status_code == 404


def test_a_set_must_be_one(tmp_path, folder):
    with pytest.raises(InputError):
        AnnotationStore(tmp_path / "nothing")
    line = {"trajectory_id": "t9", "instruction": "Go."}
    (folder / "annotations.jsonl").write_text(json.dumps(line))
    with pytest.raises(InputError, match="trajectory 't9' not found"):
        AnnotationStore(folder)
    (folder / "annotations.jsonl").write_text(json.dumps({**line, "level": "dance"}))
    with pytest.raises(DamagedFileError, match="line 1: level must be one of goal, route"):
        AnnotationStore(folder)


def test_a_file_of_somebody_else_is_left_alone(folder):
    """Lines with further values would lose them, so they are not rewritten without force."""
    (folder / "mine.csv").write_text("trajectory_id,instruction\nt0,Walk to the piano.\n")
    with pytest.raises(UsageError, match="written as JSON lines; choose a name such as mine.jsonl"):
        AnnotationStore(folder, folder / "mine.csv")
    out = folder / "mine.jsonl"
    line = {"trajectory_id": "t0", "instruction": "Walk to the piano over there.", "note": "mine"}
    out.write_text(json.dumps(line))
    before = out.read_bytes()
    with pytest.raises(UsageError, match="contains other data than annotations; choose another"):
        AnnotationStore(folder, out)
    assert out.read_bytes() == before
    AnnotationStore(folder, out, force=True).add(1, "goal", GOOD["text"], "Ada")
    assert [name for name, _ in read_annotations(out)] == ["t0", "t1"]


def test_two_pages_lose_no_line_of_each_other(folder):
    pages = [AnnotationStore(folder), AnnotationStore(folder)]
    texts = [f"Walk over to the piano, please, {n} steps." for n in range(6)]

    def write(page):
        for text in texts[page::2]:
            pages[page].add(1, "goal", text, "Ada")

    threads = [threading.Thread(target=write, args=(page,)) for page in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    found = read_annotations(folder / "annotations.jsonl")
    assert sorted(one.text for _, one in found) == texts
    assert not list(folder.glob(".annotations*"))


def test_the_server_serves(folder):
    from urllib.request import Request, urlopen

    with annotation_server(AnnotationStore(folder), port=0) as server:
        asked = Request(f"{server.url}api/walks")
        asked.add_header("Authorization", f"Bearer {server.token}")
        with urlopen(asked, timeout=10) as answer:
            assert len(json.loads(answer.read())["walks"]) == 2


def test_the_page_asks_nothing_of_elsewhere():
    for name in ("index.html", "annotate.js", "annotate.css"):
        assert "http" not in (PAGE / name).read_text().replace("the http", "")
