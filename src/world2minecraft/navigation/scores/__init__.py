"""Scores of walks and answers, as pure functions.

``navigation`` scores episodes (NE, SR, OSR, SPL, SoftSPL, nDTW, SDTW, CLS), ``path_similarity``
compares paths, and ``significance`` computes confidence intervals and compares agents.
"""

from world2minecraft.navigation.scores.navigation import (
    RADII_M,
    EpisodeScore,
    WalkedPath,
    score_episode,
    summarise,
)
from world2minecraft.navigation.scores.path_similarity import cls, dtw_m, ndtw, path_length_m
from world2minecraft.navigation.scores.significance import Rate, paired_p, rate

__all__ = [
    "RADII_M",
    "EpisodeScore",
    "Rate",
    "WalkedPath",
    "cls",
    "dtw_m",
    "ndtw",
    "paired_p",
    "path_length_m",
    "rate",
    "score_episode",
    "summarise",
]
