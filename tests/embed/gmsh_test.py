"""Gmsh's current model, refined in place: checked with what Gmsh itself says."""

import os
import pathlib
import tempfile
import unittest

import gmsh
import numpy as np

import hextwist
import hextwist.gmsh

DATA = pathlib.Path(os.environ.get("HEXTWIST_TEST_DATA", "nowhere"))


def structured(n):
    """Transfinite hexes in every volume of six four-sided faces."""
    for _, curve in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(curve, n + 1)
    for _, surface in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(surface)
        gmsh.model.mesh.setRecombine(2, surface)
    for _, volume in gmsh.model.getEntities(3):
        gmsh.model.mesh.setTransfiniteVolume(volume)
    gmsh.model.mesh.generate(3)


def swept_plate(gap=False):
    """A plate with a round hole in four sweeps of four-sided faces."""
    occ = gmsh.model.occ
    if gap:  # tags that do not begin at 1
        occ.addBox(0, 0, 0, 1, 1, 1)
        occ.addBox(5, 5, 5, 1, 1, 1)
    centre = occ.addPoint(0, 0, 0)
    r = 6 / np.sqrt(2)
    inner = [occ.addPoint(x * r, y * r, 0) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    outer = [occ.addPoint(x * 20, y * 15, 0) for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    arcs = [occ.addCircleArc(inner[i], centre, inner[(i + 1) % 4]) for i in range(4)]
    rims = [occ.addLine(outer[i], outer[(i + 1) % 4]) for i in range(4)]
    spokes = [occ.addLine(inner[i], outer[i]) for i in range(4)]
    faces = [(2, occ.addPlaneSurface([occ.addCurveLoop([arcs[i], spokes[(i + 1) % 4], -rims[i], -spokes[i]])]))
             for i in range(4)]
    occ.extrude(faces, 0, 0, 8, [3], recombine=True)
    occ.remove([(0, centre)])
    if gap:
        occ.remove([(3, 1), (3, 2)], recursive=True)
    occ.synchronize()
    structured(4)


def snapshot():
    """Everything that Gmsh knows of the mesh."""
    mesh, result = gmsh.model.mesh, []
    for dim, tag in gmsh.model.getEntities():
        nodes = [array.tolist() for array in mesh.getNodes(dim, tag, False, True)]
        types, tags, of = mesh.getElements(dim, tag)
        result.append((dim, tag, nodes, list(types), [t.tolist() for t in tags], [n.tolist() for n in of]))
    groups = [(g, gmsh.model.getPhysicalName(*g), list(gmsh.model.getEntitiesForPhysicalGroup(*g)))
              for g in gmsh.model.getPhysicalGroups()]
    return result, groups


def entities_with_elements():
    return [e for e in gmsh.model.getEntities() if len(gmsh.model.mesh.getElements(*e)[0])]


def n_hexes():
    return len(gmsh.model.mesh.getElementsByType(5)[0])


class Gmsh(unittest.TestCase):
    def setUp(self):
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.add(self.id())

    def tearDown(self):
        gmsh.finalize()

    def refine(self, commands):
        self.notices, had = [], entities_with_elements()
        session = hextwist.gmsh.refine(commands, notice=self.notices.append)
        self.assertEqual(entities_with_elements(), had)
        return session

    def check(self, on_cad=True):
        """What must hold of any mesh that was put back."""
        mesh = gmsh.model.mesh
        tags, coord, _ = mesh.getNodes()
        self.assertEqual(len(set(tags)), len(tags))
        size = max(1e-300, float(np.abs(coord).max()))
        hexes, of = mesh.getElementsByType(5)
        self.assertEqual(len(set(hexes)), len(hexes))
        _, determinants, _ = mesh.getJacobians(5, mesh.getIntegrationPoints(5, "Gauss4")[0])
        self.assertGreater(determinants.min(), 0)
        qualities = mesh.getElementQualities(hexes, "minSICN") if hasattr(mesh, "getElementQualities") else [1]
        self.assertGreater(min(qualities), 0)
        home_of = {n: entity for entity in gmsh.model.getEntities() for n in mesh.getNodes(*entity)[0]}
        self.assertEqual(len(home_of), len(tags))
        element_tags = []
        for dim, tag in gmsh.model.getEntities():
            nodes, where, parameters = mesh.getNodes(dim, tag, False, True)
            if on_cad and dim in (1, 2) and len(nodes):
                self.assertEqual(len(parameters), dim * len(nodes))
                value = gmsh.model.getValue(dim, tag, parameters)
                self.assertLess(np.abs(value - where).max(), 1e-7 * size, (dim, tag))
                closest, _ = gmsh.model.getClosestPoint(dim, tag, where)
                self.assertLess(np.abs(closest - where).max(), 1e-6 * size, (dim, tag))
            if on_cad and dim == 0 and len(nodes):
                self.assertLess(np.abs(gmsh.model.getValue(0, tag, []) - where).max(), 1e-7 * size)
            types, tags_of, nodes_of = mesh.getElements(dim, tag)
            for kind, elements, corners in zip(types, tags_of, nodes_of):
                self.assertEqual(kind, {0: 15, 1: 1, 2: 3, 3: 5}[dim])
                element_tags += list(elements)
                # Corners of an element lie on its entity or on what bounds it.
                bounds = {(dim, tag)} | set(gmsh.model.getBoundary([(dim, tag)], False, False, False))
                for lower in list(bounds):
                    bounds |= set(gmsh.model.getBoundary([lower], False, False, False)) if lower[0] else set()
                    for lowest in gmsh.model.getBoundary([lower], False, False, False) if lower[0] else []:
                        bounds |= set(gmsh.model.getBoundary([lowest], False, False, False)) if lowest[0] else set()
                if on_cad:
                    self.assertLessEqual({home_of[n] for n in np.unique(corners)}, bounds)
        self.assertEqual(len(set(element_tags)), len(element_tags))
        # The quads are exactly the sides of hexes without a neighbour, and those between volumes.
        corners = of.reshape(-1, 8)
        volume_of = {}
        for _, tag in gmsh.model.getEntities(3):
            for element in np.concatenate([t for t in mesh.getElements(3, tag)[1]] or [np.array([])]):
                volume_of[element] = tag
        sides = {}
        for element, c in zip(hexes, corners):
            for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
                sides.setdefault(tuple(sorted(c[list(face)])), []).append(volume_of[element])
        self.assertLessEqual(max(len(s) for s in sides.values()), 2)
        skin = {key for key, s in sides.items() if len(s) == 1 or s[0] != s[1]}
        quads = mesh.getElementsByType(3)[1].reshape(-1, 4)
        self.assertEqual({tuple(sorted(q)) for q in quads}, skin)
        self.assertEqual(len(quads), len(skin))
        # A conformal skin: every edge of it has an even number of quads.
        count = {}
        for key in quads[[len(sides[tuple(sorted(q))]) == 1 for q in quads]] if len(quads) else []:
            for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
                edge = tuple(sorted((key[a], key[b])))
                count[edge] = count.get(edge, 0) + 1
        self.assertTrue(all(n % 2 == 0 for n in count.values()))

    def check_orientation(self, before):
        """Quads turn as those of their surface did: normals against the surface's; lines run as those of their curve."""
        for (dim, tag), sign in before.items():
            self.assertEqual(orientation(dim, tag), sign, (dim, tag))

    def check_written(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("a.msh", "a.vtk"):
                gmsh.write(os.path.join(folder, name))
            session = hextwist.Session()
            session.import_mesh(os.path.join(folder, "a.msh"))
            self.assertEqual(session.mesh.n_hexes, n_hexes())

    def test_box_with_groups_is_refined_and_put_back(self):
        gmsh.model.occ.addBox(0, 0, 0, 10, 10, 4)
        gmsh.model.occ.synchronize()
        structured(4)
        gmsh.model.addPhysicalGroup(3, [1], 3)
        gmsh.model.setPhysicalName(3, 3, "steel")
        gmsh.model.addPhysicalGroup(2, [1, 3], 7)
        gmsh.model.setPhysicalName(2, 7, "wall")
        gmsh.model.addPhysicalGroup(1, [2], 9)
        before, groups = snapshot()
        signs = {e: orientation(*e) for e in gmsh.model.getEntities(1) + gmsh.model.getEntities(2)}
        self.assertTrue(all(signs.values()), signs)
        old = {tag: tuple(x) for tag, x in nodes_at().items()}
        session = self.refine("curve 3")
        self.assertGreater(n_hexes(), 64)
        self.assertEqual(n_hexes(), session.mesh.n_hexes)
        self.check()
        self.check_orientation(signs)
        self.assertEqual(snapshot()[1], groups)
        new = nodes_at()
        self.assertTrue(all(tuple(new[tag]) == x for tag, x in old.items()))
        # Nodes and elements of the group are those of its entities, by Gmsh's own count.
        wall = set(gmsh.model.mesh.getNodesForPhysicalGroup(2, 7)[0])
        self.assertGreater(len(wall), 2 * 25 - 5)
        # What was not touched kept its elements.
        kept = {t for e in before for tags in e[4] for t in tags} & {t for e in snapshot()[0] for tags in e[4] for t in tags}
        self.assertGreater(len(kept), 50)
        self.check_written()
        self.refine("refine hex in block 'steel' with x_coord > 7; refine face in sideset 'wall' numsplit 1")
        self.check()
        self.check_orientation(signs)
        # Gmsh goes on with the mesh as with one of its own.
        gmsh.model.mesh.renumberNodes()
        gmsh.model.mesh.renumberElements()
        self.refine("vertex 1")
        self.check()
        gmsh.model.mesh.setOrder(2)
        with self.assertRaisesRegex(hextwist.Error, "27-node hex"):
            self.refine("vertex 1")

    def test_nodes_follow_a_round_hole(self):
        swept_plate()
        holes = [tag for _, tag in gmsh.model.getEntities(2) if gmsh.model.getType(2, tag) == "Cylinder"]
        self.assertEqual(len(holes), 4)
        signs = {e: orientation(*e) for e in gmsh.model.getEntities(1) + gmsh.model.getEntities(2)}
        before = n_hexes()
        self.refine(f"surface {holes[0]} {holes[1]} numsplit 2")
        self.assertGreater(n_hexes(), before)
        nodes, coord, _ = gmsh.model.mesh.getNodes(2, holes[0], True)
        self.assertLess(np.abs(np.hypot(coord[0::3], coord[1::3]) - 6).max(), 1e-9)
        self.check()
        self.check_orientation(signs)
        self.check_written()

    def test_commands_mean_tags_whatever_the_order_in_the_CAD(self):
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1, 2)
        gmsh.model.occ.addBox(5, 0, 0, 1, 1, 1, 1)
        gmsh.model.occ.synchronize()
        structured(3)
        far = [tag for _, tag in gmsh.model.getEntities(2) if gmsh.model.getBoundingBox(2, tag)[0] > 4]
        self.assertNotIn(1, far)  # in the order of the CAD, volume 1 comes first, and its surfaces
        for tag in (far[0], 1):
            before = {volume: len(gmsh.model.mesh.getElements(3, volume)[1][0]) for volume in (1, 2)}
            self.refine(f"surface {tag}")
            grown = [volume for volume, n in before.items() if len(gmsh.model.mesh.getElements(3, volume)[1][0]) > n]
            self.assertEqual(grown, [1 if tag in far else 2])
            self.assertEqual(self.notices, [])
            self.check()

    def test_tags_with_gaps_can_be_named_and_are_told(self):
        swept_plate(gap=True)
        volumes = [tag for _, tag in gmsh.model.getEntities(3)]
        surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
        self.assertGreater(max(volumes), len(volumes))
        self.assertGreater(max(surfaces), len(surfaces), "this test needs gaps")
        holes = [tag for tag in surfaces if gmsh.model.getType(2, tag) == "Cylinder"]
        hole = holes[-1]
        link = hextwist.gmsh.take(hextwist.Session())
        self.assertEqual(sorted(link.tags["surface"]), surfaces)
        for id, tag in enumerate(link.tags["surface"], 1):
            self.assertTrue(tag == id or id not in surfaces)
            ids = link.session.ids("surface", str(tag) if tag <= len(surfaces) else f"tag{tag}")
            self.assertEqual(list(ids), [id])
            self.assertEqual(link.session.mesh.entity("surface", id)["type"] == "cylinder", tag in holes)
        self.refine(f"surface tag{hole}" if hole > len(surfaces) else f"surface {hole}")
        self.assertTrue(any("tags of Gmsh have gaps" in line for line in self.notices), self.notices)
        nodes, coord, _ = gmsh.model.mesh.getNodes(2, hole, True)
        self.assertLess(np.abs(np.hypot(coord[0::3], coord[1::3]) - 6).max(), 1e-9)
        self.check()

    def test_hexes_from_subdivided_tetrahedra(self):
        occ = gmsh.model.occ
        occ.addBox(0, 0, 0, 20, 20, 6)
        occ.addCylinder(10, 10, -1, 0, 0, 8, 4)
        occ.cut([(3, 1)], [(3, 2)])
        occ.synchronize()
        gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 2)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 4)
        gmsh.model.mesh.generate(3)
        before = n_hexes()
        self.refine("curve in surface 7")
        self.assertGreater(n_hexes(), before)
        self.check()
        self.check_written()

    def test_a_sphere_of_subdivided_tetrahedra(self):
        gmsh.model.occ.addSphere(0, 0, 0, 10)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 2)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 6)
        gmsh.model.mesh.generate(3)
        self.refine("vertex 1")
        self.check()
        self.refine("curve in surface 1")
        self.check()

    def test_touching_volumes_with_meshes_of_their_own(self):
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.addBox(1, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        structured(3)
        self.refine("surface 2")
        self.check()
        self.assertEqual(len(gmsh.model.mesh.getElements(3, 2)[1][0]), 27)
        self.assertGreater(len(gmsh.model.mesh.getElements(3, 1)[1][0]), 27)

    def test_a_volume_without_a_mesh_is_left_alone(self):
        occ = gmsh.model.occ
        occ.addBox(0, 0, 0, 1, 1, 1)
        occ.addBox(1, 0, 0, 1, 1, 1)
        occ.fragment([(3, 1)], [(3, 2)])
        occ.synchronize()
        structured(3)
        gmsh.model.mesh.clear([(3, 2)])
        before = snapshot()
        with self.assertRaisesRegex(hextwist.Error, "is not an edge of a hex|is not a side of a hex"):
            self.refine("surface 2")
        self.assertEqual(snapshot(), before)
        for dim in (2, 1, 0):
            for entity in gmsh.model.getEntities(dim):
                if gmsh.model.getBoundingBox(*entity)[3] > 1.5:
                    gmsh.model.mesh.clear([entity])
        self.refine("surface 2")
        self.assertGreater(n_hexes(), 27)
        self.check()
        self.assertTrue(any("volume has no hex" in line for line in self.notices), self.notices)

    def test_two_volumes_share_their_surface(self):
        occ = gmsh.model.occ
        occ.addBox(0, 0, 0, 1, 1, 1)
        occ.addBox(1, 0, 0, 1, 1, 1)
        occ.fragment([(3, 1)], [(3, 2)])
        occ.synchronize()
        structured(3)
        shared = [tag for _, tag in gmsh.model.getEntities(2) if len(gmsh.model.getAdjacencies(2, tag)[0]) == 2]
        self.assertEqual(len(shared), 1)
        signs = {e: orientation(*e) for e in gmsh.model.getEntities(1) + gmsh.model.getEntities(2)}
        self.refine(f"surface {shared[0]}")
        self.check()
        self.check_orientation(signs)
        for volume in (1, 2):
            coord = gmsh.model.mesh.getNodes(3, volume)[1][0::3]
            self.assertTrue(((coord < 1) == (gmsh.model.getBoundingBox(3, volume)[0] < 0.5)).all())

    def test_cylinder_with_seam_and_sphere_with_poles(self):
        models = pathlib.Path(__file__).resolve().parents[2] / "models"
        for name, target in (("cylinder", "curve 1"), ("sphere", "surface 1"), ("inclusion", "surface 1")):
            with self.subTest(name):
                gmsh.model.add(name)
                gmsh.merge(str(models / f"{name}.brep"))
                gmsh.merge(str(models / f"{name}.msh"))
                before = n_hexes()
                self.refine(target)
                self.assertGreater(n_hexes(), before)
                self.check()

    def test_built_in_geometry_is_refined_on_the_skin(self):
        geo = gmsh.model.geo
        centre = geo.addPoint(0, 0, 0)
        a, b = geo.addPoint(2, 0, 0), geo.addPoint(0, 2, 0)
        c, d = geo.addPoint(5, 0, 0), geo.addPoint(0, 5, 0)
        lines = [geo.addLine(a, c), geo.addCircleArc(c, centre, d), geo.addLine(d, b), geo.addCircleArc(b, centre, a)]
        surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
        for line in lines:
            geo.mesh.setTransfiniteCurve(line, 5)
        geo.mesh.setTransfiniteSurface(surface)
        geo.mesh.setRecombine(2, surface)
        geo.extrude([(2, surface)], 0, 0, 2, [3], recombine=True)
        geo.synchronize()
        gmsh.model.mesh.generate(3)
        before = n_hexes()
        lone = gmsh.model.mesh.getNodes(0, centre)[0]
        self.refine("surface 1")
        self.assertGreater(n_hexes(), before)
        self.check(on_cad=False)
        self.assertEqual(list(gmsh.model.mesh.getNodes(0, centre)[0]), list(lone))
        for dim, tag in gmsh.model.getEntities():
            nodes, coord, parameters = gmsh.model.mesh.getNodes(dim, tag, False, True)
            if dim == 1 or (dim == 2 and gmsh.model.getType(dim, tag) == "Plane"):
                self.assertEqual(len(parameters), dim * len(nodes))
        # Between the planes z = 0 and 2, classified as such.
        self.assertLess(np.abs(gmsh.model.mesh.getNodes(2, 1, True)[1][2::3]).max(), 1e-12)

    def test_a_model_from_a_mesh_file_keeps_its_discrete_entities(self):
        gmsh.model.occ.addBox(0, 0, 0, 2, 1, 1)
        gmsh.model.occ.synchronize()
        structured(3)
        with tempfile.TemporaryDirectory() as folder:
            gmsh.write(os.path.join(folder, "box.msh"))
            gmsh.model.add("discrete")
            gmsh.merge(os.path.join(folder, "box.msh"))
        entities = gmsh.model.getEntities()
        self.assertEqual(len(entities), 8 + 12 + 6 + 1)
        self.refine("curve 5")
        self.check(on_cad=False)
        self.assertEqual(gmsh.model.getEntities(), entities)
        for dim, tag in entities:
            self.assertGreater(len(gmsh.model.mesh.getElements(dim, tag)[1][0]), 0)
            if dim == 2:  # on its plane: all lie in one coordinate plane
                coord = gmsh.model.mesh.getNodes(dim, tag, True)[1].reshape(-1, 3)
                self.assertEqual((np.ptp(coord, axis=0) < 1e-12).sum(), 1)

    def test_failures_leave_the_model_as_it_was(self):
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        with self.assertRaisesRegex(hextwist.Error, "no hexes"):
            self.refine("curve 3")
        structured(3)
        before = snapshot()
        for commands, words in (("curve 99", "curve 99 does not exist"), ("refine crve 3", "did you mean"),
                                ("refine hex 1; import mesh 'nowhere.msh'", "nowhere.msh")):
            with self.assertRaisesRegex(hextwist.Error, words):
                self.refine(commands)
            self.assertEqual(snapshot(), before)

        def interrupt(stage, fraction):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            hextwist.gmsh.refine("curve 3", progress=interrupt)
        self.assertEqual(snapshot(), before)
        link = hextwist.gmsh.take()
        link.session.cmd("reset; create brick x 1 y 1 z 1 interval 2 2 2")
        with self.assertRaisesRegex(hextwist.Error, "another model"):
            hextwist.gmsh.put(link)
        gmsh.model.add("other")
        with self.assertRaisesRegex(hextwist.Error, "current model"):
            hextwist.gmsh.put(link)
        gmsh.model.setCurrent(self.id())
        self.assertEqual(snapshot(), before)

    def test_a_failure_of_gmsh_itself_is_undone(self):
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        structured(3)
        before = snapshot()
        link = hextwist.gmsh.take()
        link.session.cmd("refine curve 3")
        add, calls = gmsh.model.mesh.addElements, []

        def failing(*arguments):
            calls.append(arguments)
            if len(calls) == 5:
                raise RuntimeError("no more")
            add(*arguments)

        hextwist.gmsh._gmsh.model.mesh.addElements = failing
        try:
            with self.assertRaisesRegex(RuntimeError, "no more"):
                hextwist.gmsh.put(link)
        finally:
            hextwist.gmsh._gmsh.model.mesh.addElements = add
        self.assertEqual(snapshot(), before)

    def test_other_elements_are_refused_by_name(self):
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(3)
        before = snapshot()
        with self.assertRaisesRegex(hextwist.Error, "of volume 1 is a tetrahedron; only 8-node hexes"):
            self.refine("curve 3")
        self.assertEqual(snapshot(), before)
        gmsh.model.mesh.clear()
        structured(2)
        tag = gmsh.model.addDiscreteEntity(2)
        corner = int(gmsh.model.mesh.getNodes(0, 1)[0][0])
        other = int(gmsh.model.mesh.getNodes(0, 8)[0][0])
        third = int(gmsh.model.mesh.getNodes(0, 2)[0][0])
        gmsh.model.mesh.addElements(2, tag, [2], [[9999]], [[corner, other, third]])
        with self.assertRaisesRegex(hextwist.Error, f"element 9999 of surface {tag} is a triangle"):
            self.refine("curve 3")

    def test_real_parts_with_their_cad(self):
        pairs = sorted((DATA / "cad").glob("*.brep")) if (DATA / "cad").is_dir() else []
        if not pairs:
            self.skipTest("the data are not there")
        for brep in pairs:
            with self.subTest(brep.stem):
                gmsh.model.add(brep.stem)
                gmsh.merge(str(brep))
                gmsh.merge(str(brep.with_name(brep.stem + "_1k.msh")))
                before = n_hexes()
                self.refine("surface 2")
                self.assertGreater(n_hexes(), before)
                self.check()


def nodes_at():
    tags, coord, _ = gmsh.model.mesh.getNodes()
    return dict(zip(tags, coord.reshape(-1, 3)))


def orientation(dim, tag):
    """+1: the elements of a surface turn as its normal says, lines of a curve run as its parameter does; -1: against;
    0: both occur."""
    at = nodes_at()
    nodes = gmsh.model.mesh.getElements(dim, tag)[2]
    signs = set()
    for element in nodes[0].reshape(-1, 4 if dim == 2 else 2):
        p = np.array([at[n] for n in element])
        middle = p.mean(axis=0)
        parameters = gmsh.model.getParametrization(dim, tag, middle)
        if dim == 2:
            normal = np.cross(p[2] - p[0], p[3] - p[1])
            signs.add(np.sign(normal @ gmsh.model.getNormal(tag, parameters)))
        else:
            signs.add(np.sign((p[1] - p[0]) @ gmsh.model.getDerivative(1, tag, parameters)))
    return signs.pop() if len(signs) == 1 else 0
