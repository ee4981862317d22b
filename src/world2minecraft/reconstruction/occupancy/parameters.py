"""The parameters of networks: those that vote on depth, and those whose grids were saved."""

from dataclasses import dataclass

from world2minecraft.core.parameters import parameter
from world2minecraft.formats.class_ids import read_class_set
from world2minecraft.formats.predicted_grids import GridRules

AUTO, GENERATED = "auto", "generated"
BUILT_IN = (AUTO, "nyu", GENERATED)
WITHOUT_VOTES = ("", "none")  # Of ``semantics``.


@dataclass(frozen=True)
class OccupancyParameters:
    """Networks that vote on the surface points of depth; none is downloaded by default.

    semantics: Segmentation network for the images: ``auto`` or ``nyu`` for the built-in one,
        ``generated`` for one that was trained on generated rooms alone, an id such as
        ``hf:ORG/NAME`` or ``hf:FOLDER``, or ``none``. ``auto`` votes where depth is the
        evidence and an image was taken by a camera and has no labels.
    label_names: Path of a YAML file that maps label names of the network to classes.
    mono_votes: Whether the monocular network votes for the classes of surface points.
    network: Path of the ONNX file of the monocular network; empty for the built-in network.
    """

    semantics: str = parameter(AUTO)
    label_names: str = parameter("")
    mono_votes: bool = parameter(False)
    network: str = parameter("")


@dataclass(frozen=True)
class PredictionParameters:
    """Grids that another network predicted, used alone or beside depth.

    path: Folder with one file per view, or the file of one grid of the whole scene.
    convention: Program whose axes the files have: ``w2m``, ``monoscene``, ``iso``, ``embodiedocc``
        or ``sscnet``; empty to detect it where a file leaves no doubt.
    classes: Class ids of the files: ``nyu12``, ``embodied``, ``occscannet`` or a YAML file; empty
        to detect them.
    scores: Whether scores are ``probabilities`` or ``logits``.
    check: Whether grids are rejected whose axes, classes or poses contradict the capture.
    """

    path: str = parameter("")
    convention: str = parameter("")
    classes: str = parameter("")
    scores: str = parameter("probabilities")
    check: bool = parameter(True)

    def __post_init__(self):
        self.rules  # noqa: B018  # Raises UnknownNameError for an unknown name.
        if self.classes:
            read_class_set(self.classes)

    @property
    def rules(self) -> GridRules:
        """The rules by which the files are read."""
        return GridRules(self.convention, self.classes, self.scores)
