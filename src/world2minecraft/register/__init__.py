"""Between scan and occupy: poses and depth scales are put right against the map of all frames.

``register`` gives the corrections and the corrected surface, ``refine`` the corrections alone, and
``corrected`` a scan whose views come with them applied.
"""

from world2minecraft.register.corrected import corrected, told
from world2minecraft.register.parameters import RegisterParameters
from world2minecraft.register.refine import Registered, refine, register

__all__ = ["RegisterParameters", "Registered", "corrected", "refine", "register", "told"]
