#include "shapeid/tests/experiments/studies/order.hpp"

#include <algorithm>

#include "shapeid/tests/experiments/methods/division_floor.hpp"

namespace shapeid::experiments {
namespace {

/// Both values are sums of ten squares of the size of || F ||^2.
constexpr double rounding = 1e-13;

/// What counts as the same optimum on the page: a hundredth, or nothing beside the data.
double above(double value, double than, double size) {
  const double excess = value - than;
  return excess > nothing_beside_data * size ? excess / std::max(than, nothing_beside_data * size)
                                             : 0.0;
}

void judge(const Answer& answer, double full, double shapes, double size,
           OrderCount::Stalled& count) {
  constexpr double short_by = 0.01;
  const double share = above(answer.value, answer.floor, size);
  count.worst = std::max(count.worst, share);
  if (share > short_by) {
    ++count.stopped_short;
    if (answer.converged) ++count.said_converged;
  }
  if (above(answer.value, full, size) > 0.0) ++count.above_full;
  if (above(answer.value, shapes, size) > 0.0) ++count.above_shapes;
}

}  // namespace

void count_order(const Setting& setting, const std::vector<TimedWindow>& windows,
                 OrderCount& count) {
  const auto linear = make_linear(), positive = make_positive(setting), full = make_full(setting),
             points = make_shapes(setting.points), ours = make_shapes(setting.shapes);
  const auto usual = make_nonlinear(setting, Effort::usual),
             hard = make_nonlinear(setting, Effort::hard),
             log_cholesky = make_log_cholesky(setting, Effort::hard);
  for (const TimedWindow& window : windows) {
    const DataTerm& f = window.f;
    const Answer a = linear->answer(f), b = positive->answer(f), c = full->answer(f),
                 d = points->answer(f), e = ours->answer(f);
    const auto broken = [&](const Answer& larger, const Answer& smaller) {
      return larger.floor > smaller.value + rounding * f.size();
    };
    if (broken(a, b) || broken(b, c) || broken(c, d) || broken(c, e)) ++count.contradictions;
    for (const Answer* x : {&a, &b, &c, &d, &e}) {
      count.worst_gap = std::max(count.worst_gap, (x->value - x->floor) / f.size());
    }
    judge(usual->answer(f), c.value, e.value, f.size(), count.usual);
    judge(hard->answer(f), c.value, e.value, f.size(), count.hard);
    judge(log_cholesky->answer(f), c.value, e.value, f.size(), count.log_cholesky);
    ++count.windows;
  }
}

void report(const std::string& name, const OrderCount& count, Findings& findings) {
  const std::string start = "order." + name + ".";
  findings.set(start + "windows", count.windows);
  findings.set(start + "contradictions", count.contradictions);
  findings.set(start + "worst_gap", count.worst_gap);
  const auto stalled = [&](const std::string& solver, const OrderCount::Stalled& s) {
    findings.set(start + solver + ".stopped_short", s.stopped_short);
    findings.set(start + solver + ".said_converged", s.said_converged);
    findings.set(start + solver + ".above_full", s.above_full);
    findings.set(start + solver + ".above_shapes", s.above_shapes);
    findings.set(start + solver + ".worst", s.worst);
  };
  stalled("usual", count.usual);
  stalled("hard", count.hard);
  stalled("log_cholesky", count.log_cholesky);
}

}  // namespace shapeid::experiments
