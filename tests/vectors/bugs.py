#!/usr/bin/env python3
"""The example program with one bug in it: what the vectors have to catch.

bugs.py --list names the bugs; bugs.py NAME runs with that one.
"""
import os
import sys
from fractions import Fraction

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "docs", "examples"))
import vectors as good  # noqa: E402


def replaced(**functions):
    """Puts functions in the place of the example's, each given the one that was there."""
    def plant():
        for name, make in functions.items():
            setattr(good, name, make(getattr(good, name)))
        for kind in good.ANSWERS:
            good.ANSWERS[kind] = getattr(good, kind)
    return plant


def swapped_entries(order, first, second):
    """Two places of an order exchanged."""
    def plant():
        names = good.ENTRIES[order].split()
        i, j = names.index(first), names.index(second)
        names[i], names[j] = names[j], names[i]
        good.ENTRIES[order] = " ".join(names)
    return plant


def products_positive(tensor_of):
    def wrong(second):
        I = tensor_of(second)
        return [[I[i][j] if i == j else -I[i][j] for j in range(3)] for i in range(3)]
    return wrong


def about_the_centre(_):
    return lambda second, mass, c, sign: second


def moved_twice(shifted):
    return lambda second, mass, c, sign: shifted(second, 2 * mass, c, sign)


def no_rpy(rotation):
    return lambda rpy: rotation([0.0, 0.0, 0.0])


def transposed_rotation(rotation):
    return lambda rpy: good.transpose(rotation(rpy))


def angles_reversed(rotation):
    return lambda rpy: rotation(list(reversed(rpy)))


def column_major(regressor):
    def wrong(given):
        flat = regressor(given)["rows"]
        return {"rows": [flat[10 * i + j] for j in range(10) for i in range(6)]}
    return wrong


def still(regressor):
    """Neither Coriolis nor centrifugal terms."""
    return lambda given: regressor(dict(given, angular_velocity=[0.0, 0.0, 0.0]))


def gravity_falls(regressor):
    """Takes the acceleration for the specific force: the sign of gravity."""
    def wrong(given):
        a = given["specific_force"]
        return regressor(dict(given, specific_force=[a[0], a[1], a[2] - 2 * 9.81]))
    return wrong


def moment_before_force(regressor):
    def wrong(given):
        flat = regressor(given)["rows"]
        return {"rows": flat[30:] + flat[:30]}
    return wrong


def solid_cylinder_as_tube(own_moments):
    def wrong(shape):
        volume, centre, C = own_moments(shape)
        if shape["kind"] == "cylinder":
            C = good.diagonal([C[0][0] * 2, C[1][1] * 2, C[2][2]])
        return volume, centre, C
    return wrong


def semi_axes_as_axes(own_moments):
    def wrong(shape):
        if shape["kind"] == "ellipsoid":
            shape = dict(shape, semi_axes=[x / 2 for x in shape["semi_axes"]])
        return own_moments(shape)
    return wrong


def half_sides(own_moments):
    def wrong(shape):
        if shape["kind"] == "cuboid":
            shape = dict(shape, size=[2 * x for x in shape["size"]])
        return own_moments(shape)
    return wrong


def signed_volume(own_moments):
    """A tetrahedron whose vertices are in the other order weighs less than nothing."""
    def wrong(shape):
        volume, centre, C = own_moments(shape)
        if shape["kind"] == "tetrahedron":
            p = shape["vertices"]
            edges = [[x - y for x, y in zip(q, p[0])] for q in p[1:]]
            volume = good.dot(edges[0], good.cross(edges[1], edges[2])) / 6
        return volume, centre, C
    return wrong


def mass_in_halves(division):
    def wrong(given):
        parts = division(given)["parts"]
        parts[1] = parts[13] = given["mass"] / 2
        return {"parts": parts}
    return wrong


def next_axis(division):
    return lambda given: division(dict(given, axis=(given["axis"] + 1) % 3))


def parts_exchanged(division):
    def wrong(given):
        parts = division(given)["parts"]
        return {"parts": parts[12:] + parts[:12]}
    return wrong


def without_weight(projection):
    return lambda given: projection(dict(given, weight=[1.0] * len(given["weight"])))


def nothing_projected(projection):
    return lambda given: dict(projection(dict(given, J=[[0.0] * len(given["F"])])), rank=[3])


def first_contact_alone(projection):
    return lambda given: projection(dict(given, J=given["J"][:1]))


def full_rank_assumed(projection):
    return lambda given: dict(projection(given), rank=[len(given["J"])])


def clipped(minimiser):
    """Least squares first, bounds afterwards."""
    def wrong(self):
        m, _ = good.solved(self.H, self.h)
        return [max(Fraction(0), x) for x in m]
    return wrong


def unbounded(minimiser):
    return lambda self: good.solved(self.H, self.h)[0]


def weights_forgotten(init):
    return lambda self, p: init(self, dict(p, W=[1.0] * len(p["W"])))


def weights_squared(init):
    return lambda self, p: init(self, dict(p, W=[w * w for w in p["W"]]))


def first_free_only(minimiser):
    def wrong(self):
        m = minimiser(self)
        best = max(range(len(m)), key=lambda j: m[j], default=None)
        return [x if j == best else Fraction(0) for j, x in enumerate(m)]
    return wrong


def in_problem(**methods):
    def plant():
        for name, make in methods.items():
            setattr(good.MassProblem, name, make(getattr(good.MassProblem, name)))
    return plant


def accepts_all(_):
    return lambda given: {"accepted": True}


def bound_from_the_answer(certify):
    """m = 0 certifies itself."""
    def wrong(given):
        total = sum(given["answer"]["masses"])
        return certify(given) if total > 0 else {"accepted": True}
    return wrong


def trusts_parameters(certify):
    def wrong(given):
        p, m = good.MassProblem(given["problem"]), good.exact(given["answer"]["masses"])
        honest = [float(good.dot(row, m)) for row in p.U]
        return certify(dict(given, answer=dict(given["answer"], parameters=honest)))
    return wrong


def trusts_the_objective(certify):
    def wrong(given):
        m = good.exact(given["answer"]["masses"])
        value = float(good.MassProblem(given["problem"]).objective(m))
        return certify(dict(given, answer=dict(given["answer"], objective=value)))
    return wrong


def no_mass_bound(certify):
    return lambda given: certify(dict(given, problem=dict(given["problem"], mass_bound=0.0)))


BUGS = {
    "Ixz and Iyy swapped in Pinocchio's order": swapped_entries("pinocchio", "xz", "yy"),
    "Ixy and Ixz swapped in our order": swapped_entries("shapeid", "xy", "xz"),
    "Ixy and Iyz swapped in spatial_v2's order": swapped_entries("spatial_v2", "xy", "yz"),
    "Drake's products before its moments": swapped_entries("drake", "zz", "xy"),
    "products of inertia with the other sign": replaced(tensor_of=products_positive),
    "tensor about the centre for one about the origin": replaced(shifted=about_the_centre),
    "parallel axes applied twice": replaced(shifted=moved_twice),
    "rpy dropped": replaced(rotation=no_rpy),
    "rotation transposed": replaced(rotation=transposed_rotation),
    "roll, pitch, yaw in the other order": replaced(rotation=angles_reversed),
    "rows read by columns": replaced(regressor=column_major),
    "Coriolis and centrifugal terms missing": replaced(regressor=still),
    "gravity with the other sign": replaced(regressor=gravity_falls),
    "moments before forces": replaced(regressor=moment_before_force),
    "a tube for a solid cylinder": replaced(own_moments=solid_cylinder_as_tube),
    "semi-axes taken for axes": replaced(own_moments=semi_axes_as_axes),
    "half sides taken for sides": replaced(own_moments=half_sides),
    "signed volume of a tetrahedron": replaced(own_moments=signed_volume),
    "a division that halves the mass, not the density": replaced(division=mass_in_halves),
    "a cut across the next axis": replaced(division=next_axis),
    "parts of a division exchanged": replaced(division=parts_exchanged),
    "projection without its weight": replaced(projection=without_weight),
    "contact forces left in": replaced(projection=nothing_projected),
    "one contact row projected of three": replaced(projection=first_contact_alone),
    "full rank of J assumed": replaced(projection=full_rank_assumed),
    "least squares clipped at zero": in_problem(minimiser=clipped),
    "masses without bounds": in_problem(minimiser=unbounded),
    "one shape with mass only": in_problem(minimiser=first_free_only),
    "weights forgotten": in_problem(__init__=weights_forgotten),
    "weights squared": in_problem(__init__=weights_squared),
    "a checker that accepts everything": replaced(certify=accepts_all),
    "a mass bound taken from the answer": replaced(certify=bound_from_the_answer),
    "parameters of an answer believed": replaced(certify=trusts_parameters),
    "objective of an answer believed": replaced(certify=trusts_the_objective),
    "declared mass bound ignored": replaced(certify=no_mass_bound),
}

if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        print("\n".join(BUGS))
    else:
        BUGS[sys.argv[1]]()
        good.main()
