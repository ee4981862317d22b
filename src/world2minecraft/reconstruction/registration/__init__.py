"""Registration: correct the poses and depth scales of all frames against their common map.

``register`` returns the corrections and the corrected surface, ``refine`` only the corrections, and
``apply_corrections`` a scan whose views are corrected when read.
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
