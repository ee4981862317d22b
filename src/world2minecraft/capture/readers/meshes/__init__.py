"""Reader of meshes and point clouds, which renders RGB-D views from inside the room.

``mesh_source`` reads a file, converts it to metres with z up (``orientation_and_unit``), finds the
free space inside the room (``interior``), chooses camera poses (``viewpoints``) and lists one frame
per pose. A frame is rendered on demand from triangles (``mesh_rasterizer``) or points
(``cloud_splatting``). All later stages process the result like an ordinary posed RGB-D capture
without noise.
"""
