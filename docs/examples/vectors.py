#!/usr/bin/env python3
"""An implementation of its own, small and slow, for `shapeid vectors --check`.

Standard library only. A line of JSON comes in, {"id", "kind", "input"}; a line goes out. What has
to be right about the optimum is computed in fractions. Formulas: docs/derivations.
"""
import json
import sys
from fractions import Fraction
from math import cos, pi, sin


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


# Shapes of unit mass in their own axes: volume, centre, covariance.

def diagonal(v):
    return [[v[0], 0, 0], [0, v[1], 0], [0, 0, v[2]]]


def own_moments(shape):
    kind = shape["kind"]
    if kind == "cuboid":
        s = shape["size"]
        return s[0] * s[1] * s[2], [0, 0, 0], diagonal([x * x / 12 for x in s])
    if kind == "cylinder":
        r, length = shape["radius"], shape["length"]
        return pi * r * r * length, [0, 0, 0], diagonal([r * r / 4, r * r / 4, length ** 2 / 12])
    if kind == "ellipsoid":
        s = shape["semi_axes"]
        return 4 / 3 * pi * s[0] * s[1] * s[2], [0, 0, 0], diagonal([x * x / 5 for x in s])
    corners = shape["vertices"]
    centre = [sum(p[i] for p in corners) / 4 for i in range(3)]
    arms = [[p[i] - centre[i] for i in range(3)] for p in corners]
    edges = [[p[i] - corners[0][i] for i in range(3)] for p in corners[1:]]
    volume = abs(dot(edges[0], cross(edges[1], edges[2]))) / 6
    return volume, centre, [[sum(a[i] * a[j] for a in arms) / 20 for j in range(3)]
                            for i in range(3)]


def unit_parameters(centre, covariance, xyz, rpy):
    R = rotation(rpy)
    c = [p + t for p, t in zip(times(R, centre), xyz)]
    return write_body("shapeid", 1.0, c, shifted(turned(R, covariance), 1.0, c, 1))


def moments(shape):
    volume, centre, covariance = own_moments(shape)
    return {"volume_and_parameters":
            [volume] + unit_parameters(centre, covariance, shape["xyz"], shape["rpy"])}


def division(given):
    """Both parts keep the density: volume, mass, unit parameters."""
    axis, fraction, size = given["axis"], given["fraction"], given["size"]
    parts = []
    for share, side in ((fraction, -1), (1 - fraction, 1)):
        part = list(size)
        part[axis] *= share
        centre = [0, 0, 0]
        centre[axis] = side * (size[axis] - part[axis]) / 2
        volume, _, covariance = own_moments({"kind": "cuboid", "size": part})
        parts += [volume, given["mass"] * share]
        parts += unit_parameters(centre, covariance, given["xyz"], given["rpy"])
    return {"parts": parts}


def regressor(given):
    """Force and moment about the moving origin, one column a parameter."""
    w, dw, a = (given[k] for k in ("angular_velocity", "angular_acceleration", "specific_force"))
    columns = []
    for j in range(10):
        unit = [0.0] * 10
        unit[j] = 1.0
        m, h, I = unit[0], unit[1:4], symmetric(*unit[4:10])
        force = [m * p + q + r for p, q, r in zip(a, cross(dw, h), cross(w, cross(w, h)))]
        moment = [p + q + r for p, q, r in zip(times(I, dw), cross(w, times(I, w)), cross(h, a))]
        columns.append(force + moment)
    return {"rows": [x for row in transpose(columns) for x in row]}


# Least squares in fractions.

def exact(A):
    return [exact(x) if isinstance(x, list) else Fraction(x) for x in A]


def solved(A, b):
    """A solution of A x = b, which has one; unknowns without a pivot are zero. Also the rank."""
    rows = [list(row) + [right] for row, right in zip(A, b)]
    n, pivots = len(A), []
    for k in range(n):
        pivot = next((i for i in range(len(pivots), n) if rows[i][k] != 0), None)
        if pivot is None:
            continue
        at = len(pivots)
        rows[at], rows[pivot] = rows[pivot], rows[at]
        for i in range(n):
            if i != at and rows[i][k] != 0:
                factor = rows[i][k] / rows[at][k]
                rows[i] = [p - factor * q for p, q in zip(rows[i], rows[at])]
        pivots.append(k)
    x = [Fraction(0)] * n
    for at, k in enumerate(pivots):
        x[k] = rows[at][n] / rows[at][k]
    return x, len(pivots)


def projection(given):
    """[Y F]^T P [Y F] with P = W - W J^T (J W J^T)^+ J W: no basis has to be agreed upon."""
    J, W = exact(given["J"]), exact(given["weight"])
    YF = exact([row + [f] for row, f in zip(given["Y"], given["F"])])
    WYF = [[w * x for x in row] for w, row in zip(W, YF)]
    JWJ = product([[x * w for x, w in zip(row, W)] for row in J], transpose(J))
    gram, rank = product(transpose(YF), WYF), 0
    reached = product(J, WYF)
    for j, column in enumerate(transpose(reached)):
        x, rank = solved(JWJ, column)
        for i, other in enumerate(transpose(reached)):
            gram[i][j] -= dot(other, x)
    return {"gram": [float(x) for row in gram for x in row], "rank": [rank]}


class MassProblem:
    """minimise over m >= 0  |W^(1/2) (Y U m - F)|^2 + lambda sum m_j^2 / V_j."""

    def __init__(self, p):
        Y, self.U = exact(p["Y"]), exact(p["U"])
        A = product(Y, self.U)
        W, self.F = exact(p["W"]), exact(p["F"])
        self.density = [Fraction(p["lambda"]) / Fraction(v) for v in p["V"]]
        WA = [[w * x for x in row] for w, row in zip(W, A)]
        self.H = product(transpose(A), WA)
        for j, d in enumerate(self.density):
            self.H[j][j] += d
        self.h = times(transpose(WA), self.F)
        self.constant = sum(w * f * f for w, f in zip(W, self.F))
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


ANSWERS = {"convert": convert, "moments": moments, "division": division, "regressor": regressor,
           "projection": projection, "masses": masses, "certify": certify}


def main():
    for line in sys.stdin:
        question = json.loads(line)
        print(json.dumps(ANSWERS[question["kind"]](question["input"])), flush=True)


if __name__ == "__main__":
    main()
