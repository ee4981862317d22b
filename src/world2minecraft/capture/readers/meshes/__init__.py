"""Meshes and point clouds as captures: a solid is looked at from within the room it shows.

``source`` reads a file (``formats``), sets it upright and to metres (``upright``, ``units``), finds
the free space inside (``interior``), chooses places to look from (``viewpoints``) and lists one
frame for each; ``looks`` renders a frame when it is asked for, from triangles (``triangles``) or
points (``splats``). So inside and outside are told apart by what can be seen from free space, and
all later stages see an ordinary posed RGB-D capture without noise.
"""
