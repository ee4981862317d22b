"""Style ``display``: fine furniture in block_display entities over invisible colliders.

``builder`` sets the objects of a room. ``frame`` says where an object stands, ``shifting`` moves
it out of walls and onto what carries it, ``pieces`` makes few boxes of many parts, ``tints`` says
which block each is of, ``heaps`` does both for an object's own cells, and ``colliders`` sets what
a player meets.
"""
