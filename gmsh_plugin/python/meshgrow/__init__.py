"""Mesh sizes for Gmsh that grow from what is meshed already.

    import gmsh, meshgrow
    field = meshgrow.SizeField()                    # of Gmsh's current model
    field.add_mesh(sources=[(2, 7)], attach=[(3, 2)], growth_rate=1.2, size_limit=2.0)
    field.generate(3)                               # Gmsh's own 1D/2D/3D, sources first

The package talks to the libgmsh that the process has loaded (``import gmsh``); import gmsh first.
"""

from ._field import SizeField
from ._library import Error, version
from ._report import report, report_table

__version__ = version()
__all__ = ["Error", "SizeField", "report", "report_table", "__version__"]
