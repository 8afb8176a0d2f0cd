"""Refine the mesh of Gmsh's current model in place.

    import gmsh, hextwist.gmsh
    gmsh.initialize()
    gmsh.open("part.geo")
    gmsh.model.mesh.generate(3)
    hextwist.gmsh.refine("curve 3 numsplit 2")
    gmsh.write("part.msh")

The model has to have 8-node hexes and no other volume elements. New nodes lie on its OpenCASCADE CAD where it has that,
else (Gmsh's built-in kernel, models from mesh files) on the skin of the mesh. Every node and element goes back to
the entity (dim, tag) that it lies on; nodes and elements that were there keep their tags; physical groups
stay, since they are made of entities. Entities that no hex touches are left alone. Periodic correspondences of nodes on
refined entities are dropped.

Ids in commands are Gmsh's tags: of nodes and hexes always, of vertices, curves, surfaces and volumes where the tags are
1 .. n. Where they have gaps, a tag up to n is the id, and the others are named: `refine curve tag17`; a notice says
which. Physical groups can be named as blocks, side sets and node sets: `refine hex in block "steel"`.
"""

import os
import tempfile
from typing import Any, Callable, Dict, List, Optional

import gmsh as _gmsh

from hextwist import _core

__all__ = ["Link", "put", "refine", "take"]


class Link:
    """A session on the mesh of Gmsh's current model, made by take(). session: the hextwist.Session, to run commands in,
    then put(); model: the name of Gmsh's model."""

    def __init__(self, session: _core.Session, model: str, link: _core.GmshLink) -> None:
        self.session = session
        self.model = model
        self._link = link

    @property
    def tags(self) -> Dict[str, List[int]]:
        """{kind: list}: per "vertex", "curve", "surface", "volume" the tag in Gmsh of the entity of each id, from id 1;
        0: Gmsh has none."""
        return self._link.tags

    @property
    def on_cad(self) -> bool:
        """False: the session is on the skin of the mesh, since not all volumes with hexes are OpenCASCADE's."""
        return self._link.on_cad


def _read(dim, tag):
    mesh = _gmsh.model.mesh
    nodes, coord, parametric = mesh.getNodes(dim, tag, includeBoundary=False, returnParametricCoord=True)
    return (dim, tag, nodes, coord, parametric, *mesh.getElements(dim, tag))


def _groups():
    model = _gmsh.model
    return [
        (dim, tag, model.getPhysicalName(dim, tag), list(model.getEntitiesForPhysicalGroup(dim, tag)))
        for dim, tag in model.getPhysicalGroups()
    ]


def take(session: Optional[_core.Session] = None) -> Link:
    """The mesh of Gmsh's current model in a session (a new one by default; notices are printed), in place of the mesh
    and CAD that it had. Raises hextwist.Error, the session as it was: no hexes, other volume elements, elements on the
    boundary that are not sides or edges of hexes, a mesh that does not lie on its CAD."""
    session = session or _core.Session(notice=print)
    entities = [_read(dim, tag) for dim, tag in _gmsh.model.getEntities()]
    solids = set(_gmsh.model.occ.getEntities(3))
    cad = all((3, tag) in solids for dim, tag, *rest in entities if dim == 3 and len(rest[3]))
    with tempfile.TemporaryDirectory(prefix="hextwist-") as folder:
        brep = ""
        if cad:
            brep = os.path.join(folder, "model.brep")
            _gmsh.write(brep)
        link = _core.take_gmsh(session, entities, _groups(), brep)
    return Link(session, _gmsh.model.getCurrent(), link)


def _replace(entities):
    mesh = _gmsh.model.mesh
    # Boundaries can be cleared once nothing that they bound has elements.
    for dim in (3, 2, 1, 0):
        for entity in entities:
            if entity[0] == dim:
                mesh.clear([entity[:2]])
    for dim, tag, nodes, coord, parametric, *_ in entities:
        if len(nodes):
            mesh.addNodes(dim, tag, nodes, coord, parametric)
    for dim, tag, _, _, _, types, tags, nodes in entities:
        if len(types):
            mesh.addElements(dim, tag, types, tags, nodes)


def _parameters(dim, tag, coord):
    """Of points on geometry of Gmsh's own, where Gmsh can tell: not on ruled surfaces."""
    if dim == 2 and _gmsh.model.getType(dim, tag) != "Plane":
        return []
    try:
        return _gmsh.model.getParametrization(dim, tag, coord)
    except Exception:
        return []


def put(link: Link) -> None:
    """Puts the mesh of the session into the model that it was taken from, which has to be Gmsh's current one. Nodes and
    elements that were there keep their tags, new ones get tags above all in use. Raises hextwist.Error where another
    model is current or the session is on other CAD by now, and what Gmsh raises; Gmsh's model is then as it was."""
    if _gmsh.model.getCurrent() != link.model:
        raise _core.Error(f"the current model of Gmsh is not '{link.model}', where the mesh came from")
    fresh, before = _core.put_gmsh(link.session, link._link), []
    for i, entity in enumerate(fresh):
        dim, tag = entity[:2]
        before.append(_read(dim, tag))
        if len(entity[4]) == 0 and len(before[-1][4]):
            fresh[i] = (*entity[:4], _parameters(dim, tag, entity[3]), *entity[5:])
    try:
        _replace(fresh)
    except BaseException:
        _replace(before)
        raise


def refine(
    commands: str,
    *,
    output: Optional[Callable[[str], Any]] = None,
    notice: Optional[Callable[[str], Any]] = print,
    progress: Optional[Callable[[str, float], Any]] = None,
) -> _core.Session:
    """Takes the mesh, refines it and puts it back. commands: what stands behind `refine` ("curve 3 numsplit 2"), or
    whole commands, one per line or separated by ';'. Callbacks: those of hextwist.Session. Returns the session.
    Raises hextwist.Error (or what a callback raised, or KeyboardInterrupt) with Gmsh's model as it was."""
    session = _core.Session(output=output, notice=notice, progress=progress)
    link = take(session)
    first = commands.split(None, 1)[0].lower() if commands.strip() else ""
    kinds = ("node", "edge", "face", "hex", "vertex", "curve", "surface", "volume", "sheet")
    if first in kinds and not any(separator in commands.strip() for separator in ";\n"):
        # "node 5 position fixed" and the like are commands of their own.
        words = commands.lower().split()
        if "position" not in words and "scheme" not in words:
            commands = "refine " + commands
    session.cmd(commands)
    put(link)
    return session
