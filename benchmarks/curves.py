"""Curves as a small SVG: panels side by side, one line a name."""

from collections.abc import Mapping, Sequence
from pathlib import Path

PANEL, HIGH, EDGE, FOOT = 220, 170, 34, 56
LOWEST = 0.6  # Where the panels begin; what is lower is drawn there.
COLOURS = ("#1f6fb4", "#d9730d", "#4a9e4f", "#8a5bb0", "#888888")

Curves = Mapping[str, Sequence[float]]


def write_curves(
    path: Path, panels: Sequence[tuple[str, Sequence[float], Curves, float | None]]
) -> None:
    """Write panels (title, values, curves from 0 to 1, the default or None) to an SVG file."""
    names = list(dict.fromkeys(name for _, _, curves, _ in panels for name in curves))
    colours = dict(zip(names, COLOURS, strict=False))
    width, height = PANEL * len(panels), HIGH + EDGE + FOOT
    body = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'font-family="sans-serif" font-size="10" fill="#333">',
        f'<rect width="{width}" height="{height}" fill="white"/>',
    ]
    for n, panel in enumerate(panels):
        body += _panel(n * PANEL + EDGE, panel, colours)
    for n, (name, colour) in enumerate(colours.items()):
        x = EDGE + n * 170
        y = height - 10
        body.append(f'<path d="M{x} {y - 3}h18" stroke="{colour}" stroke-width="2"/>')
        body.append(f'<text x="{x + 24}" y="{y}">{name}</text>')
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([*body, "</svg>", ""]), encoding="utf-8")


def _panel(
    left: int,
    panel: tuple[str, Sequence[float], Curves, float | None],
    colours: Mapping[str, str],
) -> list[str]:
    title, values, curves, default = panel
    wide, bottom = PANEL - EDGE - 14, EDGE + HIGH - 20

    def x_of(index: float) -> float:
        return left + wide * index / max(len(values) - 1, 1)

    def y_of(share: float) -> float:
        within = min(max((share - LOWEST) / (1 - LOWEST), 0.0), 1.0)
        return bottom - (bottom - EDGE) * within

    body = [f'<text x="{left}" y="{EDGE - 14}" font-size="12">{title}</text>']
    for share in (0.6, 0.7, 0.8, 0.9, 1.0):
        body.append(f'<path d="M{left} {y_of(share):.1f}h{wide}" stroke="#ddd"/>')
        body.append(f'<text x="{left - 26}" y="{y_of(share) + 3:.1f}">{share:.2f}</text>')
    for index, value in enumerate(values):
        bold = ' font-weight="bold"' if value == default else ""
        body.append(f'<text x="{x_of(index) - 6:.1f}" y="{bottom + 14}"{bold}>{value:g}</text>')
    for name, shares in curves.items():
        points = " ".join(f"{x_of(i):.1f},{y_of(s):.1f}" for i, s in enumerate(shares))
        body.append(
            f'<polyline points="{points}" fill="none" stroke="{colours[name]}" stroke-width="2"/>'
        )
    return body
