"""Style ``display``: fine furniture in block_display entities over invisible colliders.

``builder`` places the objects of a room. ``boxes`` makes few boxes of many parts in the frame of an
object, ``block_alignment`` moves it out of walls and onto what carries it, ``part_materials``
chooses the block of each part, and ``colliders`` places what
a player meets.
"""
