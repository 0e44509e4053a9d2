"""What the experiments share: scale, seed, fields, traces and textures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from flowtex.field import FlowField
from flowtex.rendering.cpu.noise_texture import NoiseImages
from flowtex.rendering.cpu.texture import LookupMaker
from flowtex.settings import Settings
from flowtex.textures.noise_textures import NoiseTextures
from flowtex.textures.texture_set import TextureSet
from flowtex.trace.store import SliceStore
from paper import data_sets

T = TypeVar("T")

#: The paper's own method: its noise texture and step texture, ten even contributions, backward.
#: ``noise`` and ``noise_correction`` select a :class:`NoiseTextures`; the latter is no setting.
PAPER: dict[str, Any] = {
    "noise": "texture",
    "samples": 10,
    "spacing": 1.0,
    "kernel": "box",
    "two_sided": False,
    "grain": 1.0,
}
#: What flowtex does when nothing is set.
OURS: dict[str, Any] = {}


@dataclass
class Bench:
    """Scale and seed of a run, and what is computed once for all experiments.

    Attributes
    ----------
    quick
        Whether to do the reduced form: smaller pictures, fewer particles, fewer views, and long
        paths of steady fields composed of short ones.
    seed
        Number that every random choice follows from.
    data
        Folder of the liquid-oxygen post; by default PyVista downloads it.
    """

    quick: bool = False
    seed: int = 0
    data: Path | None = None
    _cache: dict[Any, Any] = field(default_factory=dict, repr=False)

    def pick(self, full: T, quick: T) -> T:
        """Return the one or the other, by the scale of the run."""
        return quick if self.quick else full

    @property
    def rng(self) -> np.random.Generator:
        """Random numbers from the seed, the same ones each time it is requested."""
        return np.random.default_rng(self.seed)

    def once(self, key: Any, make: Callable[[], T]) -> T:
        """Return the value of a key, computed when it is first requested."""
        if key not in self._cache:
            self._cache[key] = make()
        value: T = self._cache[key]
        return value

    @property
    def post(self) -> FlowField | None:
        """The liquid-oxygen post, or ``None`` where its files cannot be had."""
        return self.once("post", lambda: data_sets.post(self.data))

    @property
    def shuttle(self) -> FlowField:
        """A curved surface of 52 x 62 nodes, in the shuttle's place."""
        return self.once("shuttle", data_sets.shuttle)

    @property
    def vortex(self) -> FlowField:
        """100 x 100 nodes over 31 time steps."""
        return self.once("vortex", data_sets.vortex)

    @property
    def published(self) -> dict[str, FlowField]:
        """The data sets of the paper's tables by name; without the post where it is missing."""
        fields = {"post": self.post, "shuttle": self.shuttle, "vortex": self.vortex}
        return {name: flow for name, flow in fields.items() if flow is not None}

    @property
    def gyre(self) -> FlowField:
        """Steady double gyre on a sheared, stretched grid; its flow is known at every point."""
        return self.once("gyre", data_sets.gyre)

    @property
    def stretched(self) -> FlowField:
        """The same flow on 52 x 62 nodes whose cells grow to the right and upwards."""
        return self.once("stretched", data_sets.stretched)

    def settings(self, **values: Any) -> Settings:
        """Return settings with the seed of the run."""
        own = {k: v for k, v in values.items() if k not in ("noise", "noise_correction")}
        return Settings(**{"seed": self.seed % 65536, **own})

    def textures(self, flow: FlowField, **values: Any) -> TextureSet:
        """Textures of a field, each kind built once; the field must be one of this bench."""
        settings = self.settings(**values)
        store = self.once(
            ("store", id(flow), settings.parameter),
            lambda: SliceStore(
                flow, parameter=settings.parameter, compose=self.quick and flow.steady
            ),
        )
        key = ("textures", id(flow), settings.parameter)
        plain = self.once(key, lambda: TextureSet.build(store))
        if values.get("noise") != "texture":
            return plain
        resolution, corrected = settings.resolution, values.get("noise_correction", True)

        def make() -> TextureSet:
            return plain.with_noise(resolution, settings.seed, corrected=corrected)

        return self.once((*key, resolution, corrected, settings.seed), make)

    def lookup(self, textures: TextureSet) -> LookupMaker | None:
        """Return the look-up of the paper's noise; ``None`` for textures without it."""
        noise = textures.image
        if not isinstance(noise, NoiseTextures):
            return None
        return self.once(("lookup", id(noise)), lambda: NoiseImages(noise).lookup)
