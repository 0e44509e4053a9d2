"""Redundancy between trace slices: predict each from slices of shorter lag, count what is left.

prediction.py   predict a slice from slices of shorter lag
residuals.py    differences from the prediction as integers, and their entropy
texels.py       errors of positions in texels of the noise
measure.py      the redundancy of slices
"""

from __future__ import annotations

from paper.redundancy.measure import Redundancy, redundancy
from paper.redundancy.texels import error_in_texels

__all__ = ["Redundancy", "error_in_texels", "redundancy"]
