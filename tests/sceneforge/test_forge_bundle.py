"""The page that is shipped is the page that its sources build, byte for byte, and its own tests.

Skipped where there is no Node with npm, or no registry that can be reached.
"""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FORGE = ROOT / "src" / "world2minecraft" / "sceneforge"
WEB, STATIC = FORGE / "web", FORGE / "static"
LEAST_NODE = 20
# What npm says where there is no way to the registry; anything else is a fault of ours.
NO_REGISTRY = re.compile(
    r"E(NOTFOUND|AI_AGAIN|CONNREFUSED|CONNRESET|TIMEDOUT|NETUNREACH|HOSTUNREACH)|E(401|403|5\d\d)\b"
    r"|ERR_SOCKET_TIMEOUT|network (timeout|request)"
)
INSTALL_S, BUILD_S = 300, 300


@pytest.fixture(scope="session")
def built(tmp_path_factory) -> Path:
    """A copy of the sources with what they need, and the page built beside it."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if not node or not npm:
        pytest.skip("there is no node with npm on this machine")
    version = subprocess.run([node, "--version"], capture_output=True, text=True, check=True).stdout
    if int(version.lstrip("v").partition(".")[0]) < LEAST_NODE:
        pytest.skip(f"node is {version.strip()}; the page is built with {LEAST_NODE} or later")
    root = tmp_path_factory.mktemp("page")
    web = root / WEB.relative_to(ROOT)
    shutil.copytree(WEB, web, ignore=shutil.ignore_patterns("node_modules"))
    for beside in ("tests", "docs"):  # Some of the page's tests read vectors and a page there.
        (root / beside).symlink_to(ROOT / beside)
    installed = subprocess.run(
        [npm, "ci", "--no-audit", "--no-fund", "--prefer-offline"],
        check=False,
        cwd=web,
        capture_output=True,
        text=True,
        timeout=INSTALL_S,
    )
    said = installed.stdout + installed.stderr
    if installed.returncode and NO_REGISTRY.search(said):
        pytest.skip(f"npm reaches no registry: {said.strip().splitlines()[0][:200]}")
    assert not installed.returncode, said
    run(npm, "run", "build", folder=web)
    return web


def run(*words: str, folder: Path) -> None:
    done = subprocess.run(
        words, check=False, cwd=folder, capture_output=True, text=True, timeout=BUILD_S
    )
    assert not done.returncode, done.stdout + done.stderr


def files(folder: Path) -> dict[str, bytes]:
    every = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in every}


def test_the_shipped_page_is_the_one_that_its_sources_build(built):
    shipped, fresh = files(STATIC), files(built.parent / "static")
    assert sorted(shipped) == sorted(fresh), "build it with make forge, and commit it"
    stale = [name for name in fresh if shipped[name] != fresh[name]]
    assert not stale, f"{', '.join(stale)}: build the page with make forge, and commit it"


def test_the_page_passes_its_own_tests(built):
    run("npm", "test", folder=built)


def test_the_page_loads_nothing_from_elsewhere():
    """Its own files alone: no font, script or picture of another host."""
    for name, data in files(STATIC).items():
        text = data.decode("utf-8", "replace")
        found = re.findall(r"""(?:src|href)=["'](?:https?:)?//[^"']+|@import[^;]*//[^;]*""", text)
        assert not found, f"{name}: {found[:3]}"
