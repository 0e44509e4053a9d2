"""Files of meshes beyond those of VTK, each with the flow in the plane."""

from __future__ import annotations

import io
from contextlib import redirect_stderr
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from cfd_files import write_vtkhdf
from known_flow import Truth, at_points, plane
from scipy.spatial import Delaunay
from supported import Made, supported

KIND = "Meshes"


def points() -> tuple[Any, Any]:
    """Return places (N, 2) and triangles (M, 3) of a mesh without rows and columns."""
    inside = np.random.default_rng(3).uniform(0.05, 0.95, (40, 2))
    border = np.linspace(0, 1, 7)
    zero = np.zeros_like(border)
    sides = [(border, zero), (border, zero + 1), (zero, border), (zero + 1, border)]
    edge = np.concatenate([np.stack(side, axis=-1) for side in sides])
    places = np.unique(np.concatenate([inside, edge]), axis=0)
    return places, Delaunay(places).simplices


def vectors(places: Any, time: float = 0.0) -> Any:
    u, v = plane(places[:, 0], places[:, 1], time)
    return np.stack([u, v, 0 * u], axis=-1)


def meshio_mesh() -> Any:
    meshio = import_module("meshio")
    places, triangles = points()
    deep = np.column_stack([places, np.zeros(len(places))])
    return meshio.Mesh(deep, [("triangle", triangles)], {"velocity": vectors(places)})


def truth(**more: Any) -> Truth:
    return at_points(points()[0], **more)


@supported(KIND, "Gmsh", 'flowtex.show("flow.msh")', "nodes and cells with data", "meshio")
def gmsh(folder: Path) -> Made:
    with redirect_stderr(io.StringIO()):  # of tags that are added
        meshio_mesh().write(folder / "flow.msh", file_format="gmsh")
    return {}, truth()


@supported(KIND, "SALOME", 'flowtex.show("flow.med")', "fields on nodes", "meshio")
def salome(folder: Path) -> Made:
    meshio_mesh().write(folder / "flow.med")
    return {}, truth()


@supported(KIND, "a mesh of meshio", "flowtex.show(mesh)", "as a PyVista mesh", "meshio")
def of_meshio(folder: Path) -> Made:
    return {"mesh": meshio_mesh()}, truth()


def item(values: Any, kind: str = "Float") -> str:
    """Return an array as XDMF has it."""
    values = np.asarray(values)
    shape = " ".join(map(str, values.shape))
    numbers = " ".join(f"{value:.9g}" for value in values.ravel())
    kind = f'DataType="{kind}" Precision="8"'
    return f'<DataItem Format="XML" Dimensions="{shape}" {kind}>{numbers}</DataItem>'


def grid(time: float | None) -> str:
    """Return the grid of XDMF at a time."""
    places, triangles = points()
    values = vectors(places, time or 0.0)
    stamp = "" if time is None else f'<Time Value="{time}"/>'
    return (
        f'<Grid Name="flow" GridType="Uniform">{stamp}'
        f'<Topology TopologyType="Triangle" NumberOfElements="{len(triangles)}">'
        f"{item(triangles, 'Int')}</Topology>"
        f'<Geometry GeometryType="XYZ">{item(np.column_stack([places, 0 * places[:, 0]]))}'
        '</Geometry><Attribute Name="velocity" AttributeType="Vector" Center="Node">'
        f"{item(values)}</Attribute></Grid>"
    )


def write_xdmf(path: Path, content: str) -> None:
    path.write_text(f'<?xml version="1.0"?><Xdmf Version="3.0"><Domain>{content}</Domain></Xdmf>')


@supported(KIND, "XDMF, as of FEniCS", 'flowtex.show("flow.xdmf")', "one mesh, without times")
def xdmf(folder: Path) -> Made:
    write_xdmf(folder / "flow.xdmf", grid(None))
    return {}, truth()


@supported(KIND, "XDMF series", 'flowtex.show("series.xmf")', "a collection in time")
def xdmf_series(folder: Path) -> Made:
    grids = grid(0.0) + grid(1.5)
    collection = f'<Grid GridType="Collection" CollectionType="Temporal">{grids}</Grid>'
    write_xdmf(folder / "series.xmf", collection)
    return {}, truth(times=(0.0, 1.5))


def pieces() -> list[Any]:
    """Return the points and triangles of two unit squares beside each other."""
    found = []
    for left in (0.0, 1.0):
        mesh = pv.Plane(center=(left + 0.5, 0.5, 0), i_resolution=8, j_resolution=8).triangulate()
        found.append((np.asarray(mesh.points, dtype=float), mesh.faces.reshape(-1, 4)[:, 1:]))
    return found


def of_pieces(**more: Any) -> Truth:
    x, y = np.meshgrid(np.linspace(0, 2, 17), np.linspace(0, 1, 9))
    return at_points(np.stack([x.ravel(), y.ravel()], axis=-1), **more)


@supported(
    KIND, "VTKHDF, in partitions and with times", 'flowtex.show("flow.vtkhdf")', "as one mesh"
)
def vtkhdf(folder: Path) -> Made:
    times = (0.0, 1.5)
    write_vtkhdf(folder / "flow.vtkhdf", "UnstructuredGrid", pieces(), times, vectors)
    return {}, of_pieces(times=times)


@supported(
    KIND,
    "`pyvista.PartitionedDataSet`",
    "flowtex.show(parts)",
    "one mesh, without the copies of cells of other partitions",
)
def partitions(folder: Path) -> Made:
    parts = []
    for places, triangles in pieces():
        parts.append(pv.PolyData.from_regular_faces(places, triangles))
        parts[-1]["velocity"] = vectors(places)
    make: Any = pv.PartitionedDataSet
    return {"parts": make(parts)}, of_pieces()


def zones() -> tuple[pv.MultiBlock, Truth]:
    """Return two structured surfaces that meet, and the truth of both together."""
    x, y = np.linspace(0.0, 2.0, 13), np.linspace(0.0, 1.0, 9)
    blocks = pv.MultiBlock()
    for name, part in (("left", x[:6]), ("right", x[5:])):
        across, upward = np.meshgrid(part, y, indexing="ij")
        grid = pv.StructuredGrid(across[..., None], upward[..., None], 0 * across[..., None])
        grid["velocity"] = vectors(np.asarray(grid.points)[:, :2])
        blocks.append(grid, name)
    across, upward = np.meshgrid(x, y)
    return blocks, at_points(np.stack([across.ravel(), upward.ravel()], axis=-1))


@supported(
    KIND,
    "structured blocks that meet: `MultiBlock`, CGNS, PLOT3D",
    "flowtex.show(blocks)",
    "surfaces with common nodes on their borders are one surface; `block=` draws one",
)
def structured_blocks(folder: Path) -> Made:
    blocks, true = zones()
    return {"blocks": blocks}, true


@supported(KIND, "files of such blocks", 'flowtex.show("zones.vtm")', "as one surface")
def file_of_blocks(folder: Path) -> Made:
    blocks, true = zones()
    blocks.save(folder / "zones.vtm")
    return {}, true


@supported(
    KIND, "PLOT3D grids of two dimensions", 'flowtex.show("zones.x")', "with `zones.q` beside it"
)
def plot3d_zones(folder: Path) -> Made:
    blocks, true = zones()
    shapes = [block.dimensions[:2] for block in blocks]
    head = f"{len(shapes)}\n" + "".join(f"{i} {j}\n" for i, j in shapes)
    grid = solution = head
    for block in blocks:
        x, y, _ = np.asarray(block.points, dtype=float).T
        u, v, _ = np.asarray(block["velocity"], dtype=float).T
        grid += numbers(x, y)
        solution += "0.5 0.0 1000.0 7.0\n" + numbers(0 * u + 2, 2 * u, 2 * v, 0 * u + 9)
    (folder / "zones.x").write_text(grid)
    (folder / "zones.q").write_text(solution)
    return {}, true


def numbers(*arrays: Any) -> str:
    """Return arrays as lines of text."""
    return "".join(" ".join(f"{n:.9g}" for n in array) + "\n" for array in arrays)
