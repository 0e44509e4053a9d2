"""What the page tells about a point of the surface: a tip under the pointer, a card of its path.

Nothing here draws: numbers become words, and lists that can be sent as JSON.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.app.streaming.aim import ray
from flowtex.app.streaming.navigate import Navigator
from flowtex.app.streaming.places import BEYOND, project, runs
from flowtex.probe import PointValues, Probe, locate, values_at
from flowtex.scene import Scene

__all__ = ["Hover", "Lines", "PathCard", "number", "with_unit"]

Floats = NDArray[np.float64]
Hit = Callable[[float, float], "Floats | None"]
Lines = list[tuple[str, str]]

#: Digits of a position at zoom 1, and at most.
DIGITS, MOST_DIGITS = 4, 14
#: How many times as long as the part with samples the path is that is shown.
BEYOND_SAMPLES = 4.0
#: Units longer than this are left out.
LONGEST_UNIT = 12


def number(x: float, digits: int = DIGITS) -> str:
    """Write a number in a few digits, as the browser's client writes it."""
    if not np.isfinite(x):
        return "–"
    x += 0.0  # zero has no sign
    if digits <= DIGITS + 1 and x != 0 and not 1e-3 <= abs(x) < 1e5:
        mantissa, exponent = f"{x:.2e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    return np.format_float_positional(float(f"{x:.{digits}g}"), trim="-")


def with_unit(x: float, unit: str) -> str:
    """Write a number with its unit, where that is short enough."""
    return f"{number(x)} {unit}" if 0 < len(unit) <= LONGEST_UNIT else number(x)


class Hover:
    """Says what is under the pointer.

    Parameters
    ----------
    view
        The flow and the time that is shown.
    navigator
        What moves the camera.
    hit
        Tells which point of the surface is at a place of the view; asked for curved surfaces.
    """

    def __init__(self, view: Scene, navigator: Navigator, hit: Hit) -> None:
        self._view, self._navigator, self._hit = view, navigator, hit

    def __call__(self, x: float, y: float) -> Lines | None:
        """Return what there is to say, as words and numbers; ``None`` beside the surface.

        Parameters
        ----------
        x, y
            Place in the view from -1 to 1, to the right and up.
        """
        index = self.index(x, y)
        if index is None:
            return None
        read = values_at(self._view.field, index, self._view.time)
        lines = [("position", self._vector(read.position, read, digits=self._digits))]
        unit = read.speed_unit
        short = f" {unit}" if 0 < len(unit) <= LONGEST_UNIT else ""
        lines.append(("velocity", self._vector(read.velocity, read, digits=DIGITS) + short))
        lines.append(("speed", with_unit(read.speed, unit)))
        return lines + [(name, number(value)) for name, value in read.scalars.items()]

    def index(self, x: float, y: float) -> tuple[float, float] | None:
        """Place on the surface (j, i) at a place of the view; ``None`` beside it."""
        point = self.point(x, y)
        # A flat surface is met exactly: its border is where it is drawn.
        tolerance = 0.1 if self._view.field.surface.frame is None else 1e-6
        return None if point is None else locate(self._view.field, point, tolerance=tolerance)

    def point(self, x: float, y: float) -> Floats | None:
        """Point in space at a place of the view, in the plane of a flat surface also beside it."""
        surface = self._view.field.surface
        if surface.frame is None:
            return self._hit(x, y)
        start, along = ray(self._navigator, x, y)
        normal = np.cross(*surface.frame)
        toward = float(along @ normal)
        if abs(toward) < 1e-9:
            return None
        far = float((surface.center - start) @ normal) / toward
        return start + far * along if far > 0 else None

    @property
    def _digits(self) -> int:
        zoom = max(self._navigator.zoom, 1.0)
        return int(min(np.ceil(DIGITS + np.log10(zoom)), MOST_DIGITS))

    def _vector(self, vector: Floats, read: PointValues, *, digits: int) -> str:
        """Write a vector; a surface that lies across z has no third component."""
        surface = self._view.field.surface
        across = surface.frame is not None and not np.abs(surface.frame[:, 2]).any()
        size = float(np.abs(vector).max())
        least = 1e-9 * max(size, surface.extent if vector is read.position else size)
        shown = [0.0 if abs(v) < least else float(v) for v in vector[: 2 if across else 3]]
        return f"({', '.join(number(v, digits) for v in shown)})"


class PathCard:
    """A probe as the page shows it: a path over the picture, and a card beside it.

    Parameters
    ----------
    probe
        The probe.
    """

    def __init__(self, probe: Probe) -> None:
        self.probe = probe

    def over(self, navigator: Navigator) -> dict[str, Any]:
        """Return what lies over the picture as the camera now stands.

        Returns
        -------
        dict
            ``path`` and ``sampled``, stretches of places [x, y] of the whole path and of the part
            with samples; ``samples``, dicts of ``x``, ``y``, ``weight`` and ``grey``; ``point``,
            [x, y] or ``None``. Places go from -1 to 1 to the right and up.
        """
        probe = self.probe
        # Far beyond the samples the slices are too coarse to look at, and no picture needs them.
        near = np.abs(probe.path_lags) <= BEYOND_SAMPLES * float(np.abs(probe.lags).max())
        path, path_lags = project(navigator, probe.path[near]), probe.path_lags[near]
        inside = (path_lags <= probe.lags[0]) & (path_lags >= probe.lags[-1])
        places = project(navigator, probe.points)
        lags = np.concatenate([path_lags[inside], probe.lags])
        _, order = np.unique(-lags, return_index=True)
        sampled = np.concatenate([path[inside], places])[order]
        point = project(navigator, probe.field_values.position)
        return {
            "path": runs(path),
            "sampled": runs(sampled),
            "samples": [
                {"x": float(x), "y": float(y), "weight": bar["weight"], "grey": bar["grey"]}
                for (x, y), bar in zip(places, self.bars(), strict=True)
                if np.isfinite([x, y]).all() and max(abs(x), abs(y)) <= BEYOND
            ],
            "point": point.tolist() if np.isfinite(point).all() else None,
        }

    def bars(self) -> list[dict[str, Any]]:
        """Return the samples, from the farthest behind to the farthest ahead.

        Returns
        -------
        list of dict
            ``lag``; ``weight``, 1 for the greatest; ``grey``, the noise that is met, as a colour
            ``#rrggbb``; ``slices``, the two trace slices around the sample, and ``share``, how
            far it is from the first to the second.
        """
        probe = self.probe
        most = float(probe.weights.max())
        return [
            {
                "lag": float(lag),
                "weight": float(weight) / most,
                "grey": colour,
                "slices": [int(m) for m in slices],
                "share": float(share),
            }
            for lag, weight, colour, slices, share in zip(
                probe.lags, probe.weights, self._colours(), probe.slices, probe.shares, strict=True
            )
        ]

    def _colours(self) -> list[str]:
        """Colours of the samples: greys, or those of a picture over white."""
        probe = self.probe
        rgb = np.repeat(probe.greys[:, None], 3, axis=1)
        if probe.noise.ndim == 2:
            rgb = probe.noise[:, :3] + 1.0 - probe.noise[:, 3:]
        whole = np.rint(255 * np.clip(rgb, 0, 1)).astype(int)
        return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in whole.tolist()]

    def lines(self) -> Lines:
        """Return the card's lines, as words and numbers."""
        probe = self.probe
        length = probe.field_values.length_unit
        unit = length if probe.parameter == "arclength" else probe.field_values.time_unit
        count = len(probe.lags)
        ended = f" of {probe.asked}: the path ends" if count < probe.asked else ""
        pixels = f"{number(probe.grain / probe.pixel, 3)} pixels"
        lines = [
            ("samples", f"{count}{ended}"),
            ("level of detail", f"{probe.level:.2f}"),
            ("grain", f"{with_unit(probe.grain, length)}, {pixels}"),
            ("step", with_unit(probe.step, unit)),
            ("behind", with_unit(max(0.0, float(probe.lags[0])), unit)),
            ("ahead", with_unit(max(0.0, -float(probe.lags[-1])), unit)),
        ]
        if not isinstance(probe.value, float):
            return lines
        mean = float(probe.weights @ probe.noise)
        return [
            *lines,
            ("value", f"{mean:+.2f} × {probe.gain:.2f} = {probe.value:+.2f}"),
        ]

    def data(self) -> dict[str, Any]:
        """Return all that does not depend on the camera, for the page.

        Returns
        -------
        dict
            ``lines``, ``bars``; ``path`` and ``samples``, points [x, y, z] of the mesh, and
            ``point``, the one that was probed.
        """
        probe = self.probe
        return {
            "lines": [list(line) for line in self.lines()],
            "bars": self.bars(),
            "path": probe.path.tolist(),
            "samples": probe.points.tolist(),
            "point": probe.field_values.position.tolist(),
        }
