"""A flow on display: field, slices, settings and time; tells what a change makes necessary.

:class:`FlowView` owns the arrays and knows no toolkit. Change goes down as a notice, data is
pulled: a renderer asks for :attr:`FlowView.textures` when it draws and gets new ones only when
traces or textures have changed.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.field.interpolation import steps_around
from flowtex.settings import TABLE, Affects, Settings, SettingsError
from flowtex.textures import TextureSet, as_picture
from flowtex.trace import SliceStore, TraceSlices, shared_store

__all__ = ["NO_IMAGE", "FlowView", "steps_of"]

Notice = Callable[[Affects], None]

#: Settings that lie in the textures of some kinds of noise, and elsewhere only in uniforms.
BAKED = {
    "seed": ("texture", "spots"),
    "tiles": ("checkerboard",),
    "resolution": ("texture", "spots", "checkerboard", "image"),
}

#: Values that differ by less than this share of the greatest are the same, and the share of it by
#: which their range is widened then.
SAME, WIDER = 1e-9, 0.05

NO_IMAGE = (
    "noise is 'image' and there is no image; give one as image=, or later with set_image(image)"
)


class FlowView:
    """One flow and how it is looked at.

    Parameters
    ----------
    field
        The flow.
    settings
        How it is drawn; changes are followed.
    slices
        Traces of the field, when they are at hand.
    image
        Image for ``noise="image"``, as :func:`~flowtex.textures.images.as_picture` takes it.

    Raises
    ------
    SettingsError
        When an image is asked for and there is none, or the image cannot be used.
    """

    def __init__(
        self,
        field: FlowField,
        settings: Settings | None = None,
        *,
        slices: TraceSlices | None = None,
        image: Any | None = None,
    ) -> None:
        self.field = field
        self.settings = settings or Settings()
        self._noise = self.settings.noise
        self._image = None if image is None else as_picture(image)
        if self._noise == "image" and self._image is None:
            raise SettingsError(NO_IMAGE)
        self._store: SliceStore | None = None
        if slices is not None:
            self._store = SliceStore(field, slices=slices)
        self._textures: TextureSet | None = None
        self._notices: list[Notice] = []
        self._time = float(field.times[-1])
        self._end = self.settings.observe(self._changed)

    @property
    def store(self) -> SliceStore:
        """Traces of the field, made step by step when asked for, shared by all its views."""
        if self._store is None:
            self._store = shared_store(self.field, self.settings.parameter)
        return self._store

    @property
    def textures(self) -> TextureSet:
        """What a renderer needs."""
        if self._textures is None:
            self._textures = TextureSet.build(self.store, self.settings, self._image)
        return self._textures

    @property
    def image(self) -> NDArray[np.float32] | None:
        """Texels of the image, (H, W, 4): colours times opacity, row 0 at the bottom."""
        return self._image

    def set_image(self, image: Any) -> None:
        """Lay an image on the surface in place of the noise; sets ``noise`` to ``"image"``.

        Parameters
        ----------
        image
            As :func:`~flowtex.textures.images.as_picture` takes it.

        Raises
        ------
        ImageError
            When it cannot be used; nothing is changed then.
        """
        self._image = as_picture(image)
        if self.settings.noise != "image":
            self.settings.noise = "image"
            return
        if self._textures is not None:
            self._textures = self._textures.with_image(self._image)
        self._tell("textures")

    @property
    def time(self) -> float:
        """Time that is shown, in the field's own unit, within its first and last step."""
        return self._time

    @time.setter
    def time(self, value: float) -> None:
        first, last = float(self.field.times[0]), float(self.field.times[-1])
        if not first <= value <= last:
            msg = f"time is {value!r}; expected {first:g} to {last:g}, the times of the field"
            raise ValueError(msg)
        self._time = float(value)
        self._tell("uniform")

    @property
    def moment(self) -> tuple[int, int, float]:
        """The two time steps around the time that is shown, and how far it is between them."""
        return steps_around(self.field.times, self._time)

    def scalar(self, name: str) -> NDArray[np.float64]:
        """Nodal values at the time that is shown, (J, I); ``"speed"`` is always there.

        Raises
        ------
        KeyError
            When there is no such array; the text lists those that exist.
        """
        steps = steps_of(self.field, name)
        before, after, late = self.moment
        if len(steps) == 1:
            return np.asarray(steps[0])
        return np.asarray(steps[before] * (1 - late) + steps[after] * late)

    def scalar_range(self, name: str) -> tuple[float, float]:
        """Least and greatest value over the valid nodes and all times.

        Where all are the same but for rounding, the range is widened, so that colours do not tell
        of differences that are none.
        """
        inside = steps_of(self.field, name)[:, self.field.valid]
        inside = inside[np.isfinite(inside)]
        if not inside.size:
            return 0.0, 1.0
        low, high = float(inside.min()), float(inside.max())
        size = max(abs(low), abs(high))
        if high - low > SAME * size:
            return low, high
        return (low - WIDER * size, high + WIDER * size) if size > 0 else (0.0, 1.0)

    def still(self) -> FlowView:
        """Return a view that shows the same, and that no later change of this one reaches.

        A thread can read it while this one goes on.
        """
        made = FlowView(self.field)
        made.settings, made._image, made._time = self.settings.copy(), self._image, self._time
        made._store, made._textures = self.store, self.textures
        return made

    def observe(self, notice: Notice) -> Callable[[], None]:
        """Call ``notice(affects)`` after each change; returns what ends it."""
        self._notices.append(notice)
        return lambda: self._notices.remove(notice) if notice in self._notices else None

    def close(self) -> None:
        """Let go of the settings."""
        self._end()
        self._notices.clear()

    def _changed(self, name: str, value: Any) -> None:
        if name == "noise":
            if value == self._noise:
                return
            if value == "image" and self._image is None:
                # A setting is told of when it is set; what cannot be drawn is set back.
                self.settings.noise = self._noise
                raise SettingsError(NO_IMAGE)
            self._noise = value
        affects = TABLE[name].affects
        if name in BAKED:
            affects = "textures" if self.settings.noise in BAKED[name] else "uniform"
        if affects == "trace":
            self._store = None
        if affects != "uniform":
            self._textures = None
        self._tell(affects)

    def _tell(self, affects: Affects) -> None:
        for notice in list(self._notices):
            notice(affects)


def steps_of(field: FlowField, name: str) -> NDArray[np.float64]:
    """Return nodal values at all times, (T or 1, J, I); ``"speed"`` is always there.

    Raises
    ------
    KeyError
        When there is no such array; the text lists those that exist.
    """
    if name in field.scalars:
        return field.scalars[name]
    if name == "speed":
        return field.speed
    known = ", ".join(repr(n) for n in ("speed", *field.scalars))
    msg = f"there is no scalar {name!r} on this field; there are {known}"
    raise KeyError(msg)
