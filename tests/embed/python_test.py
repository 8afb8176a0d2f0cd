"""The Python package: arrays, lifetimes, errors, callbacks, Ctrl-C, docstrings."""

import _thread
import ast
import gc
import html
import importlib
import inspect
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import weakref

import numpy as np

import hextwist

MODELS = pathlib.Path(__file__).resolve().parents[2] / "models"


def session_on(name, **callbacks):
    session = hextwist.Session(**callbacks)
    session.import_cad(MODELS / f"{name}.brep")
    session.import_mesh(MODELS / f"{name}.msh")
    return session


def volumes(mesh):
    """Of each hex by the triple products at its corners' tetrahedra around the middle: six pyramids."""
    p = mesh.points[mesh.hexes]
    middle = p.mean(axis=1)
    total = np.zeros(len(p))
    for face in ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
        a, b, c, d = (p[:, k] - middle for k in face)
        for x, y, z in ((a, b, c), (a, c, d), (a, b, d), (b, c, d)):  # both ways to cut the quad
            total += np.einsum("ij,ij->i", x, np.cross(y, z)) / 12
    return total


class Interpreters(unittest.TestCase):
    def run_python(self, code):
        # Without the packages of the interpreter.
        return subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, check=False)

    def test_one_without_numpy_is_told_which_has_it_and_runs_commands(self):
        ran = self.run_python("import hextwist; hextwist.Session().cmd('create brick x 1 interval 2'); print('fine')")
        self.assertEqual(ran.stdout, "fine\n", ran.stderr)
        self.assertIn("has no numpy", ran.stderr)
        self.assertIn(hextwist._built_for.python, ran.stderr)

    def test_one_of_another_version_is_told_which_it_was_built_for(self):
        ran = self.run_python("import sys; sys.modules['hextwist._core'] = None; import hextwist")
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn(f"hextwist was built for {hextwist._built_for.python} (Python 3.", ran.stderr)


class Arrays(unittest.TestCase):
    def test_have_the_stated_shapes_and_describe_the_mesh(self):
        mesh = session_on("bracket").mesh
        self.assertEqual(mesh.n_hexes, 488)
        n = mesh.n_nodes
        for name, shape, dtype in (
            ("points", (n, 3), np.float64),
            ("hexes", (488, 8), np.int32),
            ("bit_hexes", (488, 8), np.int32),
            ("node_ids", (n,), np.int64),
            ("hex_ids", (488,), np.int64),
            ("node_owners", (n, 2), np.int32),
            ("node_parameters", (n, 2), np.float64),
            ("hex_volumes", (488,), np.int32),
        ):
            array = getattr(mesh, name)
            self.assertEqual((array.shape, array.dtype), (shape, dtype), name)
            self.assertFalse(array.flags.writeable, name)
            with self.assertRaises(ValueError):
                array[0] = 0
        self.assertTrue((mesh.hexes[:, [0, 1, 3, 2, 4, 5, 7, 6]] == mesh.bit_hexes).all())
        self.assertAlmostEqual(volumes(mesh).sum() / 33256.637, 1, delta=0.01)
        self.assertEqual(mesh.curve_edges.shape, (len(mesh.edge_curves), 2))
        self.assertEqual(mesh.surface_quads.shape, (len(mesh.quad_surfaces), 4))
        self.assertEqual(mesh.surface_sides.shape, (len(mesh.quad_surfaces), 2))

    def test_points_are_not_copied(self):
        session = session_on("bracket")
        one, two = session.mesh.points, session.mesh.points
        self.assertEqual(one.__array_interface__["data"], two.__array_interface__["data"])

    def test_nodes_lie_on_their_owners_at_their_parameters(self):
        session = session_on("cylinder")
        session.cmd("refine surface 1")
        mesh = session.mesh
        on = (mesh.node_owners == (2, 1)).all(axis=1)
        self.assertGreater(on.sum(), 10)
        points, parameters, distances = mesh.closest("surface", 1, mesh.points[on])
        self.assertLess(distances.max(), 1e-9 * 100)
        self.assertLess(np.abs(points - mesh.points[on]).max(), 1e-7)
        self.assertEqual(parameters.shape, (on.sum(), 2))

    def test_stay_as_they_are_while_the_session_goes_on(self):
        session = session_on("bracket")
        session.cmd("block 5 hex 1 to 4; nodeset 6 hex 1; sideset 7 surface 6")
        mesh = session.mesh
        points, block, sides = mesh.points, mesh.blocks[5].members, mesh.side_sets[7].members
        copies = points.copy(), block.copy(), sides.copy()
        hexes = mesh.hexes
        del mesh
        session.cmd("block 5 add hex 9 to 20; sideset 7 add surface 1; smooth volume all; refine curve 5; undo")
        session.cmd("refine hex 1 to 7")
        self.assertEqual(len(session.mesh.blocks[5].members) > 4, True)
        del session
        gc.collect()
        for array, copy in zip((points, block, sides), copies):
            self.assertTrue((array == copy).all())
        self.assertEqual(hexes.max(), len(points) - 1)

    def test_of_an_empty_session_are_empty(self):
        mesh = hextwist.Session().mesh
        self.assertEqual(mesh.points.shape, (0, 3))
        self.assertEqual(mesh.hexes.shape, (0, 8))
        self.assertEqual(mesh.n_entities("surface"), 0)
        self.assertEqual((mesh.blocks, mesh.hex_fields), ({}, {}))

    def test_go_into_another_session_and_come_out_the_same(self):
        session = session_on("inclusion")
        session.cmd("refine curve 3; nodeset 9 surface 1 name 'rim'; sideset 8 surface 2")
        mesh = session.mesh
        field = np.linspace(0, 1, 2 * mesh.n_nodes).reshape(-1, 2)
        other = hextwist.Session()
        other.import_cad(MODELS / "inclusion.brep")
        arguments = dict(
            node_ids=mesh.node_ids, hex_ids=mesh.hex_ids, blocks=mesh.blocks, node_sets=mesh.node_sets,
            side_sets=mesh.side_sets, hex_fields={"g": np.arange(mesh.n_hexes)},
            node_fields={"f": field, "kind": 7 * (np.arange(len(mesh.points)) % 2)},
            node_owners=mesh.node_owners, hex_volumes=mesh.hex_volumes, curve_edges=mesh.curve_edges,
            edge_curves=mesh.edge_curves, surface_quads=mesh.surface_quads, quad_surfaces=mesh.quad_surfaces)
        other.take(mesh.points, mesh.hexes, **arguments)
        same = other.mesh
        for name in ("points", "hexes", "node_ids", "hex_ids", "node_owners", "hex_volumes", "curve_edges",
                     "edge_curves", "surface_quads", "quad_surfaces"):
            self.assertTrue((getattr(mesh, name) == getattr(same, name)).all(), name)
        for groups in ("blocks", "node_sets", "side_sets"):
            a, b = getattr(mesh, groups), getattr(same, groups)
            self.assertEqual(list(a), list(b))
            for id in a:
                self.assertEqual(a[id].name, b[id].name)
                self.assertTrue((a[id].members == b[id].members).all())
        self.assertTrue((same.node_fields["f"] == field).all())
        self.assertTrue((same.arrays["node_fields/f"] == field).all())
        for name in ("points", "bit_hexes", "node_owners", "edge_curves", "surface_sides", "quad_surfaces"):
            self.assertIs(same.arrays[name].base, same)  # shown, not copied
            self.assertTrue((same.arrays[name] == getattr(same, name)).all(), name)
        self.assertEqual(sorted(name for name in same.arrays if name.startswith("blocks/")),
                         sorted(f"blocks/{id}" for id in mesh.blocks))
        self.assertTrue((same.hex_fields["g"] == np.arange(mesh.n_hexes)).all())
        self.assertTrue(other.has_cad)
        other.cmd("refine curve 5")
        self.assertEqual(sorted(set(other.mesh.node_fields["kind"])), [0, 7])  # of integers: nothing in between

    def test_without_cad_get_a_model_of_their_skin(self):
        points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in range(3)], dtype=float)
        hexes = [[0, 1, 4, 3, 6, 7, 10, 9], [1, 2, 5, 4, 7, 8, 11, 10]]
        session = hextwist.Session()
        session.take(points, hexes, blocks={4: ("left", [0]), 2: [1]})
        self.assertFalse(session.has_cad)
        self.assertEqual(session.mesh.n_entities("volume"), 2)
        self.assertEqual({i: (g.name, list(g.members)) for i, g in session.mesh.blocks.items()},
                         {2: ("", [1]), 4: ("left", [0])})
        session.cmd("refine hex 1")
        self.assertAlmostEqual(volumes(session.mesh).sum(), 2)

    def test_that_are_wrong_are_refused_by_name(self):
        points = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], dtype=float)
        hexes = np.array([[0, 1, 3, 2, 4, 5, 7, 6]])
        session = hextwist.Session()
        for error, words, change in (
            (ValueError, "points", dict(points=points[:, :2])),
            (ValueError, "hexes", dict(hexes=hexes[:, :4])),
            (TypeError, "hexes: integers", dict(hexes=hexes.astype(float))),
            (ValueError, "too large", dict(hexes=hexes + 2**40)),
            (hextwist.Error, r"hexes\[0\]: there is no node 8", dict(hexes=hexes + 1)),
            (ValueError, "node_ids: 8 rows", dict(node_ids=[1, 2])),
            (hextwist.Error, r"node_ids\[1\]", dict(node_ids=[1, 1, 2, 3, 4, 5, 6, 7])),
            (ValueError, "go together", dict(curve_edges=[[0, 1]])),
            (ValueError, "field 'a'", dict(node_fields={"a": [1.0]})),
            (ValueError, "field 'u' has no component", dict(node_fields={"u": np.zeros((8, 0))})),
            (TypeError, "names of fields", dict(node_fields={1: np.zeros(8)})),
            (TypeError, "points: an array of numbers", dict(points=[["a"] * 3] * 8)),
            (TypeError, "points: an array of numbers is wanted, not of complex128", dict(points=points * 1j)),
            (TypeError, "u: an array of numbers", dict(node_fields={"u": np.zeros(8, dtype=complex)})),
            (ValueError, "blocks: ids are integers", dict(blocks={"x": [0]})),
            (ValueError, "blocks: ids are integers", dict(blocks={1.5: [0]})),
            (ValueError, "node_sets: ids are integers", dict(node_sets={2**40: [0]})),
            (hextwist.Error, r"hex_volumes\[0\]: there is no volume -7", dict(hex_volumes=[-7])),
            (TypeError, "blocks: members are indices", dict(blocks={1: [True]})),
            (TypeError, "node_sets: members are indices", dict(node_sets={1: points[:, 0] > 0.5})),
            (ValueError, "blocks: the name of 1 has a zero byte", dict(blocks={1: ("a\0b", [0])})),
            (ValueError, "node_ids: 18446744073709551615 is too large", dict(node_ids=np.full(8, 2**64 - 1, np.uint64))),
            (ValueError, r"id: 9007199254740993 can't be kept", dict(node_fields={"id": np.full(8, 2**53 + 1)})),
            (hextwist.Error, "not a side", dict(side_sets={1: [[0, 1, 2, 7]]})),
            (hextwist.Error, "hex 1 is flat", dict(points=points * 0)),
        ):
            with self.assertRaisesRegex(error, words):
                session.take(**(dict(points=points, hexes=hexes) | change))
        self.assertEqual(session.mesh.n_hexes, 0)
        session.take(points, hexes)
        self.assertEqual(session.mesh.n_hexes, 1)
        with self.assertRaisesRegex(ValueError, r"points\[1\]: a coordinate is not finite"):
            session.mesh.closest("surface", 1, [[0, 0, 0], [0, np.nan, 0]])

    def test_objects_that_nobody_made_are_refused(self):
        with self.assertRaisesRegex(hextwist.Error, "was not made"):
            hextwist.Session.__new__(hextwist.Session).cmd("list")
        with self.assertRaises(TypeError):
            hextwist.Mesh.__new__(hextwist.Mesh)


class Commands(unittest.TestCase):
    def test_return_true_or_raise_what_the_program_prints(self):
        session = session_on("bracket")
        self.assertIs(session.cmd("refine curve 5"), True)
        n = session.mesh.n_hexes
        with self.assertRaises(hextwist.Error) as raised:
            session.cmd("# a comment\n  refine crve 3")
        error = raised.exception
        self.assertEqual((error.line, error.column), (2, 10))
        self.assertIn("did you mean 'curve'?", error.message)
        self.assertIn("^~~~", str(error))
        self.assertIn(error.message, str(error))
        self.assertEqual(session.mesh.n_hexes, n)
        with self.assertRaisesRegex(hextwist.Error, "no_such.msh"):
            session.import_mesh("no_such.msh")

    def test_leave_records_by_the_names_of_the_report(self):
        session = session_on("bracket")
        self.assertIsNone(hextwist.Session().record)
        session.cmd("refine curve 5")
        record = session.record
        self.assertEqual((record["command"], record["ok"], record["error"]), ("refine curve 5", True, None))
        self.assertEqual((record["hexes_before"], record["hexes_after"]), (488, session.mesh.n_hexes))
        self.assertAlmostEqual(record["shape"]["after"]["min"], session.mesh.quality("shape").min())
        self.assertEqual(len(session.records), 3)
        with self.assertRaises(hextwist.Error):
            session.cmd("refine curve 999")
        self.assertEqual((session.record["ok"], session.record["error_place"]), (False, {"line": 1, "column": 14}))

    def test_files_may_have_any_name(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "it's \"née\" ;.msh"
            session = session_on("bracket")
            session.export_mesh(file)
            other = hextwist.Session()
            other.import_mesh(str(file))
            self.assertEqual(other.mesh.n_hexes, 488)
            journal = pathlib.Path(folder) / "a journal"
            journal.write_text("refine curve 5\n")
            self.assertTrue(session.playback(journal))
            self.assertGreater(session.mesh.n_hexes, 488)

    def test_ids_are_those_of_the_language(self):
        session = session_on("inclusion")
        mesh = session.mesh
        for volume in (1, 2):
            expected = mesh.hex_ids[mesh.hex_volumes == volume]
            self.assertTrue((session.ids("hex", f"in volume {volume}") == expected).all())
        self.assertEqual(list(session.ids("volume")), [1, 2])
        nodes = session.nodes_of("curve", 3)
        self.assertTrue(set(mesh.node_ids[(mesh.node_owners == (1, 3)).all(axis=1)]) <= set(nodes))
        self.assertTrue((nodes == session.ids("node", "in curve 3")).all())
        for kind, words in (("curve", "curve 999"), ("colour", "colour")):
            with self.assertRaisesRegex(hextwist.Error, words):
                session.ids(kind, "999")

    def test_entities_are_described(self):
        mesh = session_on("cylinder").mesh
        total = sum(mesh.entity("surface", i)["measure"] for i in range(1, mesh.n_entities("surface") + 1))
        self.assertAlmostEqual(total / 10053.096, 1, places=6)
        kinds = {mesh.entity("surface", i)["type"] for i in range(1, 4)}
        self.assertEqual(kinds, {"plane", "cylinder"})
        self.assertEqual(mesh.entity("volume", 1)["adjacent"]["surface"], [1, 2, 3])
        with self.assertRaisesRegex(hextwist.Error, "surface 4 does not exist"):
            mesh.entity("surface", 4)
        with self.assertRaisesRegex(ValueError, "face"):
            mesh.entity("face", 1)


class Adapting(unittest.TestCase):
    def test_by_flags_and_sizes_says_where_hexes_come_from(self):
        session = session_on("bracket")
        before = session.mesh
        flags = np.zeros(488, dtype=bool)
        flags[17] = True
        origin = session.adapt(flags)
        after = session.mesh
        self.assertEqual(origin.shape, (after.n_hexes,))
        self.assertEqual((origin == 17).sum(), 27)
        # New nodes follow the curves of the CAD, so volumes of parents are kept only nearly.
        sums = np.bincount(origin, weights=volumes(after))
        self.assertLess(np.abs(sums / volumes(before) - 1).max(), 0.2)
        session.cmd("undo")
        self.assertEqual(session.mesh.n_hexes, 488)
        sizes = np.full(488, np.inf)
        sizes[17] = 1
        session.adapt(sizes=sizes, bias=1.5)
        self.assertGreater(session.mesh.n_hexes, 488)
        for wrong in (dict(), dict(flags=flags, sizes=sizes), dict(flags=flags, concave="round")):
            with self.assertRaises(ValueError):
                session.adapt(**wrong)
        with self.assertRaisesRegex(hextwist.Error, "488 flags"):
            session.adapt(flags)
        with self.assertRaises(TypeError):
            session.adapt(flags.astype(float))


    def test_levels_go_both_ways(self):
        session = hextwist.Session()
        session.cmd("create brick x 4 interval 4")
        before = session.mesh
        up = np.zeros(64, dtype=int)
        up[21] = 2
        kind, first, hexes = session.adapt_levels(up)
        fine = session.mesh
        self.assertEqual((kind.shape, first.shape), ((fine.n_hexes,), (fine.n_hexes + 1,)))
        self.assertEqual((hexes[first[:-1]][kind > 0] == 21).sum(), 729)
        self.assertGreaterEqual(fine.quality("scaled jacobian").min(), 0.405)
        kind, first, hexes = session.adapt_levels(np.full(fine.n_hexes, -2))
        self.assertTrue((session.mesh.points == before.points).all())
        self.assertEqual(sorted(hexes), sorted(set(hexes)), "every hex of before is named once")
        self.assertEqual(len(hexes), fine.n_hexes)
        with self.assertRaisesRegex(hextwist.Error, "64 hexes"):
            session.adapt_levels([1, 2])


class Callbacks(unittest.TestCase):
    def test_get_lines_and_stages(self):
        lines, stages = [], []
        session = session_on("bracket", output=lines.append, progress=lambda stage, x: stages.append((stage, x)))
        session.cmd("refine curve 5")
        self.assertIn("488 -> ", lines[-1])
        self.assertIn("place", {stage for stage, _ in stages})
        self.assertTrue(all(0 <= x <= 1 for _, x in stages))

    def test_cancel_and_leave_the_session_as_it_was(self):
        go_on = [True]
        session = session_on("bracket", progress=lambda stage, x: go_on[0])
        before = session.mesh.points
        go_on[0] = False
        with self.assertRaises(hextwist.Cancelled):
            session.cmd("refine curve 5")
        for no in (np.False_, np.bool_(False), 0):
            go_on[0] = no
            with self.assertRaises(hextwist.Cancelled):
                session.cmd("refine curve 5")
        for yes in (True, None, np.True_):
            go_on[0] = yes
            session.cmd("undo" if yes is None else "refine curve 5")
            self.assertEqual(yes is None, np.array_equal(session.mesh.points, before))

    def test_exceptions_come_out_of_the_command(self):
        def progress(stage, x):
            raise KeyError(stage)

        session = hextwist.Session(progress=progress)
        with self.assertRaises(KeyError):
            session.cmd("create brick x 1 y 1 z 1 interval 2 2 2")
        self.assertEqual(session.mesh.n_hexes, 0)

        def output(line):
            raise ZeroDivisionError

        session = hextwist.Session(output=output)
        with self.assertRaises(ZeroDivisionError):
            session.cmd("create brick x 1 y 1 z 1 interval 2 2 2")
        self.assertEqual(session.mesh.n_hexes, 0)

    def test_exceptions_take_the_command_back(self):
        armed = []

        def listen(line):
            if armed:
                raise BrokenPipeError(line)

        session = hextwist.Session(output=listen, notice=listen)
        session.cmd("create brick x 3 interval 3; refine hex 1")
        for command in ("refine hex 27; refine surface 2", "undo", "move volume 1 x 2", "smooth hex all"):
            points, hexes = session.mesh.points, session.mesh.hexes
            armed.append(1)
            with self.assertRaises(BrokenPipeError):
                session.cmd(command)
            armed.clear()
            self.assertTrue(np.array_equal(session.mesh.points, points), command)
            self.assertTrue(np.array_equal(session.mesh.hexes, hexes), command)

    def test_that_hold_their_session_go_with_it(self):
        class Listener:
            def __call__(self, line):
                pass

        listener = Listener()
        listener.session = hextwist.Session(output=listener)
        listener.session.cmd("create brick x 1 y 1 z 1 interval 2 2 2")
        gone = weakref.ref(listener)
        del listener
        gc.collect()
        self.assertIsNone(gone())

    def test_calls_from_within_are_refused(self):
        errors = []

        def output(line):
            for call in (lambda: session.cmd("undo"), lambda: session.mesh, lambda: session.ids("hex")):
                with self.assertRaisesRegex(hextwist.Error, "busy"):
                    call()
                errors.append(line)

        session = session_on("bracket")
        session = hextwist.Session(output=output)
        session.cmd("create brick x 1 y 1 z 1 interval 2 2 2")
        self.assertEqual(len(errors), 3)

    def test_ctrl_c_cancels_and_leaves_the_session_as_it_was(self):
        session = hextwist.Session()
        session.cmd("create brick x 1 y 1 z 1 interval 30 30 30")
        before = session.mesh
        for attempt in range(8):  # the command may be done before the signal comes
            timer = threading.Timer(0.15 * (attempt + 1), _thread.interrupt_main)
            timer.start()
            try:
                session.cmd("refine volume all numsplit 4")
                session.cmd("undo")
            except KeyboardInterrupt:
                break
            finally:
                timer.cancel()
        else:
            self.fail("the command was never interrupted")
        if session.record["command"] == "refine volume all numsplit 4":
            self.assertFalse(session.record["ok"])
            self.assertEqual(session.mesh.points.__array_interface__, before.points.__array_interface__)
        session.cmd("refine hex 1")

    def test_other_threads_run_meanwhile(self):
        session = hextwist.Session()
        session.cmd("create brick x 1 y 1 z 1 interval 30 30 30")
        count, stop = [0], threading.Event()

        def tick():
            while not stop.is_set():
                count[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=tick)
        thread.start()
        before = count[0]
        session.cmd("refine volume all numsplit 2")
        during = count[0] - before
        stop.set()
        thread.join()
        self.assertGreater(during, 20)


def public_names(thing):
    """(name, object) of what a module or class shows: of a class its own, of a module what `import *` brings."""
    names = getattr(thing, "__all__", vars(thing))
    return [(name, inspect.getattr_static(thing, name)) for name in names if not name.startswith("_")]


def said(thing):
    """A docstring, without the signature that pybind11 puts before it."""
    return re.sub(r"^\w+\(.*\) -> .*\n*", "", inspect.getdoc(thing) or "").strip()


def undocumented(thing, path):
    """Paths of all below a module or class that say nothing about themselves."""
    found = []
    for name, member in public_names(thing):
        if len(said(member)) < 10:
            found.append(f"{path}.{name}")
        if inspect.isclass(member):
            found += undocumented(member, f"{path}.{name}")
    return found


class Docstrings(unittest.TestCase):
    def modules(self):
        yield hextwist
        yield importlib.import_module("hextwist._core")
        try:
            yield importlib.import_module("hextwist.gmsh")
        except ImportError as error:
            print(f"without hextwist.gmsh: {error}")

    def test_are_there_for_everything_public(self):
        for module in self.modules():
            self.assertGreater(len(module.__doc__), 20, module)
            self.assertEqual(undocumented(module, module.__name__), [])

    def test_are_missed_where_there_are_none(self):
        class Half:
            """Only half of this says something."""

            def silent(self):
                pass

            @property
            def short(self):
                """Short."""

        whole = type(hextwist)("whole")
        whole.__all__, whole.Half = ["Half"], Half
        self.assertEqual(undocumented(whole, "whole"), ["whole.Half.silent", "whole.Half.short"])

    def test_say_the_shapes_and_types_that_arrays_have(self):
        session = session_on("bracket")
        mesh, n_checked = session.mesh, 0
        arrays = {name: getattr(mesh, name) for name, _ in public_names(hextwist.Mesh)}
        arrays["quality"] = mesh.quality()
        flags = np.zeros(mesh.n_hexes, dtype=bool)
        for name, array in arrays.items():
            if not isinstance(array, np.ndarray):
                continue
            columns, dtype = re.match(r"\(\w+,([^)]*)\) (\w+)\b", said(getattr(hextwist.Mesh, name))).groups()
            self.assertEqual(dtype, array.dtype.name, name)
            self.assertEqual([int(columns)] if columns else [], list(array.shape[1:]), name)
            n_checked += 1
        self.assertGreaterEqual(n_checked, 14)
        for name, array in (
            ("ids", session.ids("hex")),
            ("nodes_of", session.nodes_of("curve", 1)),
            ("adapt", session.adapt(flags)),
        ):
            self.assertEqual(array.ndim, 1)
            self.assertIn(array.dtype.name, said(getattr(hextwist.Session, name)), name)

    def test_make_a_page_on_which_everything_public_is(self):
        script = pathlib.Path(__file__).resolve().parents[2] / "docs/python_reference.py"
        with tempfile.TemporaryDirectory() as folder:
            environment = dict(os.environ, PYTHONPATH=str(pathlib.Path(hextwist.__file__).parents[1]))
            subprocess.run([sys.executable, script, folder], check=True, env=environment)
            page = (pathlib.Path(folder) / "hextwist.html").read_text(encoding="utf-8")
        shown = html.unescape(re.sub(r"<[^>]+>", "", page))
        for module in (hextwist, importlib.import_module("hextwist._core")):
            for name, member in public_names(module):
                if not inspect.isclass(member) or name == "GmshLink":
                    continue
                self.assertIn(f'id="hextwist.{name}"', page)
                for each, thing in public_names(member):
                    self.assertIn(f'id="hextwist.{name}.{each}"', page)
                    self.assertIn(said(thing), shown)
        for name in ("refine", "take", "put", "Link.tags"):
            self.assertIn(f'id="hextwist.gmsh.{name}"', page)
        self.assertIn("(commands: str) -> bool", shown)
        for nothing in ("_core", str(pathlib.Path.home()) + "/", "built-in function", "object at 0x"):
            self.assertFalse(nothing in shown, nothing)

    def test_of_what_can_fail_say_what_is_raised(self):
        for of in (hextwist.Mesh, hextwist.Session):
            for name, member in public_names(of):
                if not isinstance(member, property):
                    self.assertRegex(said(member), r"[Rr]aises", name)

    def test_and_types_for_editors_name_the_same_things(self):
        stub = ast.parse((pathlib.Path(hextwist.__file__).parent / "_core.pyi").read_text())
        core = importlib.import_module("hextwist._core")
        for node in stub.body:
            if not isinstance(node, ast.ClassDef):
                continue
            of = getattr(core, node.name)
            stated = {each.name: each for each in node.body if isinstance(each, ast.FunctionDef)}
            there = dict(public_names(of))
            self.assertEqual({name for name in stated if name != "__init__"}, set(there), node.name)
            for name, member in there.items():
                is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in stated[name].decorator_list)
                self.assertEqual(isinstance(member, property), is_property, f"{node.name}.{name}")
                if is_property:
                    continue
                signature = stated[name].args
                words = [each.arg for each in signature.args + signature.kwonlyargs]
                self.assertEqual(re.findall(r"(\w+): ", inspect.getdoc(member).splitlines()[0]), words, name)
        named = {node.name for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(named, {name for name in vars(core) if not name.startswith("_")})
