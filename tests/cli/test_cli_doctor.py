"""``w2m doctor``: the checks, their advice, and the exit code."""

import json
from importlib import metadata

import pytest

from world2minecraft import cli
from world2minecraft.cli import doctor


def test_this_machine_can_run_the_program(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "cache"))
    assert cli.run(["doctor"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[-1] == "ready: try w2m demo"
    assert all(line[:5].strip() in ("ok", "warn") for line in lines[:-1])
    for what in ("Python", "numpy", "numba", "cache", "cores", "memory", "disk", "Java"):
        assert any(line[5:].startswith(what) for line in lines)


def test_json_lists_the_checks(capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "cache"))
    assert cli.run(["doctor", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert rows[0].keys() == {"what", "state", "found", "advice"}
    assert rows[0]["what"] == "Python"


def test_warming_compiles_all_kinds_of_work_after_the_checks(capsys, monkeypatch):
    works = []
    compile_kernels = lambda work, progress: works.append(work) or 3  # noqa: E731
    monkeypatch.setattr(doctor, "examine", list)
    monkeypatch.setattr("world2minecraft.core.precompile.compile_kernels", compile_kernels)
    assert cli.run(["doctor", "--warm"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "ok   kernels       15 compiled, the others were ready"
    assert works == ["room", "pictures", "photos", "dataset", "navigation"]
    monkeypatch.setattr(doctor, "examine", lambda: [doctor.Check("x", "bad", "y")])
    assert cli.run(["doctor", "--warm"]) == 1 and len(works) == 5


@pytest.mark.parametrize("options", [[], ["--json"]])
def test_a_problem_makes_the_exit_code_1(options, capsys, monkeypatch):
    monkeypatch.setattr(doctor, "examine", lambda: [doctor.Check("x", "bad", "y")])
    assert cli.run(["doctor", *options]) == 1
    assert capsys.readouterr().out


@pytest.mark.parametrize(
    ("version", "state"), [((3, 10), "bad"), ((3, 11), "ok"), ((3, 14), "ok"), ((3, 15), "bad")]
)
def test_python(version, state):
    check = doctor.check_python(version)
    assert check.state == state
    assert bool(check.advice) == (state == "bad")


def test_a_missing_core_package_fails_with_its_install_line(capsys, monkeypatch):
    def version(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(doctor.metadata, "version", version)
    assert doctor.run() == 1
    text = capsys.readouterr().out
    assert "bad  numba         not installed; run: pip install world2minecraft\n" in text
    assert text.endswith(f"{len(doctor.CORE_PACKAGES)} problems to fix\n")


def test_a_cache_that_cannot_be_written_is_a_warning(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("W2M_CACHE_DIR", str(tmp_path / "file" / "cache"))
    check = doctor.check_cache()
    assert check.state == "warn"
    assert "W2M_CACHE_DIR" in check.advice


@pytest.mark.parametrize(("free_gb", "state"), [(None, "ok"), (8.0, "ok"), (0.3, "warn")])
def test_memory(free_gb, state):
    assert doctor.check_memory(free_gb).state == state


def test_a_full_disk_is_a_warning(monkeypatch, tmp_path):
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda _: type("Usage", (), {"free": 10}))
    assert doctor.check_disk(tmp_path).state == "warn"


def test_extras_are_those_that_the_package_declares(monkeypatch):
    declared = [
        "numpy>=2",
        "torch>=2; extra == 'train'",
        'ruff; extra == "dev"',
        "onnx; extra == 'train'",
    ]
    monkeypatch.setattr(doctor.metadata, "requires", lambda _: declared)
    assert doctor.optional_extras() == {"train": ("torch", "onnx")}


def test_a_missing_extra_is_ok_and_has_its_install_command():
    check = doctor.check_extra("train", ("numpy", "no-such-package"))
    assert check.state == "ok"
    assert check.found == "optional, no-such-package not installed"
    assert check.advice == "to install: pip install 'world2minecraft[train]'"
    assert doctor.check_extra("train", ("numpy",)).found == "installed"
