"""List the objects of a room with their places, and save them as CSV.

python examples/03_objects.py [OUT]
"""

import csv
import sys

import numpy as np

import world2minecraft as w2m

run = w2m.load(sys.argv[1] if len(sys.argv) > 1 else "OUT")

for thing in sorted(run.objects, key=lambda one: -np.prod(one.size_m)):
    x, y, z = thing.center_m
    print(f"{thing.id:3} {thing.name:12} at {x:.2f} {y:.2f} {z:.2f} m, {thing.confidence:.0%}")

with open(run.folder / "objects.csv", "w", newline="") as file:
    table = csv.writer(file)
    table.writerow(["id", "name", "x_m", "y_m", "z_m", "confidence"])
    for thing in run.objects:
        table.writerow([thing.id, thing.name, *thing.center_m.round(3), thing.confidence])
print("saved", run.folder / "objects.csv")
