"""Rendering of a build to image files: selection of shots, rendering and output.

``draw_files`` is the entry point, which ``w2m render`` and ``world2minecraft.render_files`` call.
"""
