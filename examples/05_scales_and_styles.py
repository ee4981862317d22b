"""Build one room at several scales and in several styles, and draw them side by side.

python examples/05_scales_and_styles.py [OUT]
"""

import sys

from PIL import Image

import world2minecraft as w2m

run = w2m.load(sys.argv[1] if len(sys.argv) > 1 else "OUT")
choices = [(2, "blocks"), (4, "blocks"), (4, "display")]

sheet = Image.new("RGB", (480 * len(choices), 360))
for number, (scale, style) in enumerate(choices):
    out = f"{run.folder}_{scale}_{style}"
    built = w2m.build(run, out, blocks_per_metre=scale, style=style)
    sheet.paste(w2m.render(built, size=(480, 360)), (480 * number, 0))
    print(f"{scale} blocks per metre, {style}: {built.world}")
sheet.save(f"{run.folder}_styles.png")
