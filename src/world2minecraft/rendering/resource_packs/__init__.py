"""The user's resource packs and client jars as a source of block models.

``pack_files`` opens and stacks packs, ``model_json`` reads block states and models, ``elements``
and ``texture_only_models`` convert them to elements, and ``textures`` decodes images.
"""

from world2minecraft.rendering.resource_packs.pack_models import ResourcePackModels

__all__ = ["ResourcePackModels"]
