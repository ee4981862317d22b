"""Reader of meshes and point clouds: views are rendered from within the room they show.

``mesh_source`` reads a file, sets it upright and to metres (``orientation_and_unit``), finds the
free space inside (``interior``), chooses camera poses (``viewpoints``) and lists one frame for
each, rendered when it is needed from triangles (``mesh_rasterizer``) or points
(``cloud_splatting``). So inside and outside are distinguished by what can be seen from free space,
and all later stages see an ordinary posed RGB-D capture without noise.
"""
