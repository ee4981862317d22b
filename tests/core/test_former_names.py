"""Import paths of version 0.1 still work, with a warning that names the present path."""

import importlib
import subprocess
import sys

import pytest

from world2minecraft.core.former_names import PACKAGE, former_modules

NAMES = sorted(
    (former, name) for former, module in former_modules().items() for name in module.names
)


@pytest.mark.parametrize(("former", "name"), NAMES)
def test_a_former_name_is_the_present_object(former, name):
    target, present = former_modules()[former].names[name]
    try:
        expected = getattr(importlib.import_module(f"{PACKAGE}.{target}"), present)
    except ImportError as error:
        if str(error.name).startswith(PACKAGE):
            raise
        pytest.skip(f"{error.name} is not installed")
    with pytest.warns(DeprecationWarning, match=f"{PACKAGE}.{target}"):
        scope = {}
        exec(f"from {PACKAGE}.{former} import {name}", scope)
    assert scope[name] is expected


def test_the_warning_points_to_the_line_that_imports(tmp_path):
    script = tmp_path / "old.py"
    script.write_text("import sys\nfrom world2minecraft.types import Camera\n")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert f"{script}:2: DeprecationWarning" in done.stderr
    assert "import Camera from world2minecraft.core.types.capture instead" in done.stderr


@pytest.mark.parametrize("name", ["nowhere", "rendering.nowhere", "edit.nowhere"])
def test_an_unknown_module_is_not_found(name):
    with pytest.raises(ModuleNotFoundError, match="nowhere"):
        importlib.import_module(f"{PACKAGE}.{name}")


@pytest.mark.parametrize("module", ["world2minecraft.build", "world2minecraft.minecraft.visual"])
def test_an_unknown_name_of_a_former_module_is_an_error(module):
    with pytest.raises(AttributeError, match="nothing"):
        _ = importlib.import_module(module).nothing


@pytest.mark.parametrize("name", ["build", "render"])
def test_public_functions_work_after_imports_of_former_modules(name):
    package = importlib.import_module(PACKAGE)
    assert importlib.import_module(f"{PACKAGE}.{name}") is getattr(package, name)
    with pytest.raises(TypeError, match=rf"^{name}\(\) missing"):
        getattr(package, name)()


def test_a_former_module_still_runs(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "world2minecraft.render.textures", tmp_path / "out.png", "16", "1"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert (tmp_path / "out.png").is_file()
    assert "python -m world2minecraft.rendering.textures" in done.stderr


def test_a_former_environment_id_with_a_module_still_works():
    gymnasium = pytest.importorskip("gymnasium")
    with pytest.raises(Exception, match="scene"), pytest.warns(DeprecationWarning):
        gymnasium.make("world2minecraft.vln.environment:World2Minecraft-VLN-v0")
