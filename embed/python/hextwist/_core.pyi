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
    id: int
    name: str
    members: NDArray[np.int32]

Groups = Mapping[int, Union[Group, ArrayLike, tuple[str, ArrayLike]]]

class Mesh:
    n_nodes: int
    n_hexes: int
    points: NDArray[np.float64]  # (n_nodes, 3)
    hexes: NDArray[np.int32]  # (n_hexes, 8)
    bit_hexes: NDArray[np.int32]  # (n_hexes, 8)
    node_ids: NDArray[np.int64]  # (n_nodes,)
    hex_ids: NDArray[np.int64]  # (n_hexes,)
    node_owners: NDArray[np.int32]  # (n_nodes, 2)
    node_parameters: NDArray[np.float64]  # (n_nodes, 2)
    hex_volumes: NDArray[np.int32]  # (n_hexes,)
    curve_edges: NDArray[np.int32]  # (n, 2)
    edge_curves: NDArray[np.int32]  # (n,)
    surface_quads: NDArray[np.int32]  # (n, 4)
    surface_sides: NDArray[np.int32]  # (n, 2)
    quad_surfaces: NDArray[np.int32]  # (n,)
    arrays: dict[str, NDArray[Any]]
    blocks: dict[int, Group]
    node_sets: dict[int, Group]
    side_sets: dict[int, Group]
    node_fields: dict[str, NDArray[np.float64]]
    hex_fields: dict[str, NDArray[np.float64]]
    def quality(self, metric: str = "shape") -> NDArray[np.float64]: ...
    def n_entities(self, kind: str) -> int: ...
    def entity(self, kind: str, id: int) -> dict[str, Any]: ...
    def closest(
        self, kind: str, id: int, points: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]: ...

class GmshLink:
    on_cad: bool
    tags: dict[str, list[int]]

def take_gmsh(session: Session, entities: list[Any], groups: list[Any], brep: Union[str, os.PathLike[str]]) -> GmshLink: ...
def put_gmsh(session: Session, link: GmshLink) -> list[Any]: ...

class Session:
    def __init__(
        self,
        output: Optional[Callable[[str], Any]] = None,
        notice: Optional[Callable[[str], Any]] = None,
        progress: Optional[Callable[[str, float], Any]] = None,
    ) -> None: ...
    mesh: Mesh
    has_cad: bool
    finished: bool
    record: Optional[dict[str, Any]]
    records: list[dict[str, Any]]
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
    ) -> NDArray[np.int32]: ...
    def adapt_levels(
        self, changes: ArrayLike, *, smooth: bool = False, extensive: Sequence[str] = []
    ) -> Tuple[NDArray[np.int8], NDArray[np.int32], NDArray[np.int32]]: ...
    def ids(self, kind: str, range: str = "all") -> NDArray[np.int64]: ...
    def nodes_of(self, kind: str, id: int) -> NDArray[np.int64]: ...
