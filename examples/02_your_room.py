"""Turn your own capture into a world: photos, a video, an app's export, frames, a mesh, a plan.

python examples/02_your_room.py MY_SCAN [OUT]
"""

import sys

import world2minecraft as w2m

capture = sys.argv[1]
out = sys.argv[2] if len(sys.argv) > 2 else "MINE"

try:
    run = w2m.reconstruct(capture, out, progress=print)
except w2m.errors.InputError as error:  # It names the file and what to do about it.
    sys.exit(f"error: {error}")

for note in run.notes:
    print("note:", note)
print("size in metres:", run.report["room_size_m"])
print("world:", run.world)
