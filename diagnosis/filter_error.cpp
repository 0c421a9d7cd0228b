#include "shapeid/diagnosis/filter_error.hpp"

#include <cmath>
#include <optional>

#include "shapeid/models/segment_filter.hpp"

namespace shapeid::diagnosis {
namespace {

Eigen::VectorXd channels(const Sample& s) {
  Eigen::VectorXd all(3 * s.q.size() + 9);
  all << s.q, s.dq, s.ddq, s.base_angular_velocity, s.base_angular_acceleration,
      s.base_specific_force;
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
}

/// What joints alone must provide, and the base nothing.
Eigen::VectorXd asked(const Viewer& viewer, const View& view, const RichModel& model) {
  const Prediction p = predict(viewer, view, model);
  return p.force - p.J.transpose() * p.load.force;
}

}  // namespace

std::vector<Eigen::VectorXd> filter_error(const Viewer& viewer, const RichModel& model,
                                          const Recording& smooth, const Recording& rough,
                                          double cutoff) {
  constexpr int order = 2;
  const Butterworth design(order, cutoff, rough.rate());
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
    std::vector<View> views;
    for (std::size_t i = begin; i < end; ++i) {
      views.push_back(viewer.view(rough, usable[i]));
      const Eigen::VectorXd motion = channels(views.back().sample);
      Eigen::VectorXd row(motion.size() + dof);
      row << motion, asked(viewer, views.back(), model);
      if (!filter) filter.emplace(Smoothing::zero_phase, design, row.size());
      filter->push(row);
    }
    filter->finish();
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<Eigen::VectorXd> row = filter->next();
      if (!row) break;  // too short to filter
      const double time = rough[usable[i]].time;
      while (at < errors.size() && smooth[at].time < time - near) ++at;
      if (at == errors.size() || std::abs(smooth[at].time - time) > near) continue;
      Sample filtered = views[i - begin].sample;
      set_channels(row->head(row->size() - dof), filtered);
      const View view = viewer.view(std::move(filtered), views[i - begin].elapsed);
      errors[at] = asked(viewer, view, model) - row->tail(dof);
    }
    begin = end;
  }
  return errors;
}

}  // namespace shapeid::diagnosis
