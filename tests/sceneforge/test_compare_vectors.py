"""The figures that the page counts are those of ``metrics``: the vectors that both are held to."""

import json
from pathlib import Path

import numpy as np
import pytest

from world2minecraft.editing.scene.difference import compare_labels
from world2minecraft.evaluation.metrics.occupancy import count_occupancy

VECTORS = Path(__file__).parent / "vectors" / "compare.json"


@pytest.mark.parametrize("row", json.loads(VECTORS.read_text())["cases"])
def test_vectors_are_what_metrics_say(row):
    now, other = (np.array(row[name], np.uint8).reshape(-1, 1, 1) for name in ("now", "other"))
    counts, found = count_occupancy(now, other), compare_labels(now, other)
    assert [int(getattr(found, name).sum()) for name in ("added", "removed", "changed")] == [
        row[name] for name in ("added", "removed", "changed")
    ]
    assert (counts.iou, counts.miou_present) == pytest.approx((row["iou"], row["miou"]))
