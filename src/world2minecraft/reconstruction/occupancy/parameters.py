"""What joins the evidence of views beside their depth: networks that are asked for by name."""

from dataclasses import dataclass

from world2minecraft.core.parameters import parameter


@dataclass(frozen=True)
class OccupancyParameters:
    """Networks that vote on what depth sees; none by default, and nothing is downloaded.

    semantics: a network that says what each pixel shows, such as ``hf:ORG/NAME`` or ``hf:FOLDER``.
    label_names: a YAML file of one's own that says which class a network's label names mean.
    mono_votes: the monocular network votes for the classes of what depth sees.
    network: its ONNX file; that which is shipped where empty.
    """

    semantics: str = parameter("")
    label_names: str = parameter("")
    mono_votes: bool = parameter(False)
    network: str = parameter("")
