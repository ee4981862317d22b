"""What is said twice is said alike: versions, pins, and what the set-up needs."""

import re
import tomllib
from importlib import metadata
from pathlib import Path
from zipfile import ZipFile

import pytest

import world2minecraft

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
PINS = [
    line
    for line in (ROOT / "constraints.txt").read_text().splitlines()
    if line[:1] not in ("#", "")
]
PINNED = dict(line.lower().replace("_", "-").split("==") for line in PINS)
EXTRAS = PROJECT["optional-dependencies"]
REQUIREMENTS = [
    *PROJECT["dependencies"],
    *(item for item in EXTRAS["dev"] if not item.startswith(PROJECT["name"])),
    *EXTRAS["capture"],
    *EXTRAS["data"],
    *EXTRAS["docs"],
    *EXTRAS["hf"],
    *EXTRAS["train"],
    *EXTRAS["usd"],
    *EXTRAS["vln"],
]


def numbers(version):
    return tuple(int(part) for part in re.findall(r"\d+", version))


def test_the_version_is_one():
    assert PROJECT["version"] == world2minecraft.__version__ == metadata.version("world2minecraft")


@pytest.mark.parametrize("requirement", REQUIREMENTS)
def test_each_requirement_has_a_pin_above_its_bound(requirement):
    name, bound = requirement.lower().replace("_", "-").split(">=")
    assert numbers(PINNED[name]) >= numbers(bound)


def test_pins_are_exact_sorted_and_name_no_host():
    assert all(re.fullmatch(r"[A-Za-z0-9._-]+==[0-9][0-9a-z.]*", line) for line in PINS)
    assert sorted(PINNED) == list(PINNED)


@pytest.mark.parametrize("name", ["Makefile", "constraints.txt", ".ci/run", "pyproject.toml"])
def test_the_set_up_names_no_registry(name):
    assert not re.search(r"https?://|index-url|find-links", (ROOT / name).read_text())


def test_every_pinned_package_that_is_installed_has_that_version():
    """What the tests run with is what the pins say."""
    for name, version in PINNED.items():
        try:
            assert numbers(metadata.version(name)) == numbers(version), name
        except metadata.PackageNotFoundError:
            continue  # Some are for building, or for other systems.


def test_the_wheel_holds_the_built_page_and_not_its_sources(tmp_path, monkeypatch):
    building = pytest.importorskip("hatchling.build", reason="hatchling is not installed")
    monkeypatch.chdir(ROOT)
    with ZipFile(tmp_path / building.build_wheel(str(tmp_path))) as wheel:
        every = set(wheel.namelist())
    names = {name for name in every if "/sceneforge/" in name}
    body = ("body.mjs", "game_rules.mjs", "package.json", "package-lock.json")
    assert {f"world2minecraft/navigation/server/{name}" for name in body} <= every
    assert "world2minecraft/sceneforge/annotation/page/annotate.js" in every
    page = {name.partition("/static/")[2] for name in names if "/static/" in name}
    assert {"index.html", "index.js"} <= page
    static = ROOT / "src" / "world2minecraft" / "sceneforge" / "static"
    assert page == {str(one.relative_to(static)) for one in static.rglob("*") if one.is_file()}
    assert "world2minecraft/sceneforge/server/app.py" in names
    assert not [name for name in names if "/web/" in name or "node_modules" in name]
