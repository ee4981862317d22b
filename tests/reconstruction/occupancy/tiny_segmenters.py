"""Segmenters of the transformers library with a few thousand weights, saved as such models are."""

import json
from pathlib import Path
from typing import Any

NAMES = ["wall", "floor, flooring", "bed ", "chair", "sofa", "sky", "gizmo"]
READY = {
    "do_resize": True, "size": {"height": 64, "width": 64}, "resample": 2, "do_rescale": True,
    "rescale_factor": 1 / 255, "do_normalize": True, "image_mean": [0.5, 0.5, 0.5],
    "image_std": [0.5, 0.5, 0.5],
}  # fmt: skip
KINDS = ("segformer", "mask2former", "maskformer", "oneformer", "upernet", "eomt", "beit", "dpt")


def write_segmenter(kind: str, folder: Path, seed: int = 0) -> Path:
    """Save a model of a kind with weights that are drawn by a seed."""
    import torch
    import transformers

    torch.manual_seed(seed)
    names = {"id2label": dict(enumerate(NAMES)), "label2id": {n: i for i, n in enumerate(NAMES)}}
    model = MAKERS[kind](transformers, names)
    # Drawn weights of some heads are all but 0, and every pixel would look alike.
    for weight in model.parameters():
        if weight.dim() > 1:
            torch.nn.init.xavier_normal_(weight, gain=1.3)
    model.eval().save_pretrained(folder)
    (folder / "preprocessor_config.json").write_text(json.dumps(READY))
    if kind == "oneformer":
        _write_tokenizer(folder)
    return folder


def _swin(t: Any) -> Any:
    return t.SwinConfig(
        image_size=64, embed_dim=8, depths=[1, 1, 1, 1], num_heads=[1, 1, 2, 2], window_size=4,
        out_features=["stage1", "stage2", "stage3", "stage4"],
    )  # fmt: skip


def _segformer(t: Any, names: dict) -> Any:
    return t.SegformerForSemanticSegmentation(
        t.SegformerConfig(
            depths=[1, 1, 1, 1], hidden_sizes=[8, 8, 16, 16], num_attention_heads=[1, 1, 2, 2],
            decoder_hidden_size=16, **names,
        )
    )  # fmt: skip


def _mask2former(t: Any, names: dict) -> Any:
    return t.Mask2FormerForUniversalSegmentation(
        t.Mask2FormerConfig(
            backbone_config=_swin(t), feature_size=32, mask_feature_size=32, hidden_dim=32,
            encoder_feedforward_dim=16, encoder_layers=1, decoder_layers=2, num_attention_heads=2,
            dim_feedforward=16, num_queries=5, **names,
        )
    )  # fmt: skip


def _maskformer(t: Any, names: dict) -> Any:
    decoder = t.DetrConfig(
        d_model=16, encoder_layers=1, decoder_layers=1, encoder_ffn_dim=16, decoder_ffn_dim=16,
        encoder_attention_heads=2, decoder_attention_heads=2, num_queries=5,
    )  # fmt: skip
    return t.MaskFormerForInstanceSegmentation(
        t.MaskFormerConfig(
            backbone_config=_swin(t), decoder_config=decoder, fpn_feature_size=32,
            mask_feature_size=32, **names,
        )
    )  # fmt: skip


def _oneformer(t: Any, names: dict) -> Any:
    return t.OneFormerForUniversalSegmentation(
        t.OneFormerConfig(
            backbone_config=_swin(t), num_queries=5, conv_dim=32, mask_dim=32, hidden_dim=32,
            encoder_feedforward_dim=16, encoder_layers=1, decoder_layers=2, num_attention_heads=2,
            dim_feedforward=16, text_encoder_width=16, text_encoder_num_layers=1,
            text_encoder_vocab_size=49408, text_encoder_context_length=77, task_seq_len=77,
            max_seq_len=77, query_dec_layers=1, common_stride=4, is_training=False, **names,
        )
    )  # fmt: skip


def _upernet(t: Any, names: dict) -> Any:
    return t.UperNetForSemanticSegmentation(
        t.UperNetConfig(
            backbone_config=_swin(t), hidden_size=16, use_auxiliary_head=False, pool_scales=[1, 2],
            **names,
        )
    )  # fmt: skip


def _eomt(t: Any, names: dict) -> Any:
    return t.EomtForUniversalSegmentation(
        t.EomtConfig(
            hidden_size=16, num_hidden_layers=2, num_attention_heads=2, mlp_ratio=2, image_size=64,
            patch_size=16, num_queries=5, num_blocks=1, num_upscale_blocks=1, **names,
        )
    )  # fmt: skip


def _beit(t: Any, names: dict) -> Any:
    return t.BeitForSemanticSegmentation(
        t.BeitConfig(
            hidden_size=16, num_hidden_layers=4, num_attention_heads=2, intermediate_size=16,
            image_size=64, patch_size=16, out_indices=[1, 2, 3, 4], use_auxiliary_head=False,
            **names,
        )
    )  # fmt: skip


def _dpt(t: Any, names: dict) -> Any:
    return t.DPTForSemanticSegmentation(
        t.DPTConfig(
            hidden_size=16, num_hidden_layers=4, num_attention_heads=2, intermediate_size=16,
            image_size=64, patch_size=16, backbone_out_indices=[0, 1, 2, 3],
            neck_hidden_sizes=[8, 8, 8, 8], fusion_hidden_size=8, use_auxiliary_head=False, **names,
        )
    )  # fmt: skip


MAKERS = {
    "segformer": _segformer,
    "mask2former": _mask2former,
    "maskformer": _maskformer,
    "oneformer": _oneformer,
    "upernet": _upernet,
    "eomt": _eomt,
    "beit": _beit,
    "dpt": _dpt,
}


def _write_tokenizer(folder: Path) -> None:
    """A tokenizer of letters, in the form that CLIP's has."""
    letters = "abcdefghijklmnopqrstuvwxyz"
    words = [*letters, *(f"{letter}</w>" for letter in letters)]
    words += ["<|startoftext|>", "<|endoftext|>"]
    (folder / "vocab.json").write_text(json.dumps({word: i for i, word in enumerate(words)}))
    (folder / "merges.txt").write_text("#version: 0.2\n")
    (folder / "tokenizer_config.json").write_text(
        json.dumps({"tokenizer_class": "CLIPTokenizer", "model_max_length": 77})
    )
