"""The look of one piece of furniture: its parameters, options and materials.

A family makes its parts and its blocks from a look. It reads as the mapping of its parameters, so
that ``look["seat_height"]`` is a number in metres or a share.
"""

from collections.abc import Iterator, Mapping

from world2minecraft.furniture.materials import Material


class Look(Mapping[str, float]):
    """The parameters, options and materials of one template."""

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
        """Return the choice that the design makes for one of its family's options."""
        return self._options[name]

    def has(self, role: str, *shapes: str) -> bool:
        """Whether a role's material has a block of each of these shapes."""
        material = self._materials.get(role)
        return material is not None and all(material.block(shape) for shape in shapes)

    def state(self, role: str, shape: str = "full", **properties: str) -> str:
        """Return the state of a role's material in a shape, such as ``minecraft:oak_slab[...]``.

        Raises:
            ValueError: the design gives the role no material, or one that has no such shape.
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
