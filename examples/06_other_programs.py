"""Convert a room for other programs: Blender, Litematica, WorldEdit, Bedrock, Habitat.

python examples/06_other_programs.py [OUT]
"""

import sys

import world2minecraft as w2m

run = w2m.load(sys.argv[1] if len(sys.argv) > 1 else "OUT")

for name in ("room.glb", "room.litematic", "room.schem", "room.mcstructure", "room.habitat"):
    done = w2m.convert(run, run.folder / "exports" / name, force=True)
    lost = ", ".join(f"{count} {what}" for what, count in done.not_written.items())
    print(f"{done.path}: {done.blocks:,} blocks" + (f" (not included: {lost})" if lost else ""))
