"""Building of navigation data sets: streams, trajectories, items and whole sets.

``planned_walks`` and ``recorded_walks`` provide streams of poses, ``stream_segmentation`` cuts them
into walks, ``navigation.walk_discretization`` converts walks to moves, ``keyframes`` and
``picture_store`` provide the images, ``tasks`` the questions, and ``set_building`` the whole set.
"""
