"""Methods of the paper's related work, small and plain, to compare the method with.

They are written to be read next to their papers, in NumPy and SciPy, and nothing that draws for
a user depends on them. Values have mean zero and are not scaled: contrast is the caller's.
"""

from __future__ import annotations

from paper.references.forssell import draw_texture, forssell_lic
from paper.references.image_space import ImageSpace
from paper.references.lic import lic

__all__ = ["ImageSpace", "draw_texture", "forssell_lic", "lic"]
