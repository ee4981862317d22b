"""Kernels: cached where the user may write, and compiled all the same where not."""

from pathlib import Path

import pytest

from world2minecraft.core import jit


def test_the_cache_lies_in_the_users_folder(monkeypatch, tmp_path):
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "mine"))
    folder = jit.kernel_cache_dir()
    assert folder.is_dir() and folder.parent == tmp_path / "mine" / "kernels"


def test_a_folder_that_cannot_be_made_gives_a_fresh_passing_one(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "file"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    one, other = jit.kernel_cache_dir(), jit.kernel_cache_dir()
    assert one.is_dir() and one != other and one.parent == tmp_path


def test_the_digest_follows_the_sources_of_kernels_alone(monkeypatch, tmp_path):
    monkeypatch.setattr(jit, "__file__", str(tmp_path / "jit.py"))
    kernel, plain = tmp_path / "kernel.py", tmp_path / "plain.py"
    kernel.write_text("from world2minecraft.core.jit import njit")
    plain.write_text("")
    first = jit.kernel_sources_digest()
    plain.write_text("changed = 1")
    assert jit.kernel_sources_digest() == first
    kernel.write_text("from world2minecraft.core.jit import njit  # changed")
    assert jit.kernel_sources_digest() != first


@pytest.mark.parametrize(
    ("system", "name", "expected"),
    [("linux", "XDG_CACHE_HOME", "world2minecraft"), ("win32", "LOCALAPPDATA", "world2minecraft")],
)
def test_each_system_has_its_place(monkeypatch, tmp_path, system, name, expected):
    monkeypatch.delenv("W2M_CACHE_DIR", raising=False)
    monkeypatch.setattr("sys.platform", system)
    monkeypatch.setenv(name, str(tmp_path))
    assert jit.user_cache_dir() == Path(tmp_path) / expected


def test_a_kernel_that_was_kept_is_known_by_its_module_and_name(monkeypatch, tmp_path):
    monkeypatch.setattr(jit, "KERNEL_CACHE", tmp_path)
    (tmp_path / "render_1").mkdir()
    (tmp_path / "render_1" / "pixels.draw_rows-70.py311.nbi").write_bytes(b"")
    assert jit.is_compiled("pixels.draw_rows")
    assert not jit.is_compiled("pixels.draw")
