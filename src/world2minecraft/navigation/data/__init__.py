"""From walks to questions: streams become trajectories, trajectories become items, items a set.

``stream`` reads walks, ``cleaning`` cuts them, ``discretise`` makes moves of them, ``keyframes``
takes their pictures, ``next_view`` and ``next_action`` ask about them, ``building`` does it all.
"""
