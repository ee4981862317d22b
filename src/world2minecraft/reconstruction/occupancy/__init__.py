"""Stage 2: predict evidence from a scan, one item per view.

A predictor is any object with a method ``predict(scan)``. The built-in predictors are in
``PREDICTORS``; others are registered through the entry point group ``world2minecraft.predictor``.
``depth`` can be supported by networks that vote for classes (``OccupancyParameters``).
"""

from collections.abc import Iterator
from typing import Protocol

from world2minecraft.core.errors import UsageError
from world2minecraft.core.registry import Registry
from world2minecraft.core.types import GridEvidence, PointEvidence, Scan
from world2minecraft.reconstruction.naming.name_votes import NameVoteMap, NameVotes
from world2minecraft.reconstruction.occupancy.parameters import (
    AUTO,
    WITHOUT_VOTES,
    OccupancyParameters,
    PredictionParameters,
)

__all__ = [
    "PREDICTORS",
    "OccupancyParameters",
    "PredictionParameters",
    "Predictor",
    "name_votes_of",
    "notes_of",
    "predictor",
]

PREDICTORS = Registry(
    "predictor",
    {
        "depth": "world2minecraft.reconstruction.occupancy.depth_evidence:DepthPredictor",
        "mono": "world2minecraft.reconstruction.occupancy.monocular_occupancy:MonoPredictor",
    },
)


class Predictor(Protocol):
    """Converts a scan to evidence as a stream, so that views need not be in memory together."""

    def predict(self, scan: Scan) -> Iterator[PointEvidence | GridEvidence]:
        """Yield one item of evidence per view, in the frame and the order of the scan."""
        ...


def predictor(name: str, parameters: OccupancyParameters | None = None) -> Predictor:
    """Create a predictor by name.

    Args:
        name: Name such as ``depth``, optionally with a file: ``mono:FILE.onnx``.
        parameters: Networks that vote on the surface points of ``depth``.

    Raises:
        UnknownNameError: If no predictor has this name; the message suggests the closest match.
        UsageError: If networks should vote on another predictor than ``depth``, or if ``depth``
            gets a file.
        InputError: If the file of a network cannot be used.
    """
    family, _, file = name.partition(":")
    make = PREDICTORS.load(family)
    chosen = parameters or OccupancyParameters()
    if chosen.network and not chosen.mono_votes:
        raise UsageError("occupy.network requires --set occupy.mono_votes=true")
    if file and family == "depth":
        raise UsageError(
            f"the predictor depth accepts no file, got {name!r}; for a network file, use "
            "mono:FILE.onnx (--predictor)"
        )
    silent = WITHOUT_VOTES if family == "depth" else (*WITHOUT_VOTES, AUTO)
    if chosen.semantics in silent and not chosen.mono_votes:
        return make(file) if file else make()
    if family != "depth":
        raise UsageError(
            f"semantics and occupy.mono_votes require the predictor depth, got {family!r}; omit "
            "the predictor (--predictor)"
        )
    from world2minecraft.reconstruction.occupancy.semantic_fusion import voters_of  # noqa: PLC0415  # Few runs have any.

    return make(voters=voters_of(chosen))


def name_votes_of(used: Predictor) -> NameVotes | None:
    """Return the votes for fine names of a predictor and its voters, or None if it has none."""
    base = getattr(used, "base", used)
    maps = [getattr(one, "names", None) for one in (base, *getattr(base, "voters", ()))]
    found = [one for one in maps if isinstance(one, NameVoteMap)]
    votes = NameVoteMap.joined(found).votes()
    return votes if len(votes.cubes) else None


def notes_of(used: Predictor) -> tuple[str, ...]:
    """Return the notes of a predictor for the report, after its evidence was read."""
    return tuple(getattr(used, "notes", ()))
