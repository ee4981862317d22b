"""Kernels: cached where the user may write, and compiled all the same where not."""

from pathlib import Path

import pytest

from world2minecraft.core import jit


def test_the_cache_lies_in_the_users_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "mine"))
    folder = jit.kernel_cache_dir()
    assert folder.is_dir() and folder == tmp_path / "mine" / "kernels"


def test_a_folder_that_cannot_be_made_gives_a_fresh_passing_one(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "file"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    one, other = jit.kernel_cache_dir(), jit.kernel_cache_dir()
    assert one.is_dir() and one != other and one.parent == tmp_path


@pytest.mark.parametrize(
    ("system", "name", "expected"),
    [("linux", "XDG_CACHE_HOME", "world2minecraft"), ("win32", "LOCALAPPDATA", "world2minecraft")],
)
def test_each_system_has_its_place(monkeypatch, tmp_path, system, name, expected):
    monkeypatch.delenv("W2M_CACHE_DIR", raising=False)
    monkeypatch.setattr("sys.platform", system)
    monkeypatch.setenv(name, str(tmp_path))
    assert jit.user_cache_dir() == Path(tmp_path) / expected


@pytest.mark.parametrize(
    ("system", "name"), [("linux", "XDG_CACHE_HOME"), ("win32", "LOCALAPPDATA")]
)
def test_an_empty_variable_is_as_good_as_none(monkeypatch, tmp_path, system, name):
    monkeypatch.setattr("sys.platform", system)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    monkeypatch.setenv(name, "")
    monkeypatch.setenv("W2M_CACHE_DIR", "")
    assert jit.user_cache_dir().is_relative_to(tmp_path)


def test_a_user_without_a_home_gets_a_passing_folder(monkeypatch, tmp_path):
    def homeless():
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("W2M_CACHE_DIR", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(Path, "home", homeless)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert jit.kernel_cache_dir().parent == tmp_path
