#include "shapeid/tests/diagnosis/planted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "shapeid/diagnosis/load_places.hpp"

namespace shapeid::diagnosis::planted {
namespace {

constexpr Eigen::Index inertial = 10;  // one link
constexpr int folds = 8;

void append(Eigen::MatrixXd& to, const Eigen::MatrixXd& columns) {
  to.conservativeResize(Planted::rows, to.cols() + columns.cols());
  to.rightCols(columns.cols()) = columns;
}

}  // namespace

Effect law(const std::string& id, int parameters, const std::string& unit) {
  Effect effect;
  effect.id = id;
  for (int p = 0; p < parameters; ++p) {
    Parameter& parameter = effect.parameters.emplace_back();
    parameter.name = fmt::format("p{}", p);
    parameter.unit = unit;
  }
  return effect;
}

Planted::Planted(unsigned seed) : random_(seed), force_(Eigen::VectorXd::Zero(rows)) {
  masses_.id = "masses";
  for (Eigen::Index p = 0; p < inertial; ++p) {
    masses_.columns.push_back(p);
    masses_.nonnegative.push_back(false);
  }
  columns_ = normal(inertial);
}

Eigen::MatrixXd Planted::normal(Eigen::Index columns, double memory) {
  std::normal_distribution<double> number;
  Eigen::MatrixXd list =
      Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return number(random_); });
  for (Eigen::Index i = 1; i < rows; ++i) {
    list.row(i) = memory * list.row(i - 1) + std::sqrt(1.0 - memory * memory) * list.row(i);
  }
  return list;
}

std::size_t Planted::add(const Effect& effect, const Eigen::MatrixXd& columns, int site,
                         std::size_t from_block) {
  // The same law at another site is the same effect.
  auto known = std::find_if(effects_.begin(), effects_.end(),
                            [&](const Effect& e) { return e.id == effect.id; });
  if (known == effects_.end()) known = effects_.insert(effects_.end(), effect);
  const Eigen::Index n = std::ssize(known->parameters);
  if (columns.cols() != n) throw std::logic_error("one column a parameter");
  Candidate c;
  c.effect = {&*known, site, {}, Eigen::VectorXd::Zero(n)};
  c.term.id = fmt::format("{}@{}", effect.id, site);
  c.term.from_block = from_block;
  c.room = {Eigen::Vector3d::Constant(-furthest_load), Eigen::Vector3d::Constant(furthest_load)};
  for (Eigen::Index p = 0; p < n; ++p) {
    c.term.columns.push_back(columns_.cols() + p);
    c.term.nonnegative.push_back(known->parameters[static_cast<std::size_t>(p)].nonnegative);
  }
  append(columns_, columns);
  hypotheses_.push_back(c.effect);
  candidates_.push_back(c);
  return candidates_.size() - 1;
}

std::size_t Planted::add_group(const std::vector<std::size_t>& members) {
  Candidate group = candidates_[members.front()];
  group.members = members;
  group.term = {};
  for (const std::size_t m : members) {
    const auto& columns = candidates_[m].term.columns;
    group.term.columns.insert(group.term.columns.end(), columns.begin(), columns.end());
  }
  group.term.nonnegative.assign(group.term.columns.size(), false);
  candidates_.push_back(group);
  return candidates_.size() - 1;
}

void Planted::plant(std::size_t k, const Eigen::VectorXd& value) {
  const Term& term = candidates_[k].term;
  const Eigen::Index acts = rows - static_cast<Eigen::Index>(term.from_block) * rows_of_block;
  force_.tail(acts) += columns_(Eigen::lastN(acts), term.columns) * value;
}

BlockFits Planted::fits() const {
  Tally tally;
  tally.inertial = inertial;
  tally.width = columns_.cols() + 1;
  tally.hypotheses = hypotheses_;
  Eigen::Index first = inertial;
  for (const AppliedEffect& h : hypotheses_) {
    tally.first.push_back(first);
    first += h.value.size();
  }
  for (std::size_t b = 0; b < blocks; ++b) {
    const Eigen::Index from = static_cast<Eigen::Index>(b) * rows_of_block;
    Eigen::MatrixXd M(rows_of_block, tally.width);
    M << columns_.middleRows(from, rows_of_block), force_.segment(from, rows_of_block);
    Block& block = tally.blocks.emplace_back();
    block.sums = M.transpose() * M;
    block.samples = static_cast<std::size_t>(rows_of_block);
    block.freedom = static_cast<double>(rows_of_block);
    block.from = static_cast<double>(b);
  }
  const Eigen::VectorXd given = Eigen::VectorXd::Zero(inertial);
  return {tally, given, Eigen::VectorXd::Ones(inertial), folds};
}

Selection Planted::selection(const SelectionRule& rule) const {
  return select(fits(), masses_, candidates_, rule);
}

double Planted::size_of(double standard_errors) {
  return standard_errors / std::sqrt(static_cast<double>(rows));
}

std::vector<std::size_t> accepted(const Selection& selection) {
  std::vector<std::size_t> list;
  for (const Verdict& v : selection.accepted) list.push_back(v.candidate);
  std::sort(list.begin(), list.end());
  return list;
}

const Verdict& verdict_on(std::size_t k, const Selection& selection) {
  return *std::find_if(selection.accepted.begin(), selection.accepted.end(),
                       [&](const Verdict& v) { return v.candidate == k; });
}

}  // namespace shapeid::diagnosis::planted
