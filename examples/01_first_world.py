"""Generate a room, scan it with a virtual depth camera and rebuild it as a Minecraft world.

    python examples/01_first_world.py [OUT] [FRAMES]

Nothing else is needed: no capture, no game, no GPU.
"""

import sys

import world2minecraft as w2m

out = sys.argv[1] if len(sys.argv) > 1 else "OUT"
frames = int(sys.argv[2]) if len(sys.argv) > 2 else 40

room = w2m.generate_room("living", seed=5)
scan = w2m.scan_room(room, f"{out}/capture", frames=frames)
with w2m.show_progress() as progress:
    run = w2m.reconstruct(scan, out, progress=progress)

w2m.render(run).save(f"{out}/outside.png")
w2m.render(run, view="inside").save(f"{out}/inside.png")
print(f"{len(run.objects)} objects; look at {out}/outside.png and {out}/report.html")
print(f"play: w2m install {out}")
