"""Stage 2: a scan becomes evidence, one item a view.

A predictor is any callable object with ``predict(scan)``; the built-in ones are in
``PREDICTORS``, others join through the entry point group ``world2minecraft.predictor``. ``depth``
may be helped by networks that vote for classes (``OccupancyParameters``).
"""

from collections.abc import Iterator
from typing import Protocol

from world2minecraft.core.errors import UsageError
from world2minecraft.core.registry import Registry
from world2minecraft.core.types import GridEvidence, PointEvidence, Scan
from world2minecraft.reconstruction.occupancy.parameters import OccupancyParameters

__all__ = ["PREDICTORS", "OccupancyParameters", "Predictor", "notes_of", "predictor"]

PREDICTORS = Registry(
    "predictor",
    {
        "depth": "world2minecraft.reconstruction.occupancy.depth_evidence:DepthPredictor",
        "mono": "world2minecraft.reconstruction.occupancy.monocular_occupancy:MonoPredictor",
    },
)


class Predictor(Protocol):
    """Turns a scan into evidence, streamed: no two views need lie in memory together."""

    def predict(self, scan: Scan) -> Iterator[PointEvidence | GridEvidence]:
        """Yield one item a view, in the scan's frame and order."""
        ...


def predictor(name: str, parameters: OccupancyParameters | None = None) -> Predictor:
    """Return a new predictor by name.

    Args:
        name: such as ``depth``, or with a file of its own, ``mono:FILE.onnx``.
        parameters: networks that vote on what ``depth`` sees.

    Raises:
        UnknownNameError: none has this name; the message suggests the nearest.
        UsageError: networks are to vote on what another predictor than ``depth`` gives, or
            ``depth`` is given a file.
        InputError: a network's file cannot be used.
    """
    family, _, file = name.partition(":")
    make = PREDICTORS.load(family)
    chosen = parameters or OccupancyParameters()
    if chosen.network and not chosen.mono_votes:
        raise UsageError("occupy.network requires --set occupy.mono_votes=true")
    if file and family == "depth":
        raise UsageError(
            f"--predictor depth accepts no file, got {name!r}; for a network file, use "
            "--predictor mono:FILE.onnx"
        )
    if not (chosen.semantics or chosen.mono_votes):
        return make(file) if file else make()
    if family != "depth":
        raise UsageError(
            f"--semantics and occupy.mono_votes require --predictor depth, got {family!r}; "
            "omit --predictor"
        )
    from world2minecraft.reconstruction.occupancy.semantic_fusion import voters_of  # noqa: PLC0415  # Few runs have any.

    return make(voters=voters_of(chosen))


def notes_of(used: Predictor) -> tuple[str, ...]:
    """Return what a predictor has to tell once its evidence was read: sentences for the report."""
    return tuple(getattr(used, "notes", ()))
