"""Products and models whose data are among the forms, as rows of the page "Supported data"."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import model_forms
import product_forms
from supported import Made, supported

PRODUCTS = "Products"
MODELS = "Models on grids"


def written(folder: Path, made: Any, name: str) -> Made:
    """Write the dataset of a form, and return its truth."""
    ds, truth = made
    ds.to_netcdf(folder / name)
    return {}, truth


@supported(
    PRODUCTS,
    "velocities of glaciers: ITS_LIVE, MEaSUREs",
    'flowtex.show("its_live.nc")',
    "by the polar map of `grid_mapping`; errors and deviations are no velocity",
)
def glaciers(folder: Path) -> Made:
    return written(folder, product_forms.velocities_of_ice_beside_their_errors(), "its_live.nc")


@supported(
    PRODUCTS,
    "drift of sea ice in km: OSI SAF",
    'flowtex.show("drift.nc", vectors="dX,dY")',
    "a displacement, which `vectors` names because its unit is no velocity",
)
def ice_drift(folder: Path) -> Made:
    return written(folder, product_forms.drift(), "drift.nc")


@supported(
    PRODUCTS,
    "currents of altimetry: DUACS, OSCAR",
    'flowtex.show("duacs.nc")',
    "the absolute current; a notice names the anomalies",
)
def altimetry(folder: Path) -> Made:
    made = product_forms.geostrophic_currents_and_their_anomalies()
    return written(folder, made, "duacs.nc")


@supported(
    PRODUCTS,
    "currents of coastal radars: Copernicus `EWCT`, `NSCT`",
    'flowtex.show("radar.nc")',
    "bad values by the flags of each test are left out",
)
def radar(folder: Path) -> Made:
    return written(folder, product_forms.radar_with_flags_of_each_test(), "radar.nc")


@supported(
    MODELS,
    "COSMO, Meso-NH, MPIOM: components on points of their own",
    'flowtex.show("cosmo.nc")',
    "averaged to the middle of cells, also without positions of these",
)
def cosmo(folder: Path) -> Made:
    return written(folder, model_forms.sides_of_a_rotated_pole(), "cosmo.nc")


@supported(
    MODELS,
    "PALM, CM1, MicroHH, Oceananigans, Veros: lines of cells and of sides",
    'flowtex.show("eddies.nc")',
    "positions of the lines tell which side, whatever their names",
)
def eddies(folder: Path) -> Made:
    return written(folder, model_forms.sides_in_kilometres(), "eddies.nc")
