#include "shapeid/fast/division.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include "shapeid/models/contract.hpp"

namespace shapeid::fast {
namespace {

/// || change || of masses, first moments and tensors of all links, each over its size in Phi; a
/// first moment's size is sqrt(mass x tensor).
Eigen::Vector3d relative_step(const Eigen::VectorXd& before, const Eigen::VectorXd& Phi) noexcept {
  Eigen::Array3d change = Eigen::Array3d::Zero(), size = Eigen::Array3d::Zero();
  const auto add = [](Eigen::Array3d& to, const Eigen::Matrix<double, 10, 1>& x) {
    to += Eigen::Array3d(x[0] * x[0], x.segment<3>(1).squaredNorm(), x.tail<6>().squaredNorm());
  };
  for (Eigen::Index link = 0; link < Phi.size(); link += 10) {
    add(change, Phi.segment<10>(link) - before.segment<10>(link));
    add(size, Phi.segment<10>(link));
  }
  size[1] = std::sqrt(size[0] * size[2]);  // squares of the sizes, all three
  return (change > 0.0).select((change / size).sqrt(), 0.0);
}

const DivisionOptions& checked(const DivisionOptions& options) {
  if (const Violation reason = why_senseless(options)) throw std::invalid_argument(*reason);
  return options;
}

}  // namespace

Division::Division(const BodyModel& model, const DivisionOptions& options)
    : options_(checked(options)),
      tree_(model, options.most_divisions),
      undivided_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.shapes.size()))),
      solver_(static_cast<int>(model.free_links.size()),
              static_cast<int>(model.shapes.size()) + options.most_divisions),
      last_Phi_(Eigen::VectorXd::Zero(10 * static_cast<Eigen::Index>(model.free_links.size()))) {
  SHAPEID_CONTRACT(why_on_known_links(model));
  for (std::size_t j = 0; j < model.shapes.size(); ++j) {
    const auto link =
        std::find(model.free_links.begin(), model.free_links.end(), model.shapes[j].link);
    links_.push_back(static_cast<int>(link - model.free_links.begin()));
    ids_.push_back(model.shapes[j].id);
    whole_volume_ += tree_[static_cast<int>(j)].V;
  }
  const std::size_t most = model.shapes.size() + static_cast<std::size_t>(options.most_divisions);
  parts_.reserve(most);
  candidates_.reserve(most);
  history_.reserve(static_cast<std::size_t>(options.most_divisions));
}

Outcome Division::start(const Eigen::MatrixXd& R, Start from) noexcept {
  tree_.make_room();
  history_.clear();
  parts_.clear();
  solver_.clear();
  for (std::size_t j = 0; j < links_.size(); ++j) {
    const int part = static_cast<int>(j);
    parts_.push_back(part);
    static_cast<void>(solver_.append(links_[j], tree_[part].u, tree_[part].V));
    const double mass = undivided_[static_cast<Eigen::Index>(j)];
    if (from == Start::last_masses && mass > 0.0) solver_.start_at(part, mass);
  }
  const Outcome outcome = solver_.solve(R);
  if (outcome == Outcome::solved) {
    undivided_ = solver_.m();
    undivided_objective_ = solver_.value().total();
  }
  return outcome;
}

// (16); only shapes with mass have a v that is not zero.
void Division::collect_candidates() noexcept {
  candidates_.clear();
  for (const int place : solver_.passive()) {
    const int part = parts_[static_cast<std::size_t>(place)];
    if (!tree_.is_divisible(part)) continue;
    const double mass = solver_.m()[place] / options_.expected_mass;
    const double size = tree_[part].V / whole_volume_;
    candidates_.push_back({place, options_.k1 * mass * size + options_.k2 * mass / size});
  }
}

/// The largest v, or the smallest place among those within the tie. Place -1 if there is none.
Division::Candidate Division::take_largest() noexcept {
  double largest = 0.0;
  for (const Candidate& candidate : candidates_) largest = std::max(largest, candidate.v);
  Candidate taken{-1, 0.0};
  if (!(largest > 0.0)) return taken;
  Candidate* best = nullptr;
  for (Candidate& candidate : candidates_) {
    const bool ties = candidate.v >= (1.0 - options_.tie) * largest;
    if (ties && (best == nullptr || candidate.place < best->place)) best = &candidate;
  }
  if (best == nullptr) return taken;
  taken = *best;
  best->v = 0.0;
  return taken;
}

Division::Step Division::divide(int at_once) noexcept {
  collect_candidates();
  const std::size_t before = history_.size();
  last_Phi_ = solver_.Phi();
  const double objective = solver_.value().total();
  bool has_room = true;
  while (static_cast<int>(history_.size() - before) < at_once) {
    has_room = static_cast<int>(history_.size()) < options_.most_divisions;
    if (!has_room) break;
    const Candidate next = take_largest();
    if (next.place < 0) break;
    const int whole = parts_[static_cast<std::size_t>(next.place)];
    const int first = tree_.parts_of(whole);
    if (first < 0 && !tree_.is_divisible(whole)) continue;  // too thin a mesh: the next one
    if (first < 0) break;
    static_cast<void>(solver_.divide(next.place, tree_[first].u, tree_[first].V, tree_[first + 1].u,
                                     tree_[first + 1].V));
    parts_[static_cast<std::size_t>(next.place)] = first;
    parts_.push_back(first + 1);
    history_.push_back({next.place, next.v, objective, objective, Eigen::Vector3d::Zero(), 0});
  }
  if (history_.size() == before) return has_room ? Step::nothing_divisible : Step::no_room;
  if (solver_.solve_again() != Outcome::solved) return Step::declined;
  Cut& last = history_.back();
  last.objective_after = solver_.value().total();
  last.step = relative_step(last_Phi_, solver_.Phi());
  last.iterations = solver_.iterations();
  return Step::divided;
}

Division::Stop Division::run(std::optional<double> floor) noexcept {
  int small_steps = 0, settled_steps = 0;
  while (true) {
    switch (divide()) {
      case Step::no_room:
        return Stop::limit;
      case Step::nothing_divisible:
        return Stop::nothing_divisible;
      case Step::declined:
        return Stop::declined;
      case Step::divided:
        break;
    }
    const Cut& last = history_.back();
    const int cuts = tree_[parts_[static_cast<std::size_t>(last.place)]].generation - 1;
    small_steps = last.step.maxCoeff() < options_.step ? small_steps + 1 : 0;
    settled_steps = cuts >= settled_cuts ? settled_steps + 1 : 0;
    if (small_steps < options_.patience) continue;
    const bool is_near = !floor || is_near_floor(undivided_objective_, solver_.value(), *floor);
    if (is_near || settled_steps >= options_.patience) return Stop::step;
  }
}

std::string Division::id(int place) const {
  std::string way;
  int part = parts_[static_cast<std::size_t>(place)];
  for (int parent = tree_[part].parent; parent >= 0; parent = tree_[part].parent) {
    way.insert(0, part == tree_[parent].first ? ".0" : ".1");
    part = parent;
  }
  return ids_[static_cast<std::size_t>(part)] + way;
}

}  // namespace shapeid::fast
