"""What is said twice is said alike: versions, pins, and what the set-up needs."""

import json
import re
import tomllib
from importlib import metadata
from pathlib import Path
from zipfile import ZipFile

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import world2minecraft
from world2minecraft import cli
from world2minecraft.api import editor
from world2minecraft.core.errors import UsageError

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


def applies(requirement, extras):
    """Whether a requirement applies to some supported Python and system."""
    return requirement.marker is None or any(
        requirement.marker.evaluate(
            {
                "python_version": f"3.{minor}",
                "python_full_version": f"3.{minor}.1",
                "sys_platform": system,
                "platform_system": name,
                "os_name": "nt" if system == "win32" else "posix",
                "extra": extra,
            }
        )
        for minor in (11, 12, 13, 14)
        for system, name in (("linux", "Linux"), ("darwin", "Darwin"), ("win32", "Windows"))
        for extra in extras or ("",)
    )


def test_all_packages_that_are_needed_indirectly_are_pinned():
    """A package without a pin could not be installed from files with hashes."""
    pinned = {canonicalize_name(name) for name in PINNED}
    missing, done, left = set(), set(), [("world2minecraft", tuple(EXTRAS))]
    while left:
        package, extras = item = left.pop()
        try:
            texts = () if item in done else metadata.requires(package) or ()
        except metadata.PackageNotFoundError:
            continue  # Of another system.
        done.add(item)
        for requirement in map(Requirement, texts):
            name = canonicalize_name(requirement.name)
            if applies(requirement, extras) and name != "world2minecraft":
                missing |= {name} - pinned
                left.append((name, tuple(sorted(requirement.extras))))
    assert not missing


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


def test_the_program_starts_by_the_name_of_its_package():
    """As ``pipx run world2minecraft`` and ``uvx world2minecraft`` start it."""
    scripts = PROJECT["scripts"]
    assert scripts["world2minecraft"] == scripts["w2m"]


DOCKER = [
    line for line in (ROOT / "Dockerfile").read_text().replace("\\\n", "").splitlines()
    if line and not line.startswith("#")
]  # fmt: skip


def arguments_of(word):
    return [line.split(maxsplit=1)[1] for line in DOCKER if line.split()[0] == word]


def test_the_container_is_slim_and_runs_as_a_user():
    (base,) = arguments_of("FROM")
    assert re.fullmatch(r"python:3\.1[1-4]-slim", base)
    assert arguments_of("USER") == ["w2m"]
    assert "useradd" in arguments_of("RUN")[0] and DOCKER[-1].startswith("CMD")
    assert DOCKER.index("USER w2m") > max(n for n, line in enumerate(DOCKER) if "COPY" in line)


def test_the_container_installs_pinned_versions():
    (install, warm) = arguments_of("RUN")
    assert "--constraint constraints.txt" in install and "doctor --warm" in warm
    allowed = [line[1:] for line in (ROOT / ".dockerignore").read_text().split() if line[0] == "!"]
    copied = [name for words in arguments_of("COPY") for name in words.split()[:-1]]
    assert sorted(name.removeprefix("./") for name in copied) == sorted(allowed)
    assert all((ROOT / name).exists() for name in allowed)


def test_the_container_serves_the_editor_on_its_port(monkeypatch):
    given = {}

    def prepare(source, **options):
        given.update(options)
        raise UsageError("enough")

    monkeypatch.setattr(editor, "prepare_editor", prepare)
    (command,) = arguments_of("CMD")
    assert cli.run(json.loads(command)) == 2
    assert given["host"] == "0.0.0.0" and [str(given["port"])] == arguments_of("EXPOSE")
    assert str(given["home"]).startswith(arguments_of("VOLUME")[0])


def test_requirement_files_hold_hashes_of_all_pins():
    held = {}
    for name in ("requirements.txt", "requirements-all.txt"):
        text = (ROOT / "tools/release" / name).read_text()
        entries = re.split(r"\n(?=\S)", text.partition("\n")[2].strip())
        held[name] = {
            one.partition(" ")[0]: re.findall(r"--hash=sha256:(\S+)", one) for one in entries
        }
    every, needed = held["requirements-all.txt"], held["requirements.txt"]
    assert sorted(every) == sorted(PINS), "run make pin-hashes"
    assert all(found and all(len(one) == 64 for one in found) for found in every.values())
    assert needed.items() <= every.items()
    names = {one.lower().partition("==")[0] for one in needed}
    assert {re.split(r"[><=]", one.lower())[0] for one in PROJECT["dependencies"]} <= names


def test_the_conda_recipe_needs_what_the_package_needs():
    recipe = yaml.safe_load((ROOT / "tools/release/conda/recipe.yaml").read_text())
    names = {"openexr": "openexr-python"}  # Another name on conda-forge.
    needed = [re.split(r"(?=>=)", one.lower()) for one in PROJECT["dependencies"]]
    expected = [f"python {PROJECT['requires-python']}"]
    expected += [f"{names.get(name, name)} {bound}" for name, bound in needed]
    assert recipe["requirements"]["run"] == expected
    assert recipe["context"]["version"] == PROJECT["version"]
    scripts = {one.split(" = ")[0] for one in recipe["build"]["python"]["entry_points"]}
    assert scripts == set(PROJECT["scripts"])
