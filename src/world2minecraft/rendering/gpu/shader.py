"""The shader's text: the parts of this folder, and the constants that Python knows."""

from importlib.resources import files

from world2minecraft.rendering.gpu.scene_buffers import LAYOUT
from world2minecraft.rendering.gpu.uniforms import AT_CORNERS, AT_ENCODE, struct_text

PARTS = ("rays", "elements", "shade", "picture")
# In the order of their bindings.
BINDINGS = ("parameters", "cells", "light", "tables", "texels", "labels", "tone", "views", "out")
_TYPES = {"cells": "i32", "views": "View"}


def shader_text() -> str:
    """Return the whole shader, WGSL."""
    folder = files("world2minecraft.rendering.gpu")
    places = LAYOUT | {"AT_ENCODE": AT_ENCODE, "AT_CORNERS": AT_CORNERS}
    constants = "".join(f"const {name}: u32 = {value}u;\n" for name, value in places.items())
    bindings = "@group(0) @binding(0) var<uniform> P: Params;\n"
    for place, name in enumerate(BINDINGS[1:], 1):
        access = "read_write" if name == "out" else "read"
        kind = f"array<{_TYPES.get(name, 'u32')}>"
        bindings += f"@group(0) @binding({place}) var<storage, {access}> {name}: {kind};\n"
    parts = [(folder / f"{name}.wgsl").read_text(encoding="utf-8") for name in PARTS]
    return "\n".join([constants, struct_text(), bindings, *parts])
