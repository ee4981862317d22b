"""Statistics of a data set, compared with the data sets in the paper."""

from world2minecraft.minecraftocc.statistics.counting import (
    PictureCounts,
    StatisticsCounter,
    count_samples,
    picture_counts,
)
from world2minecraft.minecraftocc.statistics.tables import (
    statistics_json,
    statistics_latex,
    statistics_text,
)
from world2minecraft.minecraftocc.statistics.types import DatasetStatistics, FineCount, SceneCount

__all__ = [
    "DatasetStatistics",
    "FineCount",
    "PictureCounts",
    "SceneCount",
    "StatisticsCounter",
    "count_samples",
    "picture_counts",
    "statistics_json",
    "statistics_latex",
    "statistics_text",
]
