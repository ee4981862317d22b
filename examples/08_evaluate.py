"""Score a reconstruction against the room that was scanned.

    python examples/08_evaluate.py [OUT] [TRUTH]

TRUTH is the folder of a virtual scan, such as the one that example 01 writes.
"""

import sys

import world2minecraft as w2m

run = w2m.load(sys.argv[1] if len(sys.argv) > 1 else "OUT")
truth = sys.argv[2] if len(sys.argv) > 2 else run.folder / "capture"

scores = w2m.evaluate(run, truth)
surface, cells, objects = (
    scores[name] for name in ("surface_within_one_voxel", "occupancy", "objects")
)
print(f"surface    precision {surface['precision']:.3f}, recall {surface['recall']:.3f}")
print(f"occupancy  IoU {cells['iou']:.3f}, mIoU {cells['miou']:.3f}")
print(f"objects    F1 {objects['f1']:.3f}")
