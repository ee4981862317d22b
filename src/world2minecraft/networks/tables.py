"""Scores as rows of a LaTeX table, in the columns of the World2Minecraft paper."""

from typing import Any

from world2minecraft.core.classes import CLASS_NAMES

_SPECIAL = {"_": r"\_", "%": r"\%", "&": r"\&", "#": r"\#", "$": r"\$", "{": r"\{", "}": r"\}"}


def latex_rows(scores: dict[str, Any], name: str) -> str:
    """Return a comment that names the columns, and a row a protocol, per cent.

    Example:
        >>> figures = {"iou": 0.5, "miou": 0.25, "precision": 1.0, "recall": 0.5}
        >>> figures["class_iou"] = dict.fromkeys(CLASS_NAMES, 0.1)
        >>> scores = {"protocols": {"iso": {"micro": figures}}}
        >>> latex_rows(scores, "net a").splitlines()[1][:30]
        'net a (iso) & 50.00 & 25.00 & '
    """
    lines = [f"% method & IoU & mIoU & precision & recall & {' & '.join(CLASS_NAMES)}"]
    for protocol, found in scores["protocols"].items():
        micro = found["micro"]
        values = [micro[key] for key in ("iou", "miou", "precision", "recall")]
        values += [micro["class_iou"][label] for label in CLASS_NAMES]
        cells = " & ".join(f"{100 * value:.2f}" for value in values)
        lines.append(f"{_escaped(f'{name} ({protocol})')} & {cells} \\\\")
    return "\n".join(lines) + "\n"


def _escaped(text: str) -> str:
    return "".join(_SPECIAL.get(sign, sign) for sign in text)
