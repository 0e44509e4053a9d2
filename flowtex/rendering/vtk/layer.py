"""One flow texture on one PyVista actor.

``Actor.add_shader_replacement`` puts the shader's text in under flowtex's own name, anew only for
another variant. Everything that changes from frame to frame is a uniform: VTK calls back with the
shader program before each draw, and numbers and texture units are written to it there.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.util.vtkConstants import VTK_FLOAT, VTK_OBJECT
from vtkmodules.vtkRenderingCore import vtkMapper
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow, vtkShaderProgram, vtkTextureObject

from flowtex._util.array_types import AnyArray, Floats, Floats32, Halves, Ints
from flowtex.rendering.even import EvenBlocks
from flowtex.rendering.mesh_levels import MeshLevels, TriangleBlocks, mesh_levels_of
from flowtex.rendering.shaders import shader_folder, shader_text
from flowtex.rendering.tile_choice import TileView
from flowtex.rendering.uniforms import (
    ANCHOR_RANGE,
    ViewState,
    has_arrows,
    is_even,
    is_moving,
    is_near,
    is_sparse,
    uniforms,
    variants,
)
from flowtex.rendering.vtk.area import PassArea
from flowtex.rendering.vtk.flow_mapper import (
    COORDINATE,
    CORNERS,
    IMAGE,
    POSITION,
    FlowMapper,
    MappedColours,
    map_attributes,
    set_triangles,
)
from flowtex.rendering.vtk.frame import weak_callback
from flowtex.rendering.vtk.slice_levels import needs_levels
from flowtex.settings import Settings
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.texture_set import LayerPrefetch, TextureSet
from flowtex.textures.triangle_geometry import TriangleGeometry, image_size

#: OpenGL's numbers of internal formats in half precision by channels.
FORMATS = {1: 0x822D, 2: 0x822F, 4: 0x881A}
SINGLE = {2: 0x8230, 3: 0x8815, 4: 0x8814}  #: The same in single precision.
HALF_FLOAT = 0x140B  #: OpenGL's number of the type of half precision.


def send_texture(
    window: vtkOpenGLRenderWindow,
    texels: AnyArray,
    *,
    levels: int | None = None,
    repeat: tuple[bool, bool] = (False, False),
    single: bool = False,
) -> vtkTextureObject:
    """Send a texture array with its mip levels to a window; an image is an array of one layer.

    The texels (layers, H, W, 1, 2 or 4) are stored in half precision, which ``vtkTexture`` has not;
    2 to 4 may be in ``single``. There are ``levels`` mip levels besides the finest, by default all.
    """
    with np.errstate(over="ignore"):
        texels = np.ascontiguousarray(texels, np.float32 if single else np.float16)
    target = vtkTextureObject()
    target.SetContext(window)
    target.SetGenerateMipmap(levels != 0)
    target.SetMinificationFilter(vtkTextureObject.LinearMipmapLinear)
    target.SetMagnificationFilter(vtkTextureObject.Linear)
    target.SetWrapS(vtkTextureObject.Repeat if repeat[1] else vtkTextureObject.ClampToEdge)
    target.SetWrapT(vtkTextureObject.Repeat if repeat[0] else vtkTextureObject.ClampToEdge)
    layers, height, width, channels = texels.shape
    all_levels = max(height, width).bit_length() - 1
    # Left as it is, VTK's greatest level is 0, and there is no other level.
    target.SetMaxLevel(all_levels if levels is None else levels)
    target.SetInternalFormat((SINGLE if single else FORMATS)[channels])
    if not single:
        # VTK has no name for half precision; a type that is set has precedence over its names.
        target.SetDataType(HALF_FLOAT)
    target.Create2DArrayFromRaw(width, height, channels, VTK_FLOAT, layers, texels)
    return target


def _unbind(texture: vtkTextureObject) -> None:
    if texture.GetTextureUnit() >= 0:
        texture.Deactivate()


OWNER = "flowtex"  #: Name under which PyVista registers the replacements.

#: Variants of a shader that shows sums.
SHOWN = {"FLOWTEX_DEFERRED", "FLOWTEX_OWN", "FLOWTEX_PROJECTED"}
#: Shaders, and our parts of them.
STAGES = [(s, p) for s in ("vertex", "geometry", "fragment") for p in ("dec", "impl")]


class FlowLayer:
    """Draws a texture set on an actor whose mesh comes from :func:`surface_mesh`.

    Settings are read before each frame. ``layers`` returns the layers of a destination time in
    place of the texture set; levels of the mesh are made unless they are given.
    """

    def __init__(
        self,
        actor: pv.Actor,
        renderer: Any,
        textures: TextureSet,
        settings: Settings,
        layers: Callable[[int], Halves] | None = None,
        mesh_levels: MeshLevels | TriangleBlocks | None = None,
    ) -> None:
        self.actor = actor
        self._mapper: Any = actor.mapper
        self._renderer = weakref.ref(renderer)
        self.textures = textures  #: The texture set that is drawn.
        self._settings = settings
        self._prefetch = LayerPrefetch(textures)
        self._layers = layers
        self._steps = (0, 0)
        self.height = 1.0  #: Height of the view at the focal point, in the mesh's units.
        self._drawn = False
        self._variant: frozenset[str] | None = None
        self._mesh_levels = mesh_levels
        self._colours: MappedColours | None = None
        self.flat_array: str | None = None  #: Name of the point array whose values belong to cells.
        self._gpu: dict[str, vtkTextureObject] = {}
        self._context = 0  # the time at which VTK made the context of these
        self._retired: list[vtkTextureObject] = []
        self._has_levels = layers is not None  #: Whether slices have mip levels; tiles' always do.
        self.view = ViewState()
        #: Whether passes before the frame sum the pixels, and what they have drawn.
        self.deferred = False
        self.shown: vtkTextureObject | None = None
        self.shown_area: PassArea | None = None  #: Where in it the pixels of the frame are.
        #: Whether a pass of the renderer draws the actor into a picture of another size.
        self.is_projected = False
        self._is_blank = False
        self._observed = observe_draws(self._mapper, self.before_draw)

    @property
    def mesh(self) -> pv.PolyData:
        """The mesh of the actor."""
        mesh: pv.PolyData = self._mapper.dataset
        return mesh

    @property
    def mesh_levels(self) -> MeshLevels | TriangleBlocks:
        """The triangles of each level of the mesh."""
        if self._mesh_levels is None:
            self._mesh_levels = mesh_levels_of(self.textures)
        return self._mesh_levels

    def set_textures(self, textures: TextureSet) -> None:
        """Draw another texture set of the same surface from now on."""
        same = textures.same_paths(self.textures)
        self.textures = textures
        self._prefetch.close()
        self._prefetch = LayerPrefetch(textures)
        self.view.anchor = np.zeros(3)  # that of the mesh's new attributes
        self._retire(*(["u_image"] if same else self._gpu))
        self._variant = None

    def set_moment(self, before: int, after: int, between: float) -> None:
        """Show the time between two steps; the next ones in its direction are prepared."""
        old_time = self.view.time
        if (before, after) != self._steps:
            old = dict(zip(self._steps, ("u_slices", "u_slicesNext"), strict=True))
            reused = {}
            for s in (before, after):
                if s in old:
                    reused[old[s]] = self._gpu.pop(old[s], None)
            self._retire("u_slices", "u_slicesNext")
            for step, name in ((before, "u_slices"), (after, "u_slicesNext")):
                texture = reused.get(old.get(step, ""))
                if texture is not None:
                    self._gpu[name] = texture
            self._steps = (before, after)
        first, last = self.textures.store.field.times[[before, after]]
        self.view.between = between
        self.view.time = float(first + between * (last - first))
        if self._drawn and not self._is_blank and self.view.time != old_time:
            if self.view.time > old_time:
                ahead = after + (between > 0)
            else:
                ahead = before - 1
            self._prefetch.prepare(ahead)

    def close(self) -> None:
        """Restore the actor and free the graphics card's memory."""
        self._mapper.RemoveObserver(self._observed)
        self._prefetch.close()
        self.actor.clear_shader_replacements(_feature_name=OWNER)
        self._mapper.RemoveAllVertexAttributeMappings()
        self._retire(*self._gpu)
        self._free(self.window)

    @property
    def variant(self) -> frozenset[str]:
        """The names of the shader's variant."""
        moving = is_moving(self.textures, self._settings, self.view)
        near = is_near(self.textures, self._settings, self.view)
        sparse = is_sparse(self.textures, self._settings)
        found = variants(self.textures, moving=moving, near=near, sparse=sparse)
        if not self.deferred:
            return found
        found |= {"FLOWTEX_DEFERRED"}
        if self._has_own_colours:
            found |= {"FLOWTEX_OWN"}
        if self.is_projected:
            found |= {"FLOWTEX_PROJECTED"}
        return found

    @property
    def even_grain(self) -> float | None:
        """The grain in pixels of a texture whose local mean is subtracted, or ``None``."""
        if not is_even(self.textures, self._settings):
            return None
        return float(self._settings.grain * self.view.density)

    @property
    def even_margin(self) -> int:
        """Pixels beyond the edges of a frame on which its colours depend."""
        if self.even_grain is None:
            return 0
        return EvenBlocks.of(self.even_grain, (0, 1, 0, 1)).margin

    @property
    def _has_own_colours(self) -> bool:
        """Whether VTK's colours are needed: those of vertices, or with edges."""
        prop = self.actor.prop
        colours = self._colours
        if colours is None:
            alike = prop.GetAmbientColor() == prop.GetDiffuseColor()
            return bool(prop.show_edges or self._mapper.GetScalarVisibility() or not alike)
        return bool(prop.show_edges) and not colours.on_cells

    def _write_text(self, renderer: Any) -> None:
        self.deferred = is_deferred(self.actor, renderer, self.textures)
        self.is_projected = self.deferred and renderer.GetPass() is not None
        # An actor that shows what passes have drawn has one text, however they sum.
        if self.deferred:
            variant = self.variant & SHOWN
        else:
            variant = self.variant
        if variant == self._variant:
            return
        self._variant = variant
        arrays: dict[str, str] = {}
        if self._needs_position:
            self._write_position()
            arrays["flowtexPosition"] = POSITION
        if not self.deferred:
            arrays["flowtexCoordinate"] = COORDINATE
            if self.textures.geometry.corners is not None:
                arrays["flowtexCorners"] = CORNERS
            if self.textures.image is not None:
                arrays["flowtexImage"] = IMAGE
        map_attributes(self._mapper, arrays)
        insert_text(self.actor, OWNER, "", variant, before=True)

    @property
    def _needs_position(self) -> bool:
        """Whether the vertices of the mesh have their positions from the anchor."""
        return self.is_projected or not self.deferred

    def _write_position(self) -> None:
        geometry = self.textures.geometry
        position = geometry.position_from(self.view.anchor)
        self.mesh.point_data[POSITION] = geometry.at_vertices(position)

    def before_draw(self, program: vtkShaderProgram | None) -> None:
        """Write uniforms and texture units to the program that is about to draw."""
        window = self.window
        if program is None or window is None:
            return
        self._free(window)
        # Texture units are few, and the layer drawn just before no longer needs its own.
        if (last := _last.get(window)) is not None and (layer := last()) not in (None, self):
            layer.after_frame()
        _last[window] = weakref.ref(self)
        values = uniforms(self.textures, self._settings, self.view)
        above, before = self.textures.geometry.padding
        values["u_even"] &= self.deferred
        values["u_padding"] = float(before), float(above)
        arrows = has_arrows(self.textures, self._settings)
        coloured = arrows and self._settings.arrow_color == "scalars"
        values["u_mapped"] = self._colours is not None and not self._has_own_colours
        values["u_flat"] = self._colours is not None and self._colours.on_cells
        values["u_plain"] = coloured and self._colours is not None
        values["u_plainColour"] = tuple(self.actor.prop.color.float_rgb)
        for name, value in values.items():
            if program.IsUniformUsed(name) or isinstance(value, list):
                write_uniform(program, name, value)
        for name, load in self._loaders(partial(send_texture, window)).items():
            if program.IsUniformUsed(name):
                if name not in self._gpu:
                    self._gpu[name] = load()
                if self._gpu[name].GetTextureUnit() < 0:
                    self._gpu[name].Activate()
                program.SetUniformi(name, self._gpu[name].GetTextureUnit())
        if not self.view.between and program.IsUniformUsed("u_slicesNext"):
            # At a step there is no next one, and the sampler needs a texture of its kind.
            program.SetUniformi("u_slicesNext", self._gpu["u_slices"].GetTextureUnit())
        if program.IsUniformUsed("u_shown"):
            self._write_shown(program)

    def _write_shown(self, program: vtkShaderProgram) -> None:
        """Write what the passes have drawn, and where its pixels are, to a program."""
        shown = self.shown
        area = self.shown_area
        if shown is None or area is None:
            return
        if shown.GetTextureUnit() < 0:
            shown.Activate()
        program.SetUniformi("u_shown", shown.GetTextureUnit())
        if not self.is_projected:
            program.SetUniformi("u_margin", area.margin)
            return
        to_pixels = np.eye(4)
        to_pixels[:2, :2] = np.diag(area.size / 2)
        to_pixels[:2, 3] = area.corner + area.size / 2
        matrix = to_pixels @ self._to_picture(area.view)
        program.SetUniformMatrix("u_toPixels", pv.vtkmatrix_from_array(matrix.T))

    def after_frame(self) -> None:
        """Release the texture units."""
        self._drawn = True
        for texture in self._gpu.values():
            _unbind(texture)
        if self.shown is not None:
            _unbind(self.shown)

    def rays(self, matrix: Floats, size: Ints) -> tuple[Floats, Floats, Floats]:
        """Return the corner of the picture, and its change by a pixel to the right and upwards.

        They lie on the plane through the focus, (3,) each, as positions are given to shaders. The
        matrix (4, 4) leads from the world to the picture, whose size is in pixels.
        """
        geometry = self.textures.geometry
        whole = self._to_picture(matrix)
        focus = whole @ [*(geometry.local(self.view.focus) - self.view.anchor), 1.0]
        corners = np.array([[-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [focus[2] / focus[3]] * 3])
        points = np.linalg.solve(whole, np.vstack([corners, np.ones(3)]))
        points = points[:3] / points[3]
        along, up = (points[:, 1:] - points[:, :1]).T / size[:, None]
        return points[:, 0], along, up

    def _to_picture(self, matrix: Floats) -> Floats:
        """Return the matrix (4, 4) of positions from the anchor, given that of the world."""
        geometry = self.textures.geometry
        place = np.eye(4)
        place[:3, :3] = geometry.frame.T
        place[:3, 3] = geometry.center + geometry.frame.T @ self.view.anchor
        return np.asarray(matrix @ self.place @ place)

    def box(self, matrix: Floats, size: Ints) -> tuple[int, int, int, int] | None:
        """Return first and end of the columns and rows in which the layer may be seen."""
        ends = np.reshape(self.mesh.GetBounds(), (3, 2))
        corners = np.stack([*np.meshgrid(*ends, indexing="ij"), np.ones((2, 2, 2))])
        seen = matrix @ self.place @ corners.reshape(4, 8)
        if (seen[3] <= 0).all():  # all of it is behind the eye
            return None
        low = np.zeros(2)
        high = size
        if (seen[3] > 0).all():
            at = (seen[:2] / seen[3] + 1) / 2 * size[:, None]
            low = np.maximum(low, at.min(axis=1) - 2)
            high = np.minimum(high, at.max(axis=1) + 2)
        if (low >= high).any():
            return None
        return int(low[0]), int(high[0]), int(low[1]), int(high[1])

    @property
    def place(self) -> Floats:
        """The actor's matrix, (4, 4)."""
        return np.asarray(pv.array_from_vtkmatrix(self.actor.GetMatrix()))

    def _loaders(self, send: Callable[..., vtkTextureObject]) -> dict[str, Callable[[], Any]]:
        """Return functions that send the textures to the graphics card, by names of samplers."""
        loaders: dict[str, Callable[[], Any]] = {"u_slices": lambda: send(**self._slices(0))}
        colours = self._colours
        geometry = self.textures.geometry
        # Sent even without colours: a sampler that is not set would use unit 0, and clash with a
        # sampler of another kind there.
        none = np.zeros((1, 1, 1, 4))
        single = partial(send, levels=0, single=True)
        loaders |= {
            "u_shares": lambda: single(colours.shares(geometry) if colours else none),
            "u_colours": lambda: single(colours.colours() if colours else none),
            "u_nodes": lambda: single(_nodes(geometry, self.view.anchor)),
        }
        if self.view.between:
            loaders["u_slicesNext"] = lambda: send(**self._slices(1))
        if (corners := geometry.corners) is not None:
            loaders["u_corners"] = lambda: single(_corners(corners))
        if (image := self.textures.image) is not None:
            loaders["u_image"] = partial(send, image.texels[None], repeat=image.repeated)
            loaders["u_stepImage"] = partial(
                send, image.step[None, :, :, None], repeat=image.repeat
            )
        return loaders

    def _slices(self, number: int) -> dict[str, Any]:
        step = self._steps[number]
        textures = self.textures
        if self._is_blank:
            layers = np.zeros((textures.count, *textures.geometry.size, 4), np.float16)
            layers[0, ..., 3] = 1.0
        else:
            if self._layers:
                layers = self._layers(step)
            else:
                layers = self._prefetch.take(step)
        levels = 0
        if self._has_levels:
            levels = textures.geometry.levels
        return {"texels": layers, "levels": levels}

    def look(self) -> None:
        """Choose the shader, and transform the camera and the anchor to the mesh's coordinates."""
        renderer = self._renderer()
        if renderer is None:
            return
        self._follow_context()
        self._follow_colours()
        camera = renderer.GetActiveCamera()
        parallel = bool(camera.GetParallelProjection())
        if parallel:
            eye = np.multiply(camera.GetDirectionOfProjection(), -1)
        else:
            eye = camera.GetPosition()
        placed = self.place
        points = [(*camera.GetFocalPoint(), 1.0), (*eye, float(not parallel))]
        focus, self.view.eye = np.linalg.solve(placed, np.transpose(points)).T
        self.view.focus = focus[:3]
        scale = float(np.cbrt(abs(np.linalg.det(placed[:3, :3]))))
        height = 2 * camera.GetDistance() * np.tan(np.radians(camera.GetViewAngle() / 2))
        self.height = float(2 * camera.GetParallelScale() if parallel else height) / scale
        self.view.pixel = self.height / renderer.GetSize()[1]
        if not self._has_levels:
            settings = self._settings
            self._has_levels = needs_levels(self.textures, settings, self.view, placed, self.mesh)
            if self._has_levels:
                self._retire("u_slices", "u_slicesNext")
        self._write_text(renderer)
        self._move_anchor()

    def prepare(self, *, blank: bool = False) -> None:
        """Start to trace for the next frame; a ``blank`` layer, which tiles cover, has no paths."""
        blank &= not has_arrows(self.textures, self._settings)
        if self._is_blank and not blank:
            self._retire("u_slices", "u_slicesNext")
        self._is_blank = blank and (self._is_blank or "u_slices" not in self._gpu)
        if "u_slices" not in self._gpu and not self._is_blank:
            # A separate thread traces while this one continues with meshes and shaders.
            self._prefetch.prepare(self._steps[0])

    def _move_anchor(self) -> None:
        """Move the origin of positions near the focus where precision needs it."""
        geometry = self.textures.geometry
        focus = geometry.local(self.view.focus)
        if np.abs(focus - self.view.anchor).max() <= ANCHOR_RANGE * self.height:
            return
        near_middle = np.abs(focus).max() <= ANCHOR_RANGE * self.height
        if near_middle:
            self.view.anchor = np.zeros(3)
        else:
            self.view.anchor = focus
        self._retire("u_nodes")
        if self._needs_position:
            self._write_position()

    def choose_levels(self, renderer: Any, view: TileView) -> Ints:
        """Return the coarsest levels (block rows, columns) that the view allows, -1 out of view."""
        prop = self.actor.prop
        levels = self.mesh_levels.levels(view.eye, view.half_height, renderer.GetSize()[1])
        if prop.show_edges or prop.style != "Surface":
            levels = np.minimum(levels, 0)
        blocks = self.mesh_levels.blocks
        return np.where(view.sees(blocks[..., :3], blocks[..., 3]), levels, -1)

    def set_triangles(self, levels: Ints, borders: Ints | None) -> None:
        """Draw other triangles; :meth:`MeshLevels.triangles` has the parameters."""
        triangles = self.mesh_levels.triangles(levels, borders)
        if (levels < 0).any():
            # The bounds of the mesh do not change.
            outermost = self.textures.geometry.outermost
            triangles = np.concatenate([triangles, np.repeat(outermost[:, None], 3, axis=1)])
        set_triangles(self.mesh, triangles)

    def follow(self, mapper: vtkMapper) -> None:
        """Take the colours of another mapper, by the same point array."""
        for name in (
            *("ScalarVisibility", "LookupTable", "ScalarRange", "UseLookupTableScalarRange"),
            *("InterpolateScalarsBeforeMapping", "ColorMode", "ScalarMode"),
        ):
            getattr(self._mapper, f"Set{name}")(getattr(mapper, f"Get{name}")())
        if (name := mapper.GetArrayName()) is not None:
            self._mapper.SelectColorArray(name)

    def _follow_colours(self) -> None:
        colours = MappedColours.of(self._mapper, self.mesh, self.flat_array)
        before = self._colours
        self._colours = colours
        if (before and before.state) != (self._colours and self._colours.state):
            self._retire("u_shares", "u_colours")

    @property
    def window(self) -> vtkOpenGLRenderWindow | None:
        """The window of the renderer, once it has one."""
        renderer = self._renderer()
        if renderer is None:
            return None
        return renderer.GetRenderWindow()

    def _follow_context(self) -> None:
        """Forget textures that VTK has freed with their context."""
        window = self.window
        if window is None or window.GetContextCreationTime() == self._context:
            return
        self._context = window.GetContextCreationTime()
        self._gpu.clear()
        self._retired.clear()

    def _retire(self, *names: str) -> None:
        """Release textures when their window's context is current."""
        self._retired += [t for n in names if (t := self._gpu.pop(n, None)) is not None]

    def _free(self, window: vtkOpenGLRenderWindow | None) -> None:
        for texture in self._retired if window is not None else ():
            _unbind(texture)
            texture.ReleaseGraphicsResources(window)
        self._retired.clear()


#: The layer that each window has drawn last.
_last: weakref.WeakKeyDictionary[vtkOpenGLRenderWindow, weakref.ref[FlowLayer]] = (
    weakref.WeakKeyDictionary()
)


def is_deferred(actor: pv.Actor, renderer: Any, textures: TextureSet) -> bool:
    """Return whether passes before the frame can sum the pixels of an actor."""
    return bool(
        textures.image is None
        and actor.prop.opacity == 1
        and actor.prop.style == "Surface"
        and not actor.GetForceTranslucent()
        and not renderer.GetRenderWindow().GetStereoRender()
    )


def _nodes(geometry: SurfaceGeometry | TriangleGeometry, anchor: Floats) -> Floats32:
    """Return nodal positions from an anchor and normals, (2 or 1, J, I, 3), as the slices lie."""
    nodal = [geometry.position_from(anchor)]
    if not geometry.planar:
        nodal.append(geometry.normal)
    layers = np.nan_to_num(np.stack(nodal))
    if geometry.corners is None:
        return layers
    texels = np.zeros((len(layers), *geometry.size, 3), np.float32)
    for layer, image in zip(layers, texels, strict=True):
        geometry.write_texels(layer, image)
    return texels


def _corners(corners: Floats32) -> Floats32:
    """Return texels (1, H, W, 4) with the nodes of each triangle, given at vertices, (3 m, 4)."""
    rows, columns = image_size(len(corners) // 3)
    texels = np.zeros((1, rows, columns, 4), np.float32)
    texels.reshape(-1, 4)[: len(corners) // 3] = corners[::3]
    return texels


def insert_text(
    actor: pv.Actor, owner: str, prefix: str, variant: frozenset[str], *, before: bool = False
) -> None:
    """Insert flowtex's files that begin with a prefix after the marks of VTK, or before them."""
    actor.clear_shader_replacements(_feature_name=owner)
    for stage, part in STAGES:
        name = f"vtk/{prefix}{stage}_{part}.glsl"
        if (shader_folder() / name).is_file():
            is_last = (stage, part) == ("fragment", "impl")
            if is_last:
                mark = "//VTK::Light::Impl"
            else:
                mark = f"//VTK::PositionVC::{part.title()}"
            text = shader_text(name, variant)
            if before:
                text = f"{text}\n{mark}\n"
            else:
                text = f"{mark}\n{text}"
            actor.add_shader_replacement(stage, mark, text, _feature_name=owner)


def plain_actor(mesh: pv.PolyData) -> pv.Actor:
    """Return an actor beside the flow, which cannot be picked and does not affect the bounds."""
    mapper = FlowMapper(mesh)
    mapper.scalar_visibility = False
    mapper.SetVBOShiftScaleMethod(0)  # our shaders take positions as they are
    actor = pv.Actor(mapper=mapper)
    actor.PickableOff()
    actor.UseBoundsOff()
    return actor


def observe_draws(mapper: Any, method: Callable[[vtkShaderProgram | None], None]) -> int:
    """Call a method with the program before each draw, without keeping its object alive."""
    call = weak_callback(method)
    call.CallDataType = VTK_OBJECT
    return int(mapper.AddObserver("UpdateShaderEvent", call))


def write_uniform(program: vtkShaderProgram, name: str, value: Any) -> None:
    """Set one uniform, by the type of its value."""
    if isinstance(value, (bool, int)):
        program.SetUniformi(name, int(value))
    elif isinstance(value, float):
        program.SetUniformf(name, value)
    elif isinstance(value, list):
        program.SetUniform1fv(name, len(value), value)
    else:
        getattr(program, f"SetUniform{len(value)}f")(name, value)
