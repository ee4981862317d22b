"""Rooms made in other ways beside ours: their layouts read, scored alike, built and judged.

``importers`` read what LayoutGPT, I-Design and LayoutVLM write, and our own runs, as
``ComparedScene``. ``scores`` counts what lies outside, what collides and which categories are
there. ``building`` makes Minecraft worlds of them, ``judge`` asks a model how they look.
"""

from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.scores import Margins, SceneScores, score_scene, summary_of

__all__ = ["ComparedScene", "Margins", "SceneScores", "score_scene", "summary_of"]
