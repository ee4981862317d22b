"""From walks to questions: streams become trajectories, trajectories become items, items a set.

``planned_walks`` and ``recorded_walks`` give streams, ``stream_segmentation`` cuts them into
walks, ``navigation.walk_discretization`` makes moves of them, ``keyframes`` and ``picture_store``
their pictures, ``tasks`` the questions, ``set_building`` the whole set.
"""
