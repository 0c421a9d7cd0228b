// An implementation of its own, small and plain, for `shapeid vectors --check`: Eigen for the
// mathematics and nothing else. A line of JSON comes in, {"id", "kind", "input"}; a line goes out.
// Build: g++ -std=c++20 -O2 -I /usr/include/eigen3 main.cpp
#include <iostream>

#include "bodies.hpp"
#include "masses.hpp"

namespace example {
namespace {

std::string convert(const Json& given) {
  const Sigma read = read_body(given["from"].text, given["numbers"].numbers());
  return member_text("numbers", write_body(given["to"].text, read));
}

std::string moments(const Json& given) {
  const Solid made = solid(given);
  Eigen::VectorXd numbers(11);
  numbers << made.volume, parameters(made.moments);
  return member_text("volume_and_parameters", numbers);
}

/// Both parts keep the density: volume, mass, unit parameters.
std::string division(const Json& given) {
  const int axis = given["axis"].integer();
  const double fraction = given["fraction"].number(), mass = given["mass"].number();
  const Eigen::Vector3d size = given["size"].numbers();
  const Eigen::Matrix4d T = pose(given["xyz"].numbers(), given["rpy"].numbers());
  Eigen::VectorXd parts(24);
  for (int i = 0; i < 2; ++i) {
    const double share = i == 0 ? fraction : 1.0 - fraction;
    Eigen::Vector3d part = size, centre = Eigen::Vector3d::Zero();
    part[axis] *= share;
    centre[axis] = (i == 0 ? -0.5 : 0.5) * (size[axis] - part[axis]);
    const Eigen::Matrix3d S = (part.cwiseAbs2() / 12.0).asDiagonal();
    const Sigma own = body(1.0, Eigen::Vector3d::Zero(), S);
    const Sigma placed = mapped(T * pose(centre, Eigen::Vector3d::Zero()), own);
    parts.segment(12 * i, 12) << part.prod(), mass * share, parameters(placed);
  }
  return member_text("parts", parts);
}

/// Force and moment about the moving origin, one column a parameter.
Eigen::MatrixXd body_rows(const Eigen::Vector3d& omega, const Eigen::Vector3d& alpha,
                          const Eigen::Vector3d& a) {
  Eigen::MatrixXd Y(6, 10);
  for (int j = 0; j < 10; ++j) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(10, j);
    const Eigen::Vector3d h = unit.segment<3>(1);
    const Eigen::Matrix3d I = read_tensor(order_named("shapeid"), unit.tail(6));
    Y.col(j).head<3>() = unit[0] * a + alpha.cross(h) + omega.cross(omega.cross(h));
    Y.col(j).tail<3>() = I * alpha + omega.cross(I * omega) + h.cross(a);
  }
  return Y;
}

std::string regressor(const Json& given) {
  return member_text("rows", by_rows(body_rows(given["angular_velocity"].numbers(),
                                               given["angular_acceleration"].numbers(),
                                               given["specific_force"].numbers())));
}

/// [Y F]^T W^(1/2) Q2 Q2^T W^(1/2) [Y F], with Q2 from the QR of W^(1/2) J^T.
std::string projection(const Json& given) {
  const Eigen::VectorXd roots = given["weight"].numbers().cwiseSqrt();
  const Eigen::MatrixXd Y = given["Y"].matrix();
  Eigen::MatrixXd YF(Y.rows(), Y.cols() + 1);
  YF << Y, given["F"].numbers();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(roots.asDiagonal() *
                                                 given["J"].matrix().transpose());
  qr.setThreshold(1e-12);
  const Eigen::MatrixXd turned = qr.householderQ().adjoint() * (roots.asDiagonal() * YF);
  const Eigen::MatrixXd rest = turned.bottomRows(Y.rows() - qr.rank());
  const Eigen::VectorXd rank = Eigen::VectorXd::Constant(1, static_cast<double>(qr.rank()));
  return member_text("gram", by_rows(rest.transpose() * rest)) + "," + member_text("rank", rank);
}

std::string masses(const Json& given) {
  return member_text("masses", minimiser(mass_problem(given)));
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
      {"convert", convert},      {"moments", moments}, {"division", division},
      {"regressor", regressor},  {"masses", masses},   {"certify", certify},
      {"projection", projection}};
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
