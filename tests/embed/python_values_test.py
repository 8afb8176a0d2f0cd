"""The Python package: fields one by one, at points and from mesh to mesh; groups and surfaces looked up."""

import unittest

import numpy as np

import hextwist
from python_test import session_on


class Values(unittest.TestCase):
    @staticmethod
    def linear(points):
        return points @ [1.0, -2.0, 3.0] + 4

    @staticmethod
    def times(rows, x):
        data, columns, first = rows
        return np.add.reduceat(data * x[columns], first[:-1])

    def test_a_field_is_set_undone_and_carried(self):
        session = session_on("bracket")
        bare = session.mesh
        session.set_field("linear", self.linear(bare.points))
        session.set_field("class", np.arange(488) // 100, on="hexes")
        session.set_field("pair", np.stack([bare.points[:, 0], bare.points[:, 1]], axis=1))
        self.assertNotIn("linear", bare.node_fields)
        self.assertEqual(session.mesh.node_fields["pair"].shape, (bare.n_nodes, 2))
        origin = session.adapt(np.arange(488) % 50 == 0)
        after = session.mesh
        self.assertLess(np.abs(after.node_fields["linear"] - self.linear(after.points)).max(), 1e-10)
        self.assertTrue((after.hex_fields["class"] == origin // 100).all())
        session.set_field("late", after.points[:, 0])
        session.adapt_levels(np.full(after.n_hexes, -3))
        self.assertEqual(session.mesh.n_hexes, 488, "levels go on behind a field that was set")
        self.assertTrue((session.mesh.node_fields["late"] == bare.points[:, 0]).all())
        for _ in range(6):
            session.cmd("undo")
        self.assertEqual(list(session.mesh.node_fields), list(bare.node_fields))
        for wrong, kind in ((dict(name="a", values=[1.0]), hextwist.Error), (dict(name="", values=bare.points), hextwist.Error),
                            (dict(name="level", values=np.zeros(488), on="hexes"), hextwist.Error),
                            (dict(name="a", values=np.zeros((2, 2, 2))), ValueError), (dict(name="a", values=["x"]), TypeError),
                            (dict(name="a", values=bare.points, on="faces"), ValueError)):
            with self.assertRaises(kind):
                session.set_field(**wrong)

    def test_points_and_prolongation_are_exact_for_what_is_linear(self):
        session = session_on("bracket")
        session.set_field("linear", self.linear(session.mesh.points))
        before = session.mesh
        origin = session.adapt(np.arange(488) % 9 == 0)
        after = session.mesh
        values = self.linear(before.points)
        for rows in (before.prolongation(after, origin), before.prolongation(after)):
            self.assertLess(np.abs(self.times(rows, values) - self.linear(after.points)).max(), 1e-10)
            data, columns, first = rows
            self.assertEqual((data.dtype, columns.dtype, first.dtype, len(first)), (np.float64, np.int32, np.int64, after.n_nodes + 1))
        middles = after.points[after.hexes].mean(axis=1)
        hexes, distances = after.locate(middles)
        self.assertTrue((hexes == np.arange(after.n_hexes)).all() and (distances == 0).all())
        self.assertLess(np.abs(after.field_at("linear", middles) - self.linear(middles)).max(), 1e-10)
        self.assertLess(np.abs(self.times(after.interpolation(middles), self.linear(after.points)) - self.linear(middles)).max(), 1e-10)
        self.assertTrue((after.field_at("level", middles, on="hexes") == after.hex_fields["level"]).all())
        self.assertGreater(after.locate([[1e4, 0, 0]])[1][0], 9e3)
        for wrong, kind in ((lambda: after.field_at("no such", middles), hextwist.Error), (lambda: after.locate([1, 2, 3]), ValueError),
                            (lambda: after.locate([[np.nan, 0, 0]]), hextwist.Error), (lambda: before.prolongation(after, [1]), ValueError),
                            (lambda: before.prolongation(after, np.full(after.n_hexes, 10**6)), hextwist.Error),
                            (lambda: hextwist.Session().mesh.locate([[0, 0, 0]]), hextwist.Error)):
            with self.assertRaises(kind):
                wrong()

    def test_groups_by_name_sides_and_surfaces(self):
        mesh = session_on("bracket").mesh
        for group in mesh.side_sets.values():
            self.assertEqual(mesh.group("sideset", group.name).id, group.id)
            corners = mesh.bit_hexes[group.sides[:, 0]]
            on = (np.arange(8)[None, :] >> (group.sides[:, 1:] >> 1) & 1) == (group.sides[:, 1:] & 1)
            self.assertTrue((np.sort(corners[on].reshape(-1, 4)) == np.sort(group.members)).all())
        self.assertIsNone(next(iter(mesh.blocks.values())).sides)
        for faces in (mesh.surface_quads, mesh.surface_quads[:, ::-1], mesh.surface_sides):
            self.assertTrue((mesh.surfaces_of(faces) == mesh.quad_surfaces).all())
        self.assertEqual(mesh.surfaces_of([[0, 0, 1, 10**9]]).tolist(), [0])
        self.assertEqual(mesh.surfaces_of([]).tolist(), [])
        group = mesh.group("sideset", "bore")
        other = hextwist.Session()
        other.take(mesh.points, mesh.hexes, side_sets={5: ("bore", group.sides)})
        self.assertTrue((other.mesh.group("sideset", "bore").members == group.members).all())
        for wrong, kind in ((lambda: mesh.group("sideset", "no such"), hextwist.Error), (lambda: mesh.group("set", "bore"), ValueError),
                            (lambda: mesh.surfaces_of([[0, 6]]), ValueError), (lambda: mesh.surfaces_of([[1, 2, 3]]), ValueError),
                            (lambda: other.take(mesh.points, mesh.hexes, side_sets={1: [[488, 0]]}), ValueError)):
            with self.assertRaises(kind):
                wrong()

    def test_a_method_is_chosen(self):
        for method, pieces in (("auto", 27), ("single", 27), ("parallel", 8)):
            session = hextwist.Session()
            session.cmd("create brick x 4 y 4 z 4 interval 4 4 4")
            origin = session.adapt(np.arange(64) == 21, method=method)
            self.assertEqual((origin == 21).sum(), pieces, method)
        for wrong in (dict(flags=np.zeros(1), method="round"), dict(sizes=np.ones(64), method="single")):
            with self.assertRaises(ValueError):
                session.adapt(**wrong)
