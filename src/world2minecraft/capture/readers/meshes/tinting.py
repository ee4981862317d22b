"""Colours and labels by the names that files give their columns."""

from collections.abc import Mapping

import numpy as np

RED_NAMES = (
    ("red", "green", "blue"),
    ("r", "g", "b"),
    ("diffuse_red", "diffuse_green", "diffuse_blue"),
)
SPLAT_COLOURS = ("f_dc_0", "f_dc_1", "f_dc_2")
SPLAT_BASE = 0.28209479177387814  # Of the constant spherical harmonic, in which splats store it.


def colour_of(columns: Mapping[str, np.ndarray]) -> np.ndarray | None:
    """Return uint8 [N, 3] of columns that hold colours, or None.

    Whole numbers up to 255, or up to 65535 (LAS, PTS of some scanners), and shares up to 1 are
    told apart by their most.
    """
    for names in RED_NAMES:
        if all(name in columns for name in names):
            return as_colour(np.stack([columns[name] for name in names], axis=1))
    if all(name in columns for name in SPLAT_COLOURS):
        mixed = np.stack([columns[name] for name in SPLAT_COLOURS], axis=1)
        return np.clip((0.5 + SPLAT_BASE * mixed) * 255 + 0.5, 0, 255).astype(np.uint8)
    return None


def as_colour(values: np.ndarray) -> np.ndarray | None:
    """Return uint8 [N, 3] of colours in any of the usual ranges; None where all is black."""
    if values.dtype == np.uint8:
        return np.ascontiguousarray(values)
    finite = np.nan_to_num(values.astype(np.float32))
    most = float(finite.max(initial=0))
    if most <= 0:
        return None
    share = 255.0 if most <= 1.0 else 1.0 if most <= 255 else 255 / 65535
    return np.clip(finite * np.float32(share) + np.float32(0.5), 0, 255).astype(np.uint8)
