"""The structure of a room: floor, ceiling, walls, openings, outlines and storeys."""
