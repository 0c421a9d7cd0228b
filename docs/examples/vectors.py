#!/usr/bin/env python3
"""An implementation of its own, small and slow, for `shapeid vectors --check`.

Standard library only. A line of JSON comes in, {"id", "kind", "input"}; a line goes out. What has
to be right about the optimum is computed in fractions. Formulas: docs/derivations.
"""
import json
import sys
from fractions import Fraction
from math import acos, cos, lcm, pi, sin, sqrt


def transpose(A):
    return [list(column) for column in zip(*A)]


def product(A, B):
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*B)] for row in A]


def times(A, x):
    return [sum(a * b for a, b in zip(row, x)) for row in A]


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def skew(a):
    return [[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]]


def rotation(rpy):
    """R = Rz(yaw) Ry(pitch) Rx(roll), as in URDF."""
    (cr, sr), (cp, sp), (cy, sy) = [(cos(x), sin(x)) for x in rpy]
    return [[cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr]]


# Bodies: mass, first moment, second moments (the integral of x x^T), all about the origin.

def tensor_of(second):
    trace = sum(second[i][i] for i in range(3))
    return [[(trace if i == j else 0) - second[i][j] for j in range(3)] for i in range(3)]


def from_tensor(I):
    half = sum(I[i][i] for i in range(3)) / 2
    return [[(half if i == j else 0) - I[i][j] for j in range(3)] for i in range(3)]


def shifted(second, mass, c, sign):
    """Second moments about a point at distance c: plus to leave the centre, minus to go there."""
    return [[second[i][j] + sign * mass * c[i] * c[j] for j in range(3)] for i in range(3)]


def turned(R, second):
    return product(product(R, second), transpose(R))


def symmetric(xx, xy, xz, yy, yz, zz):
    return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]


# Where the six entries of the tensor stand in each order.
ENTRIES = {"shapeid": "xx xy xz yy yz zz", "idyntree": "xx xy xz yy yz zz",
           "pinocchio": "xx xy yy xz yz zz", "drake": "xx yy zz xy xz yz",
           "mujoco": "xx yy zz xy xz yz", "urdf": "xx xy xz yy yz zz",
           "spatial_v2": "xx yy zz yz xz xy", "symoro": "xx xy xz yy yz zz"}
NAMES = ["xx", "xy", "xz", "yy", "yz", "zz"]


def read_tensor(order, six):
    entry = dict(zip(ENTRIES[order].split(), six))
    return symmetric(*[entry[name] for name in NAMES])


def write_tensor(order, I):
    at = {"x": 0, "y": 1, "z": 2}
    return [I[at[name[0]]][at[name[1]]] for name in ENTRIES[order].split()]


def read_body(order, v):
    """Mass, first moment and second moments about the origin."""
    if order == "symoro":
        return v[9], v[6:9], from_tensor(read_tensor(order, v[0:6]))
    m = v[0]
    if order in ("drake", "mujoco", "urdf"):
        c = v[1:4]
        second = from_tensor(read_tensor(order, v[-6:]))
        if order == "drake":
            second = [[m * x for x in row] for row in second]
        if order == "urdf":
            second = turned(rotation(v[4:7]), second)
        if order != "drake":
            second = shifted(second, m, c, 1)
        return m, [m * x for x in c], second
    return m, v[1:4], from_tensor(read_tensor(order, v[4:10]))


def write_body(order, m, h, second):
    if order == "symoro":
        return write_tensor(order, tensor_of(second)) + list(h) + [m]
    if order in ("drake", "mujoco", "urdf"):
        c = [x / m for x in h]
        if order == "drake":
            second = [[x / m for x in row] for row in second]
        else:
            second = shifted(second, m, c, -1)
        middle = [0.0, 0.0, 0.0] if order == "urdf" else []
        return [m] + c + middle + write_tensor(order, tensor_of(second))
    return [m] + list(h) + write_tensor(order, tensor_of(second))


def convert(given):
    return {"numbers": write_body(given["to"], *read_body(given["from"], given["numbers"]))}


# Existence: the pseudo-inertia [[S, h], [h^T, m]] is positive semidefinite.

def existence(given):
    """Eliminates the largest pivot first, in fractions: no pivot may be negative."""
    m, h, second = read_body("shapeid", exact(given["parameters"]))
    if m == 0:
        return {"exists": not any(exact(given["parameters"]))}
    left = [list(row) + [x] for row, x in zip(second, h)] + [list(h) + [m]]
    while left:
        n = len(left)
        k = max(range(n), key=lambda i: left[i][i])
        pivot = left[k][k]
        if pivot <= 0:
            return {"exists": all(x == 0 for row in left for x in row)}
        rest = [i for i in range(n) if i != k]
        left = [[left[i][j] - left[i][k] * left[k][j] / pivot for j in rest] for i in rest]
    return {"exists": True}


# Shapes of unit mass: volume, and means of (x, 1)(x, 1)^T, mapped by T to T ... T^T.

def placed(xyz, rpy, stretch=(1.0, 1.0, 1.0)):
    R = rotation(rpy)
    return [[R[i][j] * stretch[j] for j in range(3)] + [xyz[i]] for i in range(3)] + [[0, 0, 0, 1]]


def powers(a, b, k):
    """The integral of x^k from a to b."""
    return (b ** (k + 1) - a ** (k + 1)) / (k + 1)


def turn(a, b):
    """Means of cos, sin, cos^2, cos sin, sin^2 over an angle from a to b."""
    w = b - a
    double = (sin(2 * b) - sin(2 * a)) / (4 * w)
    return [(sin(b) - sin(a)) / w, (cos(a) - cos(b)) / w, 0.5 + double,
            (sin(b) ** 2 - sin(a) ** 2) / (2 * w), 0.5 - double]


def means(first, second):
    """(x, 1)(x, 1)^T from the means of x, y, z and of xx, xy, xz, yy, yz, zz."""
    S = symmetric(*second)
    return [row + [c] for row, c in zip(S, first)] + [list(first) + [1]]


def cuboid_cell(lower, upper):
    c = [(a + b) / 2 for a, b in zip(lower, upper)]
    w = [b - a for a, b in zip(lower, upper)]
    return w[0] * w[1] * w[2], means(c, [c[i] * c[j] + (w[i] ** 2 / 12 if i == j else 0)
                                         for i in range(3) for j in range(i, 3)])


def cylinder_cell(lower, upper):
    """Of radius 1 and height 1: r, angle, z. The weight of r is r."""
    (r0, angle0, z0), (r1, angle1, z1) = lower, upper
    area = powers(r0, r1, 1)
    r, rr = powers(r0, r1, 2) / area, powers(r0, r1, 3) / area
    z, zz = (z0 + z1) / 2, powers(z0, z1, 2) / (z1 - z0)
    c, s, cc, cs, ss = turn(angle0, angle1)
    return (area * (angle1 - angle0) * (z1 - z0),
            means([r * c, r * s, z], [rr * cc, rr * cs, r * c * z, rr * ss, r * s * z, zz]))


def ellipsoid_cell(lower, upper):
    """Of the unit ball: r with weight r^2, polar angle t with weight sin t, azimuth."""
    (r0, t0, angle0), (r1, t1, angle1) = lower, upper
    size = powers(r0, r1, 2)
    r, rr = powers(r0, r1, 3) / size, powers(r0, r1, 4) / size
    q0, q1 = cos(t1), cos(t0)
    width = q1 - q0
    q, qq = (q0 + q1) / 2, powers(q0, q1, 2) / width
    p = ((t1 - t0) / 2 - (sin(2 * t1) - sin(2 * t0)) / 4) / width   # mean of sin t
    pq = (sin(t1) ** 3 - sin(t0) ** 3) / (3 * width)
    pp = 1 - qq
    c, s, cc, cs, ss = turn(angle0, angle1)
    return (size * width * (angle1 - angle0),
            means([r * p * c, r * p * s, r * q],
                  [rr * pp * cc, rr * pp * cs, rr * pq * c, rr * pp * ss, rr * pq * s, rr * qq]))


def surface(corners, faces):
    """Signed tetrahedra between the triangles and the origin."""
    volume, total = 0.0, [[0.0] * 4 for _ in range(4)]
    for face in faces:
        p = [corners[k] for k in face]
        g = [sum(x) for x in zip(*p)]
        V = dot(p[0], cross(p[1], p[2])) / 6
        second = [(g[i] * g[j] + sum(x[i] * x[j] for x in p)) / 20
                  for i in range(3) for j in range(i, 3)]
        volume += V
        total = [[x + V * y for x, y in zip(*rows)]
                 for rows in zip(total, means([x / 4 for x in g], second))]
    return abs(volume), [[x / volume for x in row] for row in total]


CELLS = {"cuboid": (cuboid_cell, [-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]),
         "cylinder": (cylinder_cell, [0, 0, -0.5], [1, 2 * pi, 0.5]),
         "ellipsoid": (ellipsoid_cell, [0, 0, 0], [1, pi, 2 * pi])}


def sides(shape):
    """How far the canonical body is stretched along its axes."""
    if shape["kind"] == "cylinder":
        return [shape["radius"], shape["radius"], shape["length"]]
    return shape["size"] if shape["kind"] == "cuboid" else shape["semi_axes"]


def bounds(shape):
    _, lower, upper = CELLS[shape["kind"]]
    return list(shape.get("lower", lower)), list(shape.get("upper", upper))


def solid(shape):
    """Volume, and the ten parameters of unit mass."""
    if shape["kind"] in CELLS:
        stretch = sides(shape)
        volume, M = CELLS[shape["kind"]][0](*bounds(shape))
        volume *= stretch[0] * stretch[1] * stretch[2]
        T = placed(shape["xyz"], shape["rpy"], stretch)
    else:
        whole = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]
        volume, M = surface(shape["vertices"], shape.get("faces", whole))
        T = placed(shape["xyz"], shape["rpy"])
    M = product(product(T, M), transpose(T))
    return volume, write_body("shapeid", 1.0, [row[3] for row in M[:3]], [row[:3] for row in M[:3]])


def moments(shape):
    volume, unit = solid(shape)
    return {"volume_and_parameters": [volume] + unit}


def place_of_cut(kind, axis, a, b, fraction):
    """Below it lies `fraction` of the volume between a and b."""
    if kind == "cylinder" and axis == 0:
        return (a ** 2 + fraction * (b ** 2 - a ** 2)) ** (1 / 2)
    if kind == "ellipsoid" and axis == 0:
        return (a ** 3 + fraction * (b ** 3 - a ** 3)) ** (1 / 3)
    if kind == "ellipsoid" and axis == 1:
        return acos((1 - fraction) * cos(a) + fraction * cos(b))
    return a + fraction * (b - a)


def cut(shape, axis, fraction):
    lower, upper = bounds(shape)
    at = place_of_cut(shape["kind"], axis, lower[axis], upper[axis], fraction)
    below, above = list(upper), list(lower)
    below[axis] = above[axis] = at
    return dict(shape, lower=lower, upper=below), dict(shape, lower=above, upper=upper)


def division(given):
    """Both parts keep the density: volume, mass, unit parameters."""
    parts = []
    pieces = cut(given["shape"], given["axis"], given["fraction"])
    for piece, share in zip(pieces, (given["fraction"], 1 - given["fraction"])):
        volume, unit = solid(piece)
        parts += [volume, given["mass"] * share] + unit
    return {"parts": parts}


# Motion. Newton and Euler about a moving origin, one column a parameter.

def added(*vectors):
    return [sum(x) for x in zip(*vectors)]


def body_rows(w, dw, a):
    columns = []
    for j in range(10):
        unit = [0.0] * 10
        unit[j] = 1.0
        m, h, I = unit[0], unit[1:4], symmetric(*unit[4:10])
        force = added([m * x for x in a], cross(dw, h), cross(w, cross(w, h)))
        moment = added(times(I, dw), cross(w, times(I, w)), cross(h, a))
        columns.append(force + moment)
    return transpose(columns)


def regressor(given):
    rows = body_rows(*(given[k] for k in
                       ("angular_velocity", "angular_acceleration", "specific_force")))
    return {"rows": [x for row in rows for x in row]}


def about(axis, angle):
    """Rodrigues: the rotation about a unit vector."""
    K = skew(axis)
    KK = product(K, K)
    return [[(i == j) + sin(angle) * K[i][j] + (1 - cos(angle)) * KK[i][j] for j in range(3)]
            for i in range(3)]


def motions(robot, sample):
    """Of every link, in base axes: R, origin p, w, dw, proper acceleration a, and its joints."""
    found = [{"R": rotation([0, 0, 0]), "p": [0.0] * 3, "w": sample["angular_velocity"],
              "dw": sample["angular_acceleration"], "a": sample["specific_force"], "joints": []}]
    for j, link in enumerate(robot["links"][1:]):
        q, dq, ddq = (sample[name][j] for name in ("q", "dq", "ddq"))
        up = found[link["parent"]]
        R = product(up["R"], rotation(link["rpy"]))
        z, arm = times(R, link["axis"]), times(up["R"], link["xyz"])
        turns = link["joint"] == "revolute"
        if turns:
            R = product(R, about(link["axis"], q))
        else:
            arm = added(arm, [q * x for x in z])
        w, dw = up["w"], up["dw"]
        a = added(up["a"], cross(dw, arm), cross(w, cross(w, arm)))
        spin = [dq * x for x in z]
        if turns:
            w, dw = added(w, spin), added(dw, [ddq * x for x in z], cross(w, spin))
        else:
            a = added(a, [2 * x for x in cross(w, spin)], [ddq * x for x in z])
        p = added(up["p"], arm)
        found.append({"R": R, "p": p, "w": w, "dw": dw, "a": a,
                      "joints": up["joints"] + [(j, turns, z, p)]})
    return found


def point_jacobian(robot, motion, point):
    """Linear, then angular velocity of a body's point, for each generalised velocity."""
    base = 6 if robot["root"] == "floating" else 0
    J = [[0.0] * (base + len(robot["links"]) - 1) for _ in range(6)]
    for i in range(base):
        J[i][i] = 1.0
    if base:
        for row, entries in zip(J, skew([-x for x in point])):
            row[3:6] = entries
    for j, turns, z, p in motion["joints"]:
        linear = cross(z, [x - y for x, y in zip(point, p)]) if turns else z
        for i in range(3):
            J[i][base + j] = linear[i]
            J[3 + i][base + j] = z[i] if turns else 0.0
    return J


def robot_rows(robot, sample):
    """Y: rows in generalised order, ten columns a link."""
    blocks = []
    for motion in motions(robot, sample):
        back = transpose(motion["R"])
        B = body_rows(*(times(back, motion[name]) for name in ("w", "dw", "a")))
        turned = product(motion["R"], B[:3]) + product(motion["R"], B[3:])
        blocks.append(product(transpose(point_jacobian(robot, motion, motion["p"])), turned))
    return [[x for part in parts for x in part] for parts in zip(*blocks)]


def contact_rows(robot, sample):
    found, rows = motions(robot, sample), []
    for contact in robot["contacts"]:
        motion = found[contact["link"]]
        point = added(motion["p"], times(motion["R"], contact["xyz"]))
        J = point_jacobian(robot, motion, point)
        rows += J[:3]
        if contact["kind"] == "plane":
            rows += J[3:]
        if contact["kind"] == "line":  # no moment about itself: its turning is held about y and z
            axes = transpose(product(motion["R"], rotation(contact["rpy"])))
            rows += product(axes[1:], J[3:])
    return rows


def robot(given):
    return {"rows": [x for row in robot_rows(given["robot"], given["sample"]) for x in row],
            "jacobian": [x for row in contact_rows(given["robot"], given["sample"]) for x in row]}


# Least squares in fractions.

def exact(A):
    return [exact(x) if isinstance(x, list) else Fraction(x) for x in A]


def exact_product(A, B):
    """Of fractions, over one denominator each: far fewer divisors are sought than by fractions."""
    def whole(M):
        scale = lcm(*(x.denominator for row in M for x in row))
        return scale, [[x.numerator * (scale // x.denominator) for x in row] for row in M]
    (a, A), (b, B) = whole(A), whole(B)
    return [[Fraction(x, a * b) for x in row] for row in product(A, B)]


def solved(A, b):
    """A solution of A x = b, which has one; unknowns without a pivot are zero. Also the rank.

    Elimination over integers (Bareiss): every division leaves no remainder."""
    rows = []
    for row, right in zip(A, b):
        row = list(row) + [right]
        scale = lcm(*(x.denominator for x in row))
        rows.append([x.numerator * (scale // x.denominator) for x in row])
    n, pivots, last = len(A), [], 1
    for k in range(n):
        at = len(pivots)
        pivot = next((i for i in range(at, n) if rows[i][k] != 0), None)
        if pivot is None:
            continue
        rows[at], rows[pivot] = rows[pivot], rows[at]
        lead = rows[at]
        for i in range(n):
            if i != at:
                rows[i] = [(lead[k] * p - rows[i][k] * q) // last for p, q in zip(rows[i], lead)]
        last = lead[k]
        pivots.append(k)
    x = [Fraction(0)] * n
    for at, k in enumerate(pivots):
        x[k] = Fraction(rows[at][n], rows[at][k])
    return x, len(pivots)


def projection(given):
    """[Y F]^T P [Y F] with P = W - W J^T (J W J^T)^+ J W: no basis has to be agreed upon."""
    J, W = exact(given["J"]), exact(given["weight"])
    YF = exact([row + [f] for row, f in zip(given["Y"], given["F"])])
    WYF = [[w * x for x in row] for w, row in zip(W, YF)]
    JWJ = exact_product([[x * w for x, w in zip(row, W)] for row in J], transpose(J))
    gram, rank = exact_product(transpose(YF), WYF), 0
    reached = exact_product(J, WYF)
    for j, column in enumerate(transpose(reached)):
        x, rank = solved(JWJ, column)
        for i, other in enumerate(transpose(reached)):
            gram[i][j] -= dot(other, x)
    return {"gram": [float(x) for row in gram for x in row], "rank": [rank]}


def normal(Y, F, W):
    """Y^T W Y, Y^T W F and F^T W F, exactly."""
    Y, F, W = exact(Y), exact(F), exact(W)
    YF = [row + [f] for row, f in zip(Y, F)]
    G = exact_product(transpose(YF), [[w * x for x in row] for w, row in zip(W, YF)])
    return [row[:-1] for row in G[:-1]], [row[-1] for row in G[:-1]], G[-1][-1]


class MassProblem:
    """minimise over m >= 0  |W^(1/2) (Y U m - F)|^2 + lambda sum m_j^2 / V_j."""

    def __init__(self, p):
        G, g, self.constant = p["normal"] if "normal" in p else normal(p["Y"], p["F"], p["W"])
        self.U = exact(p["U"])
        self.H = exact_product(transpose(self.U), exact_product(G, self.U))
        for j, volume in enumerate(p["V"]):
            self.H[j][j] += Fraction(p["lambda"]) / Fraction(volume)
        self.h = times(transpose(self.U), g)
        self.mass_bound = Fraction(p["mass_bound"])

    def half_slopes(self, m):
        return [p - q for p, q in zip(times(self.H, m), self.h)]

    def objective(self, m):
        return dot(m, times(self.H, m)) - 2 * dot(self.h, m) + self.constant

    def minimiser(self):
        """Lawson and Hanson, in exact arithmetic."""
        n = len(self.h)
        m, free = [Fraction(0)] * n, []
        while True:
            slopes = self.half_slopes(m)
            held = [j for j in range(n) if j not in free]
            steepest = min(held, key=lambda j: slopes[j], default=None)
            if steepest is None or slopes[steepest] >= 0:
                return m
            free.append(steepest)
            while True:
                target, _ = solved([[self.H[i][j] for j in free] for i in free],
                                   [self.h[i] for i in free])
                steps = [(m[j] / (m[j] - t), j) for j, t in zip(free, target) if t <= 0]
                step = min(steps)[0] if steps else 1
                for j, t in zip(free, target):
                    m[j] += step * (t - m[j])
                if not steps:
                    break
                free = [j for j in free if m[j] > 0]


def masses(given):
    return {"masses": [float(m) for m in MassProblem(given).minimiser()]}


# Algorithm 1: divide the shape that (16) picks, and solve again.

def halves(cuboid):
    """Across the longest side; of sides that tie, the first."""
    lower, upper = bounds(cuboid)
    lengths = [(b - a) * x for a, b, x in zip(lower, upper, cuboid["size"])]
    axis = next(i for i in range(3) if lengths[i] >= (1 - 1e-9) * max(lengths))
    return cut(cuboid, axis, 0.5)


def criterion(m, V, whole, given):
    """(16), each factor relative: k1 (m/M0)(V/V0) + k2 (m/M0)/(V/V0)."""
    mass, size = m / given["expected_mass"], V / whole
    return given["k1"] * mass * size + given["k2"] * mass / size


def next_place(v, tie):
    return next(j for j in range(len(v)) if v[j] >= max(v) - tie * abs(max(v)))


def solved_shapes(data, shapes, given):
    """Masses, volumes, objective and parameters for normal equations and these shapes."""
    links = len(data[0]) // 10
    U, V = [], []
    for shape in shapes:
        volume, unit = solid(shape)
        at = 10 * shape.get("link", 0)
        U.append([0.0] * at + unit + [0.0] * (10 * links - at - 10))
        V.append(volume)
    p = MassProblem({"normal": data, "U": transpose(U), "V": V, "lambda": given["lambda"],
                     "mass_bound": 0.0})
    m = p.minimiser()
    return ([float(x) for x in m], V, float(p.objective(m)),
            [float(dot(row, m)) for row in p.U])


def divided(data, shapes, given):
    """Places that are divided, masses and objective after each, and the last parameters."""
    shapes = list(shapes)
    m, V, value, Phi = solved_shapes(data, shapes, given)
    whole = sum(V)
    places, masses_of_all, objectives = [], list(m), [value]
    for _ in range(given["divisions"]):
        v = [criterion(mass, volume, whole, given) for mass, volume in zip(m, V)]
        place = next_place(v, given["tie"])
        shapes[place], other = halves(shapes[place])
        shapes.append(other)
        m, V, value, Phi = solved_shapes(data, shapes, given)
        places.append(place)
        masses_of_all += m
        objectives.append(value)
    return places, masses_of_all, objectives, Phi


def run(given):
    data = normal(given["Y"], given["F"], given["W"])
    places, m, objectives, Phi = divided(data, given["shapes"], given)
    return {"divided": places, "masses": m, "objectives": objectives, "parameters": Phi}


def without_forces(rows, J, weight):
    """W^(1/2) rows, less what lies in the range of W^(1/2) J^T. Gram and Schmidt, largest first."""
    roots = [sqrt(w) for w in weight]
    rows = [[w * x for x in row] for w, row in zip(roots, rows)]
    reached = [[w * x for w, x in zip(roots, row)] for row in J]
    columns = transpose(rows)
    threshold = 1e-12 * max([1.0] + [dot(c, c) for c in reached])
    while reached:
        direction = max(reached, key=lambda c: dot(c, c))
        size = dot(direction, direction)
        if size <= threshold:
            break
        reached.remove(direction)
        for vectors in (reached, columns):
            for _ in range(2):  # the second pass takes what rounding left of the first
                vectors[:] = [[x - dot(direction, v) / size * d for x, d in zip(v, direction)]
                              for v in vectors]
    return transpose(columns)


def load(given):
    """Every link is known; one carries a load somewhere in a box."""
    machine, area = given["robot"], given["area"]
    at = 10 * area["link"]
    known = given["parameters"]
    base = 6 if machine["root"] == "floating" else 0
    Y, F = [], []
    for sample in given["samples"]:
        rows = robot_rows(machine, sample)
        applied = [0.0] * base + sample["tau"]
        both = [row[at:at + 10] + [tau - dot(row, known)] for row, tau in zip(rows, applied)]
        for row in without_forces(both, contact_rows(machine, sample), given["weight"]):
            Y.append(row[:10])
            F.append(row[10])
    box = {"kind": "cuboid", "size": [1.0, 1.0, 1.0], "lower": area["lower"],
           "upper": area["upper"], "xyz": area["xyz"], "rpy": area["rpy"]}
    places, _, objectives, Phi = divided(normal(Y, F, [1.0] * len(F)), [box], given)
    mass = Phi[0] or 1.0  # what weighs nothing is said to be at the origin
    return {"divided": places, "mass_and_centre": Phi[:1] + [h / mass for h in Phi[1:4]],
            "objective": objectives[-1:]}


def near(a, b, size):
    return abs(a - b) <= 1e-9 * size


def certify(given):
    """Feasible, honest about itself, and no farther above the optimum than `gap` allows."""
    p, answer = MassProblem(given["problem"]), given["answer"]
    m = exact(answer["masses"])
    if min(m) < 0 or (p.mass_bound > 0 and sum(m) > p.mass_bound):
        return {"accepted": False}
    for said, row in zip(answer["parameters"], p.U):
        if not near(Fraction(said), dot(row, m), sum(abs(u) * x for u, x in zip(row, m))):
            return {"accepted": False}
    value = p.objective(m)
    if not near(Fraction(answer["objective"]), value, value + Fraction(1, 10 ** 9) * p.constant):
        return {"accepted": False}
    gap = value - p.objective(p.minimiser())
    return {"accepted": gap <= Fraction(given["gap"]) * p.constant}


ANSWERS = {"convert": convert, "existence": existence, "moments": moments, "division": division,
           "regressor": regressor, "robot": robot, "projection": projection, "masses": masses,
           "run": run, "load": load, "certify": certify}


def main():
    for line in sys.stdin:
        question = json.loads(line)
        print(json.dumps(ANSWERS[question["kind"]](question["input"])), flush=True)


if __name__ == "__main__":
    main()
