// An implementation of its own, small and plain, for `shapeid vectors --check`: Eigen for the
// mathematics and nothing else. A line of JSON comes in, {"id", "kind", "input"}; a line goes out.
// Build: g++ -std=c++20 -O2 -I /usr/include/eigen3 main.cpp
#include <Eigen/Eigenvalues>

#include <iostream>

#include "divisions.hpp"
#include "robots.hpp"

namespace example {
namespace {

std::string convert(const Json& given) {
  const Sigma read = read_body(given["from"].text, given["numbers"].numbers());
  return member_text("numbers", write_body(given["to"].text, read));
}

/// The pseudo-inertia, in units of the body's own mass and size, has no negative eigenvalue.
std::string existence(const Json& given) {
  const Sigma made = read_body("shapeid", given["parameters"].numbers());
  const double mass = made(3, 3), squares = made.topLeftCorner<3, 3>().trace();
  bool exists = made.isZero();
  if (mass > 0.0 && squares > 0.0) {
    Eigen::Vector4d units = Eigen::Vector4d::Constant(1.0 / std::sqrt(squares));
    units[3] = 1.0 / std::sqrt(mass);
    const Sigma scaled = units.asDiagonal() * made * units.asDiagonal();
    constexpr double rounding = 1e-12;
    exists = scaled.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff() >= -rounding;
  }
  return std::string("\"exists\":") + (exists ? "true" : "false");
}

std::string moments(const Json& given) {
  const Solid made = solid(given);
  Eigen::VectorXd numbers(11);
  numbers << made.volume, parameters(made.moments);
  return member_text("volume_and_parameters", numbers);
}

/// Both parts keep the density: volume, mass, unit parameters.
std::string division(const Json& given) {
  const double fraction = given["fraction"].number(), mass = given["mass"].number();
  const auto [below, above] = cut(cell(given["shape"]), given["axis"].integer(), fraction);
  const Solid first = solid(below), second = solid(above);
  Eigen::VectorXd parts(24);
  parts << first.volume, mass * fraction, parameters(first.moments), second.volume,
      mass * (1.0 - fraction), parameters(second.moments);
  return member_text("parts", parts);
}

std::string regressor(const Json& given) {
  return member_text("rows", by_rows(body_rows(given["angular_velocity"].numbers(),
                                               given["angular_acceleration"].numbers(),
                                               given["specific_force"].numbers())));
}

std::string robot(const Json& given) {
  const auto motions = link_motions(given["robot"], given["sample"]);
  return member_text("rows", by_rows(robot_rows(motions))) + "," +
         member_text("jacobian", by_rows(contact_rows(given["robot"], motions)));
}

/// [Y F]^T W^(1/2) Q2 Q2^T W^(1/2) [Y F]: no basis has to be agreed upon.
std::string projection(const Json& given) {
  const Eigen::MatrixXd Y = given["Y"].matrix();
  Eigen::MatrixXd YF(Y.rows(), Y.cols() + 1);
  YF << Y, given["F"].numbers();
  const FreeRows rows = without_forces(YF, given["J"].matrix(), given["weight"].numbers());
  return member_text("gram", by_rows(rows.YF.transpose() * rows.YF)) + "," +
         member_text("rank", Eigen::VectorXd::Constant(1, static_cast<double>(rows.rank)));
}

std::string masses(const Json& given) {
  return member_text("masses", minimiser(mass_problem(given)));
}

std::string run(const Json& given) {
  std::vector<SoughtShape> shapes;
  for (const Json& shape : given["shapes"].items) {
    shapes.push_back({shape["link"].integer(), cell(shape)});
  }
  const Run found =
      divided(given["Y"].matrix(), given["F"].numbers(), given["W"].numbers(), shapes, given);
  return member_text("divided", found.places) + "," + member_text("masses", found.masses) + "," +
         member_text("objectives", found.objectives) + "," + member_text("parameters", found.Phi);
}

/// Every link is known; one carries a load somewhere in a box.
std::string load(const Json& given) {
  const Json &machine = given["robot"], &area = given["area"];
  const Eigen::Index at = Eigen::Index{10} * area["link"].integer();
  const Eigen::VectorXd known = given["parameters"].numbers();
  Eigen::MatrixXd YF(0, 11);
  for (const Json& sample : given["samples"].items) {
    const auto motions = link_motions(machine, sample);
    const Eigen::MatrixXd Y = robot_rows(motions);
    const Eigen::VectorXd tau = sample["tau"].numbers();
    Eigen::MatrixXd both(Y.rows(), 11);
    both << Y.middleCols<10>(at), -Y * known;
    both.col(10).tail(tau.size()) += tau;
    const FreeRows rows =
        without_forces(both, contact_rows(machine, motions), given["weight"].numbers());
    YF.conservativeResize(YF.rows() + rows.YF.rows(), Eigen::NoChange);
    YF.bottomRows(rows.YF.rows()) = rows.YF;
  }
  const Cell box{"cuboid", area["lower"].numbers(), area["upper"].numbers(),
                 Eigen::Vector3d::Ones(), pose(area["xyz"].numbers(), area["rpy"].numbers())};
  const Run found =
      divided(YF.leftCols<10>(), YF.col(10), Eigen::VectorXd::Ones(YF.rows()), {{0, box}}, given);
  Eigen::Vector4d place = found.Phi.head<4>();
  if (place[0] > 0.0) place.tail<3>() /= place[0];
  return member_text("divided", found.places) + "," + member_text("mass_and_centre", place) + "," +
         member_text("objective", {found.objectives.back()});
}

/// Feasible, honest about itself, and no farther above the optimum than `gap` allows.
bool accepted(const Json& given) {
  constexpr double honest = 1e-9;
  const MassProblem p = mass_problem(given["problem"]);
  const Json& answer = given["answer"];
  const Eigen::VectorXd m = answer["masses"].numbers();
  if (m.minCoeff() < 0.0 || (p.mass_bound > 0.0 && m.sum() > p.mass_bound)) return false;
  const Eigen::VectorXd wrong = answer["parameters"].numbers() - p.U * m;
  if ((wrong.cwiseAbs() - honest * (p.U.cwiseAbs() * m)).maxCoeff() > 0.0) return false;
  const double value = p.objective(m), none = p.c.squaredNorm();
  if (std::abs(answer["objective"].number() - value) > honest * (value + honest * none)) {
    return false;
  }
  return value - p.objective(minimiser(p)) <= given["gap"].number() * none;
}

std::string certify(const Json& given) {
  return std::string("\"accepted\":") + (accepted(given) ? "true" : "false");
}

std::string answer(const std::string& kind, const Json& input) {
  using Answer = std::string (*)(const Json&);
  static const std::map<std::string, Answer> answers = {
      {"convert", convert},     {"existence", existence},
      {"moments", moments},     {"division", division},
      {"regressor", regressor}, {"robot", robot},
      {"masses", masses},       {"run", run},
      {"load", load},           {"projection", projection},
      {"certify", certify}};
  const auto found = answers.find(kind);
  return found == answers.end() ? "" : found->second(input);
}

}  // namespace
}  // namespace example

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    const char* at = line.c_str();
    const example::Json question = example::read_json(at);
    std::cout << "{" << example::answer(question["kind"].text, question["input"]) << "}"
              << std::endl;  // a line is answered before the next one comes
  }
}
