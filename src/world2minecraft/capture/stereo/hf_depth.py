"""Depth networks of the transformers library, by name or from a folder."""

import numpy as np
from PIL import Image

from world2minecraft.capture.stereo.monocular_depth import Kind
from world2minecraft.core.errors import InputError, first_line
from world2minecraft.core.types import Camera
from world2minecraft.external_models import transformers_hub as hub
from world2minecraft.external_models.transformers_hub import preprocess, single_thread

# Models that give metres without saying so in their config. DepthPro gives inverse depth.
METRIC_TYPES = ("zoedepth", "glpn")


class HuggingFaceDepth:
    """A depth network from a model hub or a folder, run on the CPU in single precision.

    Raises:
        MissingExtraError: If torch or transformers is not installed.
        InputError: If the model cannot be downloaded, is of another type or lacks weights.
    """

    kind: Kind

    def __init__(self, model: str):
        transformers = hub.import_transformers("a depth model")
        self.name = hub.display_name(model)
        self._ready = hub.load_preprocessor(model, transformers)
        self._network = hub.load_network(model, transformers.AutoModelForDepthEstimation)
        config = self._network.config
        states_metres = getattr(config, "depth_estimation_type", None) == "metric"
        metric = states_metres or config.model_type in METRIC_TYPES
        self.kind = "metric" if metric else "inverse"

    def predict(self, colour: np.ndarray, camera: Camera) -> np.ndarray:
        """Predict the depth of an image, uint8 [H, W, 3], as float32 [H, W], without its camera.

        Raises:
            InputError: If the network does not support images of this size.
        """
        with single_thread() as torch:
            try:
                pixels = torch.from_numpy(preprocess(colour, self._ready))
                found = self._network(pixel_values=pixels).predicted_depth
            except RuntimeError as error:
                reason = f"cannot process the image: {first_line(error)}"
                raise InputError(self.name, reason) from None
            values = found.reshape(found.shape[-2:]).to(torch.float32).numpy()
        size = (colour.shape[1], colour.shape[0])
        return np.array(Image.fromarray(values).resize(size, Image.Resampling.BILINEAR))
