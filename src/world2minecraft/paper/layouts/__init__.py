"""Comparison of rooms from different layout methods: importing, scoring, building and judging.

``importers`` read the output of LayoutGPT, I-Design and LayoutVLM, and runs of this program, as
``ComparedScene``. ``scores`` measures objects outside rooms, collisions and categories.
``layout_to_world`` builds Minecraft worlds, and ``judge`` grades images with a model.
"""

from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.scores import Margins, SceneScores, score_scene, summary_of

__all__ = ["ComparedScene", "Margins", "SceneScores", "score_scene", "summary_of"]
