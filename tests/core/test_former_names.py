"""Import paths of version 0.1 still work, with a warning that names the present path."""

import importlib
import subprocess
import sys

import pytest

import world2minecraft as w2m
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


SAME_NAME = sorted({former.partition(".")[0] for former in former_modules()} & set(w2m.__all__))
USES_OF_PUBLIC_FUNCTIONS = """
import importlib, inspect, pickle, pydoc, sys
{imports}
import world2minecraft as w2m
from world2minecraft import api
for name in {names}:
    former = importlib.import_module("world2minecraft." + name)
    importlib.reload(former)
    function = getattr(w2m, name)
    assert function is getattr(api, name) is not former, name
    assert inspect.isfunction(function), name
    assert "Example:" in inspect.getdoc(function), name
    assert pydoc.plain(pydoc.render_doc(function)).startswith("Python Library Documentation: func")
    assert pickle.loads(pickle.dumps(function)) is function, name
importlib.reload(w2m)
for name in {names}:
    assert getattr(w2m, name) is getattr(api, name), name
"""


def test_some_former_modules_have_names_of_public_functions():
    assert SAME_NAME == ["build", "render"]


@pytest.mark.parametrize(
    "imports",
    [
        "",
        "import world2minecraft.build, world2minecraft.render.views",
        "from world2minecraft.build import BuildParameters",
        "from world2minecraft import render; import world2minecraft.render",
        "import world2minecraft; world2minecraft.build; import world2minecraft.build",
        "from world2minecraft import *; from world2minecraft.render.views import *",
    ],
)
def test_former_modules_do_not_replace_public_functions(imports):
    code = USES_OF_PUBLIC_FUNCTIONS.format(imports=imports, names=SAME_NAME)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_errors_of_the_package_are_those_of_the_program(recwarn):
    from world2minecraft.errors import InputError

    from world2minecraft.core import errors as internal

    assert InputError is internal.InputError
    assert w2m.errors is internal is importlib.import_module(f"{PACKAGE}.errors")
    assert internal.__spec__.name == f"{PACKAGE}.core.errors"
    assert not recwarn.list


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
