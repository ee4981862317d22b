"""The surface whose height was stated has the stated class; all else keeps its own."""

from dataclasses import replace

import numpy as np
import pytest
from label_rooms import SmallRoom

from world2minecraft.core.classes import SemanticClass
from world2minecraft.reconstruction.semantics.known_surfaces import label_known_surface

TABLE, FURN, BED, OBJS = (
    SemanticClass.TABLE,
    SemanticClass.FURN,
    SemanticClass.BED,
    SemanticClass.OBJS,
)
TOP = (1.0, 1.0, 0.66, 2.2, 1.8, 0.72)
CUP = (1.6, 1.4, 0.72, 1.7, 1.5, 0.84)


def _labelled(box, label):
    grid, evidence, truth = SmallRoom().add(box, OBJS).add(CUP, BED).scanned()
    labels = np.where(truth == OBJS, label, truth).astype(np.uint8)
    return replace(grid, labels=np.where(grid.occupied, labels, grid.labels)), evidence


def test_a_known_table_is_a_table():
    grid, evidence = _labelled(TOP, FURN)
    found = label_known_surface(grid, evidence, "table height", 0.72)
    changed = found.labels != grid.labels
    assert changed.sum() > 0.6 * (grid.labels == FURN).sum()
    assert (found.labels[changed] == TABLE).all() and (grid.labels[changed] != BED).mean() > 0.98
    assert (found.confidence[changed] > 0.8).all()


@pytest.mark.parametrize(
    ("name", "height_m", "label"),
    [("table height", 0.72, TABLE), ("table height", 0.9, FURN), ("seat height", 0.72, FURN)],
)
def test_nothing_else_changes(name, height_m, label):
    grid, evidence = _labelled(TOP, label)
    found = label_known_surface(grid, evidence, name, height_m)
    np.testing.assert_array_equal(found.labels, grid.labels)


def test_a_known_counter_has_a_body():
    grid, evidence = _labelled((1.0, 1.0, 0.0, 2.2, 1.8, 0.72), OBJS)
    found = label_known_surface(grid, evidence, "Counter-height", 0.72)
    assert (found.labels == FURN).sum() > 0.9 * (grid.labels == OBJS).sum()
