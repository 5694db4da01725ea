"""Materials of a 3MF: a base material a body, or a composite of base resins where the mix is known."""

from typing import Any

from pneutouch.body import Body
from pneutouch.spec.material import Material


class Materials:
    """The material resources of one model, made as bodies need them.

    Args:
        wrapper: lib3mf.
        model: The model that takes the resources.
        materials: Those of its bodies: a group is made only where a body needs it.
    """

    def __init__(self, wrapper: Any, model: Any, materials: list[Material]) -> None:
        self._wrapper = wrapper
        self._group = model.AddBaseMaterialGroup()
        composed = any(is_composite(material) for material in materials)
        self._composites: Any = model.AddCompositeMaterials(self._group) if composed else None
        self._bases: dict[tuple[str, str], int] = {}

    def property_of(self, body: Body) -> tuple[int, int]:
        """Resource and property of a body's material, as an object-level property takes them."""
        material, intent = body.material, f"{body.role}: {body.material.label}"
        if not is_composite(material):
            return self._group.GetResourceID(), self._base(intent, material.colour)
        return self._composites.GetResourceID(), self._composite(intent, material)

    def _base(self, name: str, colour: str) -> int:
        """A base material, once for each name and colour: names are unique in a package."""
        if (name, colour) not in self._bases:
            shown = self._wrapper.RGBAToColor(*bytes.fromhex(colour[1:]), 255)
            self._bases[name, colour] = self._group.AddMaterial(name, shown)
        return self._bases[name, colour]

    def _composite(self, intent: str, material: Material) -> int:
        """A composite of base resins that show the digital material's colour: a viewer mixes the colours too."""
        import lib3mf

        assert material.mix is not None
        parts = []
        for resin in material.base_resins:
            part = lib3mf.CompositeConstituent()
            part.PropertyID = self._base(f"{intent}: {resin}", material.colour)
            part.MixingRatio = material.mix.fractions[resin]
            parts.append(part)
        return int(self._composites.AddComposite(parts))


def is_composite(material: Material) -> bool:
    """True if a material is written as a composite: mixed from several resins in known fractions."""
    return material.is_digital and material.mix is not None
