"""The scene: a field, its appearance, its settings and the time shown.

:class:`Scene` owns the arrays and knows no toolkit. It notifies of a change, and data is pulled:
a renderer asks for :attr:`Scene.textures` when it draws and gets new ones only when traces
or textures have changed. Scenes of one field share its traces, and textures where the settings
that lie in them are the same.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from flowtex._util.arguments import brief, is_number
from flowtex._util.array_types import Bytes, Floats, Floats32
from flowtex._util.cache import WeakCache, digest
from flowtex._util.colours import (
    ZERO_SHARE,
    ColourScale,
    is_diverging,
    rounded_ends,
    scale_of,
    with_limits,
)
from flowtex.errors import FieldError, notify
from flowtex.field import FlowField
from flowtex.field.dates import time_within
from flowtex.field.derived.kinds import SIGNED
from flowtex.field.derived.shared import shared_steps, with_scalars
from flowtex.field.folds import FOLDED, mixes_at_folds
from flowtex.field.interpolation import at_moment, steps_around
from flowtex.field.options import FieldOptions, option_names
from flowtex.field.steps import LazySteps, Steps
from flowtex.rendering.cpu.shade import mean_colours
from flowtex.rendering.drawn_flow import ColourValues, DrawnFlow
from flowtex.rendering.structure import STRUCTURE, Structure, check_structure, shared_structure
from flowtex.scene.fields import is_tiled, read_field, share_field
from flowtex.scene.options import ROBUST, SPEED, Appearance, Options
from flowtex.settings import TABLE, Affects, Settings, SettingsError, Signal
from flowtex.textures.images import as_picture, load_image
from flowtex.textures.texture_set import TextureSet, check_noise
from flowtex.textures.tiles.pyramid import Pyramid
from flowtex.textures.tiles.shared import coarsened_field, shared_pyramid
from flowtex.textures.value_ranges import drawn_speeds, ends_of, usual_ends, valued_places, widened
from flowtex.trace.slices import TraceSlices
from flowtex.trace.store import SliceStore, chosen_lines, shared_store

#: The kind of a change: what a setting affects, or the appearance.
Change = Affects | Literal["appearance"]

#: Settings that change the texture of ``noise="texture"``, and otherwise only uniforms.
IN_NOISE_TEXTURE = ("seed", "resolution")

NO_IMAGE = "noise is 'image', but no image is given; pass image=, or call set_image(image)"


class Scene:
    """One flow, its appearance and its settings.

    It follows changes of the settings; the image of the appearance is advected where
    ``noise="image"``. Traces of the field may be given as ``slices``, and texels in place of that
    image, (H, W, 4): colours times opacity, row 0 at the bottom. Raises a SettingsError when
    an image is missing or cannot be used, and a FieldError when a scalar does not exist.
    """

    def __init__(
        self,
        field: FlowField,
        settings: Settings | None = None,
        appearance: Appearance | None = None,
        *,
        slices: TraceSlices | None = None,
        image: Floats32 | None = None,
    ) -> None:
        self.settings = settings or Settings()
        self._appearance = appearance or Appearance.of()
        self._given = field  # without scalars that only the colours need
        self.field = with_scalars(field, self._appearance.scalar_name)
        self.image = image
        if image is None and self.appearance.image is not None:
            self.image = as_picture(load_image(self.appearance.image))
        if self.settings.noise == "image" and self.image is None:
            raise SettingsError(NO_IMAGE)
        check_noise(field, self.settings.noise)
        check_structure(field, self.settings)
        self._structure: Structure | None = None
        self._lacks: dict[tuple[str, bool], bool] = {}
        self._ranges: dict[tuple[str, bool, bool], tuple[float, float]] = {}
        self._kept: dict[tuple[str, bool], tuple[float, float]] = {}
        self._pyramid: Pyramid | None = None
        self._sliced = slices
        self._check_colours(self._appearance)
        self._noise = self.settings.noise
        self._store: SliceStore | None = None
        if slices is not None:
            self._store = SliceStore(field, slices=slices)
        self._textures: TextureSet | None = None
        self._version = 0  # of the textures
        self._changed = Signal()
        self._show_time(field.first_time)
        self._end = self.settings.observe(self._setting_changed)

    @classmethod
    def of(cls, mesh: Any, **options: Any) -> Scene:
        """Return the scene of a mesh or a field, from the arguments of one call.

        These are fields of :class:`FieldOptions` and :class:`Appearance`, and settings. Raises a
        FieldError, SettingsError or ImageError where one does not fit.
        """
        return make_scenes(mesh, Options.split("field", "appearance", **options))[0]

    def beside(self, changes: Mapping[str, Any], field: FlowField | None = None) -> Scene:
        """Return a second scene of the same field, or of another one, with some changes.

        ``changes`` are fields of :class:`Appearance` and settings. With :func:`link_scenes`, later
        changes of all others apply to both scenes.

        Raises
        ------
        FieldError
            When the changes choose data, or cannot be drawn.
        """
        field_names = []
        for name in option_names(FieldOptions):
            if name in changes:
                field_names.append(name)
        if field_names:
            raise FieldError(
                f"beside has {', '.join(field_names)}, which selects data; both views show the "
                "same field, so expected settings"
            )
        field = field or self._given
        settings = dict(self.settings)
        if "image" in changes:  # an image keeps its own colours
            del settings["noise"], settings["strength"]
        options = Options.split("appearance", **{**settings, **changes})
        chosen = {}
        for n, v in vars(options.appearance).items():
            if n in changes:
                chosen[n] = v
        look = _look_beside(self, chosen, field)
        if "image" in chosen:
            image = None
        else:
            image = self.image
        slices = self._sliced
        if field is not self._given or any(map(is_traced_by, changes)):
            slices = None
        scene = Scene(field, options.make_settings(), look, image=image, slices=slices)
        scene._kept = self._kept
        return scene

    @property
    def appearance(self) -> Appearance:
        """How the surface looks; set another one to change it and notify observers.

        Raises the errors of the constructor, and then nothing changes.
        """
        return self._appearance

    @appearance.setter
    def appearance(self, value: Appearance) -> None:
        """Draw by another appearance; after an error the present one stays.

        Raises
        ------
        FieldError
            When the scalar does not exist, or colours or the image cannot be used.
        """
        before = self.field
        if value.scalar_name not in (SPEED, *before.scalars):
            self.field = with_scalars(self._given, value.scalar_name)
        same_image = value.image is None or value.image is self._appearance.image
        try:
            self._check_colours(value)
            if same_image:
                picture = None
            else:
                picture = self._picture(value.image)
        except BaseException:
            self.field = before
            raise
        has_new_tiles = before is not self.field and self.pyramid is not None
        if has_new_tiles:
            self._pyramid = self._store = self._textures = None
        self._appearance = value
        if picture is not None:
            self._lay(picture)
        if has_new_tiles:  # which have the values of the new scalar
            self._changed.emit("trace")
        self._changed.emit("appearance")

    @property
    def is_lit(self) -> bool:
        """Whether the surface is lit; by default a curved one is, unless it is the Earth's.

        A globe is a map: its colours are those of the colour bar as far as the limb.
        """
        lighting = self.appearance.lighting
        if lighting is not None:
            return lighting
        surface = self.whole.surface
        return surface.frame is None and not surface.on_globe

    @property
    def has_bar(self) -> bool:
        """Whether there is a legend; by default there is, unless an image covers the colours."""
        shown = self.appearance.show_scalar_bar
        if shown is None:
            shown = self.settings.noise != "image"
        return shown and self.appearance.visible

    @property
    def scalar_name(self) -> str | None:
        """Name of the scalar that colours the surface; ``None`` for a plain one."""
        return self.appearance.scalar_name

    @property
    def scalar_names(self) -> tuple[str, ...]:
        """Names of the scalars that can colour the surface, with the one that does."""
        names = dict.fromkeys((SPEED, *self._given.scalars))
        if self.scalar_name is not None:
            names[self.scalar_name] = None
        return tuple(names)

    def title_of(self, name: str) -> str:
        """Return the title of a legend: words and unit."""
        unit = self.field.unit_of(name)
        label = self.whole.label_of(name)
        if unit:
            return f"{label} ({unit})"
        return label

    @property
    def scalar_limits(self) -> tuple[float, float]:
        """Values at the ends of the colour map."""
        return self._limits(self.appearance)

    @property
    def has_own_range(self) -> bool:
        """Whether the automatic colour range comes from this flow, not from one before."""
        return not any(name == self.scalar_name for name, _ in self._kept)

    @property
    def colour_scale(self) -> ColourScale:
        """The colours of the scalars, by which all renderers draw."""
        return scale_of(self.appearance, self._limits(self.appearance))

    @property
    def legend_colours(self) -> Bytes:
        """The colour map as a legend shows it, (N, 4): as the picture does on average."""
        return mean_colours(self.colour_scale.table, self.settings)

    @property
    def legend_limits(self) -> tuple[float, float]:
        """The same as a legend shows them: an end that is 0 up to rounding is 0."""
        return rounded_ends(*self.scalar_limits, log_scale=self.appearance.log_scale)

    @property
    def lines(self) -> str:
        """Lines along which the texture is drawn: ``"pathlines"`` or ``"streamlines"``."""
        if self._sliced is not None:
            return "pathlines"
        return chosen_lines(self.field, self.settings.lines)

    @property
    def pyramid(self) -> Pyramid | None:
        """The tiles of a large field; ``None`` where all of it is traced together.

        Noise in a texture, and a sign-free field, are not drawn in tiles.
        """
        if self._sliced is not None or not is_tiled(self.field, self.settings):
            return None
        if self._pyramid is None:
            self._pyramid = shared_pyramid(self.field, self.settings.parameter, self.lines)
        if self._pyramid.depth:
            return self._pyramid
        return None

    @property
    def whole(self) -> FlowField:
        """The field that is drawn when all of it is in view: of a large one, its coarsest level."""
        if self.pyramid is None:
            return self.field
        return self.pyramid.root

    @property
    def structure(self) -> Structure:
        """Critical points and separatrices of each step, which scenes of a field share."""
        self._structure = shared_structure(self.field)
        return self._structure

    @property
    def store(self) -> SliceStore:
        """Traces of :attr:`whole`, made step by step on request, shared by all its scenes."""
        if self._store is None:
            self._store = shared_store(self.whole, self.settings.parameter, self.lines)
        return self._store

    @property
    def textures(self) -> TextureSet:
        """The texture set for the current settings."""
        textures = self._textures
        version = self._version
        if textures is None:
            store = self.store
            pyramid = self.pyramid
            image = None
            noise_size: tuple[int, int] | None = None
            # Textures keep their store alive, so its id is unique while they live.
            key: tuple[object, ...] = (id(store),)
            if self.settings.noise == "image":
                image = self.image
                assert image is not None
                key += (digest(image),)
            elif self.settings.noise == "texture":
                noise_size = (self.settings.resolution, self.settings.seed)
                key += noise_size

            def make() -> TextureSet:
                if pyramid:
                    return pyramid.root_textures(store)
                made = TextureSet.build(store, image)
                if noise_size is not None:
                    made = made.with_noise(*noise_size)
                return made

            textures = _textures.get(key, make)
            if version == self._version:  # no other thread has changed a setting meanwhile
                self._textures = textures
        return textures

    @property
    def drawn(self) -> DrawnFlow:
        """What is drawn at the time that is shown."""
        name = self.scalar_name
        colours = None
        if name is not None:
            colours = ColourValues(name, name in self.field.on_cells, self.moment)
        return DrawnFlow(self.textures, self.pyramid, self.moment, colours)

    def set_image(self, image: Any) -> None:
        """Lay an image, as :class:`Appearance` has it, in place of the noise on the surface.

        It sets ``noise`` to ``"image"``. Raises an ImageError when it cannot be used, and a
        SettingsError for a surface of triangles; nothing is changed then.
        """
        self._lay(self._picture(image))

    def _picture(self, image: Any) -> Floats32:
        """Return the texels of an image; raise an error if the surface takes none."""
        check_noise(self.field, "image")
        return as_picture(load_image(image))

    def _lay(self, picture: Floats32) -> None:
        """Show an image, as texels, in place of the noise."""
        self.image = picture
        if self.settings.noise != "image":
            self.settings.noise = "image"
            return
        if self._textures is not None:
            self._textures = self._textures.with_image(self.image)
        self._changed.emit("textures")

    @property
    def time(self) -> float:
        """Time shown, in the field's own unit, within its first and last step.

        If the field's times count from a date, it can be set to a date or the text of one.
        """
        return self._time

    @time.setter
    def time(self, value: Any) -> None:
        if self.field.steady and self.field.start is None:
            if not (is_number(value) and value == self._time):
                text = brief(value)
                notify(f"time is {text}, but the field is steady: it is the same at all times")
            return
        self._show_time(time_within(self.field.start, self.field.times, value))
        self._changed.emit("uniform")

    def _show_time(self, time: float) -> None:
        self._time = time
        #: The two time steps around the time that is shown, and how far it is between them.
        self.moment = steps_around(self.field.times, time)

    @property
    def step(self) -> int:
        """The time step that is nearest to the time that is shown."""
        before, after, share = self.moment
        if share < 0.5:
            return before
        return after

    def scalar(self, name: str, field: FlowField | None = None) -> Floats:
        """Values at the time that is shown, (J, I); :func:`steps_of` has the errors.

        ``field`` may be a part of the scene's field, or a coarser form of it.
        """
        return at_moment(self.scalar_steps(name, field), self.moment)

    def scalar_steps(self, name: str, field: FlowField | None = None) -> Steps:
        """Values at all times, (T or 1, J, I); :meth:`scalar` has the parameters."""
        return shared_steps(field or self.field, name)

    def _limits(self, appearance: Appearance) -> tuple[float, float]:
        """Return the values at the ends of the colour map of an appearance."""
        name = appearance.scalar_name
        chosen = appearance.clim
        if isinstance(chosen, tuple):
            return chosen
        if name is None:
            return 0.0, 1.0
        if chosen == ROBUST or appearance.log_scale:
            low, high = self._common_range(name, robust=chosen == ROBUST)
        else:
            low, high = self.usual_range(name)
        if (low < 0 < high or name in SIGNED) and is_diverging(appearance.cmap):
            low, high = -max(-low, high), max(-low, high)
        if appearance.norm is not None:
            norm = with_limits(appearance.norm, low, high)
            low = float(norm.vmin)
            high = float(norm.vmax)
        return low, high

    def change(self, changes: Mapping[str, Any]) -> None:
        """Change fields of the appearance; a ``clim`` of ``None`` alone fits the present data.

        Raises the errors of the constructor, and then nothing changes.
        """
        if "clim" in changes and "scalars" not in changes:
            self._kept = {}
        self.appearance = self.appearance.changed(**changes)

    def _check_colours(self, appearance: Appearance) -> None:
        """Raise a FieldError if the scalar does not exist, or has no logarithm."""
        if (name := appearance.scalar_name) is None:
            return
        self.scalar_steps(name)
        if appearance.norm is not None:
            scale_of(appearance, self._limits(appearance))
        if appearance.log_scale:
            low, high = self._limits(appearance)
        else:
            low = 1.0
            high = 1.0
        if low <= 0:
            raise FieldError(
                f"log_scale is True, but {name!r} ranges from {low:g} to {high:g}; expected values "
                "above 0: pass clim=(low, high) with low above 0, or omit log_scale"
            )

    def usual_range(self, name: str) -> tuple[float, float]:
        """Return the default range of colours: all values, or robust if there are outliers."""
        return usual_ends(self._common_range(name), self._common_range(name, robust=True))

    def _common_range(self, name: str, *, robust: bool = False) -> tuple[float, float]:
        """Return the range that scenes before this one had, or else the range of the data."""
        return self._kept.get((name, robust)) or self.scalar_range(name, robust=robust)

    @property
    def beyond(self) -> tuple[bool, bool]:
        """Whether values lie below and above the limits of the colours."""
        if (name := self.scalar_name) is None:
            return False, False
        (low, high) = self.scalar_limits
        (least, most) = self.scalar_range(name)
        rounding = ZERO_SHARE * (most - least)
        return low > least + rounding, high < most - rounding

    def scalar_range(self, name: str, *, robust: bool = False) -> tuple[float, float]:
        """Least and greatest value over the valid nodes and all times.

        A robust range leaves 2 % of the values out at either end. Where all are the same up to
        rounding, the range is widened, so that colours do not show rounding errors.
        """
        key = (name, robust, self.pyramid is None)
        if key not in self._ranges:
            ends = None
            if self.pyramid is not None:
                ends = self.pyramid.ranges.get((name, robust))
            if ends is None:
                ends = ends_of(self._range_values(name), robust=robust)
            self._ranges[key] = widened(ends, self.field, name)
        return self._ranges[key]

    def _range_values(self, name: str) -> Floats:
        """Values of the valid nodes, or of the volume that they cut, at all times."""
        field = self.field
        typical = self.field.typical
        in_volume = typical.volume_values.get(name)
        if in_volume is not None:
            return in_volume
        if self.pyramid is None or name in self.field.scalars:
            values = np.asarray(self.scalar_steps(name, typical))
            return np.asarray(values[:, valued_places(field, name)])
        return drawn_speeds(typical, self.whole)

    @property
    def lacks_values(self) -> bool:
        """Whether the scalar is missing at a valid node of the drawn surface at some time.

        Of steps that are read late, these are typical ones and the present one.
        """
        name = self.scalar_name
        if name is None or name not in self.field.scalars:  # the speed, which all nodes have
            return False
        whole = self.whole
        places = valued_places(whole, name)
        key = (name, self.pyramid is None)
        if key not in self._lacks:
            values = np.asarray(self.scalar_steps(name, whole.typical))
            self._lacks[key] = bool(np.isnan(values[:, places]).any())
        if self._lacks[key] or not isinstance(whole.velocity, LazySteps):
            return self._lacks[key]
        present = self.scalar(name, whole)[None]
        return bool(np.isnan(present[:, places]).any())

    def copy(self) -> Scene:
        """Return an independent scene that shows the same, for a thread."""
        scene = Scene(self.field)
        scene._given = self._given
        scene.settings = self.settings.copy()
        scene._appearance = self.appearance
        scene.image = self.image
        scene._noise = self._noise
        scene._show_time(self._time)
        scene._sliced = self._sliced
        scene._pyramid = self._pyramid
        scene._kept = self._kept
        scene._store = self.store
        scene._textures = self.textures
        return scene

    def coarsened(self, nodes: int) -> Scene:
        """Return a scene of the same settings on at most this many nodes, for a first picture.

        Its colours have the range of this one.
        """
        if self.field.triangles is None:
            whole = self.field
        else:
            whole = self.whole
        field = share_field(coarsened_field(whole, nodes))
        scene = Scene(field)
        scale = self.colour_scale
        look = self.appearance
        limits: dict[str, Any]
        if scale.norm is None:
            limits = {"clim": (scale.low, scale.high)}
        else:
            limits = {"norm": scale.norm}
        if look.scalar_name is None:
            scene._appearance = look
        else:
            scene._appearance = replace(look, **limits)
        scene.settings = self.settings.copy()
        scene.image = self.image
        scene._noise = self._noise
        scene._show_time(self._time)
        parameter = self.settings.parameter
        lines = self.lines
        compose = field.steady or lines == "streamlines"
        scene._store = _coarse_stores.get(
            (id(field), parameter, lines),  # a store keeps its field alive
            lambda: SliceStore(field, parameter=parameter, lines=lines, compose=compose),
        )
        return scene

    def showing(
        self,
        field: FlowField,
        own: dict[str, Any] | None = None,
        *,
        keep_range: bool = True,
        same_data: bool = False,
    ) -> Scene:
        """Return a scene of another flow that shares these settings and has this appearance.

        Its time is the nearest one. Its colours keep their range for ``keep_range``, except those
        of a formula, whose range follows its parameters, and for another part of the ``same_data``
        those whose range in the whole volume is known. With ``own`` changes of the appearance,
        scalars that the flow lacks are replaced by the speed. Raises the errors of the constructor.
        """
        if own is None:
            look = self._appearance
        else:
            look = _look_beside(self, own, field)
        scene = Scene(field, self.settings, look, image=self.image)
        if keep_range and field.formula is None:
            kept = self._shown_ranges()
            if same_data:
                for key in list(kept):
                    if key[0] in field.volume_values:
                        del kept[key]
            scene._kept = kept
        scene._show_time(min(max(self._time, scene._time), float(field.times[-1])))
        return scene

    def _shown_ranges(self) -> dict[tuple[str, bool], tuple[float, float]]:
        """Return the ranges that colours have had, by scalar and whether they are robust."""
        ranges = {}
        for (name, robust, _), ends in self._ranges.items():
            ranges[name, robust] = ends
        return ranges | self._kept

    def follow(self, before: Scene) -> None:
        """Replace another scene, and notify its observers."""
        self._changed = before._changed
        before._changed = Signal()
        before.close()
        self._changed.emit("trace")

    def observe(self, observer: Callable[[Change], None]) -> Callable[[], None]:
        """Call ``observer(affects)`` after each change; the returned function ends this."""
        return self._changed.connect(observer)

    def close(self) -> None:
        """Stop following the settings."""
        self._end()
        self._changed = Signal()

    def _setting_changed(self, name: str, value: Any) -> None:
        """Check a setting that has changed, and forget what was made with the earlier one."""
        if name in STRUCTURE:
            try:
                check_structure(self.field, self.settings)
            except SettingsError:
                setattr(self.settings, name, TABLE[name].default)
                raise
        if name == "noise":
            if value == self._noise:
                return
            try:
                check_noise(self.field, value)
                if value == "image" and self.image is None:
                    raise SettingsError(NO_IMAGE)
            except SettingsError:
                # Observers are called after a setting is set, so an invalid value is reset.
                self.settings.noise = self._noise
                raise
            self._noise = value
        affects = TABLE[name].affects
        if name in IN_NOISE_TEXTURE and self.settings.noise == "texture":
            affects = "textures"
        if affects == "trace":
            self._store = self._pyramid = None
            self._sliced = None
        elif name == "noise" and self._pyramid is not None and self._pyramid.depth:
            self._store = None  # in tiles or whole
        if affects != "uniform":
            self._version += 1
            self._textures = None
        self._changed.emit(affects)


def make_scenes(mesh: Any, options: Options) -> list[Scene]:
    """Return the scene of a mesh or a field, and one beside it if the view asks for it.

    Equal fields are one, and share their traces. Raises a FieldError, SettingsError or ImageError
    where an argument does not fit.
    """
    field = share_field(read_field(mesh, options.field))
    changes = options.view.beside
    if mixes_at_folds(field):
        notify(FOLDED)
    settings = options.make_settings(field)
    first = Scene(field, settings, options.appearance, slices=options.field.slices)
    if changes is None:
        return [first]
    return [first, first.beside(changes)]


def is_traced_by(name: str) -> bool:
    """Return whether a setting of this name changes the paths that are traced."""
    return name in TABLE and TABLE[name].affects == "trace"


def _look_beside(first: Scene, changes: dict[str, Any], field: FlowField) -> Appearance:
    """Return the appearance of a scene beside a first one, with a range of its own."""
    if "scalars" not in changes and first.scalar_name not in (None, SPEED, *field.scalars):
        changes = {**changes, "scalars": SPEED}
    if "scalars" in changes:
        changes = {"clim": None, **changes}
    return first.appearance.changed(**changes)


def link_scenes(
    first: Callable[[], Scene], second: Callable[[], Scene], own: Collection[str]
) -> Callable[[], None]:
    """Apply later changes of a first scene to a second one beside it, except ``own``.

    Parameters
    ----------
    first, second
        Return the scenes that are shown at the moment.
    own
        Names of settings and of parts of the appearance that the second scene keeps.

    Returns
    -------
    callable
        Ends the link.
    """

    def follow_setting(name: str, value: Any) -> None:
        if name not in own:
            second().settings.update(**{name: value})

    def follow_look(affects: Change) -> None:
        if affects != "appearance":
            return
        scene = second()
        if not first()._kept:  # the first has dropped its earlier ranges: so does the second
            scene._kept = {}
        names = [*own, "image"]
        if "scalars" in own:
            names.append("clim")
        kept = {}
        for n, v in vars(scene.appearance).items():
            if n in names:
                kept[n] = v
        look = _look_beside(first(), kept, scene.field)
        try:
            scene.appearance = look
        except ValueError:  # its values have no logarithm, unlike those of the first scene
            scene.appearance = replace(look, log_scale=False, norm=None, clim=None)

    end_of_settings = first().settings.observe(follow_setting)
    end_of_look = first().observe(follow_look)

    def end() -> None:
        end_of_settings()
        end_of_look()

    return end


def lay_image(scenes: Sequence[Scene], image: Any, own: Collection[str]) -> None:
    """Set the image of scenes, except of followers that have their own noise."""
    # Followers take the noise of the first scene, and need the image before.
    for scene in reversed(scenes):
        if scene is scenes[0] or "noise" not in own or scene.settings.noise == "image":
            scene.set_image(image)


_coarse_stores: WeakCache[SliceStore] = WeakCache()
_textures: WeakCache[TextureSet] = WeakCache()
