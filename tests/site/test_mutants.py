"""The check of the tests: its lists are true, and a fault that is put in takes effect."""

import importlib
import sys
import tomllib
from pathlib import Path

import pytest
from tools.mutants import __file__ as home
from tools.mutants.grafting import LoadError, graft

FOLDER = Path(home).parent
ROOT = FOLDER.parents[1]
SOURCE = ROOT / "src" / "world2minecraft"
PLAN = tomllib.loads((FOLDER / "plan.toml").read_text())
EXPLAINED = tomllib.loads((FOLDER / "explained.toml").read_text())
MODULE = """
from dataclasses import dataclass
from functools import lru_cache

STEP = 2

def add(value, step=STEP):
    return value + step

@lru_cache
def cached(value):
    return value + 1

@dataclass(frozen=True)
class Pair:
    left: int = 3

    @property
    def twice(self):
        return self.left * 2

    @staticmethod
    def made():
        return Pair()
"""


@pytest.fixture
def module(tmp_path, monkeypatch):
    (tmp_path / "module_with_faults.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    yield importlib.import_module("module_with_faults")
    del sys.modules["module_with_faults"]


@pytest.mark.parametrize("group", PLAN.values(), ids=PLAN)
def test_what_the_plan_names_is_there(group):
    assert all((SOURCE / name).is_file() for name in group["modules"])
    assert all((ROOT / name).exists() for name in group["tests"])


@pytest.mark.parametrize("name", EXPLAINED)
def test_an_explained_fault_is_of_a_line_that_still_stands(name):
    lines = {line.strip() for line in (SOURCE / name).read_text().splitlines()}
    changes = [change for reason in EXPLAINED[name] for change in reason["changes"]]
    assert all(change.split("  =>  ")[0] in lines for change in changes)
    assert len(changes) == len(set(changes))


def test_whoever_imported_a_function_runs_its_fault(module):
    add, cached = module.add, module.cached
    assert (add(1), cached(1)) == (3, 2)
    graft(module, MODULE.replace("value +", "value -"), in_function=True)
    assert (add(1), cached(1)) == (-1, 0)
    assert module.add is add


def test_whoever_holds_a_value_of_a_class_runs_its_fault(module):
    pair, made = module.Pair(), module.Pair.made
    graft(module, MODULE.replace("* 2", "* 5").replace("left: int = 3", "left: int = 4"), False)
    assert (pair.twice, made().left, module.Pair().twice) == (15, 4, 20)
    assert isinstance(made(), module.Pair)


def test_a_changed_constant_reaches_defaults_and_importers(module):
    holder = sys.modules["module_that_imports"] = type(sys)("module_that_imports")
    holder.STEP = module.STEP
    graft(module, MODULE.replace("STEP = 2", "STEP = 7"), in_function=False)
    del sys.modules["module_that_imports"]
    assert (module.add(1), module.STEP, holder.STEP) == (8, 7, 7)


def test_a_fault_that_does_not_load_is_told_apart(module):
    with pytest.raises(LoadError, match="division"):
        graft(module, MODULE.replace("STEP = 2", "STEP = 2 / 0"), in_function=False)
    assert sys.modules["module_with_faults"] is module
    assert module.STEP == 2
