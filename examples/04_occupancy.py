"""Read the semantic occupancy as NumPy arrays, and measure the room in them.

python examples/04_occupancy.py [OUT]
"""

import sys

import numpy as np

import world2minecraft as w2m

run = w2m.load(sys.argv[1] if len(sys.argv) > 1 else "OUT")
room = run.room  # Cells in the room frame: x, y, z up; 0 is empty, 255 unknown.

print(room)
floor = np.isin(room.labels, (2,)).any(axis=2)
print(f"floor seen: {floor.sum() * room.voxel_m**2:.1f} m2")
for number, name in room.names.items():
    cells = np.count_nonzero(room.instances == number)
    print(f"{name:12} {cells * room.voxel_m**3 * 1000:6.0f} litres")
room.plan(px_per_cell=8).save(run.folder / "classes.png")
