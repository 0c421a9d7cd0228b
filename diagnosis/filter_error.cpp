#include "shapeid/diagnosis/filter_error.hpp"

#include <Eigen/QR>

#include <cmath>
#include <optional>
#include <utility>

#include "shapeid/models/butterworth.hpp"
#include "shapeid/models/segment_filter.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::VectorXd channels(const Sample& s) {
  const Eigen::Index n = s.q.size();
  Eigen::VectorXd all(3 * n + 9 + 3 * std::ssize(s.contact_force));
  all.head(3 * n + 9) << s.q, s.dq, s.ddq, s.base_angular_velocity, s.base_angular_acceleration,
      s.base_specific_force;
  Eigen::Index at = 3 * n + 9;
  for (const Eigen::Vector3d& force : s.contact_force) {
    all.segment<3>(at) = force;
    at += 3;
  }
  return all;
}

void set_channels(const Eigen::VectorXd& all, Sample& s) {
  const Eigen::Index n = s.q.size();
  s.q = all.head(n);
  s.dq = all.segment(n, n);
  s.ddq = all.segment(2 * n, n);
  s.base_angular_velocity = all.segment<3>(3 * n);
  s.base_angular_acceleration = all.segment<3>(3 * n + 3);
  s.base_specific_force = all.segment<3>(3 * n + 6);
  Eigen::Index at = 3 * n + 9;
  for (Eigen::Vector3d& force : s.contact_force) {
    force = all.segment<3>(at);
    at += 3;
  }
}

/// Where the numbers of every contact's force stand in one vector, whichever of them touch.
class ForceSlots {
 public:
  explicit ForceSlots(const Robot& robot) {
    for (const Contact& contact : robot.contacts) {
      first_.push_back(size_);
      size_ += force_numbers(contact.kind);
    }
    first_.push_back(size_);
  }

  [[nodiscard]] Eigen::Index size() const { return size_; }

  /// Numbers of the contacts that touch, in their order, to all; zero for the others.
  [[nodiscard]] Eigen::VectorXd spread(const Sample& sample, const Eigen::VectorXd& force) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(size_);
    Eigen::Index row = 0;
    for_each(sample, force.size(), [&](Eigen::Index first, Eigen::Index count) {
      all.segment(first, count) = force.segment(row, count);
      row += count;
    });
    return all;
  }

  [[nodiscard]] Eigen::VectorXd gather(const Sample& sample, const Eigen::VectorXd& all,
                                       Eigen::Index rows) const {
    Eigen::VectorXd force(rows);
    Eigen::Index row = 0;
    for_each(sample, rows, [&](Eigen::Index first, Eigen::Index count) {
      force.segment(row, count) = all.segment(first, count);
      row += count;
    });
    return force;
  }

 private:
  /// `rows` is zero where contacts are not projected away, whatever the flags say.
  template <typename Visit>
  void for_each(const Sample& sample, Eigen::Index rows, Visit visit) const {
    for (std::size_t c = 0; rows > 0 && c < sample.in_contact.size(); ++c) {
      if (sample.in_contact[c]) visit(first_[c], first_[c + 1] - first_[c]);
    }
  }

  std::vector<Eigen::Index> first_;
  Eigen::Index size_ = 0;
};

/// What is kept of a rough sample until it is filtered: a View has matrices of many times its size.
struct Rough {
  Sample sample;  ///< transformations done
  double elapsed = 0.0;
};

/// The contact forces with which the model comes closest to what was logged.
Eigen::VectorXd contact_force(const Viewer& viewer, const View& view, const Prediction& p) {
  if (p.J.rows() == 0) return Eigen::VectorXd(0);
  return p.J.transpose().completeOrthogonalDecomposition().solve(p.force -
                                                                 logged_force(viewer, view));
}

}  // namespace

std::vector<Eigen::VectorXd> filter_error(const Viewer& viewer, const RichModel& model,
                                          const Recording& smooth, const Recording& rough,
                                          double cutoff) {
  const Butterworth design(log_filter_order, cutoff, rough.rate());
  const ForceSlots slots(viewer.robot());
  const Eigen::Index dof = viewer.robot().dof();
  std::vector<Eigen::VectorXd> errors(smooth.samples().size(), Eigen::VectorXd::Zero(dof));
  const double near = 0.25 / rough.rate();
  std::size_t at = 0;  // in the smooth recording

  // usable() has neighbours on both sides, which delays among the effects look at.
  const std::vector<std::size_t> usable = rough.usable(1);
  std::size_t begin = 0;
  while (begin < usable.size()) {
    std::size_t end = begin + 1;
    while (end < usable.size() && usable[end] == usable[end - 1] + 1) ++end;
    std::optional<SegmentFilter> filter;
    std::vector<Rough> seen;
    for (std::size_t i = begin; i < end; ++i) {
      View view = viewer.view(rough, usable[i]);
      // A filtered sample has no neighbours, so the load's rate counts on neither side: of what is
      // linear in the load the filter makes no error but the load's own.
      view.around.clear();
      const Prediction p = predict(viewer, view, model);
      const Eigen::VectorXd f = contact_force(viewer, view, p);
      const Eigen::VectorXd motion = channels(view.sample);
      Eigen::VectorXd row(motion.size() + slots.size() + dof);
      row << motion, slots.spread(view.sample, f), p.force - p.J.transpose() * f;
      if (!filter) filter.emplace(Smoothing::zero_phase, design, row.size());
      filter->push(row);
      seen.push_back({std::move(view.sample), view.surroundings.elapsed});
    }
    filter->finish();
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<Eigen::VectorXd> row = filter->next();
      if (!row) break;  // too short to filter
      const double time = rough[usable[i]].time;
      while (at < errors.size() && smooth[at].time < time - near) ++at;
      if (at == errors.size() || std::abs(smooth[at].time - time) > near) continue;
      Sample filtered = std::move(seen[i - begin].sample);
      set_channels(row->head(row->size() - slots.size() - dof), filtered);
      filtered.in_contact = smooth[at].in_contact;
      Surroundings surroundings = smooth.surroundings(at);
      surroundings.elapsed = seen[i - begin].elapsed;
      const View view = viewer.view(std::move(filtered), std::move(surroundings));
      const Prediction p = predict(viewer, view, model);
      const Eigen::VectorXd f = slots.gather(
          view.sample, row->segment(row->size() - slots.size() - dof, slots.size()), p.J.rows());
      errors[at] = p.force - p.J.transpose() * f - row->tail(dof);
    }
    begin = end;
  }
  return errors;
}

}  // namespace shapeid::diagnosis
