#!/usr/bin/env python3
"""The example program with one bug in it: what the vectors have to catch.

bugs.py --list names the bugs; bugs.py NAME runs with that one.
"""
import os
import sys
from fractions import Fraction

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "docs", "examples"))
import vectors as good  # noqa: E402


def replaced(**functions):
    """Puts functions in the place of the example's, each given the one that was there."""
    def plant():
        for name, make in functions.items():
            setattr(good, name, make(getattr(good, name)))
        for kind in good.ANSWERS:
            good.ANSWERS[kind] = getattr(good, kind)
        for kind, (_, lower, upper) in good.CELLS.items():
            good.CELLS[kind] = getattr(good, kind + "_cell"), lower, upper
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


def mass_and_tensor_alone(existence):
    """Positive mass and a positive tensor about the centre: the triangle inequality is forgotten."""
    def wrong(given):
        m, h, second = good.read_body("shapeid", good.exact(given["parameters"]))
        if m <= 0:
            return {"exists": False}
        I = good.tensor_of(good.shifted(second, m, [x / m for x in h], -1))
        minors = [I[0][0], I[0][0] * I[1][1] - I[0][1] ** 2, good.dot(I[0], good.cross(I[1], I[2]))]
        return {"exists": min(minors) > 0}
    return wrong


def without_first_moment(existence):
    def wrong(given):
        p = given["parameters"]
        return existence({"parameters": p[:1] + [0.0, 0.0, 0.0] + p[4:]})
    return wrong


def mass_alone(existence):
    return lambda given: {"exists": given["parameters"][0] >= 0}


def column_major(regressor):
    def wrong(given):
        flat = regressor(given)["rows"]
        return {"rows": [flat[10 * i + j] for j in range(10) for i in range(6)]}
    return wrong


def still(body_rows):
    """Neither Coriolis nor centrifugal terms of the body."""
    return lambda w, dw, a: body_rows([0.0, 0.0, 0.0], dw, a)


def gravity_falls(body_rows):
    """Takes the acceleration for the specific force: the sign of gravity."""
    return lambda w, dw, a: body_rows(w, dw, [-x for x in a])


def moment_before_force(body_rows):
    def wrong(w, dw, a):
        rows = body_rows(w, dw, a)
        return rows[3:] + rows[:3]
    return wrong


def other_sample(change):
    """Every use of a robot sees another motion."""
    return lambda motions: lambda robot, sample: motions(robot, dict(sample, **change(sample)))


def other_links(change):
    """Every use of a robot sees other links: `change` of each, with its place in the list."""
    def make(motions):
        def wrong(robot, sample):
            links = [link if i == 0 else dict(link, **change(link, i))
                     for i, link in enumerate(robot["links"])]
            return motions(dict(robot, links=links), sample)
        return wrong
    return make


def without_velocities(sample):
    return {"dq": [0.0] * len(sample["dq"])}


def joints_reversed(sample):
    return {name: list(reversed(sample[name])) for name in ("q", "dq", "ddq")}


def sliding_without_coriolis(motions):
    """2 w x z dq of prismatic joints left out, there and in all that they carry."""
    def wrong(robot, sample):
        found = motions(robot, sample)
        lost = [[0.0] * 3]
        for j, link in enumerate(robot["links"][1:]):
            term = [0.0] * 3
            if link["joint"] == "prismatic":
                z = found[j + 1]["joints"][-1][2]
                term = [2 * sample["dq"][j] * x for x in good.cross(found[j + 1]["w"], z)]
            lost.append(good.added(lost[link["parent"]], term))
        for motion, term in zip(found, lost):
            motion["a"] = [x - y for x, y in zip(motion["a"], term)]
        return found
    return wrong


def spin_without_coriolis(motions):
    """w x z dq of turning joints left out of the angular acceleration of their links."""
    def wrong(robot, sample):
        found = motions(robot, sample)
        for j, link in enumerate(robot["links"][1:]):
            if link["joint"] == "revolute":
                z = found[j + 1]["joints"][-1][2]
                spin = [sample["dq"][j] * x for x in z]
                term = good.cross(found[link["parent"]]["w"], spin)
                found[j + 1]["dw"] = [x - y for x, y in zip(found[j + 1]["dw"], term)]
        return found
    return wrong


def joints_before_the_base(robot_rows):
    def wrong(robot, sample):
        rows = robot_rows(robot, sample)
        return rows[6:] + rows[:6] if robot["root"] == "floating" else rows
    return wrong


def other_contacts(change):
    def make(contact_rows):
        def wrong(robot, sample):
            contacts = [dict(c, **change(c)) for c in robot["contacts"]]
            return contact_rows(dict(robot, contacts=contacts), sample)
        return wrong
    return make


def tube(cylinder_cell):
    """Of the whole cylinder all mass is at its radius."""
    def wrong(lower, upper):
        volume, M = cylinder_cell(lower, upper)
        for i in range(2):
            M[i][i] *= 2
        return volume, M
    return wrong


def even_radius(powers):
    """The volume element r dr taken for dr."""
    return lambda a, b, k: powers(a, b, max(k - 1, 0))


def semi_axes_as_axes(sides):
    def wrong(shape):
        return [x / 2 for x in sides(shape)] if shape["kind"] == "ellipsoid" else sides(shape)
    return wrong


def half_sides(sides):
    def wrong(shape):
        return [2 * x for x in sides(shape)] if shape["kind"] == "cuboid" else sides(shape)
    return wrong


def signed_volume(surface):
    """A surface whose triangles are in the other order weighs less than nothing."""
    def wrong(corners, faces):
        volume, M = surface(corners, faces)
        p = [[corners[k] for k in face] for face in faces]
        signed = sum(good.dot(a, good.cross(b, c)) for a, b, c in p)
        return volume if signed > 0 else -volume, M
    return wrong


def hull_of_a_mesh(surface):
    """Every tetrahedron counts as positive: a hollow is filled twice."""
    def wrong(corners, faces):
        turned = []
        for face in faces:
            a, b, c = (corners[k] for k in face)
            turned.append(face if good.dot(a, good.cross(b, c)) > 0 else list(reversed(face)))
        return surface(corners, turned)
    return wrong


def cut_in_the_middle(place_of_cut):
    """Halves the coordinate, not the volume."""
    return lambda kind, axis, a, b, fraction: a + fraction * (b - a)


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


def no_contacts(without_forces):
    return lambda rows, J, weight: without_forces(rows, [], weight)


def weighted_afterwards(without_forces):
    """Projects first and weighs the projected rows."""
    def wrong(rows, J, weight):
        projected = without_forces(rows, J, [1.0] * len(weight))
        return [[w ** 0.5 * x for x in row] for w, row in zip(weight, projected)]
    return wrong


def clipped(minimiser):
    """Least squares first, bounds afterwards."""
    def wrong(self):
        m, _ = good.solved(self.H, self.h)
        return [max(Fraction(0), x) for x in m]
    return wrong


def unbounded(minimiser):
    return lambda self: good.solved(self.H, self.h)[0]


def weights_forgotten(normal):
    return lambda Y, F, W: normal(Y, F, [1.0] * len(W))


def weights_squared(normal):
    return lambda Y, F, W: normal(Y, F, [w * w for w in W])


def without_density(init):
    return lambda self, p: init(self, dict(p, **{"lambda": 0.0}))


def plain_ridge(init):
    """lambda m^2 over the mean volume: halves count for less than the whole."""
    def wrong(self, p):
        init(self, dict(p, V=[sum(p["V"]) / len(p["V"])] * len(p["V"])))
    return wrong


def first_free_only(minimiser):
    def wrong(self):
        m = minimiser(self)
        best = max(range(len(m)), key=lambda j: m[j], default=None)
        return [x if j == best else Fraction(0) for j, x in enumerate(m)]
    return wrong


def last_of_ties(next_place):
    def wrong(v, tie):
        return len(v) - 1 - next_place(list(reversed(v)), tie)
    return wrong


def unscaled(criterion):
    """As printed: k1 m V + k2 m / V in kg and m^3."""
    return lambda m, V, whole, given: given["k1"] * m * V + given["k2"] * m / V


def one_term(name):
    return lambda criterion: lambda m, V, whole, given: criterion(m, V, whole, dict(given, **{name: 0}))


def heaviest_first(criterion):
    return lambda m, V, whole, given: m


def shortest_side(halves):
    def wrong(cuboid):
        lower, upper = good.bounds(cuboid)
        lengths = [(b - a) * x for a, b, x in zip(lower, upper, cuboid["size"])]
        return good.cut(cuboid, lengths.index(min(lengths)), 0.5)
    return wrong


def last_of_equal_sides(halves):
    def wrong(cuboid):
        lower, upper = good.bounds(cuboid)
        lengths = [(b - a) * x for a, b, x in zip(lower, upper, cuboid["size"])]
        longest = max(range(3), key=lambda i: (lengths[i] >= (1 - 1e-9) * max(lengths), i))
        return good.cut(cuboid, longest, 0.5)
    return wrong


def halves_exchanged(halves):
    return lambda cuboid: tuple(reversed(halves(cuboid)))


def last_solution_kept(divided):
    """The masses of the last division but one."""
    def wrong(data, shapes, given):
        fewer = dict(given, divisions=given["divisions"] - 1)
        places, _, _, _ = divided(data, shapes, given)
        _, m, objectives, Phi = divided(data, shapes, fewer)
        return places, m, objectives, Phi
    return wrong


def other_area(change):
    return lambda load: lambda given: load(dict(given, area=dict(given["area"], **change)))


def next_link(load):
    def wrong(given):
        link = (given["area"]["link"] + 1) % len(given["robot"]["links"])
        return load(dict(given, area=dict(given["area"], link=link)))
    return wrong


def nothing_known(load):
    return lambda given: load(dict(given, parameters=[0.0] * len(given["parameters"])))


def first_moment_for_centre(load):
    def wrong(given):
        answer = load(given)
        m = answer["mass_and_centre"]
        return dict(answer, mass_and_centre=m[:1] + [m[0] * x for x in m[1:]])
    return wrong


def centre_in_the_area(load):
    """Told in the frame of the area, not in the link's."""
    def wrong(given):
        answer, area = load(given), given["area"]
        m = answer["mass_and_centre"]
        way = [x - y for x, y in zip(m[1:], area["xyz"])]
        back = good.times(good.transpose(good.rotation(area["rpy"])), way)
        return dict(answer, mass_and_centre=m[:1] + back)
    return wrong


def torques_reversed(load):
    def wrong(given):
        samples = [dict(s, tau=list(reversed(s["tau"]))) for s in given["samples"]]
        return load(dict(given, samples=samples))
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


def refuses_no_mass(certify):
    def wrong(given):
        return certify(given) if sum(given["answer"]["masses"]) > 0 else {"accepted": False}
    return wrong


def compares_masses(certify):
    """Judges by the distance from masses of its own."""
    def wrong(given):
        own = good.MassProblem(given["problem"]).minimiser()
        apart = max(abs(x - y) for x, y in zip(given["answer"]["masses"], own))
        return certify(given) if apart < 1e-3 else {"accepted": False}
    return wrong


def wide_gap(certify):
    return lambda given: certify(dict(given, gap=10 * given["gap"]))


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
    # parameters
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
    "triangle inequality forgotten": replaced(existence=mass_and_tensor_alone),
    "existence decided without the first moment": replaced(existence=without_first_moment),
    "positive mass taken for existence": replaced(existence=mass_alone),
    # motion
    "rows read by columns": replaced(regressor=column_major),
    "Coriolis and centrifugal terms of a body missing": replaced(body_rows=still),
    "gravity with the other sign": replaced(body_rows=gravity_falls),
    "moments before forces": replaced(body_rows=moment_before_force),
    "joint velocities ignored": replaced(motions=other_sample(without_velocities)),
    "Coriolis term of a sliding joint missing": replaced(motions=sliding_without_coriolis),
    "Coriolis term of a turning joint missing": replaced(motions=spin_without_coriolis),
    "joints in the other order": replaced(motions=other_sample(joints_reversed)),
    "a tree taken for a chain": replaced(motions=other_links(lambda link, i: {"parent": i - 1})),
    "rpy of joints dropped": replaced(motions=other_links(lambda link, i: {"rpy": [0.0] * 3})),
    "joint axes in the parent's axes": replaced(motions=other_links(
        lambda link, i: {"axis": good.times(good.transpose(good.rotation(link["rpy"])),
                                            link["axis"])})),
    "joints that turn the other way": replaced(about=lambda about: lambda z, q: about(z, -q)),
    "joint rows before base rows": replaced(robot_rows=joints_before_the_base),
    "contact at the origin of its link": replaced(contact_rows=other_contacts(
        lambda contact: {"xyz": [0.0] * 3})),
    "every contact taken for a point": replaced(contact_rows=other_contacts(
        lambda contact: {"kind": "point"})),
    "a line of contact in its link's axes": replaced(contact_rows=other_contacts(
        lambda contact: {"rpy": [0.0] * 3})),
    # shapes
    "a tube for a solid cylinder": replaced(cylinder_cell=tube),
    "volume element of radii forgotten": replaced(powers=even_radius),
    "semi-axes taken for axes": replaced(sides=semi_axes_as_axes),
    "half sides taken for sides": replaced(sides=half_sides),
    "signed volume of a surface": replaced(surface=signed_volume),
    "a hollow counted as solid": replaced(surface=hull_of_a_mesh),
    "a division that halves the mass, not the density": replaced(division=mass_in_halves),
    "a cut across the next axis": replaced(division=next_axis),
    "parts of a division exchanged": replaced(division=parts_exchanged),
    "a cut that halves the radius, not the volume": replaced(place_of_cut=cut_in_the_middle),
    # projection
    "projection without its weight": replaced(projection=without_weight),
    "contact forces left in": replaced(projection=nothing_projected),
    "one contact row projected of three": replaced(projection=first_contact_alone),
    "full rank of J assumed": replaced(projection=full_rank_assumed),
    "contact forces of a robot left in": replaced(without_forces=no_contacts),
    "rows weighted after the projection": replaced(without_forces=weighted_afterwards),
    # masses
    "least squares clipped at zero": in_problem(minimiser=clipped),
    "masses without bounds": in_problem(minimiser=unbounded),
    "one shape with mass only": in_problem(minimiser=first_free_only),
    "weights forgotten": replaced(normal=weights_forgotten),
    "weights squared": replaced(normal=weights_squared),
    "density term forgotten": in_problem(__init__=without_density),
    "a ridge for the density term": in_problem(__init__=plain_ridge),
    # divisions
    "the last of tied shapes divided": replaced(next_place=last_of_ties),
    "criterion (16) with its units": replaced(criterion=unscaled),
    "criterion (16) without its first term": replaced(criterion=one_term("k1")),
    "criterion (16) without its second term": replaced(criterion=one_term("k2")),
    "the heaviest shape divided": replaced(criterion=heaviest_first),
    "a cut across the shortest side": replaced(halves=shortest_side),
    "a cut across the last of equal sides": replaced(halves=last_of_equal_sides),
    "halves in each other's place": replaced(halves=halves_exchanged),
    "masses before the last division returned": replaced(divided=last_solution_kept),
    # loads
    "area of a load without its place": replaced(load=other_area({"xyz": [0.0] * 3})),
    "area of a load without its rotation": replaced(load=other_area({"rpy": [0.0] * 3})),
    "load on the next link": replaced(load=next_link),
    "known links left in": replaced(load=nothing_known),
    "first moment of a load taken for its centre": replaced(load=first_moment_for_centre),
    "centre of a load in the area's frame": replaced(load=centre_in_the_area),
    "torques of joints in each other's place": replaced(load=torques_reversed),
    # judgement
    "a checker that accepts everything": replaced(certify=accepts_all),
    "a mass bound taken from the answer": replaced(certify=bound_from_the_answer),
    "no mass never accepted": replaced(certify=refuses_no_mass),
    "another optimum than one's own never accepted": replaced(certify=compares_masses),
    "parameters of an answer believed": replaced(certify=trusts_parameters),
    "objective of an answer believed": replaced(certify=trusts_the_objective),
    "declared mass bound ignored": replaced(certify=no_mass_bound),
    "a gap ten times as wide": replaced(certify=wide_gap),
}

if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        print("\n".join(BUGS))
    else:
        BUGS[sys.argv[1]]()
        good.main()
