"""Quick survey of a capture: sharpness of its images, view directions and a top view.

A sample of images is decoded at low resolution. If there are depth and poses, some frames are
rendered to a top view. ``survey_capture`` collects the results, ``diagnose_capture`` rates them,
and the package ``capture.poster`` draws them on a page.
"""

from world2minecraft.capture.quality.survey import Survey, survey_capture

__all__ = ["Survey", "survey_capture"]
