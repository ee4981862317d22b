"""Between scan and occupy: poses and depth scales are put right against the map of all frames.

``register`` gives the corrections and the corrected surface, ``refine`` the corrections alone, and
``apply_corrections`` a scan whose views come with them applied.
"""

from world2minecraft.reconstruction.registration.corrected_scan import (
    apply_corrections,
    with_registration_note,
)
from world2minecraft.reconstruction.registration.parameters import RegistrationParameters
from world2minecraft.reconstruction.registration.pose_refinement import Registered, refine, register

__all__ = [
    "Registered",
    "RegistrationParameters",
    "apply_corrections",
    "refine",
    "register",
    "with_registration_note",
]
