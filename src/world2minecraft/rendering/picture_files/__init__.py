"""Pictures of a build as files: which shots are taken, how they are drawn, and where they go.

``draw_files`` does all of it; ``w2m render`` and ``world2minecraft.render_files`` call it.
"""
