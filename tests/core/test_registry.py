"""Registries: lazy, ordered, open to other packages, and helpful about names."""

import sys
from importlib.metadata import EntryPoint

import pytest

from world2minecraft.core import registry
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.registry import Registry

BUILTINS = {"geometric": "world2minecraft.core.classes:class_id", "json": "json:loads"}


@pytest.fixture
def labellers():
    return Registry("labeller", BUILTINS)


def offer(monkeypatch, **targets):
    """Stand in for installed packages that declare entry points."""
    asked = []

    def points_of(group, search_path):
        asked.append(group)
        return tuple(EntryPoint(name, target, group) for name, target in targets.items())

    monkeypatch.setattr(registry, "points_of", points_of)
    return asked


def test_a_built_in_name_gives_its_attribute(labellers):
    assert labellers.load("geometric")("sofa") == 7


def test_names_keep_their_order_and_others_follow_sorted(labellers, monkeypatch):
    asked = offer(monkeypatch, zebra="json:dumps", ant="json:dumps", json="json:dumps")
    assert labellers.names() == ("geometric", "json", "ant", "zebra")
    assert set(asked) == {"world2minecraft.labeller"}


def test_another_package_adds_a_name(labellers, monkeypatch):
    offer(monkeypatch, mine="json:dumps")
    assert labellers.load("mine")([1]) == "[1]"


def test_another_package_cannot_take_a_built_in_name(labellers, monkeypatch):
    offer(monkeypatch, geometric="json:dumps")
    assert labellers.load("geometric")("sofa") == 7


def test_nothing_is_imported_before_its_name_is_asked_for(monkeypatch, tmp_path):
    (tmp_path / "w2m_lazy_probe.py").write_text("answer = 42\n")
    monkeypatch.syspath_prepend(tmp_path)
    probes = Registry("probe", {"probe": "w2m_lazy_probe:answer"})
    assert probes.names() == ("probe",)
    assert "w2m_lazy_probe" not in sys.modules
    assert probes.load("probe") == 42
    monkeypatch.delitem(sys.modules, "w2m_lazy_probe")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("geometri", "no labeller is named 'geometri'; did you mean 'geometric'?"),
        ("xyz", "no labeller is named 'xyz'; known: geometric, json"),
    ],
)
def test_an_unknown_name_is_answered_with_the_nearest(labellers, monkeypatch, name, message):
    offer(monkeypatch)
    with pytest.raises(UnknownNameError) as caught:
        labellers.load(name)
    assert str(caught.value) == message


def test_a_later_change_of_the_table_does_not_reach_in():
    table = dict(BUILTINS)
    made = Registry("labeller", table)
    table.clear()
    assert made.names()[:2] == ("geometric", "json")


def test_a_package_found_later_is_known(monkeypatch, tmp_path):
    late = Registry("late", {})
    assert late.names() == ()
    information = tmp_path / "late-1.0.dist-info"
    information.mkdir()
    (information / "METADATA").write_text("Metadata-Version: 2.1\nName: late\nVersion: 1.0\n")
    (information / "entry_points.txt").write_text("[world2minecraft.late]\nmine = json:dumps\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert late.names() == ("mine",)
    assert late.load("mine")([1]) == "[1]"
