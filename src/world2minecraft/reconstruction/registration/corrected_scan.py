"""A scan whose views are corrected when they are read."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.view_stream import views_named
from world2minecraft.core.types import Corrections, Scan, View, ViewStream


@dataclass(eq=False, repr=False)
class CorrectedViews:
    """A stream of views whose poses and depths are corrected when read."""

    views: ViewStream
    changes: dict[str, tuple[np.ndarray, float]]

    def __len__(self) -> int:
        """The number of views."""
        return len(self.views)

    def __iter__(self) -> Iterator[View]:
        """Read the views from the first."""
        for view in self.views:
            yield correct_view(view, self.changes)

    def named(self, names: Collection[str]) -> Iterator[View]:
        """Read the views of the given names."""
        for view in views_named(self.views, names):
            yield correct_view(view, self.changes)

    @property
    def frames(self) -> tuple[FrameFiles, ...]:
        """The frames of the capture with corrected poses, without decoding them."""
        return tuple(self._corrected(frame) for frame in getattr(self.views, "frames", ()))

    def _corrected(self, frame: FrameFiles) -> FrameFiles:
        if frame.name not in self.changes or frame.camera_to_world is None:
            return frame
        change, _ = self.changes[frame.name]
        return replace(frame, camera_to_world=change @ frame.camera_to_world)

    @property
    def damaged(self) -> dict[str, str]:
        """The frames that could not be decoded so far, with the reasons."""
        return getattr(self.views, "damaged", {})


def apply_corrections(scan: Scan, corrections: Corrections) -> Scan:
    """Return the scan with corrected poses and depths."""
    changes = {
        name: (change, float(scale))
        for name, change, scale in zip(
            corrections.names, corrections.pose_change, corrections.depth_scale, strict=True
        )
    }
    return replace(scan, views=CorrectedViews(scan.views, changes))


def with_registration_note(scan: Scan, facts: Mapping[str, Any]) -> Scan:
    """Return the scan with a note on the results of the registration."""
    if not facts.get("kept"):
        return scan
    text = (
        f"camera poses were refined: moved by {facts['moved_median_mm']:.1f} mm and "
        f"{facts['turned_median_deg']:.2f} degrees (median over all frames)"
    )
    if facts["depth_scaled"]:
        text += f"; depth scales with a spread of {facts['depth_scale_spread']:.1%} were equalized"
    text += (
        f"; misfit of held-out surfaces reduced from {facts['misfit_before_mm']:.1f} mm to "
        f"{facts['misfit_after_mm']:.1f} mm"
    )
    return replace(scan, notes=(*scan.notes, text))


def correct_view(view: View, changes: dict[str, tuple[np.ndarray, float]]) -> View:
    """Return a view with its corrections applied; views without corrections are not changed."""
    if view.name not in changes:
        return view
    change, scale = changes[view.name]
    depth_m = view.depth_m
    if depth_m is not None and scale != 1.0:
        depth_m = depth_m * np.float32(scale)
    return replace(view, camera_to_scan=change @ view.camera_to_scan, depth_m=depth_m)
