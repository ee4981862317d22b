"""The package that the pages ``docs/how-to/add-*.md`` form works as printed."""

import json
import re
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from tests.site.pages import FENCE

from world2minecraft import cli
from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.unlabelled_volume import unlabelled_volume
from world2minecraft.navigation.agents.registry import AGENTS
from world2minecraft.reconstruction.occupancy import predictor
from world2minecraft.reconstruction.semantics import LABELLERS

PAGES = sorted((Path(__file__).resolve().parents[2] / "docs" / "how-to").glob("add-*.md"))
PAGE = "\n".join(page.read_text() for page in PAGES)
FILES = {
    found[1]: one["body"]
    for one in FENCE.finditer(PAGE)
    if (found := re.match(r"# (\S+)\n", one["body"]))
}


@pytest.fixture(scope="module", autouse=True)
def package(tmp_path_factory):
    """Install the page's package: its modules, and its entry points as a wheel holds them."""
    root = tmp_path_factory.mktemp("site-packages")
    for name, text in FILES.items():
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_text(text)
    points = tomllib.loads(FILES["pyproject.toml"])["project"]["entry-points"]
    lines = []
    for group, entries in points.items():
        lines += [f"[{group}]", *(f"{name} = {target}" for name, target in entries.items())]
    folder = root / "my_package-1.0.dist-info"
    folder.mkdir()
    (folder / "entry_points.txt").write_text("\n".join(lines) + "\n")
    (folder / "METADATA").write_text("Metadata-Version: 2.1\nName: my_package\nVersion: 1.0\n")
    sys.path.insert(0, str(root))
    yield
    sys.path.remove(str(root))
    for name in [name for name in sys.modules if name.partition(".")[0] == "my_package"]:
        del sys.modules[name]


@pytest.fixture(scope="module")
def capture(tmp_path_factory, box_room):
    """The page's own layout of a capture: poses.csv beside pictures."""
    folder = tmp_path_factory.mktemp("csv")
    write_plain(folder, box_room.views(6))
    stated = json.loads((folder / "capture.json").read_text())
    (folder / "capture.json").unlink()
    rows = []
    for kind, old in (("rgb", "colour"), ("depth", "depth")):
        (folder / kind).mkdir(exist_ok=True)
        for path in sorted((folder / old).glob("*.png")):
            path.rename(folder / kind / path.name)
    for entry in stated["frames"]:
        pose = [str(value) for row in entry["camera_to_world"] for value in row]
        rows.append(",".join([entry["name"], "160", "120", "130", "80", "60", *pose]))
    (folder / "poses.csv").write_text("\n".join(rows) + "\n")
    return folder


def test_the_source_is_found_out_by_itself(capture):
    found = find_capture(capture)
    assert found.source == "csv_frames" and len(found.frames) == 6
    assert found.frames[0].colour_path.is_file() and found.frames[0].depth_path.is_file()


def test_the_predictor_gives_every_second_view(capture):
    scan = open_scan(capture)
    used = [evidence.view for evidence in predictor("thinned").predict(scan)]
    assert used == [view.name for view in scan.views][::2] and used


def test_the_labeller_caps_what_it_claims():
    from my_package import labeller

    assert LABELLERS.load("cautious") is labeller.CautiousLabeller


def test_the_format_brings_blocks_back_and_refuses_a_lie(tmp_path):
    palette = ("minecraft:air", "minecraft:stone", "minecraft:oak_slab[type=bottom]")
    states = np.arange(24, dtype=np.uint16).reshape(2, 3, 4) % 3
    volume = unlabelled_volume(states, palette, (0, 0, 0))
    write_blocks(volume, tmp_path / "house.blocks", losses=Losses())
    again = read_blocks(tmp_path / "house.blocks")
    assert (again.states == states).all() and again.palette == palette
    (tmp_path / "lie.blocks").write_text("2 3 4\nminecraft:air\n0\n")
    assert cli.run(["convert", str(tmp_path / "lie.blocks"), str(tmp_path / "a.schem")]) == 3


def test_the_network_learns():
    torch = pytest.importorskip("torch", reason="torch is not installed")
    from world2minecraft.networks.batch import OccInput
    from world2minecraft.networks.models import make_network

    network = make_network("columns", "tiny", grid_shape=(8, 8, 8), voxel_m=0.16)
    batch = OccInput(
        torch.rand(2, 3, 24, 32), torch.eye(3).repeat(2, 1, 1), torch.eye(4).repeat(2, 1, 1),
        (8, 8, 8), 0.16,
    )  # fmt: skip
    scores = network(batch).logits
    assert scores.shape == (2, 12, 8, 8, 8)
    scores[:, 3].sum().backward()
    assert all(weights.grad is not None for weights in network.parameters())


def test_the_agent_walks_turns_and_stops():
    pytest.importorskip("gymnasium", reason="gymnasium is not installed")
    from world2minecraft.navigation.agents import Observation, Task
    from world2minecraft.navigation.moves import get_move_set
    from world2minecraft.navigation.types import Move, Stance

    agent = AGENTS.load("wall_follower")()
    agent.begin(Task("Go to the table", get_move_set("vlnce"), 0.25, 5, 0.25))
    stance, picture = Stance(0, 0, 0, 0), np.zeros((4, 4, 3), np.uint8)
    met = ((Move.FORWARD, True),)
    decided = [
        agent.decide(Observation(step, picture, stance, done)).moves[0]
        for step, done in ((0, ()), (1, met), (4, ()))
    ]
    assert decided == [Move.FORWARD, Move.LEFT, Move.STOP]


def test_a_registry_that_the_page_names_is_there():
    source = Path(cli.__file__).parents[1]
    rows = re.findall(r"`([A-Z_]+)` of `([\w/]+\.py)`", PAGE)
    assert len(rows) >= 9
    for name, path in rows:
        assert re.search(rf"^{name}\b.*=", (source / path).read_text(), re.MULTILINE), (name, path)
