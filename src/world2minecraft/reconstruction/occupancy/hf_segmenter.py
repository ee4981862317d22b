"""Universal and semantic segmentation models of the transformers library, by name or folder.

A universal model (Mask2Former, OneFormer, MaskFormer, EoMT) predicts masks and their labels; the
score of a label at a pixel is the sum of their products over all masks. A semantic model
(SegFormer, UPerNet, BEiT, DPT) predicts scores of labels at pixels. The scores of all labels of a
class are added and normalized over all labels.
"""

from functools import cached_property
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, InputError, first_line
from world2minecraft.external_models import transformers_hub as hub
from world2minecraft.external_models.transformers_hub import preprocess, single_thread

TASK = "the task is semantic"  # OneFormer takes its task as text.
TOKENIZER_FILES = ("tokenizer.json", "vocab.json")


class HuggingFaceSemantics:
    """A segmentation model from a model hub or a folder, run on one CPU thread.

    Only its configuration is read before the first prediction, so cached predictions do not load
    it.

    Raises:
        MissingExtraError: If torch or transformers is not installed.
        InputError: If the model cannot be loaded or is not a supported segmentation model.
    """

    def __init__(self, model: str):
        self._model = model
        self._transformers = hub.import_transformers("a segmenter")
        self.name = hub.display_name(model)
        config = hub.load_config(model, self._transformers)
        self._kind = _kind(model, config, self._transformers)
        names = getattr(config, "id2label", None) or {}
        self.labels = tuple(str(names[number]) for number in sorted(names))
        self.identity = hub.model_revision(model, self._transformers)
        self._config = config

    def predict(self, colour: np.ndarray, classes: np.ndarray) -> np.ndarray:
        """Predict class probabilities, float32 [h, w, 12]; see ``Segmenter``.

        Raises:
            InputError: If the network cannot be loaded or fails on this image.
        """
        network, ready = self._network, self._ready
        with single_thread() as torch:
            try:
                pixels = torch.from_numpy(preprocess(colour, ready))
                found = network(pixel_values=pixels, **self._told)
                scores = _label_scores(torch, found)  # [C, h, w]
            except (RuntimeError, ValueError) as error:
                reason = f"cannot run the network: {first_line(error)}"
                raise InputError(self.name, reason) from None
            if scores.shape[0] != len(classes):
                raise DamagedFileError(
                    self._model,
                    f"predicts {scores.shape[0]} labels but its configuration names {len(classes)}",
                )
            summed = torch.einsum("chw,ck->hwk", scores, torch.from_numpy(classes))
            total = scores.sum(dim=0).clamp_min(1e-6)[..., None]
            return (summed / total).to(torch.float32).numpy()

    @cached_property
    def _network(self) -> Any:
        return hub.load_network(self._model, self._kind)

    @cached_property
    def _ready(self) -> dict[str, Any]:
        ready = hub.load_preprocessor(self._model, self._transformers)
        if str(self._config.model_type).startswith("eomt"):  # It expects square images.
            side = self._config.image_size
            ready = {**ready, "size": {"width": side, "height": side}}
        return ready

    @cached_property
    def _told(self) -> dict[str, Any]:
        """The additional inputs of the network besides the image."""
        if self._config.model_type != "oneformer":
            return {}
        import torch  # noqa: PLC0415  # pyright: ignore[reportMissingImports]

        if not hub.has_file(self._model, TOKENIZER_FILES, self._transformers):
            raise InputError(
                self._model,
                f"contains no tokenizer file ({', '.join(TOKENIZER_FILES)}); download the complete "
                "model",
            )
        try:
            words = self._transformers.AutoTokenizer.from_pretrained(self._model)
            length = getattr(self._config, "task_seq_len", None) or 77
            encoded = words([TASK], padding="max_length", max_length=length, truncation=True)
        except Exception as error:  # The library raises many kinds.
            raise InputError(
                self._model, f"cannot load the tokenizer: {first_line(error)}"
            ) from None
        tokens = np.array(encoded["input_ids"]) * np.array(encoded["attention_mask"])
        return {"task_inputs": torch.from_numpy(tokens)}


def _kind(model: str, config: Any, transformers: Any) -> Any:
    """Return the class of the library that loads a segmentation model."""
    architecture = (getattr(config, "architectures", None) or [""])[0]
    families = transformers.models.auto.modeling_auto
    universal = families.MODEL_FOR_UNIVERSAL_SEGMENTATION_MAPPING_NAMES
    semantic = families.MODEL_FOR_SEMANTIC_SEGMENTATION_MAPPING_NAMES
    if config.model_type in universal and architecture in ("", universal[config.model_type]):
        return transformers.AutoModelForUniversalSegmentation
    if config.model_type in semantic and architecture in ("", semantic[config.model_type]):
        return transformers.AutoModelForSemanticSegmentation
    raise InputError(
        model,
        f"is not a supported segmentation model: {architecture or config.model_type}; supported: "
        f"{', '.join(sorted({**universal, **semantic}))}",
    )


def _label_scores(torch: Any, found: Any) -> Any:
    """Return the non-negative scores of labels at pixels, [C, h, w]."""
    masks = getattr(found, "masks_queries_logits", None)
    if masks is None:
        return torch.softmax(found.logits[0].float(), dim=0)
    kinds = torch.softmax(found.class_queries_logits[0].float(), dim=-1)[:, :-1]
    return torch.einsum("qc,qhw->chw", kinds, torch.sigmoid(masks[0].float()))
