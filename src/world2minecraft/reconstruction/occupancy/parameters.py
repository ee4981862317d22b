"""The parameters of networks that vote on the surface points of depth."""

from dataclasses import dataclass

from world2minecraft.core.parameters import parameter


@dataclass(frozen=True)
class OccupancyParameters:
    """Networks that vote on the surface points of depth; none is used or downloaded by default.

    semantics: Segmentation network for the colour images, such as ``hf:ORG/NAME`` or ``hf:FOLDER``.
    label_names: Path of a YAML file that maps label names of the network to classes.
    mono_votes: Whether the monocular network votes for the classes of surface points.
    network: Path of the ONNX file of the monocular network; empty for the built-in network.
    """

    semantics: str = parameter("")
    label_names: str = parameter("")
    mono_votes: bool = parameter(False)
    network: str = parameter("")
