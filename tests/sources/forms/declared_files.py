"""Files of models and images whose grids, levels and units are declared or known by names."""

from __future__ import annotations

from pathlib import Path

from supported import Made, supported
from topology_forms import (
    images_in_pixels,
    layers_without_a_declaration,
    places_of_points_by_name,
    roms_on_points_of_their_own,
    sgrid_of_any_names,
)

KIND = "Models on grids"


@supported(
    KIND,
    "ROMS and CROCO: `u`, `v` on points of their own",
    'flowtex.show("roms.nc")',
    "averaged to the centres of cells, with `mask_rho` and scalars",
)
def roms(folder: Path) -> Made:
    ds, truth = roms_on_points_of_their_own("own places")
    ds.to_netcdf(folder / "roms.nc")
    return {}, truth


@supported(
    KIND,
    "SGRID: `grid_topology` with `face_dimensions`",
    'flowtex.show("sgrid.nc")',
    "dimensions of any names, and coordinates of the nodes or faces",
)
def sgrid(folder: Path) -> Made:
    ds, truth = sgrid_of_any_names("dimensions of edges")
    ds.to_netcdf(folder / "sgrid.nc")
    return {}, truth


@supported(
    "Models on triangles",
    "Delft3D-FM: `ucx`, `ucy` in layers",
    'flowtex.show("fm_map.nc")',
    'the layer nearest to the surface; `level=0.1` by `LayCoord_cc`; `u="ucxa"` for the mean',
)
def layers(folder: Path) -> Made:
    ds, truth = layers_without_a_declaration("mesh and contours")
    ds.to_netcdf(folder / "fm_map.nc")
    return {}, truth


@supported(
    "Image velocimetry",
    "PIVPy, in pixels or scaled",
    'flowtex.show("pivpy.nc")',
    "displacements in pixels are velocities per frame; `chc` and `mask` leave out vectors",
)
def images(folder: Path) -> Made:
    ds, truth = images_in_pixels("pix")
    ds.to_netcdf(folder / "pivpy.nc")
    return {}, truth


@supported(
    "Points",
    "nodes with `node_x` and `node_y`, without a mesh",
    'flowtex.show("nodes.nc")',
    "joined by triangles; also `cell_center_x`, `pos_x` and similar names",
)
def points_by_name(folder: Path) -> Made:
    ds, truth = places_of_points_by_name("node_x")
    ds.to_netcdf(folder / "nodes.nc")
    return {}, truth
