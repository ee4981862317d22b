"""The look of a piece of furniture: its parameters, options and materials.

A family builds its parts and blocks from a look. The look is a mapping of its parameters:
``look["seat_height"]`` is a number in metres, or a ratio.
"""

from collections.abc import Iterator, Mapping

from world2minecraft.furniture.materials import Material


class Look(Mapping[str, float]):
    """The parameters, options and materials of a template."""

    def __init__(
        self,
        name: str,
        parameters: Mapping[str, float],
        options: Mapping[str, str] | None = None,
        materials: Mapping[str, Material] | None = None,
    ):
        self.name = name
        self._parameters = dict(parameters)
        self._options, self._materials = dict(options or {}), dict(materials or {})

    def __getitem__(self, name: str) -> float:
        return self._parameters[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._parameters)

    def __len__(self) -> int:
        return len(self._parameters)

    def option(self, name: str) -> str:
        """Return the value that the design has for one of its family's options."""
        return self._options[name]

    def has(self, role: str, *shapes: str) -> bool:
        """Return whether the material of a role has blocks of all given shapes."""
        material = self._materials.get(role)
        return material is not None and all(material.block(shape) for shape in shapes)

    def state(self, role: str, shape: str = "full", **properties: str) -> str:
        """Return the block state of a role's material in a shape, such as ``minecraft:oak_slab``.

        Raises:
            ValueError: If the role has no material, or if its material does not have the shape.
        """
        material = self._materials.get(role)
        if material is None:
            raise ValueError(f"template {self.name} does not define the material of its {role}")
        block = material.block(shape)
        if block is None:
            raise ValueError(
                f"template {self.name} needs a {shape} for its {role}, but its material "
                f"{material.value} has none"
            )
        listed = ",".join(f"{key}={value}" for key, value in properties.items())
        return f"{block}[{listed}]" if listed else block
