"""Local, conforming, all-hexahedral mesh refinement on CAD models.

    import hextwist
    session = hextwist.Session()
    session.cmd("import step 'part.step'; import mesh 'part.msh'; refine curve 3 numsplit 2")
    session.mesh.points, session.mesh.hexes
"""

from hextwist._core import Cancelled, Error, Group, Mesh, Session, __version__

__all__ = ["Cancelled", "Error", "Group", "Mesh", "Session", "__version__"]
