"""The steps for Windows in docs/how-to/install.md, run line by line on the system at hand."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
SHIPPED = ("pyproject.toml", "constraints.txt", "README.md", "LICENSE", "NOTICE", "src")
SCRIPTS = "Scripts" if os.name == "nt" else "bin"


def documented_steps() -> list[str]:
    (block,) = re.findall(
        r"```powershell\n(.*?)```", (ROOT / "docs/how-to/install.md").read_text(), re.S
    )
    return block.splitlines()


def words_here(step: str) -> list[str]:
    """Return a PowerShell line as words for the system at hand."""
    first, *others = step.split()
    program = sys.executable if first == "py" else f".venv/{SCRIPTS}/python"
    assert first in ("py", r".venv\Scripts\python")
    return [program, *(word.strip('"') for word in others)]


@pytest.fixture
def clone(tmp_path):
    for name in SHIPPED:
        source = ROOT / name
        if source.is_dir():
            ignored = shutil.ignore_patterns("node_modules", "__pycache__")
            shutil.copytree(source, tmp_path / name, ignore=ignored)
        else:
            shutil.copy(source, tmp_path / name)
    return tmp_path


def lend_packages(clone: Path) -> None:
    """Lend the installed dependencies to the new environment, so that nothing is downloaded."""
    (places,) = clone.glob(".venv/[lL]ib/**/site-packages")
    (places / "lent.pth").write_text(sysconfig.get_paths()["purelib"])


def run(words: list[str], clone: Path) -> str:
    """Run a command without the index, and return what it printed."""
    environment = {
        **{k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "PIP_CONSTRAINT")},
        "PIP_NO_DEPS": "1",
        "PIP_NO_INDEX": "1",
        "PIP_NO_BUILD_ISOLATION": "0",  # pip reads this as "no isolation".
    }
    done = subprocess.run(
        words, cwd=clone, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, f"{words}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def test_the_documented_steps_lead_to_a_room_to_send(clone):
    steps = documented_steps()
    assert [step.split()[2] for step in steps] == ["venv", "pip", *["world2minecraft"] * 3]
    for step in steps:
        words = words_here(step)
        run([*words, "--frames", "8", "--kind", "study"] if "demo" in words else words, clone)
        if "venv" in words:
            lend_packages(clone)
    page = clone / "room.html"
    assert page.stat().st_size < 5_000_000 and page.read_text().startswith("<!doctype html>")
    where = "import world2minecraft; print(world2minecraft.__file__)"
    used = run([words_here(steps[-1])[0], "-c", where], clone)
    assert Path(used.strip()).is_relative_to(clone / ".venv")
