#include "shapeid/diagnosis/torque_header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "shapeid/diagnosis/hypotheses.hpp"

namespace shapeid::diagnosis {
namespace {

constexpr const char* algebra = R"(
struct Vector {
  double x = 0, y = 0, z = 0;
};
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator*(double s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vector operator*(Vector a, double s) { return s * a; }
inline Vector& operator+=(Vector& a, Vector b) { return a = a + b; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
struct Matrix {  // rows
  Vector a, b, c;
};
inline Vector operator*(const Matrix& m, Vector v) { return {dot(m.a, v), dot(m.b, v), dot(m.c, v)}; }
inline Matrix transposed(const Matrix& m) {
  return {{m.a.x, m.b.x, m.c.x}, {m.a.y, m.b.y, m.c.y}, {m.a.z, m.b.z, m.c.z}};
}
inline Matrix operator*(const Matrix& m, const Matrix& n) {
  const Matrix t = transposed(n);
  return transposed({m * t.a, m * t.b, m * t.c});
}
/// By the angle (rad) about a unit vector.
inline Matrix turned(Vector u, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), k = 1 - c;
  return {{c + k * u.x * u.x, k * u.x * u.y - s * u.z, k * u.x * u.z + s * u.y},
          {k * u.y * u.x + s * u.z, c + k * u.y * u.y, k * u.y * u.z - s * u.x},
          {k * u.z * u.x - s * u.y, k * u.z * u.y + s * u.x, c + k * u.z * u.z}};
}

struct Link {
  int parent;
  bool slides;
  Vector axis, place;
  Matrix turn;
  double mass;
  Vector first_moment;
  Matrix tensor;  // about the link's origin
};
)";

constexpr const char* dynamics = R"(
/// Motion of every link and the wrench it takes, in base axes.
struct Links {
  Matrix R[link_count];
  Vector p[link_count], w[link_count], alpha[link_count], a[link_count];  // origin, motion
  Vector f[link_count], n[link_count];  // force; moment about the link's origin
  Vector z[link_count];                 // z[j]: axis of joint j
  static int parent(int j) { return links[j + 1].parent; }

  void move(const double* q, const double* dq, const double* ddq, const double* base) {
    R[0] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    a[0] = {0, 0, 9.81};
    if (base != nullptr) {
      w[0] = {base[0], base[1], base[2]};
      alpha[0] = {base[3], base[4], base[5]};
      a[0] = {base[6], base[7], base[8]};
    }
    for (int i = 1; i < link_count; ++i) {
      const Link& link = links[i];
      const int k = link.parent, j = i - 1;
      const Matrix frame = R[k] * link.turn;
      z[j] = frame * link.axis;
      R[i] = link.slides ? frame : frame * turned(link.axis, q[j]);
      Vector r = R[k] * link.place;
      if (link.slides) r += z[j] * q[j];
      p[i] = p[k] + r;
      w[i] = w[k];
      alpha[i] = alpha[k];
      a[i] = a[k] + cross(alpha[k], r) + cross(w[k], cross(w[k], r));
      if (link.slides) {
        a[i] += z[j] * ddq[j] + 2.0 * cross(w[k], z[j] * dq[j]);
      } else {
        w[i] += z[j] * dq[j];
        alpha[i] += z[j] * ddq[j] + cross(w[k], z[j] * dq[j]);
      }
    }
    for (int i = 0; i < link_count; ++i) {
      carry(i, links[i].mass, links[i].first_moment, links[i].tensor);
    }
  }

  /// A body that moves with link i, about the link's origin and in its axes.
  void carry(int i, double mass, Vector first_moment, const Matrix& about_origin) {
    const Vector h = R[i] * first_moment;
    const Matrix tensor = R[i] * about_origin * transposed(R[i]);
    f[i] += mass * a[i] + cross(alpha[i], h) + cross(w[i], cross(w[i], h));
    n[i] += cross(h, a[i]) + tensor * alpha[i] + cross(w[i], tensor * w[i]);
  }

  void torques(double* tau) {
    for (int i = link_count - 1; i > 0; --i) {
      const int k = links[i].parent;
      tau[i - 1] += links[i].slides ? dot(z[i - 1], f[i]) : dot(z[i - 1], n[i]);
      const Vector r = p[i] + -1.0 * p[k];
      f[k] += f[i];
      n[k] += n[i] + cross(r, f[i]);
    }
  }
};
)";

constexpr const char* contacts = R"(
/// Takes off what contact forces provide, if there are any.
inline void take_off(const double* contact, double* torque) {
  for (int i = 0; contact != nullptr && i < joint_count; ++i) torque[i] -= contact[i];
}
)";

constexpr const char* interpolation = R"(
/// In straight lines from knot to knot, constant beyond the first and the last.
inline double curve(const double* knots, const double* numbers, int count, double x) {
  if (x <= knots[0]) return numbers[0];
  for (int i = 1; i < count; ++i) {
    if (x >= knots[i]) continue;
    const double share = (x - knots[i - 1]) / (knots[i] - knots[i - 1]);
    return (1 - share) * numbers[i - 1] + share * numbers[i];
  }
  return numbers[count - 1];
}
)";

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("{{{}, {}, {}}}", v.x(), v.y(), v.z());
}

std::string matrix_text(const Eigen::Matrix3d& m) {
  return fmt::format("{{{}, {}, {}}}", vector_text(m.row(0).transpose()),
                     vector_text(m.row(1).transpose()), vector_text(m.row(2).transpose()));
}

/// A name in a comment to the end of its line: a backslash there would take the next one in.
std::string in_comment(std::string name) {
  const auto ends_lines = [](char c) { return c == '\\' || static_cast<unsigned char>(c) < ' '; };
  std::replace_if(name.begin(), name.end(), ends_lines, '?');
  return name;
}

std::string link_text(const Link& link, const InertialParameters& inertia) {
  return fmt::format("    {{{}, {}, {}, {}, {}, {}, {}, {}}},  // {}\n", link.parent,
                     link.joint.kind == JointKind::prismatic, vector_text(link.joint.axis),
                     vector_text(link.joint.placement.translation()),
                     matrix_text(link.joint.placement.linear()), inertia.mass(),
                     vector_text(inertia.first_moment()), matrix_text(inertia.tensor()),
                     in_comment(link.name));
}

std::string declared(const std::string& name, double value) {
  return fmt::format(" const double {} = {};", name, value);
}

std::string declared_place(const AppliedEffect& a) {
  std::string text = fmt::format("const int j = {};", a.site);
  for (std::size_t i = 0; i < a.effect->shape.size(); ++i) {
    text += declared(a.effect->shape[i].name, a.shape[static_cast<Eigen::Index>(i)]);
  }
  return text;
}

/// One effect's statements with its numbers in scope.
std::string scoped(const AppliedEffect& a, const std::string& statements) {
  std::string numbers = declared_place(a);
  for (std::size_t i = 0; i < a.effect->parameters.size(); ++i) {
    numbers += declared(a.effect->parameters[i].name, a.value[static_cast<Eigen::Index>(i)]);
  }
  return fmt::format("  {{  // {}\n    {}\n    {}\n  }}\n", a.effect->id, numbers, statements);
}

std::string curve_code(const Curve& curve) {
  const auto array_of = [](CurveSignal signal) {
    switch (signal) {
      case CurveSignal::position:
        return "q";
      case CurveSignal::speed:
        return "dq";
      case CurveSignal::acceleration:
        return "ddq";
      case CurveSignal::load:
        break;
    }
    return "load";
  };
  const Effect& law = *curve.law.effect;
  return fmt::format(
      "  {{  // as {}, unexplained\n    const double knots[] = {{{}}};\n"
      "    const double numbers[] = {{{}}};\n    {}\n"
      "    const double {} = curve(knots, numbers, {}, {}[{}]);\n    {}\n  }}\n",
      law.id, fmt::join(curve.at, ", "), fmt::join(curve.number, ", "), declared_place(curve.law),
      law.parameters[0].name, curve.at.size(), array_of(curve.over.signal), curve.over.joint,
      law.code.torque);
}

// Both functions begin with the joints where they stand, and not where they were logged.
std::string corrected(const std::string& motion) {
  return "  double q[joint_count + 1] = {};\n"
         "  for (int i = 0; i < joint_count; ++i) q[i] = q_logged[i];\n" +
         motion;
}

/// What an effect needs that follows the load's rate: the load by itself, and its difference as
/// the library takes it.
std::string load_code(const std::string& motion) {
  return "\n/// What the rigid links ask for, N m; arguments as of predict().\n"
         "inline void rigid_load(const double* q_logged, const double* dq, const double* ddq,\n"
         "                       const double* base, double* load,\n"
         "                       const double* contact = nullptr) {\n" +
         corrected(motion) +
         "  for (int i = 0; i < joint_count; ++i) load[i] = 0.0;\n"
         "  Links rigid;\n  rigid.move(q, dq, ddq, base);\n  rigid.torques(load);\n"
         "  take_off(contact, load);\n}\n";
}

/// As much of the motion is at hand here as is asked for.
std::string prediction_from_log(const Robot& robot, const std::vector<AppliedEffect>& effects) {
  std::vector<double> times;
  std::string text;
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  for (const LoadRate& over : slopes_of_filters(robot, effects, anywhere)) {
    text += fmt::format(
        "  load_rate[{0}] = (load_at(around[{2}], {0}) - load_at(around[{1}], {0})) / {3};\n",
        over.joint, times.size(), times.size() + 1, over.span());
    times.insert(times.end(), {over.begin, over.end});
  }
  return fmt::format(
      R"(
struct Motion {{
  const double *q, *dq, *ddq, *base, *contact = nullptr;
}};

inline double load_at(const Motion& at, int joint) {{
  double load[joint_count + 1];
  rigid_load(at.q, at.dq, at.ddq, at.base, load, at.contact);
  return load[joint];
}}

/// When, s from now, the motions are that predict() looks at beside the one of now.
constexpr double around_times[] = {{{0}}};

/// The same with load_rate from those, in this order.
inline void predict(const Motion& now, const Motion* around, double* tau) {{
  double load_rate[joint_count + 1] = {{}};
{1}  predict(now.q, now.dq, now.ddq, now.base, load_rate, tau, now.contact);
}}
)",
      fmt::join(times, ", "), text);
}

/// Of declared rotors: beside all that was found, since the logged torque was taken without them.
std::string rotor_code(const Robot& robot) {
  std::string text;
  for (int j = 0; j < robot.joint_count(); ++j) {
    const double inertia = robot.joint(j).rotor_inertia;
    if (inertia > 0.0) text += fmt::format("  tau[{0}] += {1} * ddq[{0}];  // rotor\n", j, inertia);
  }
  return text;
}

}  // namespace

std::string torque_header(const Robot& robot, const RichModel& model) {
  const std::vector<AppliedEffect> effects = model.acting();
  const Viewer viewer(robot, ContactTreatment::ignore, effects);
  std::string inertias, motion, between, torque, scaling, left_out;
  for (const AppliedEffect& a : effects) {
    const TorqueCode& code = a.effect->code;
    if (!code.motion.empty()) motion += scoped(a, code.motion);
    if (!code.link.empty()) between += scoped(a, code.link);
    // What scales the prediction scales all of it, wherever it stands in the list.
    const bool scales = a.effect->transform.scales;
    if (!code.torque.empty()) (scales ? scaling : torque) += scoped(a, code.torque);
    const bool in_robot = a.effect->transform.robot != nullptr;
    if (code.motion.empty() && code.link.empty() && code.torque.empty() && !in_robot) {
      left_out += fmt::format("//   {}\n", in_comment(hypothesis_id(robot, a)));
    }
  }
  for (const Curve& curve : model.curves) torque += curve_code(curve);
  for (int i = 0; i < robot.link_count(); ++i) {
    inertias += link_text(viewer.robot().links[static_cast<std::size_t>(i)],
                          {model.Phi.segment<10>(Eigen::Index{10} * i)});
  }
  std::string names;
  for (int j = 0; j < robot.joint_count(); ++j) {
    names += fmt::format("//   {} {}\n", j, in_comment(robot.joint(j).name));
  }
  std::string text = "// Joint torques of " + in_comment(robot.name) +
                     ", as shapeid identified it.\n// Joints:\n" + names;
  if (!left_out.empty()) text += "// Found, and not part of this prediction:\n" + left_out;
  text += "#pragma once\n\n#include <cmath>\n\nnamespace shapeid_model {\n";
  text += algebra;
  text += fmt::format("\nconstexpr int joint_count = {}, link_count = {};\n", robot.joint_count(),
                      robot.link_count());
  text += "const Link links[link_count] = {\n" + inertias + "};\n";
  text += dynamics;
  text += contacts;
  if (!model.curves.empty()) text += interpolation;
  const bool rate = needs_load_rate(effects);
  if (rate) text += load_code(motion);
  text +=
      "\n/// q, dq, ddq, tau: joint_count numbers each (rad, N m). base: gyro, its derivative, "
      "specific\n/// force, in base axes; null: fixed and upright. contact: J^T f at the joints "
      "(joint_count numbers)\n/// of the contact forces f on the robot, with J where joints and "
      "contact points are found to be\n/// (effects.yaml); null: nothing touches.\n";
  if (rate) {
    text += "/// load_rate (N m/s): the change of rigid_load() a second, a drive's T ago.\n";
  }
  text +=
      "inline void predict(const double* q_logged, const double* dq, const double* ddq,\n"
      "                    const double* base, " +
      std::string(rate ? "const double* load_rate, " : "") +
      "double* tau,\n                    const double* contact = nullptr) {\n" + corrected(motion) +
      "  double load[joint_count + 1] = {};\n"
      "  Links at;\n  at.move(q, dq, ddq, base);\n"
      "  for (int i = 0; i < joint_count; ++i) tau[i] = 0.0;\n"
      "  Links rigid = at;\n  rigid.torques(load);\n  take_off(contact, load);\n" +
      between + "  at.torques(tau);\n  take_off(contact, tau);\n" + torque + scaling +
      rotor_code(robot) + "}\n";
  if (rate) text += prediction_from_log(robot, effects);
  text += "\n}  // namespace shapeid_model\n";
  return text;
}

}  // namespace shapeid::diagnosis
