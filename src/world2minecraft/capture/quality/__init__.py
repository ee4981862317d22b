"""A quick survey of a capture: sharpness of its pictures, view directions, a top view.

A few pictures are decoded, small; where there are depth and poses, some frames are laid into one
top view. ``survey_capture`` gathers it, ``diagnose_capture`` rates it, and the package
``capture.poster`` draws it on one page.
"""

from world2minecraft.capture.quality.survey import Survey, survey_capture

__all__ = ["Survey", "survey_capture"]
