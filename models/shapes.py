"""The models: for each its CAD, its mesh, its exact measures and its named groups. Lengths as if in millimetres.

Groups: (dimension, name, which), where which(low, high) looks at the box of an entity.
"""
import dataclasses
import math
from typing import Callable

import gmsh
import numpy as np

import hexes as hx
from splines import Spline, measures, occ_surface

pi = math.pi
NEAR = 1e-3


@dataclasses.dataclass
class Shape:
    name: str
    exercises: str
    cad: Callable
    mesh: Callable  # called first: may use Gmsh, which is cleared afterwards
    volume: float
    area: float  # of all faces, those between two solids once
    exact: str = "closed form"
    groups: list = dataclasses.field(default_factory=list)
    binary: bool = False
    splines: bool = False
    measure_error: float = 1e-9  # relative; by which OpenCASCADE's own integration and curves may differ


def occ():
    return gmsh.model.occ


def box_at(**limits):
    """which() for entities whose box lies within the limits: box_at(x=0, z=(10, 20))."""
    def which(low, high):
        for name, limit in limits.items():
            axis = "xyz".index(name)
            first, last = limit if isinstance(limit, tuple) else (limit, limit)
            if low[axis] < first - NEAR or high[axis] > last + NEAR:
                return False
        return True
    return which


def everything(low, high):
    return True


def profile(points):
    """Planar face from a closed outline: ("line", (x, y, z)) or ("arc", centre, end) pieces; first is the start."""
    tags = [occ().addPoint(*points[0])]
    curves = []
    for kind, *where in points[1:]:
        last = np.allclose(where[-1], points[0])
        end = tags[0] if last else occ().addPoint(*where[-1])
        if kind == "line":
            curves.append(occ().addLine(tags[-1], end))
        else:
            centre = occ().addPoint(*where[0])
            curves.append(occ().addCircleArc(tags[-1], centre, end))
            occ().remove([(0, centre)])
        tags.append(end)
    return occ().addPlaneSurface([occ().addCurveLoop(curves)])


def cut(solid, *tools):
    return occ().cut([(3, solid)], [(3, tool) for tool in tools])[0]


# --- brackets -----------------------------------------------------------------------------------------------------

def bracket():
    """L of two plates 8 thick and 40 wide; base 58 long with two bolt holes, upright ending in a lug with a bearing
    hole. Sharp inner corner."""
    t, half, length, height, bolt, bore = 8, 20, 58, 50, 5, 10
    bolts = [(38, -10), (38, 10)]

    def cad():
        base = occ().addBox(0, -half, 0, length, 2 * half, t)
        face = profile([(0, -half, 0), ("line", (0, half, 0)), ("line", (0, half, height)),
                        ("arc", (0, 0, height), (0, 0, height + half)), ("arc", (0, 0, height), (0, -half, height)),
                        ("line", (0, -half, 0))])
        upright = occ().extrude([(2, face)], t, 0, 0)
        upright = next(tag for dim, tag in upright if dim == 3)
        whole, _ = occ().fuse([(3, base)], [(3, upright)])
        occ().remove([(2, face)])
        tools = [occ().addCylinder(x, y, -1, 0, 0, t + 2, bolt) for x, y in bolts]
        tools.append(occ().addCylinder(-1, 0, height, t + 2, 0, 0, bore))
        cut(whole[0][1], *tools)

    def mesh():
        base = hx.merged([hx.rectangle(2, 8, 0, 8, -half, half), hx.rectangle(4, 8, 8, 28, -half, half)]
                         + [hx.hole_in_square(4, 2, x, y, bolt, 10, 1.15) for x, y in bolts]
                         + [hx.rectangle(2, 8, 48, length, -half, half)])
        square = 20
        upright = hx.merged([hx.rectangle(4, 8, t, height - square, -half, half)]
                            + [hx.between(8, 3, hx.arc(height, 0, bore, 135, 225),
                                          hx.line((height - square, half), (height - square, -half)), 1.15)]
                            + [hx.between(4, 3, hx.arc(height, 0, bore, 90, 135),
                                          hx.line((height, half), (height - square, half)), 1.15)]
                            + [hx.between(4, 3, hx.arc(height, 0, bore, 225, 270),
                                          hx.line((height - square, -half), (height, -half)), 1.15)]
                            + [hx.between(12, 3, hx.arc(height, 0, bore, -90, 90), hx.arc(height, 0, half, -90, 90), 1.15)])
        return hx.joined([hx.swept(base, 2, lambda x, y, w: (x, y, w * t)),
                          hx.swept(upright, 2, lambda z, y, w: (w * t, y, z))])

    upright = 2 * half * (height - t) + pi * half**2 / 2 - pi * bore**2  # one side of it, above the base
    base = 2 * half * length - 2 * pi * bolt**2
    rim = 2 * (height - t) + pi * half + 2 * pi * bore
    return Shape("bracket", "plain L bracket with two bolt holes and a lug with a bearing hole; sharp concave corner; "
                 "the model of `./dev demo`", cad, mesh, t * (base + upright),
                 2 * base - 2 * half * t + t * (2 * (length + 2 * half) - 2 * half) + 2 * half * t
                 + 4 * pi * bolt * t + 2 * upright + rim * t,
                 groups=[(3, "steel", everything), (2, "bore", box_at(y=(-bore, bore), z=(height - bore, height + bore))),
                         (2, "bolts", box_at(x=(33, 43), z=(0, t), y=(-15, 15))), (2, "foot", box_at(z=0)),
                         (1, "bore_rim", box_at(x=0, y=(-bore, bore), z=(height - bore, height + bore)))])


def bracket_fillet():
    """L of two plates 10 thick and 60 wide with an inner fillet of radius 8, an outer round of 18, two holes in each."""
    t, half, r, length, bolt, big = 10, 30, 8, 78, 6, 7
    c = r + t  # centre of the bend
    holes = [(c + 15 + 15, -15), (c + 15 + 15, 15)]

    def cad():
        s = r / math.sqrt(2)
        face = profile([(c, -half, 0), ("line", (length, -half, 0)), ("line", (length, -half, t)), ("line", (c, -half, t)),
                        ("arc", (c, -half, c), (t, -half, c)), ("line", (t, -half, length)),
                        ("line", (0, -half, length)), ("line", (0, -half, c)), ("arc", (c, -half, c), (c, -half, 0))])
        solid = next(tag for dim, tag in occ().extrude([(2, face)], 0, 2 * half, 0) if dim == 3)
        occ().remove([(2, face)])
        cut(solid, *[occ().addCylinder(x, y, -1, 0, 0, t + 2, bolt) for x, y in holes],
            *[occ().addCylinder(-1, y, z, t + 2, 0, 0, big) for z, y in holes])

    def leg(radius):
        return hx.merged([hx.rectangle(3, 12, c, c + 15, -half, half)]
                         + [hx.hole_in_square(6, 2, x, y, radius, 15, 1.1) for x, y in holes]
                         + [hx.rectangle(3, 12, c + 45, length, -half, half)])

    def mesh():
        def bend(u, v, w):  # u along the bend, v across, w from the outside in
            radius, angle = c - w * t, -pi / 2 - u * pi / 2
            return c + radius * np.cos(angle), -half + 2 * half * v, c + radius * np.sin(angle)
        return hx.joined([hx.swept(leg(bolt), 3, lambda x, y, w: (x, y, w * t)),
                          hx.swept(leg(big), 3, lambda z, y, w: (w * t, y, z)),
                          hx.block(6, 12, 3, bend)])

    flat = length - c
    section = 2 * flat * t + pi / 4 * (c**2 - r**2)
    removed = 2 * pi * (bolt**2 + big**2)
    outline = 4 * flat + 2 * t + pi / 2 * (c + r)
    return Shape("bracket_fillet", "L bracket with an inner fillet, an outer round and four holes; smooth (tangent) "
                 "edges between planes and cylinders", cad, mesh, section * 2 * half - removed * t,
                 2 * section + outline * 2 * half - 2 * removed + 4 * pi * (bolt + big) * t, binary=True,
                 groups=[(3, "bracket", everything), (2, "fillet", box_at(x=(t, c), z=(t, c))),
                         (2, "fixed", box_at(x=(1, length), z=(0, t), y=(-half + 1, half - 1)))])


# --- plates -------------------------------------------------------------------------------------------------------

def plate_hole():
    r, half, length, width, t = 16, 28, 120, 80, 8

    def cad():
        cut(occ().addBox(-length / 2, -width / 2, 0, length, width, t), occ().addCylinder(0, 0, -1, 0, 0, t + 2, r))

    def mesh():
        xs, ys = [(-60, -half, 4), (-half, half, 8), (half, 60, 4)], [(-40, -half, 2), (-half, half, 8), (half, 40, 2)]
        cells = [hx.rectangle(nx, ny, x0, x1, y0, y1) for x0, x1, nx in xs for y0, y1, ny in ys
                 if (x0, y0) != (-half, -half)]
        quads = hx.merged(cells + [hx.hole_in_square(8, 3, 0, 0, r, half, 1.2)])
        return hx.joined([hx.swept(quads, 3, lambda x, y, w: (x, y, w * t))])

    face = length * width - pi * r**2
    return Shape("plate_hole", "plate with a round hole: the classic stress concentration; seam edge in the hole", cad, mesh,
                 face * t, 2 * face + 2 * (length + width) * t + 2 * pi * r * t,
                 groups=[(3, "plate", everything), (2, "hole", box_at(x=(-r, r), y=(-r, r))),
                         (2, "clamped", box_at(x=-60)), (2, "pulled", box_at(x=60))])


def plate_quarter():
    r, length, width, t = 10, 50, 40, 5

    def cad():
        cut(occ().addBox(0, 0, 0, length, width, t), occ().addCylinder(0, 0, -1, 0, 0, t + 2, r))

    def mesh():
        quads = hx.merged([hx.between(6, 10, hx.arc(0, 0, r, 0, 45), hx.line((length, 0), (length, width)), 1.5),
                           hx.between(6, 10, hx.arc(0, 0, r, 45, 90), hx.line((length, width), (0, width)), 1.5)])
        return hx.joined([hx.swept(quads, 2, lambda x, y, w: (x, y, w * t))])

    face = length * width - pi * r**2 / 4
    return Shape("plate_quarter", "a quarter of a plate with a hole: symmetry planes, no seam, cells graded to the hole",
                 cad, mesh, face * t, 2 * face + (length + width + length - r + width - r + pi * r / 2) * t,
                 groups=[(3, "plate", everything), (2, "symmetry_x", box_at(x=0)), (2, "symmetry_y", box_at(y=0)),
                         (2, "load", box_at(x=length)), (1, "hole_rims", lambda low, high: NEAR < high[0] < r + NEAR
                          and NEAR < high[1] < r + NEAR and high[2] - low[2] < NEAR),
                         (0, "origin_side", box_at(x=r, y=0, z=0))])


# --- round things -------------------------------------------------------------------------------------------------

def round_disk(r, core, n, rings):
    """O-grid: a square of n x n with sides bulged a little, four sectors around it."""
    swell = lambda s: 1 + 0.22 * (1 - s**2)

    def side(degrees):
        turn = math.radians(degrees)
        return lambda u: (core * (math.cos(turn) * swell(2 * u - 1) - math.sin(turn) * (2 * u - 1)),
                          core * (math.sin(turn) * swell(2 * u - 1) + math.cos(turn) * (2 * u - 1)))
    sides = [hx.between(n, rings, side(a), hx.arc(0, 0, r, a - 45, a + 45)) for a in (0, 90, 180, 270)]

    def middle(u, v):
        x, y = 2 * u - 1, 2 * v - 1
        return core * x * swell(y), core * y * swell(x)
    return hx.merged([hx.patch(n, n, middle)] + sides)


def cylinder():
    r, h, core = 20, 60, 9

    def cad():
        occ().addCylinder(0, 0, 0, 0, 0, h, r)

    def mesh():
        return hx.joined([hx.swept(round_disk(r, core, 6, 3), 8, lambda x, y, w: (x, y, w * h))])

    return Shape("cylinder", "O-grid in a single solid: closed rims, seam edge", cad, mesh, pi * r**2 * h,
                 2 * pi * r**2 + 2 * pi * r * h,
                 groups=[(3, "rod", everything), (2, "bottom", box_at(z=0)), (2, "top", box_at(z=h))])


def cube_direction(u, v):
    """Equiangular direction on the +x side of a cube, u and v in [-1, 1]."""
    y, z = np.tan(u * pi / 4), np.tan(v * pi / 4)
    return np.stack([np.ones_like(u), y, z]) / np.sqrt(1 + y * y + z * z)


def turned(side, p):
    """The +x side of a cube turned to side 0..5."""
    x, y, z = p
    return [(x, y, z), (-x, -y, z), (-y, x, z), (y, -x, z), (-z, y, x), (z, y, -x)][side]


def ball_core(n, half, bulge, part=0):
    def mapping(u, v, w):
        q = np.stack([2 * u - 1, 2 * v - 1, 2 * w - 1])
        norm, top = np.linalg.norm(q, axis=0), np.abs(q).max(axis=0)
        return half * q * (1 - bulge + bulge * np.where(norm > 0, top / np.maximum(norm, 1e-30), 1))
    return hx.block(n, n, n, mapping, part)


def core_surface(u, v, half, bulge):
    q = np.stack([np.ones_like(u), u, v])
    return half * q * (1 - bulge + bulge / np.linalg.norm(q, axis=0))


def ball_shell(side, n, m, r, half, bulge, part=0):
    def mapping(a, b, w):
        u, v = 2 * a - 1, 2 * b - 1
        return turned(side, (1 - w) * core_surface(u, v, half, bulge) + w * r * cube_direction(u, v))
    return hx.block(n, n, m, mapping, part)


def sphere():
    r = 20

    def cad():
        occ().addSphere(0, 0, 0, r)

    def mesh():
        return hx.joined([ball_core(6, 10, 0.35)] + [ball_shell(side, 6, 3, r, 10, 0.35) for side in range(6)])

    return Shape("sphere", "ball of seven blocks in a single solid: one face with a seam and two poles (degenerate edges)",
                 cad, mesh, 4 / 3 * pi * r**3, 4 * pi * r**2, groups=[(3, "ball", everything), (2, "skin", everything)])


def inclusion():
    r, half = 10, 20

    def cad():
        box = occ().addBox(-half, -half, -half, 2 * half, 2 * half, 2 * half)
        occ().fragment([(3, box)], [(3, occ().addSphere(0, 0, 0, r))])

    def mesh():
        def outside(side):
            def mapping(a, b, w):
                u, v = 2 * a - 1, 2 * b - 1
                flat = half * np.stack([np.ones_like(u), u, v])
                return turned(side, (1 - w) * r * cube_direction(u, v) + w * flat)
            return hx.block(4, 4, 4, mapping, INCLUSION_PARTS["matrix"])
        ball = INCLUSION_PARTS["inclusion"]
        return hx.joined([ball_core(4, 5, 0.35, ball)] + [ball_shell(side, 4, 2, r, 5, 0.35, ball) for side in range(6)]
                         + [outside(side) for side in range(6)])

    return Shape("inclusion", "two materials: a ball in a cube, two solids that share a spherical face", cad, mesh,
                 (2 * half)**3, 6 * (2 * half)**2 + 4 * pi * r**2, binary=True,
                 groups=[(3, "matrix", lambda low, high: high[0] > r + 1), (3, "inclusion", box_at(x=(-r, r))),
                         (2, "interface", box_at(x=(-r, r)))])


INCLUSION_PARTS = {"inclusion": 0, "matrix": 1}


def pipe_tee():
    """Pipe along x with a branch up z; everything is a surface mesh with an inner and an outer position per node."""
    length, height = 46, 40
    outer, inner = (20, 13), (16, 10)  # radii of pipe and branch
    a, spread = 22, pi / 3             # half size of the patch around the branch: along x, and as an angle

    def cad():
        def tube(radii, extra):
            run, branch = radii
            pipe = occ().addCylinder(-length - extra, 0, 0, 2 * (length + extra), 0, 0, run)
            occ().rotate([(3, pipe)], 0, 0, 0, 1, 0, 0, pi)  # seam to the bottom
            return pipe, occ().addCylinder(0, 0, 0, 0, 0, height + extra, branch)
        pipe, branch = tube(outer, 0)
        whole, _ = occ().fuse([(3, pipe)], [(3, branch)])
        cut(whole[0][1], *tube(inner, 1))

    def saddle(radii, angle):
        run, branch = radii
        x, y = branch * np.cos(angle), branch * np.sin(angle)
        return x, np.arcsin(y / run)

    def wall(n_u, n_v, surface):
        """surface(radii, u, v) -> (x, y, z)"""
        def mapping(u, v, w):
            p, q = surface(inner, u, v), surface(outer, u, v)
            return tuple((1 - w) * s + w * t for s, t in zip(p, q))
        return hx.block(n_u, n_v, 2, mapping)

    def on_run(radii, x, theta):
        return x, radii[0] * np.sin(theta), radii[0] * np.cos(theta)

    def around_branch(quarter):
        def surface(radii, u, v):
            angle = (quarter + u - 0.5) * pi / 2
            s = 2 * u - 1
            corner = [(a + 0 * s, spread * s), (-a * s, spread + 0 * s), (-a + 0 * s, -spread * s), (a * s, -spread + 0 * s)]
            (x0, t0), (x1, t1) = saddle(radii, angle), corner[quarter]
            return on_run(radii, (1 - v) * x0 + v * x1, (1 - v) * t0 + v * t1)
        return wall(8, 3, surface)

    def up_branch(radii, u, v):
        angle = 2 * pi * u - pi / 4
        r = radii[1]
        z0 = np.sqrt(radii[0]**2 - (r * np.sin(angle))**2)
        return r * np.cos(angle), r * np.sin(angle), (1 - v) * z0 + v * height

    def run(x0, x1, t0, t1):
        return lambda radii, u, v: on_run(radii, x0 + (x1 - x0) * u, t0 + (t1 - t0) * v)

    def mesh():
        sides = [wall(4, n, run(x0, x1, t0, t1)) for x0, x1 in ((-length, -a), (a, length))
                 for t0, t1, n in ((-spread, spread, 8), (spread, 2 * pi - spread, 16))]
        return hx.joined([around_branch(q) for q in range(4)] + sides + [wall(32, 5, up_branch)]
                         + [wall(8, 16, run(-a, a, spread, 2 * pi - spread))])

    # Integrals over the branch's cross-section; smooth and periodic, so that equal steps are exact to rounding.
    angle = np.arange(4096) * (2 * pi / 4096)
    mean = lambda f: float(np.mean(f)) * 2 * pi

    def union(radii):
        run, r = radii
        root = np.sqrt(run**2 - (r * np.sin(angle))**2)
        solid = pi * run**2 * 2 * length + pi * r**2 * height - mean(r**2 * np.cos(angle)**2 * root)
        skin = 2 * pi * run * 2 * length - mean(r**2 * np.cos(angle)**2 * run / root) + mean(r * (height - root))
        return solid, skin

    (v_out, s_out), (v_in, s_in) = union(outer), union(inner)
    ends = 2 * pi * (outer[0]**2 - inner[0]**2) + pi * (outer[1]**2 - inner[1]**2)
    return Shape("pipe_tee", "pipe with a branch: two cylinders meet in space curves, inside and outside", cad, mesh,
                 v_out - v_in, s_out + s_in + ends, exact="integral to rounding", measure_error=2e-5,
                 groups=[(3, "pipe", everything), (2, "inlet", box_at(x=-length)), (2, "outlet", box_at(x=length)),
                         (2, "branch_end", box_at(z=height))])


# --- splines ------------------------------------------------------------------------------------------------------

def ring_twist():
    """Square bar bent to a ring and twisted by 90 degrees, so that its four sides follow each other."""
    radius, half = 20, 4
    u, v = Spline(5, 48), Spline(1, 1)

    def corner(k):
        def values(t):
            phi = 2 * pi * t
            a = pi / 4 + k * pi / 2 + phi / 4
            rho = radius + math.sqrt(2) * half * np.cos(a)
            return np.stack([rho * np.cos(phi), rho * np.sin(phi), math.sqrt(2) * half * np.sin(a)], axis=1)
        return u.interpolating(values)

    corners = [corner(k) for k in range(5)]
    nets = [np.stack([corners[k], corners[k + 1]], axis=1) for k in range(4)]

    def cad():
        faces = [occ_surface(u, v, net) for net in nets]
        occ().addVolume([occ().addSurfaceLoop(faces, sewing=True)])
        occ().synchronize()
        occ().remove([(2, face) for face in faces], recursive=True)

    def mesh():
        def mapping(a, b, t):
            levels, level = np.unique(t, return_inverse=True)
            p = [(u.basis(levels) @ corners[k])[level] for k in range(4)]
            a, b = a[:, None], b[:, None]
            return ((1 - a) * (1 - b) * p[2] + a * (1 - b) * p[3] + a * b * p[0] + (1 - a) * b * p[1]).T
        return hx.joined([hx.block(4, 4, 40, mapping)])

    area, solid = np.sum([measures(u, v, net) for net in nets], axis=0)
    return Shape("ring_twist", "closed ring twisted by 90 degrees: two sheets that cross themselves all the way round; "
                 "four spline faces that follow each other", cad, mesh, abs(float(solid)), float(area),
                 exact="integral to rounding", splines=True, measure_error=1e-6, groups=[(3, "ring", everything)])


def curved_plate():
    """Doubly curved B-spline surface over a 60 x 40 rectangle, extruded upwards by 2.5: a thin shell."""
    x, y, t = 60, 40, 2.5
    u, v = Spline(3, 3), Spline(3, 2)
    heights = np.array([[0, 2, 3, 2, 0], [2, 9, 8, 4, 1], [4, 12, 14, 6, 2], [3, 10, 15, 9, 4], [1, 5, 8, 9, 5],
                        [0, 1, 4, 6, 5]], float)
    net = np.stack([np.repeat(x * u.greville()[:, None], v.n, 1), np.repeat(y * v.greville()[None], u.n, 0), heights],
                   axis=2)

    def cad():
        occ().extrude([(2, occ_surface(u, v, net))], 0, 0, t)

    def mesh():
        def mapping(a, b, w):
            z = np.einsum("pi,pj,ij->p", u.basis(a), v.basis(b), heights)
            return x * a, y * b, z + t * w
        return hx.joined([hx.block(24, 16, 2, mapping)])

    return Shape("curved_plate", "thin doubly curved shell: B-spline faces, spline edges", cad, mesh, x * y * t,
                 2 * measures(u, v, net)[0] + 2 * (x + y) * t, exact="volume closed form, area integral to rounding",
                 splines=True, binary=True, measure_error=1e-6,
                 groups=[(3, "shell", everything), (2, "clamped", box_at(x=0)), (0, "corners", everything)])


# --- irregular and concave ----------------------------------------------------------------------------------------

def quads_by_gmsh(size):
    """Quads of the current faces, about half of `size` long: Gmsh recombines triangles of that size and cuts again."""
    for option, value in (("Mesh.Algorithm", 5), ("Mesh.RecombineAll", 1), ("Mesh.RecombinationAlgorithm", 1),
                          ("Mesh.SubdivisionAlgorithm", 1), ("Mesh.MeshSizeMin", size), ("Mesh.MeshSizeMax", size)):
        gmsh.option.setNumber(option, value)
    gmsh.model.mesh.generate(2)
    tags, points, _ = gmsh.model.mesh.getNodes()
    kinds, _, nodes = gmsh.model.mesh.getElements(2)
    assert list(kinds) == [3], "the faces did not become all quads"
    index = {tag: i for i, tag in enumerate(tags.tolist())}
    quads = np.array([index[tag] for tag in nodes[0].tolist()]).reshape(-1, 4)
    return hx.welded(points.reshape(-1, 3)[:, :2], quads)


def cam():
    """Outline of two circles and their tangents with a hole in each; quads by Gmsh, swept."""
    big, small, gap, bore, pin, t = 20, 10, 40, 9, 5, 18
    tilt = math.asin((big - small) / gap)

    def outline():
        at = lambda x, r, angle: (x + r * math.cos(angle), r * math.sin(angle), 0)
        up, down = pi / 2 - tilt, tilt - pi / 2
        return profile([at(0, big, up), ("arc", (0, 0, 0), (-big, 0, 0)), ("arc", (0, 0, 0), at(0, big, down)),
                        ("line", at(gap, small, down)), ("arc", (gap, 0, 0), (gap + small, 0, 0)),
                        ("arc", (gap, 0, 0), at(gap, small, up)), ("line", at(0, big, up))])

    def flat():
        holes = [(2, occ().addDisk(0, 0, 0, bore, bore)), (2, occ().addDisk(gap, 0, 0, pin, pin))]
        return occ().cut([(2, outline())], holes)[0]

    def cad():
        face = flat()
        occ().extrude(face, 0, 0, t)
        occ().remove(face)

    def mesh():
        flat()
        occ().synchronize()
        return hx.joined([hx.swept(quads_by_gmsh(7), 6, lambda x, y, w: (x, y, w * t))])

    tangent = math.sqrt(gap**2 - (big - small)**2)
    face = (tangent * (big + small) + big**2 * (pi / 2 + tilt) + small**2 * (pi / 2 - tilt) - pi * (bore**2 + pin**2))
    rim = 2 * tangent + big * (pi + 2 * tilt) + small * (pi - 2 * tilt) + 2 * pi * (bore + pin)
    return Shape("cam", "swept unstructured quads: irregular nodes, sheets that wind through the part", cad, mesh, face * t,
                 2 * face + rim * t, measure_error=1e-6,
                 groups=[(3, "cam", everything), (2, "bore", box_at(x=(-bore, bore), y=(-bore, bore))),
                         (2, "pin", box_at(x=(gap - pin, gap + pin), y=(-pin, pin)))])


def l_block():
    a, h = 40, 20

    def cad():
        cut(occ().addBox(0, 0, 0, a, a, h), occ().addBox(a / 2, a / 2, -1, a, a, h + 2))

    def mesh():
        quads = hx.merged([hx.rectangle(5, 5, x, x + a / 2, y, y + a / 2) for x, y in ((0, 0), (a / 2, 0), (0, a / 2))])
        return hx.joined([hx.swept(quads, 5, lambda x, y, w: (x, y, w * h))])

    return Shape("l_block", "concave L of cubes: every closed form is simple", cad, mesh, 0.75 * a * a * h,
                 1.5 * a * a + 4 * a * h, groups=[(3, "block", everything), (1, "inner_edge", box_at(x=20, y=20)),
                                                  (2, "inner_faces", box_at(x=(20, 40), y=(20, 40), z=(0, 20)))])


def notched_cube():
    a = 32

    def cad():
        cut(occ().addBox(0, 0, 0, a, a, a), occ().addBox(a / 2, a / 2, a / 2, a, a, a))

    def mesh():
        b = a / 2
        cell = lambda i, j, k: hx.block(4, 4, 4, lambda u, v, w: ((i + u) * b, (j + v) * b, (k + w) * b))
        return hx.joined([cell(c & 1, c >> 1 & 1, c >> 2) for c in range(7)])

    return Shape("notched_cube", "cube without one octant: concave in all three directions at one vertex", cad, mesh,
                 7 / 8 * a**3, 6 * a * a, binary=True,
                 groups=[(3, "cube", everything), (0, "inner_corner", box_at(x=16, y=16, z=16))])


# --- counterparts of the paper's figures 7, 16 and 17 (./dev paper) -------------------------------------------------

def bent_bar():
    """Bar of 30 x 65, bent by 111 degrees around an axis 20 away: layers thin out, cells are narrow inside the bend."""
    inner, outer, height, bend = 20, 50, 65, math.radians(111)

    def cad():
        face = profile([(inner, 0, 0), ("line", (outer, 0, 0)), ("line", (outer, 0, height)), ("line", (inner, 0, height)),
                        ("line", (inner, 0, 0))])
        occ().revolve([(2, face)], 0, 0, 0, 0, 0, 1, bend)

    def mesh():
        def mapping(u, v, w):
            r, angle = inner + (outer - inner) * u, bend * (1 - (1 - w)**1.2)
            return r * np.cos(angle), r * np.sin(angle), height * v
        return hx.joined([hx.block(6, 13, 16, mapping)])

    section = bend / 2 * (outer**2 - inner**2)
    return Shape("bent_bar", "swept grid of 6 x 13 x 16, narrow inside the bend; stands for the paper's figure 7", cad, mesh,
                 section * height, 2 * section + bend * (inner + outer) * height + 2 * (outer - inner) * height,
                 binary=True, groups=[(3, "bar", everything), (2, "end", box_at(y=0))])


def graded_rod():
    """The disk of the cylinder swept with growing layers."""
    r, h = 20, 40

    def cad():
        occ().addCylinder(0, 0, 0, 0, 0, h, r)

    def mesh():
        return hx.joined([hx.swept(round_disk(r, 10, 6, 3), 10, lambda x, y, w: (x, y, h * w**1.35))])

    return Shape("graded_rod", "O-grid swept with growing layers; stands for the paper's figure 17", cad, mesh,
                 pi * r**2 * h, 2 * pi * r**2 + 2 * pi * r * h, binary=True,
                 groups=[(3, "rod", everything), (2, "top", box_at(z=h))])


def bearing_plate():
    """Plate with a hole off its middle: structured ends, unstructured quads by Gmsh between them, swept."""
    length, width, t, x, y, r = 80, 40, 15, 40, 18, 10
    ends = [(0, 20), (20, 60), (60, 80)]
    size = 5  # of the quads, which Gmsh then halves

    def cad():
        cut(occ().addBox(0, 0, 0, length, width, t), occ().addCylinder(x, y, -1, 0, 0, t + 2, r))

    def mesh():
        left, middle, right = [occ().addRectangle(x0, 0, 0, x1 - x0, width) for x0, x1 in ends]
        holed = occ().cut([(2, middle)], [(2, occ().addDisk(x, y, 0, r, r))])[0]
        occ().fragment(holed, [(2, left), (2, right)])
        occ().synchronize()
        for _, face in gmsh.model.getEntities(2):
            low, _, _, high, _, _ = gmsh.model.getBoundingBox(2, face)
            if high - low < 30:
                gmsh.model.mesh.setTransfiniteSurface(face)
        for _, curve in gmsh.model.getEntities(1):
            gmsh.model.mesh.setTransfiniteCurve(curve, round(occ().getMass(1, curve) / size) + 1)
        return hx.joined([hx.swept(quads_by_gmsh(size), 6, lambda x, y, w: (x, y, w * t))])

    face = length * width - pi * r**2
    return Shape("bearing_plate", "swept quads, structured at the ends, unstructured around a hole; stands for the paper's "
                 "figure 16", cad, mesh, face * t, 2 * face + 2 * (length + width) * t + 2 * pi * r * t, binary=True,
                 groups=[(3, "plate", everything), (2, "hole", box_at(x=(x - r, x + r), y=(y - r, y + r)))])


def all_models():
    return [bracket(), bracket_fillet(), plate_hole(), plate_quarter(), cylinder(), sphere(), inclusion(), pipe_tee(),
            ring_twist(), curved_plate(), cam(), l_block(), notched_cube(), bent_bar(), graded_rod(), bearing_plate()]
