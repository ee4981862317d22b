"""Write the SHA-256 of each file of each pinned package, as requirement files of pip.

    python tools/release/pin_hashes.py          after a change of constraints.txt; one minute

The package index is asked for the files of the versions in ``constraints.txt``. The wheels of
Python 3.11 to 3.14 for all platforms are listed, and source archives of packages without wheels.
``requirements.txt`` holds what ``pip install world2minecraft`` needs, ``requirements-all.txt`` all
of ``constraints.txt``. pip refuses other files (docs/how-to/install.md).
"""

import json
import re
import sys
import urllib.request
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name, parse_wheel_filename

ROOT = Path(__file__).resolve().parents[2]
PINS, FOLDER = ROOT / "constraints.txt", ROOT / "tools/release"
INDEX = "https://pypi.org/simple"
JSON = "application/vnd.pypi.simple.v1+json"
MAX_BYTES = 64 << 20
MINORS = range(11, 15)  # Python 3.11 to 3.14.
HEAD = """\
# By python tools/release/pin_hashes.py: {what}, with the files on the package index.
"""


def pins(text: str) -> Iterator[tuple[str, str]]:
    """Yield name and version of each pin of a constraint file."""
    for line in text.splitlines():
        name, found, version = line.partition("#")[0].partition(";")[0].strip().partition("==")
        if found:
            yield name, version


def pythons_of(filename: str) -> set[int]:
    """Return the minor versions of Python, 11 to 14, that can install a file.

    Example:
        >>> names = ("a-1-cp310-cp310-win32.whl", "a-1-cp312-cp312-win32.whl", "a-1.tar.gz")
        >>> [pythons_of(name) for name in (*names, "a-1-cp313-abi3-win32.whl")]
        [set(), {12}, set(), {13, 14}]
    """
    if not filename.endswith(".whl"):
        return set()
    found = set[int]()
    for tag in parse_wheel_filename(filename)[3]:
        minor = int(tag.interpreter[3:]) if re.fullmatch(r"cp3\d+", tag.interpreter) else 0
        for python in MINORS:
            stable = tag.abi == "abi3" and 0 < minor <= python
            if tag.interpreter == "py3" or minor == python or stable:
                found.add(python)
    return found


def marker_of(filenames: Iterable[str]) -> str:
    """Return the environment marker of a version that some Python has no wheel of, or "".

    Example:
        >>> marker_of(f"a-1-cp3{minor}-cp3{minor}-win32.whl" for minor in (11, 12, 13))
        'python_version != "3.14"'
        >>> marker_of(["a-1.tar.gz"])
        ''
    """
    found = set[int]().union(*map(pythons_of, filenames))
    missing = [python for python in MINORS if found and python not in found]
    return " and ".join(f'python_version != "3.{python}"' for python in missing)


def files_of(name: str, version: str) -> dict[str, str]:
    """Return the wheels of one version, or its source archives, with their hashes."""
    request = urllib.request.Request(f"{INDEX}/{name}/", headers={"Accept": JSON})
    with urllib.request.urlopen(request, timeout=60) as answer:
        files = json.loads(answer.read(MAX_BYTES))["files"]
    plain = "[-_.]+".join(map(re.escape, re.split(r"[-_.]+", name)))
    of_version = re.compile(rf"{plain}-{re.escape(version)}(?:-.*\.whl|\.tar\.gz|\.zip)$", re.I)
    found = {
        file["filename"]: file["hashes"]["sha256"]
        for file in files
        if of_version.match(file["filename"])
    }
    return {file: digest for file, digest in found.items() if pythons_of(file)} or found


def needed_names(package: str, known: Iterable[str]) -> set[str]:
    """Return the names of what a package needs without extras, on any platform and Python.

    Args:
        package: An installed package.
        known: The names to choose from.
    """
    by_name, needed, left = {canonicalize_name(name): name for name in known}, set[str](), [package]
    while left:
        for text in requires(left.pop()) or ():
            wanted = Requirement(text)
            name = by_name.get(canonicalize_name(wanted.name))
            if "extra ==" in str(wanted.marker) or name is None or name in needed:
                continue
            needed.add(name)
            if _is_installed(name):
                left.append(name)
    return needed


def _is_installed(name: str) -> bool:
    try:
        requires(name)
    except PackageNotFoundError:
        return False  # Of another platform.
    return True


def _line(name: str, version: str, files: Iterable[str]) -> str:
    marker = marker_of(files)
    return f"{name}=={version}" + (f" ; {marker}" if marker else "")


def _hash_options(files: Mapping[str, str]) -> list[str]:
    return [f"    --hash=sha256:{digest}" for digest in sorted(files.values())]


def main() -> int:
    """Write the files; return the exit code."""
    wanted = list(pins(PINS.read_text()))
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda pin: files_of(*pin), wanted))
    listed = dict(zip(wanted, found, strict=True))
    if missing := [f"{name}=={version}" for (name, version), held in listed.items() if not held]:
        print(f"the index has no files of {', '.join(missing)}", file=sys.stderr)
        return 1
    needed = needed_names("world2minecraft", (name for name, _ in wanted))
    for file, what, names in (
        ("requirements.txt", "what the program needs", needed),
        ("requirements-all.txt", "all of constraints.txt", {name for name, _ in wanted}),
    ):
        rows = [
            " \\\n".join([_line(name, version, files), *_hash_options(files)])
            for (name, version), files in listed.items()
            if name in names
        ]
        (FOLDER / file).write_text(HEAD.format(what=what) + "\n".join(rows) + "\n")
        print(f"{FOLDER / file}: {len(rows)} packages")
    return 0


if __name__ == "__main__":
    sys.exit(main())
