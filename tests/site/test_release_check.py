"""What ``make release-check`` finds amiss with a wheel, an sdist and a Python."""

import io
import sys
import tarfile
from pathlib import Path
from zipfile import ZipFile

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools" / "release"))

import check

WHOLE = (*check.NEEDED, "x.dist-info/licenses/LICENSE", "x.dist-info/licenses/NOTICE")


def wheel_of(folder, names):
    path = folder / "x.whl"
    with ZipFile(path, "w") as opened:
        for name in names:
            opened.writestr(name, "x")
    return path


def sdist_of(folder, names):
    path = folder / "x.tar.gz"
    with tarfile.open(path, "w:gz") as opened:
        for name in names:
            member = tarfile.TarInfo(f"x-1/{name}")
            member.size = 1
            opened.addfile(member, io.BytesIO(b"x"))
    return path


def test_a_whole_wheel_has_no_fault(tmp_path):
    assert check.wheel_faults(wheel_of(tmp_path, WHOLE)) == []


@pytest.mark.parametrize(
    ("names", "fault"),
    [
        (WHOLE[1:], "the wheel lacks world2minecraft/cli/verbs.py"),
        ((*WHOLE, "tests/conftest.py"), "the wheel holds tests/conftest.py"),
        (
            WHOLE[:-1],
            "the wheel should hold LICENSE and NOTICE; it holds ['x.dist-info/licenses/LICENSE']",
        ),
    ],
)
def test_a_fault_of_a_wheel_is_told(tmp_path, names, fault):
    assert check.wheel_faults(wheel_of(tmp_path, names)) == [fault]


def test_a_wheel_that_is_too_large_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(check, "MAX_WHEEL_MB", 0.0)
    (fault,) = check.wheel_faults(wheel_of(tmp_path, WHOLE))
    assert fault.startswith("the wheel has 0.0 MB")


def test_an_sdist_is_looked_through(tmp_path):
    assert check.sdist_faults(sdist_of(tmp_path, check.IN_SDIST)) == []
    faults = check.sdist_faults(sdist_of(tmp_path, (*check.IN_SDIST[1:], ".venv/x")))
    assert faults == ["the sdist lacks LICENSE", "the sdist holds .venv/x"]


def test_a_wheel_that_differs_from_its_sdists_is_told(tmp_path, monkeypatch):
    first, second = tmp_path / "a", tmp_path / "b"
    first.mkdir(), second.mkdir()
    wheel = wheel_of(first, (*WHOLE, "one.py"))
    monkeypatch.setattr(check, "build", lambda *_: (wheel_of(second, WHOLE), None))
    faults = check._unlike(wheel, sdist_of(tmp_path, check.IN_SDIST))
    assert faults == ["a wheel of the sdist differs in one.py"]


def test_this_python_is_found_and_none_that_is_not_there():
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    assert check.interpreter(version)
    assert check.interpreter("2.99") is None


def test_a_python_that_is_not_there_is_no_fault(tmp_path, capsys):
    assert check.tried("2.99", tmp_path / "x.whl") == []
    assert capsys.readouterr().out == "Python 2.99: not found here, not tried\n"
