"""What is drawn of a flow, which goes from the scene to the surface that draws it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from flowtex._util.array_types import Floats
from flowtex.field import FlowField
from flowtex.field.derived.shared import shared_steps
from flowtex.field.interpolation import at_moment
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.pyramid import Pyramid

#: The two time steps around a time, and how far it is between them, as ``steps_around`` has it.
Moment: TypeAlias = tuple[int, int, float]


@dataclass(frozen=True)
class ColourValues:
    """The values at one moment of the scalar that colours a surface."""

    name: str
    on_cells: bool
    moment: Moment

    def of(self, field: FlowField) -> Floats:
        """Return the values, (J, I), for a field, for a part of it, or for a coarser level."""
        return at_moment(shared_steps(field, self.name), self.moment)


@dataclass(frozen=True, eq=False)
class DrawnFlow:
    """One picture of a flow, apart from settings, which are uniforms, and the camera."""

    textures: TextureSet
    pyramid: Pyramid | None  #: The tiles of a large surface.
    moment: Moment
    colours: ColourValues | None  #: ``None`` for a surface in one colour.

    def has_textures_of(self, other: DrawnFlow) -> bool:
        """Return whether another picture has the same textures and tiles."""
        return self.textures is other.textures and self.pyramid is other.pyramid
