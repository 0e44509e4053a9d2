"""Levels of an adaptively refined mesh as blocks, where finer cells replace coarser ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pyvista as pv


def amr_blocks(levels: Any) -> pv.MultiBlock:
    """Return the boxes of all levels of VTK's overlapping AMR, from coarse to fine.

    Cells that a finer level has are marked as refined in VTK's ghost array.
    """
    import pyvista as pv
    from vtkmodules.vtkCommonDataModel import vtkAMRUtilities

    vtkAMRUtilities.BlankCells(levels)
    blocks = pv.MultiBlock()
    for level in range(levels.GetNumberOfLevels()):
        for number in range(levels.GetNumberOfBlocks(level)):
            grid = levels.GetDataSetAsImageData(level, number)
            if grid is None:  # another process has it
                continue
            image = pv.ImageData()
            image.ShallowCopy(grid)
            blocks.append(image, f"level {level} box {number}")
    return blocks
