"""Installation of the Node.js packages for server players with npm, on request only."""

import hashlib
import re
import shutil
import subprocess
from importlib.resources import files
from pathlib import Path

from world2minecraft.core.errors import ServerError, UsageError
from world2minecraft.core.files import write_text
from world2minecraft.core.jit import user_cache_dir

MIN_NODE = 18
LIMIT_S = 900.0
SCRIPT = "body.mjs"
_STATED = ("package.json", "package-lock.json")
_DONE = "installed"
_HOW = "w2m vln server --install"


def is_installed() -> bool:
    """Return whether the pinned packages are installed."""
    return (_folder() / _DONE).is_file()


def body_folder() -> Path:
    """Return the folder that contains the installed packages.

    Raises:
        UsageError: If the packages or Node.js are not installed.
    """
    if not is_installed():
        raise UsageError(f"playing on a server requires mineflayer; install it once with {_HOW}")
    node()
    return _folder()


def install() -> Path:
    """Install the packages pinned in ``package-lock.json``, without running their scripts.

    Raises:
        UsageError: If Node.js or npm is not installed.
        ServerError: If npm fails.
    """
    node()
    npm = shutil.which("npm")
    if npm is None:
        raise UsageError("npm not found; install Node.js from https://nodejs.org")
    folder = _folder()
    folder.mkdir(parents=True, exist_ok=True)
    for name in _STATED:
        write_text(folder / name, _shipped(name))
    command = [npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund"]
    try:
        done = subprocess.run(
            command, cwd=folder, check=False, capture_output=True, timeout=LIMIT_S,
            encoding="utf-8", errors="replace",
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise ServerError(f"npm did not finish within {LIMIT_S:g} s; run {_HOW} again") from error
    if done.returncode:
        last = " ".join(done.stderr.split())[-300:]
        raise ServerError(f"npm could not install mineflayer: {last}")
    write_text(folder / _DONE, "")
    return folder


def node() -> str:
    """Return the path of the Node.js executable.

    Raises:
        UsageError: If Node.js is not installed, or too old.
    """
    found = shutil.which("node")
    if found is None:
        raise UsageError(f"Node.js not found; install version {MIN_NODE} or newer")
    version_text = subprocess.run(
        [found, "--version"], check=False, capture_output=True, encoding="utf-8", timeout=30
    ).stdout
    version = re.match(r"v(\d+)\.", version_text)
    if version is None or int(version[1]) < MIN_NODE:
        raise UsageError(
            f"Node.js {MIN_NODE} or newer is required, found "
            f"{version_text.strip() or 'an unknown version'}"
        )
    return found


def script() -> Path:
    """Return the path of the player program."""
    return Path(str(files("world2minecraft.navigation.server").joinpath(SCRIPT)))


def _folder() -> Path:
    digest = hashlib.sha256(_shipped("package-lock.json").encode()).hexdigest()[:12]
    return user_cache_dir() / f"server-body-{digest}"


def _shipped(name: str) -> str:
    return files("world2minecraft.navigation.server").joinpath(name).read_text("utf-8")
