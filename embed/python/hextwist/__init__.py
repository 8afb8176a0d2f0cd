"""Local, conforming, all-hexahedral mesh refinement on CAD models.

    import hextwist
    session = hextwist.Session()
    session.cmd("import step 'part.step'; import mesh 'part.msh'; refine curve 3 numsplit 2")
    session.mesh.points, session.mesh.hexes
"""

import importlib.util
import sys
import warnings

from hextwist import _built_for

try:
    from hextwist._core import Cancelled, Error, Group, Mesh, Session, __version__
except ImportError as error:
    raise ImportError(
        f"hextwist was built for {_built_for.python} (Python {_built_for.version}), this is {sys.executable} "
        f"(Python {sys.version_info.major}.{sys.version_info.minor}): run that one, or build for this one with "
        f"-D Python_EXECUTABLE={sys.executable}"
    ) from error

if importlib.util.find_spec("numpy") is None:
    warnings.warn(
        f"{sys.executable} has no numpy, without which hextwist can run commands but hand out no arrays: install it "
        f"there, or run {_built_for.python}, for which hextwist was built",
        RuntimeWarning,
        stacklevel=2,
    )

__all__ = ["Cancelled", "Error", "Group", "Mesh", "Session", "__version__"]
