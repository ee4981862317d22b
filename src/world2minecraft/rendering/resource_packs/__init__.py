"""Resource packs and client jars of the user as a source of block models.

``pack_files`` opens and stacks packs, ``model_json`` reads blockstates and models, ``elements`` and
``implicit_models`` make elements of them, ``textures`` decodes pictures.
"""

from world2minecraft.rendering.resource_packs.pack_models import ResourcePackModels

__all__ = ["ResourcePackModels"]
