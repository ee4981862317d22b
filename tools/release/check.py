"""Try a release as a new user gets it: ``make release-check``.

A wheel and an sdist are built into ``dist/`` and looked through; a wheel built of the sdist alone
must hold the same. Then, for each Python from 3.11 to 3.14 that is found, the wheel is installed
into a fresh environment with the pinned files, and ``w2m demo`` makes its world there, with
neither a compiler nor Node to be found. The exit code is 1 if a check fails and 0 otherwise. A
Python version that is not installed is reported, and is no failure.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from zipfile import ZipFile

ROOT = Path(__file__).resolve().parents[2]
HASHES = ROOT / "tools/release/requirements.txt"
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
MAX_WHEEL_MB = 40.0  # Maximum size of the download.
PACKAGE = "world2minecraft"
# What the program cannot do without, one of a kind.
NEEDED = (
    f"{PACKAGE}/cli/verbs.py",
    f"{PACKAGE}/sceneforge/static/index.html",
    f"{PACKAGE}/sceneforge/static/index.js",
    f"{PACKAGE}/weights/completion.onnx",
    f"{PACKAGE}/weights/completion.md",
    f"{PACKAGE}/minecraft/data/blocks.json.gz",
    f"{PACKAGE}/minecraft/data/NOTICE-minecraft-data.txt",
    f"{PACKAGE}/sceneforge/NOTICE-three.txt",
)
UNWANTED = ("node_modules/", "/sceneforge/web/", "tests/", "benchmarks/", ".pyc", ".jar")
IN_SDIST = ("LICENSE", "NOTICE", "CITATION.cff", "Makefile", "constraints.txt", "tests/conftest.py")


def main() -> int:
    """Build, look and try; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--pythons", nargs="*", default=PYTHONS, help="versions to try")
    parser.add_argument("--dist", type=Path, default=ROOT / "dist", help="where the files go")
    arguments = parser.parse_args()
    shutil.rmtree(arguments.dist, ignore_errors=True)
    wheel, sdist = build(ROOT, arguments.dist)
    faults = wheel_faults(wheel) + sdist_faults(sdist) + _unlike(wheel, sdist)
    for version in arguments.pythons:
        faults += tried(version, wheel)
    for fault in faults:
        print(f"fault: {fault}", file=sys.stderr)
    return 1 if faults else 0


def build(root: Path, dist: Path) -> tuple[Path, Path]:
    """Build the wheel and the sdist of a tree into ``dist``, and return where they are."""
    words = [sys.executable, "-m", "hatchling", "build", "--directory", str(dist)]
    subprocess.run(words, cwd=root, check=True, stdout=subprocess.DEVNULL)
    (wheel,), (sdist,) = list(dist.glob("*.whl")), list(dist.glob("*.tar.gz"))
    for path in (wheel, sdist):
        print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB")
    return wheel, sdist


def wheel_faults(wheel: Path) -> list[str]:
    """Return the faults of a wheel: its size, missing files, and files that should not be in it."""
    with ZipFile(wheel) as opened:
        names = opened.namelist()
    size_mb = wheel.stat().st_size / 1e6
    faults = [f"the wheel lacks {name}" for name in NEEDED if name not in names]
    faults += [f"the wheel holds {name}" for name in names if any(bad in name for bad in UNWANTED)]
    licences = [name for name in names if "/licenses/" in name]
    if len(licences) != 2:
        faults.append(f"the wheel should hold LICENSE and NOTICE; it holds {licences}")
    if size_mb > MAX_WHEEL_MB:
        faults.append(f"the wheel has {size_mb:.1f} MB; {MAX_WHEEL_MB:.0f} are the most")
    return faults


def sdist_faults(sdist: Path) -> list[str]:
    """Return what an sdist lacks, and what it holds that nobody wrote."""
    with tarfile.open(sdist) as opened:
        names = [name.partition("/")[2] for name in opened.getnames()]
    faults = [f"the sdist lacks {name}" for name in IN_SDIST if name not in names]
    bad = ("node_modules/", ".venv", ".git/", ".pyc")
    return faults + [f"the sdist holds {one}" for one in names if any(b in one for b in bad)]


def _unlike(wheel: Path, sdist: Path) -> list[str]:
    """Return the files in which a wheel built of the sdist differs from the wheel."""
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(sdist) as opened:
            opened.extractall(folder, filter="data")
        (tree,) = Path(folder).iterdir()
        again, _ = build(tree, Path(folder) / "dist")
        first, second = _sums(wheel), _sums(again)
    unlike = sorted(name for name in first | second if first.get(name) != second.get(name))
    return [f"a wheel of the sdist differs in {name}" for name in unlike]


def _sums(wheel: Path) -> Mapping[str, str]:
    with ZipFile(wheel) as opened:
        return {name: sha256(opened.read(name)).hexdigest() for name in opened.namelist()}


def tried(version: str, wheel: Path) -> list[str]:
    """Install a wheel into a fresh environment of one Python, and make the demo's world there."""
    python = interpreter(version)
    if python is None:
        print(f"Python {version}: not found here, not tried")
        return []
    with tempfile.TemporaryDirectory() as folder:
        try:
            started = time.monotonic()
            _install(python, Path(folder) / "venv", wheel)
            installed = time.monotonic()
            faults = _demo(Path(folder))
        except subprocess.CalledProcessError as failed:
            return [f"Python {version}: {failed.cmd[0]} ... ended with {failed.returncode}"]
        demo_s = time.monotonic() - installed
    print(f"Python {version}: installed in {installed - started:.0f} s, demo in {demo_s:.0f} s")
    return [f"Python {version}: {fault}" for fault in faults]


def interpreter(version: str) -> str | None:
    """Return the path of a Python of that version that really runs, if there is one."""
    named = shutil.which(f"python{version}")
    # Version managers put names on the path for what they have not switched on.
    managed = sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python{version}"))
    for candidate in [*([named] if named else []), *map(str, managed)]:
        asked = subprocess.run([candidate, "-V"], capture_output=True, text=True, check=False)
        if asked.returncode == 0 and asked.stdout.startswith(f"Python {version}."):
            return candidate
    return None


def _install(python: str, folder: Path, wheel: Path) -> None:
    subprocess.run([python, "-m", "venv", str(folder)], check=True)
    pip = [str(_tool(folder, "python")), "-m", "pip", "install", "--quiet", "--only-binary=:all:"]
    subprocess.run([*pip, "--require-hashes", "--requirement", str(HASHES)], check=True)
    subprocess.run([*pip, "--no-deps", str(wheel)], check=True)
    subprocess.run([*pip[:3], "check"], check=True, stdout=subprocess.DEVNULL)


def _demo(folder: Path) -> list[str]:
    """Run the demo where nothing but the environment's own programs is found."""
    environment = {
        **{name: value for name, value in os.environ.items() if not name.startswith("PYTHON")},
        "PATH": str(_tool(folder / "venv", "python").parent),
        "XDG_CACHE_HOME": str(folder / "cache"),
    }
    w2m = str(_tool(folder / "venv", "w2m"))
    out = folder / "OUT"
    for words in (["--version"], ["demo", "--out", str(out)]):
        subprocess.run(
            [w2m, *words], env=environment, cwd=folder, check=True, stdout=subprocess.DEVNULL
        )
    wanted = ("build/world/level.dat", "build/room.schem", "report.html", "preview.png")
    return [f"w2m demo wrote no {name}" for name in wanted if not (out / name).is_file()]


def _tool(folder: Path, name: str) -> Path:
    """Return where an environment keeps a program."""
    return folder / ("Scripts" if os.name == "nt" else "bin") / name


if __name__ == "__main__":
    sys.exit(main())
