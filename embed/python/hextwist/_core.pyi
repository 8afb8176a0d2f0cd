"""Shapes and meanings are in the docstrings (help(hextwist.Session)) and in docs/embedding.md."""

import os
from typing import Any, Callable, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class Error(Exception):
    message: str
    line: int
    column: int

class Cancelled(Error): ...

class Group:
    @property
    def id(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def members(self) -> NDArray[np.int32]: ...
    @property
    def sides(self) -> Optional[NDArray[np.int32]]: ...  # (n, 2)

Groups = Mapping[int, Union[Group, ArrayLike, tuple[str, ArrayLike]]]

Rows = Tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.int64]]  # data, columns, first

class Mesh:
    @property
    def n_nodes(self) -> int: ...
    @property
    def n_hexes(self) -> int: ...
    @property
    def points(self) -> NDArray[np.float64]: ...  # (n_nodes, 3)
    @property
    def hexes(self) -> NDArray[np.int32]: ...  # (n_hexes, 8)
    @property
    def bit_hexes(self) -> NDArray[np.int32]: ...  # (n_hexes, 8)
    @property
    def node_ids(self) -> NDArray[np.int64]: ...  # (n_nodes,)
    @property
    def hex_ids(self) -> NDArray[np.int64]: ...  # (n_hexes,)
    @property
    def node_owners(self) -> NDArray[np.int32]: ...  # (n_nodes, 2)
    @property
    def node_parameters(self) -> NDArray[np.float64]: ...  # (n_nodes, 2)
    @property
    def hex_volumes(self) -> NDArray[np.int32]: ...  # (n_hexes,)
    @property
    def curve_edges(self) -> NDArray[np.int32]: ...  # (n, 2)
    @property
    def edge_curves(self) -> NDArray[np.int32]: ...  # (n,)
    @property
    def surface_quads(self) -> NDArray[np.int32]: ...  # (n, 4)
    @property
    def surface_sides(self) -> NDArray[np.int32]: ...  # (n, 2)
    @property
    def quad_surfaces(self) -> NDArray[np.int32]: ...  # (n,)
    @property
    def arrays(self) -> dict[str, NDArray[Any]]: ...
    @property
    def blocks(self) -> dict[int, Group]: ...
    @property
    def node_sets(self) -> dict[int, Group]: ...
    @property
    def side_sets(self) -> dict[int, Group]: ...
    @property
    def node_fields(self) -> dict[str, NDArray[np.float64]]: ...
    @property
    def hex_fields(self) -> dict[str, NDArray[np.float64]]: ...
    def group(self, kind: str, name: str) -> Group: ...
    def surfaces_of(self, faces: ArrayLike) -> NDArray[np.int32]: ...
    def locate(self, points: ArrayLike) -> tuple[NDArray[np.int32], NDArray[np.float64]]: ...
    def field_at(self, name: str, points: ArrayLike, *, on: str = "nodes") -> NDArray[np.float64]: ...
    def interpolation(self, points: ArrayLike) -> Rows: ...
    def prolongation(self, after: Mesh, origin: Optional[ArrayLike] = None) -> Rows: ...
    def quality(self, metric: str = "shape") -> NDArray[np.float64]: ...
    def n_entities(self, kind: str) -> int: ...
    def entity(self, kind: str, id: int) -> dict[str, Any]: ...
    def closest(
        self, kind: str, id: int, points: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...

class GmshLink:
    @property
    def on_cad(self) -> bool: ...
    @property
    def tags(self) -> dict[str, list[int]]: ...

def take_gmsh(session: Session, entities: list[Any], groups: list[Any], brep: Union[str, os.PathLike[str]]) -> GmshLink: ...
def put_gmsh(session: Session, link: GmshLink) -> list[Any]: ...

class Session:
    def __init__(
        self,
        output: Optional[Callable[[str], Any]] = None,
        notice: Optional[Callable[[str], Any]] = None,
        progress: Optional[Callable[[str, float], Any]] = None,
    ) -> None: ...
    @property
    def mesh(self) -> Mesh: ...
    @property
    def has_cad(self) -> bool: ...
    @property
    def finished(self) -> bool: ...
    @property
    def record(self) -> Optional[dict[str, Any]]: ...
    @property
    def records(self) -> list[dict[str, Any]]: ...
    def cmd(self, commands: str) -> bool: ...
    def import_cad(self, file: Union[str, os.PathLike[str]]) -> bool: ...
    def import_mesh(self, file: Union[str, os.PathLike[str]]) -> bool: ...
    def export_mesh(self, file: Union[str, os.PathLike[str]]) -> bool: ...
    def playback(self, file: Union[str, os.PathLike[str]]) -> bool: ...
    def take(
        self,
        points: ArrayLike,
        hexes: ArrayLike,
        *,
        node_ids: Optional[ArrayLike] = None,
        hex_ids: Optional[ArrayLike] = None,
        blocks: Groups = {},
        node_sets: Groups = {},
        side_sets: Groups = {},
        node_fields: Mapping[str, ArrayLike] = {},
        hex_fields: Mapping[str, ArrayLike] = {},
        node_owners: Optional[ArrayLike] = None,
        hex_volumes: Optional[ArrayLike] = None,
        curve_edges: Optional[ArrayLike] = None,
        edge_curves: Optional[ArrayLike] = None,
        surface_quads: Optional[ArrayLike] = None,
        quad_surfaces: Optional[ArrayLike] = None,
    ) -> None: ...
    def adapt(
        self,
        flags: Optional[ArrayLike] = None,
        *,
        sizes: Optional[ArrayLike] = None,
        gradation: bool = True,
        bias: float = 1.0,
        concave: str = "template",
        smooth: bool = False,
        method: str = "auto",
        extensive: Sequence[str] = [],
    ) -> NDArray[np.int32]: ...
    def adapt_levels(
        self, changes: ArrayLike, *, smooth: bool = False, extensive: Sequence[str] = []
    ) -> Tuple[NDArray[np.int8], NDArray[np.int32], NDArray[np.int32]]: ...
    def set_field(self, name: str, values: ArrayLike, *, on: str = "nodes") -> None: ...
    def ids(self, kind: str, range: str = "all") -> NDArray[np.int64]: ...
    def nodes_of(self, kind: str, id: int) -> NDArray[np.int64]: ...
