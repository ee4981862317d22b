"""What a capture shows, found in seconds: how sharp its pictures are, where they look, a plan.

A few pictures are decoded, small; where there are depth and poses, some frames are laid into one
top view. ``survey_capture`` gathers it, ``doubts_of`` judges it, and the package ``capture.poster``
draws it on one page.
"""

from world2minecraft.capture.quality.survey import Survey, survey_capture

__all__ = ["Survey", "survey_capture"]
