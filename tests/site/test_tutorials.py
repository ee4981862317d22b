"""The tutorials do what they say: every command and snippet of them runs, on a small room."""

import contextlib
import os
import re
import shlex
import shutil
from pathlib import Path

import pytest
from tests.site.pages import Step, steps_of

from rcon_console import Console
from world2minecraft import cli
from world2minecraft.procgen.rooms.room import generate_room
from world2minecraft.procgen.virtual_scan import scan_room

DOCS = Path(__file__).resolve().parents[2] / "docs" / "tutorials"
FIRST = "phone-scan"
# After the first, each needs no other, but for the network's that needs the data set's.
AFTER = {"train": "data-set"}
NEEDS = {
    "agent": ("gymnasium", "imageio_ffmpeg"),
    "data-set": ("pyarrow",),
    "train": ("torch", "pyarrow"),
    "ray": ("ray", "pyarrow"),
}
OTHERS = {"index", "first-five-minutes"}  # Tested elsewhere, or without commands.
PAGES = sorted({path.stem for path in DOCS.glob("*.md")} - OTHERS)
OF_0_1 = Path(__file__).parent / "docs_of_0_1"
CHANGED = ["agent", "edit"]  # Since version 0.1.
SERVER = "localhost:25575"


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    """Return a function that does what a page says, once, in a folder with a small scan."""
    folder = tmp_path_factory.mktemp("tutorials") / "now"
    scan_room(generate_room(7, kind="study"), folder / "my_scan", frames=16, width=320, height=240)
    done = set()

    def follow(path, place):
        with contextlib.chdir(place):
            for step in steps_of(path.read_text()):
                do(step)

    def walk_of_0_1(page):
        walk(FIRST)
        place = folder.parent / page
        shutil.copytree(folder.parent / FIRST, place)
        follow(OF_0_1 / f"{page}.md", place)
        return place

    def walk(page):
        for before in filter(None, (FIRST if page != FIRST else None, AFTER.get(page))):
            walk(before)
        if page not in done:
            done.add(page)
            follow(DOCS / f"{page}.md", folder)
            if page == FIRST:
                shutil.copytree(folder, folder.parent / FIRST)
        return folder

    walk.of_0_1 = walk_of_0_1
    return walk


def do(step: Step) -> None:
    if step.kind == "yaml":
        (name,) = re.findall(r"^# (\S+\.yaml)$", step.body, re.MULTILINE)
        Path(name).write_text(step.body)
    elif step.kind == "python":
        exec(compile(step.body, "<the page>", "exec"), {"__name__": "page"})
    else:
        with Console() as console:
            for line in step.body.splitlines():
                command(f"{line} {step.more}", console)


def command(line: str, console: Console) -> None:
    program, *words = shlex.split(line.replace(SERVER, f"127.0.0.1:{console.port}"))
    if program == "export":
        name, _, value = words[0].partition("=")
        os.environ[name] = value
        return
    assert program == "w2m", line
    assert cli.run(words) == 0, line
    if "--rcon" in words:
        assert len(console.blocks) > 100


@pytest.fixture(autouse=True)
def environment():
    """What a page exports ends with it."""
    before = dict(os.environ)
    yield
    os.environ.clear()
    os.environ.update(before)


@pytest.mark.parametrize("page", PAGES)
def test_each_command_and_snippet_of_a_tutorial_runs(page, walk):
    for needed in NEEDS.get(page, ()):
        pytest.importorskip(needed, reason=f"{needed} is not installed")
    folder = walk(page)
    named = re.findall(r"--out (\S+)", (DOCS / f"{page}.md").read_text())
    ran = [
        word for step in steps_of((DOCS / f"{page}.md").read_text()) for word in step.body.split()
    ]
    assert ran
    assert all((folder / name).exists() for name in named if name in ran)


@pytest.mark.parametrize("page", CHANGED)
def test_a_tutorial_of_0_1_runs_unchanged_with_warnings(page, walk):
    for needed in NEEDS.get(page, ()):
        pytest.importorskip(needed, reason=f"{needed} is not installed")
    former = (OF_0_1 / f"{page}.md").read_text()
    assert steps_of(former) != steps_of((DOCS / f"{page}.md").read_text())
    with pytest.warns(DeprecationWarning, match=r"world2minecraft"):
        walk.of_0_1(page)


def test_the_page_of_tutorials_names_each():
    page = (DOCS / "index.md").read_text()
    assert set(re.findall(r"\(([\w-]+)\.md\)", page)) >= set(PAGES)


def test_steps_are_found_with_what_the_tests_add():
    page = (
        "# Page\n\n```text\nnot run\n```\n<!-- the tests add: --few 1 -->\n```sh\nw2m a\n```\n"
        "\n```python\nx = 1\n```\n"
    )
    assert steps_of(page) == [Step("sh", "w2m a\n", "--few 1"), Step("python", "x = 1\n", "")]


def test_the_undone_world_and_the_restricted_palette(walk):
    folder = walk("edit")
    assert not [step for step in (folder / "saves/Home/w2m_undo").glob("0*") if step.is_dir()]
    from world2minecraft.minecraft.formats import read_blocks

    folder = walk("palette")
    states = read_blocks(folder / "NORDIC/build/room.schem").palette
    names = {str(state).partition("[")[0].removeprefix("minecraft:") for state in states}
    allowed = {"air", "cave_air", "light", "barrier", "white_concrete", "light_gray_concrete"}
    allowed |= {"birch_planks", "birch_slab", "birch_stairs", "dark_oak_planks", "red_wool"}
    assert names <= allowed | {"glass", "glass_pane"}
