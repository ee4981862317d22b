"""What docs/reference/forge.md shows is what a server does."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from forge_serving import served

from world2minecraft.sceneforge.editor import Editor
from world2minecraft.sceneforge.scene_sources import demo_room
from world2minecraft.sceneforge.server import agent_routes, export_routes
from world2minecraft.sceneforge.server import start_routes as start
from world2minecraft.sceneforge.server.app import routes

TEXT = (Path(__file__).resolve().parents[2] / "docs" / "reference" / "forge.md").read_text()


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    with served(Editor(demo_room(tmp_path_factory.mktemp("demo")))) as server:
        yield server


def test_the_python_of_the_page_mends_a_room_and_saves_it(server, capsys):
    before = server.session.rev
    (code,) = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
    exec(code, {"TOKEN": server.token, "SERVER": server.url.rstrip("/")})
    assert "fill" in capsys.readouterr().out
    assert server.session.rev > before
    assert server.session.document.saved_rev == server.session.rev


def test_the_lines_of_curl_are_answered(server):
    if shutil.which("curl") is None:
        pytest.skip("there is no curl on this machine")
    commands = re.findall(r"^curl .*?(?<!\\)$", TEXT, re.DOTALL | re.MULTILINE)
    assert len(commands) == 3
    for command in commands:
        words = command.replace("8484", str(server.port)).replace("$TOKEN", server.token)
        done = subprocess.run(["sh", "-c", words], capture_output=True, text=True, check=True)
        assert '"error"' not in done.stdout and done.stdout


def test_every_path_of_the_table_is_there():
    found = re.findall(r"`(?:GET |POST |PUT |WS )?/(api/[\w/]+)", TEXT)
    named = {re.sub(r"/[A-Z]+\b", "/*", path) for path in found}
    every = [*routes(), *start.routes(), *export_routes.routes(), *agent_routes.routes()]
    assert len(named) > 15
    assert named <= {re.sub(r"{.*?}", "*", route.path[1:]) for route in every}
