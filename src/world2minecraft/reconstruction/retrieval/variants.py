"""Choice of the design within a family after matching, by size, parameters and colour.

Many designs share a shape. Of the designs that explain the object's cells about as well as the
match, the closest in size and colour is used. Objects of the same size and colour are decided
together, so that a set of chairs stays a set.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from world2minecraft.core.types import OccupancyGrid, Placement
from world2minecraft.furniture import Span, Template, template, variants_of
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.reconstruction.retrieval.object_evidence import OWN, Evidence
from world2minecraft.reconstruction.retrieval.template_matching import (
    NO_SHIFT,
    Bias,
    Scored,
    score_shifts,
)

LOST_IOU = 0.02  # Maximum loss of IoU by another design: about the noise of a scan.
SLACK_M = 0.04  # Tolerance of half a cell, as sizes are whole cells.
NEUTRAL = 0.1  # Oklab distance assumed for designs that suit any colour.
SIZE_COST = 0.1  # Oklab distance equivalent to a side at the end of its range (estimated).
CLEAR_CHROMA, FADED = 0.025, 0.1  # Minimum chroma of a hue, and the cost of losing it.
STAY = 0.02  # Minimum advantage of another design over the match.
LIGHT = np.sqrt(0.4)  # Weight of lightness against hue, as in the choice of blocks.
SAME_SET, SAME_SIZE_M = 0.08, 0.12


class Offer(NamedTuple):
    """A design that may replace a match, with its IoU and parameter values."""

    template: str
    iou: float
    parameters: dict[str, float]


class Choice(NamedTuple):
    """A placement, the designs that may replace it, and the Oklab colour of its cells or None."""

    placement: Placement
    offers: tuple[Offer, ...]
    colour: np.ndarray | None


def offers_of(evidence: Evidence, match: Scored, bias: Bias) -> tuple[Offer, ...]:
    """Return the designs of a match's family with a similar fit, the match itself first."""
    trial = match.trial
    size = np.array(trial.counts) * bias.voxel_m
    found = [Offer(trial.template.name, match.iou, dict(trial.values))]
    for other in variants_of(trial.template.family):
        values = _taken_over(other, dict(trial.values))
        if other.matched or values is None or not _alike(other, trial.template, size):
            continue
        tried = trial._replace(template=other, values=tuple(sorted(values.items())))
        scored = score_shifts(evidence, tried, NO_SHIFT, bias)
        if scored.iou >= match.iou - LOST_IOU:
            found.append(Offer(other.name, scored.iou, values))
    return tuple(found)


def _alike(other: Template, own: Template, size_m: np.ndarray) -> bool:
    """Return whether a design has the mount, orientation and size of the matched design."""
    same = (other.class_id, other.mount, other.turns) == (own.class_id, own.mount, own.turns)
    return same and all(
        span.minimum - SLACK_M <= side <= span.maximum + SLACK_M
        for side, span in zip(size_m, other.size_m, strict=True)
    )


def in_other_design(placement: Placement, other: Template) -> Placement | None:
    """Return a placement in another design of its family, or None if that does not fit."""
    own = template(placement.template)
    values = _taken_over(other, dict(placement.parameters))
    if other.name == own.name or other.family != own.family or values is None:
        return None
    if not _alike(other, own, placement.size_m):
        return None
    return replace(placement, template=other.name, parameters=values)


def _taken_over(other: Template, values: dict[str, float]) -> dict[str, float] | None:
    """Apply the parameter values of the matched design to another design.

    Returns:
        The default parameters of ``other``, updated with ``values``, or None if ``other`` lacks a
        parameter or does not allow its value.
    """
    result = other.complete()
    for name, value in values.items():
        if name not in other.parameters or abs(other.parameters[name].clip(value) - value) > 1e-6:
            return None
        result[name] = value
    return result


def colour_of_cells(grid: OccupancyGrid, evidence: Evidence) -> np.ndarray | None:
    """Return the median Oklab colour of an object's cells, float32 [3], or None without colour."""
    cells = np.argwhere(evidence.code == OWN) + evidence.corner
    colours = grid.colour[tuple(cells.T)]
    colours = colours[colours.any(axis=1)]
    return np.median(srgb_to_oklab(colours), axis=0) if len(colours) else None


def choose(choices: Sequence[Choice]) -> tuple[Placement, ...]:
    """Return the placements, in their order, with the design chosen for their set."""
    result: dict[int, Placement] = {}
    for members in _sets(choices):
        best = _best([choices[index] for index in members])
        for index in members:
            placement, offers, _ = choices[index]
            taken = next((offer for offer in offers if offer.template == best), None)
            result[index] = placement if taken is None else _standing(placement, taken)
    return tuple(result[index] for index in range(len(choices)))


def _standing(placement: Placement, offer: Offer) -> Placement:
    if offer.template == placement.template:
        return placement
    return replace(
        placement,
        template=offer.template,
        parameters=offer.parameters,
        iou=round(offer.iou, 4),
    )


def _sets(choices: Sequence[Choice]) -> list[list[int]]:
    """Group the choices of one template by object, and by similar size and colour, as indices."""
    found: list[list[int]] = []
    for index, choice in enumerate(choices):
        home = next((one for one in found if _same(choice, choices[one[0]])), None)
        if home is None:
            found.append([index])
        else:
            home.append(index)
    return found


def _same(one: Choice, other: Choice) -> bool:
    if one.placement.template != other.placement.template or not one.offers or not other.offers:
        return False
    if one.placement.object_id == other.placement.object_id:  # The runs of one object.
        return True
    distance = np.abs(one.placement.size_m - other.placement.size_m).max()
    return distance <= SAME_SIZE_M and _colours_apart(one.colour, other.colour) <= SAME_SET


def _colours_apart(one: np.ndarray | None, other: np.ndarray | None) -> float:
    if one is None or other is None:
        return 0.0 if one is other else np.inf
    return float(np.linalg.norm((one - other) * [LIGHT, 1, 1]))


def _best(members: list[Choice]) -> str:
    """Return the template that suits a set best, of those offered to all its members."""
    common = set.intersection(*({offer.template for offer in one.offers} for one in members))
    own = members[0].placement.template
    size = np.mean([one.placement.size_m for one in members], axis=0)
    known = [one.colour for one in members if one.colour is not None]
    colour = np.mean(known, axis=0) if known else None
    costs = {name: _cost(template(name), size, colour) for name in sorted(common)}
    if own not in costs:
        return own
    costs[own] -= STAY
    return min(costs, key=lambda name: (round(costs[name], 6), name != own, name))


def design_cost(placement: Placement, colour: np.ndarray | None) -> float:
    """Return how little a placed design suits its size and an Oklab colour, as a distance."""
    return _cost(template(placement.template), placement.size_m, colour)


def _cost(design: Template, size_m: np.ndarray, colour: np.ndarray | None) -> float:
    far = max(_strangeness(*pair) for pair in zip(size_m, design.size_m, strict=True))
    if not design.suits:
        return NEUTRAL + SIZE_COST * far
    if colour is None:
        return np.inf
    suited = srgb_to_oklab(np.array(design.suits, np.uint8))
    distance = min(_colours_apart(colour, one) + _faded(colour, one) for one in suited)
    return distance + SIZE_COST * far


def _faded(colour: np.ndarray, suited: np.ndarray) -> float:
    """Return the cost of replacing a saturated colour by grey: pale wood is not steel."""
    own, other = (float(np.hypot(*one[1:])) for one in (colour, suited))
    return FADED if own >= CLEAR_CHROMA and other < own / 2 else 0.0


def _strangeness(side: float, span: Span) -> float:
    room = span.typical - span.minimum if side < span.typical else span.maximum - span.typical
    return min(abs(side - span.typical) / room, 1.0) if room > 0 else 0.0
