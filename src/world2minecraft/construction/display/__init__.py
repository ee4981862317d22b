"""Build style ``display``: detailed furniture of block_display entities over invisible colliders.

``builder`` places the objects of a room. ``boxes`` reduces the parts of an object to few boxes,
``block_alignment`` moves the object out of walls and onto its support, ``part_materials`` chooses
the block of each part, and ``colliders`` places the blocks that players collide with.
"""
