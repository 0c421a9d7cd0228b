#include "coq.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <regex>
#include <stdexcept>
#include <vector>

namespace shapeid::test {
namespace {

/// What a command prints on either channel.
std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen((command + " 2>&1").c_str(), "r"), pclose);
  std::string text;
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) {
    text.push_back(static_cast<char>(c));
  }
  return text;
}

template <typename Entry>
std::string list(Eigen::Index size, const Entry& entry) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < size; ++i) text += (i > 0 ? "; " : "") + entry(i);
  return text + "]";
}

}  // namespace

std::string coq_number(double x) {
  constexpr int digits = std::numeric_limits<double>::digits;
  int exponent = 0;
  auto mantissa = static_cast<long long>(std::ldexp(std::frexp(x, &exponent), digits));
  exponent -= digits;
  for (; mantissa != 0 && mantissa % 2 == 0; mantissa /= 2) ++exponent;
  if (mantissa == 0) return "(q 0 1)";
  return exponent < 0 ? fmt::format("(q ({}) (2 ^ {}))", mantissa, -exponent)
                      : fmt::format("(q (({}) * 2 ^ {}) 1)", mantissa, exponent);
}

std::string coq_list(const Eigen::VectorXd& x) {
  return list(x.size(), [&](Eigen::Index i) { return coq_number(x[i]); });
}

std::string coq_rows(const Eigen::MatrixXd& M) {
  return list(M.rows(), [&](Eigen::Index i) { return coq_list(M.row(i)); });
}

Eigen::VectorXd evaluated(const std::string& definitions, const std::string& expression) {
  // Tests run side by side, each as its own process.
  const std::string name =
      fmt::format("questions/evaluate_{}", std::hash<std::string>()(expression));
  const std::string file = fmt::format("{}/{}.v", SHAPEID_PROOFS, name);
  std::ofstream(file) << "From Shapeid Require Import evaluate.\nImport ListNotations.\n"
                      << definitions << "\nEval vm_compute in fractions (" << expression << ").\n";
  const std::string answer =
      output_of(fmt::format("cd '{}' && coqc -Q . Shapeid {}.v", SHAPEID_PROOFS, name));

  const std::regex fraction(R"(\((-?\d+)\D+(\d+))");
  const std::string plain = std::regex_replace(answer, std::regex(R"(\((-\d+)\)|%Z|\s)"), "$1");
  std::vector<double> values;
  for (std::sregex_iterator m(plain.begin(), plain.end(), fraction), end; m != end; ++m) {
    values.push_back(static_cast<double>(std::strtold((*m)[1].str().c_str(), nullptr) /
                                         std::strtold((*m)[2].str().c_str(), nullptr)));
  }
  if (values.empty()) throw std::runtime_error(file + ": " + answer);
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

}  // namespace shapeid::test
