"""The completion network as it is run: ONNX in, chances out, a large grid in tiles."""

from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.errors import DamagedFileError, first_line
from world2minecraft.core.files import read_bytes
from world2minecraft.reconstruction.semantics.completion_channels import (
    CHANNELS,
    Sight,
    network_input,
)

WEIGHTS = Path(__file__).parents[2] / "weights" / "completion.onnx"
LEARNT_VOXEL_M, VOXEL_TOLERANCE = 0.08, 0.25  # Other cells look like other things.
MULTIPLE = 8  # Of the sides that the network takes.
TILE, MARGIN = 96, 16  # Cells: a room is one tile; what lies at a tile's edge sees less around it.
MAX_BYTES = 64 << 20
THREADS = 2
HALF = 0.5


class CompletionModel:
    """The network of a file. The file is read when the first chances are asked for."""

    def __init__(self, weights: Path | None = None):
        self.weights = weights or WEIGHTS

    @cached_property
    def _session(self) -> Any:
        import onnxruntime  # noqa: PLC0415  # Half a second that other labellers do not need.

        data = read_bytes(self.weights, MAX_BYTES)
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = THREADS
        options.log_severity_level = 3
        options.enable_cpu_mem_arena = False
        try:
            session = onnxruntime.InferenceSession(
                data, options, providers=["CPUExecutionProvider"]
            )
        except Exception as error:  # onnxruntime has no exception tree of its own.
            raise DamagedFileError(self.weights, f"is no network: {first_line(error)}") from error
        taken = session.get_inputs()[0].shape
        if len(taken) != 5 or taken[1] != CHANNELS:
            raise DamagedFileError(
                self.weights, f"takes {taken}; this version gives {CHANNELS} channels of cells"
            )
        return session

    def chances(self, sight: Sight) -> np.ndarray:
        """Return float32 [12, X, Y, Z], the chance of each class of each cell.

        Raises:
            InputError: the weights are not there. DamagedFileError: they are none.
        """
        cells = network_input(sight)
        shape = cells.shape[1:]
        result = np.zeros((CLASS_COUNT, *shape), np.float32)
        for x in spans(shape[0]):
            for y in spans(shape[1]):
                logits = self._logits(cells[:, x[0] : x[3], y[0] : y[3]])
                inner = logits[:, x[1] - x[0] : x[2] - x[0], y[1] - y[0] : y[2] - y[0]]
                result[:, x[1] : x[2], y[1] : y[2]] = softmax(inner)
        return result

    def _logits(self, cells: np.ndarray) -> np.ndarray:
        """Return the logits of one tile, padded with unknown cells to whole multiples."""
        shape = cells.shape[1:]
        padding = [(0, -side % MULTIPLE) for side in shape]
        padded = np.pad(cells, [(0, 0), *padding])
        padded[2] = np.pad(cells[2], padding, constant_values=1)
        (logits,) = self._session.run(None, {self._session.get_inputs()[0].name: padded[None]})
        return logits[0, :, : shape[0], : shape[1], : shape[2]]


def likeliest(chance: np.ndarray, log_odds: np.ndarray) -> np.ndarray:
    """Return uint8 [X, Y, Z]: what each cell most likely is, observed surface kept.

    Surface takes the likeliest of the eleven classes. Any other cell is solid where its classes
    together are likelier than empty; so are more rooms whole than by the single best class.

    Args:
        chance: float32 [12, X, Y, Z].
        log_odds: [X, Y, Z]; above 0 where surface was observed.
    """
    best = chance[1:].argmax(axis=0).astype(np.uint8) + 1
    solid = (log_odds > 0) | (chance[0] < HALF)
    return np.where(solid, best, np.uint8(0))


def spans(length: int) -> list[tuple[int, int, int, int]]:
    """Return how a side is cut: first and last cell looked at, and those kept, of each tile.

    Example:
        >>> spans(100)
        [(0, 0, 100, 100)]
        >>> spans(200)
        [(0, 0, 67, 83), (51, 67, 133, 149), (117, 133, 200, 200)]
    """
    count = 1 if length <= TILE + MARGIN else -(-length // TILE)
    edges = [round(length * n / count) for n in range(count + 1)]
    return [(max(a - MARGIN, 0), a, b, min(b + MARGIN, length)) for a, b in pairwise(edges)]


def softmax(logits: np.ndarray) -> np.ndarray:
    """Return chances of logits along the first axis."""
    shares = np.exp(logits - logits.max(axis=0))
    return shares / shares.sum(axis=0)
