#include "shapeid/tests/blind/parts/foreign.hpp"

#include <algorithm>
#include <cmath>

namespace shapeid::blind {
namespace {

/// The encoder sits on the motor: it is ahead of the joint by the half gap on the side that drives.
void backlash(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    constexpr double light = 0.5;  // N m: below it the teeth change sides
    for (Reading& r : readings) {
      r.sample.q[a.site] += 0.5 * a.size * std::tanh(r.sample.tau[a.site] / light);
    }
  });
}

/// Likewise through a spring; size is the compliance, rad / N m.
void flexible_joint(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    for (Reading& r : readings) r.sample.q[a.site] += a.size * r.sample.tau[a.site];
  });
}

/// Feet on foam: deep, and the ground does not spring back as it was pressed in.
void soft_ground(Ingredients& in, const Machine&, const Amount& a) {
  in.ground.stiffness /= a.size;
  in.ground.dissipation *= 2.0;
}

/// Torque ripple that grows with the load, as of an eccentric gear.
void load_ripple(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    for (Reading& r : readings) {
      r.sample.tau[a.site] *= 1.0 + a.size * std::sin(9.0 * r.sample.q[a.site] + 0.7);
    }
  });
}

/// Dahl's friction with a long way to turn round: the drive overcomes it.
void hysteresis(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    constexpr double way = 0.15;  // rad
    double share = 0.0;
    double before = readings.front().sample.q[a.site];
    for (Reading& r : readings) {
      const double step = r.sample.q[a.site] - before;
      before = r.sample.q[a.site];
      share += (step - std::abs(step) * share) / way;
      r.sample.tau[a.site] += a.size * share;
    }
  });
}

/// The torque sensor reads no more than so much; size is the share of its largest reading cut off.
void saturation(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    double most = 0.0;
    for (const Reading& r : readings) most = std::max(most, std::abs(r.sample.tau[a.site]));
    const double limit = most * (1.0 - std::min(a.size, 0.9));
    for (Reading& r : readings) {
      r.sample.tau[a.site] = std::clamp(r.sample.tau[a.site], -limit, limit);
    }
  });
}

/// An offset that drifts as the drive grows warm.
void warm_offset(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    constexpr double slow = 8.0;  // s
    for (Reading& r : readings) {
      r.sample.tau[a.site] += a.size * (1.0 - std::exp(-r.sample.time / slow));
    }
  });
}

/// Oil that is churned: friction with the square of speed. Its slope is viscous.
void churning(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    for (Reading& r : readings) {
      const double dq = r.sample.dq[a.site];
      r.sample.tau[a.site] += a.size * dq * std::abs(dq);
    }
  });
}

/// A gear that is lossy when the torque is positive: half of it is a gain.
void one_sided_gain(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    for (Reading& r : readings) {
      double& tau = r.sample.tau[a.site];
      if (tau > 0.0) tau *= 1.0 + a.size;
    }
  });
}

/// Friction of a bent shaft: larger on one side of the turn. Its mean is dry friction.
void uneven_friction(Ingredients& in, const Machine&, const Amount& a) {
  in.signals.emplace_back([a](Readings& readings) {
    for (Reading& r : readings) {
      const double uneven = 1.0 + std::sin(3.0 * r.sample.q[a.site]);
      r.sample.tau[a.site] += a.size * uneven * std::tanh(r.sample.dq[a.site] / 0.02);
    }
  });
}

/// A foot switch that hangs: every third step is not seen.
void missed_steps(Ingredients& in, const Machine&, const Amount& a) {
  int step = 0;
  bool before = false;
  change_flags(in, a.site, [=](bool touches, double, double) mutable {
    if (touches && !before) ++step;
    before = touches;
    return touches && step % 3 != 0;
  });
}

Kind make(const std::string& id, double nominal,
          void (*put)(Ingredients&, const Machine&, const Amount&),
          std::vector<std::string> described_by = {}) {
  Kind k;
  k.id = id;
  k.foreign = true;
  k.nominal = nominal;
  k.put = put;
  k.described_by = std::move(described_by);
  return k;
}

}  // namespace

std::vector<Kind> foreign_kinds() {
  std::vector<Kind> all = {
      make("backlash", 0.02, backlash),
      make("flexible_joint", 0.002, flexible_joint),
      make("load_ripple", 0.15, load_ripple),
      make("hysteresis", 1.0, hysteresis, {"coulomb_friction", "joint_spring"}),
      make("saturation", 0.3, saturation),
      make("warm_offset", 0.6, warm_offset, {"torque_offset"}),
      make("uneven_friction", 0.5, uneven_friction, {"coulomb_friction"}),
      make("churning", 0.3, churning, {"viscous_friction"}),
      make("one_sided_gain", 0.1, one_sided_gain, {"torque_gain"}),
      make("soft_ground", 8.0, soft_ground),
      make("missed_steps", 1.0, missed_steps,
           {"contact_undeclared", "contact_late", "contact_short"}),
  };
  for (Kind& k : all) {
    k.largest = 12.0 * k.nominal;
    if (k.id == "saturation") k.largest = 0.8;
    if (k.id == "soft_ground") {
      k.dynamic = true;
      k.arm = false;
      k.place = Place::whole;
    }
    if (k.id == "missed_steps") {
      k.flags = true;
      k.arm = false;
      k.place = Place::contact;
    }
  }
  return all;
}

/// ends.
void change_flags(Ingredients& in, int site,
                  const std::function<bool(bool touches, double since, double until)>& told) {
  in.signals.emplace_back([site, told](Readings& readings) {
    const auto foot = static_cast<std::size_t>(site);
    constexpr double long_ago = 1.0;  // at the ends of the log: longer than any step
    for (std::size_t begin = 0, end = 0; begin < readings.size(); begin = end) {
      const bool touches = readings[begin].sample.in_contact[foot];
      while (end < readings.size() && readings[end].sample.in_contact[foot] == touches) ++end;
      const double from = readings[begin].sample.time - (begin == 0 ? long_ago : 0.0);
      const bool last = end == readings.size();
      const double to = last ? readings.back().sample.time + long_ago : readings[end].sample.time;
      for (std::size_t i = begin; i < end; ++i) {
        const double t = readings[i].sample.time;
        readings[i].sample.in_contact[foot] = told(touches, t - from, to - t);
      }
    }
  });
}

void delay(Readings& readings, double seconds,
           const std::function<void(Sample&, const Sample&, double)>& add,
           const std::function<void(Sample&)>& zero) {
  const Readings before = readings;
  const double step = before[1].sample.time - before[0].sample.time;
  constexpr int first = -2, last = 3;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double place = std::max(0.0, static_cast<double>(i) - seconds / step);
    const double share = place - std::floor(place);
    zero(readings[i].sample);
    for (int k = first; k <= last; ++k) {
      double weight = 1.0;
      for (int j = first; j <= last; ++j) {
        if (j != k) weight *= (share - j) / (k - j);
      }
      const double reading = std::floor(place) + k;
      const double within = std::clamp(reading, 0.0, static_cast<double>(before.size() - 1));
      add(readings[i].sample, before[static_cast<std::size_t>(within)].sample, weight);
    }
  }
}

}  // namespace shapeid::blind
