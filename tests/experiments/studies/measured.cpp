#include "shapeid/tests/experiments/studies/measured.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <array>
#include <cstdio>
#include <map>

#include "shapeid/fast/division.hpp"
#include "shapeid/models/shapes_yaml.hpp"
#include "shapeid/reference/regressor.hpp"
#include "shapeid/tests/experiments/data/cheetah.hpp"
#include "shapeid/tests/experiments/data/windows.hpp"
#include "shapeid/tests/experiments/methods/mass_columns.hpp"
#include "shapeid/tests/experiments/page/plot.hpp"
#include "shapeid/tests/experiments/page/spread_table.hpp"
#include "shapeid/tests/experiments/studies/torque_scale.hpp"

namespace shapeid::experiments {
namespace {

const std::array<const char*, 3> kinds = {"abduction", "hip", "knee"};

/// Divided by criterion (16) with the defaults until its step rule stops.
Vector10 divided(const BodyModel& model, const DataTerm& f, double expected_mass) {
  DivisionOptions options;
  options.expected_mass = expected_mass;
  fast::Division division(model, options);
  const double V0 = shape_volumes(model).sum();
  division.set_lambda(1e-12 * f.size() * V0 / (expected_mass * expected_mass));
  const Eigen::MatrixXd R = triangle_of(f);  // the division keeps looking at it
  if (division.start(R) != fast::Outcome::solved) throw std::runtime_error("window declined");
  division.run();
  return division.masses().Phi();
}

/// Anything carried: the trunk and 15 cm above it.
BodyModel carried(const Robot& robot) {
  return load_region(robot, 0, {-0.18, -0.12, -0.05}, {0.18, 0.12, 0.2});
}

struct Run {
  std::string terrain;
  std::vector<Sample> fitted, tested;
};

// ------------------------------------------------------------------------- base and load

/// What the method says if torques are as logged.
void base_and_load(const Cheetah& cheetah, const std::vector<Run>& runs, Findings& findings) {
  const BodyModel base = default_shapes(cheetah.robot, {0}), load = carried(cheetah.robot);
  const double given = cheetah.robot.links[0].inertia.mass();
  Table table = {{"terrain", "base found, kg", "load found, kg", "at x, y, z, m"}};
  std::vector<double> bases, loads;
  for (const Run& run : runs) {
    const Vector10 found = divided(base, whole(cheetah.robot, base, run.fitted), given);
    const InertialParameters on_top{divided(load, whole(cheetah.robot, load, run.fitted), 1.0)};
    bases.push_back(found[0]);
    loads.push_back(on_top.mass());
    findings.set("measured.base." + run.terrain, found[0]);
    findings.set("measured.load." + run.terrain, on_top.mass());
    const Eigen::Vector3d c = on_top.centre_of_mass();
    table.push_back({run.terrain, fmt::format("{:.3g}", found[0]),
                     fmt::format("{:.3g}", on_top.mass()),
                     fmt::format("{:.2f}, {:.2f}, {:.2f}", c.x(), c.y(), c.z())});
  }
  findings.set("measured.base.given", given);
  set_spread(findings, "measured.base.all", bases);
  set_spread(findings, "measured.load.all", loads);
  findings.tables["measured_base"] = table;
}

// ------------------------------------------------------------------------- load or scale

/// The same load sought for every scale of the torques: which pair does the data prefer?
void load_or_scale(const Cheetah& cheetah, const std::vector<Run>& runs, Findings& findings) {
  const BodyModel load = carried(cheetah.robot);
  Table table = {{"terrain", "load at s = 1, kg", "residual", "least residual at s =", "load there",
                  "residual", "s without load", "residual", "on the next part: s = 1, load",
                  "s alone"}};
  Panel residuals{"torque scale s", "residual, of that at s = 1", {}, ""};
  Panel masses{"torque scale s", "load (kg)", {}, ""};
  std::vector<double> scales, alone, cost;
  for (const Run& run : runs) {
    const ScaledRows fitted(cheetah.robot, load, run.fitted),
        tested(cheetah.robot, load, run.tested);
    const Vector10 none = Vector10::Zero();
    struct Point {
      double s, rms;
      Vector10 Phi;
    };
    Point one{}, best{}, empty{};
    best.rms = empty.rms = 1e9;
    Curve residual{run.terrain, {}}, mass{run.terrain, {}};
    std::vector<Point> profile;
    constexpr int steps = 60, at_one = 20;
    for (int k = 0; k <= steps; ++k) {
      const double s = 1.0 + 0.02 * (k - at_one);
      Point p{s, 0.0, divided(load, fitted.at(s), 1.0)};
      p.rms = fitted.rms(s, p.Phi);
      profile.push_back(p);
      if (k == at_one) one = p;
      if (p.rms < best.rms) best = p;
      if (const double without = fitted.rms(s, none); without < empty.rms) {
        empty = {s, without, none};
      }
    }
    for (const Point& p : profile) {
      residual.points.emplace_back(p.s, p.rms / one.rms);
      mass.points.emplace_back(p.s, p.Phi[0]);
    }
    residuals.curves.push_back(residual);
    masses.curves.push_back(mass);
    const double next_load = tested.rms(1.0, one.Phi), next_scale = tested.rms(empty.s, none);
    const std::string start = "measured.scale." + run.terrain + ".";
    findings.set(start + "load_at_one", one.Phi[0]);
    findings.set(start + "best", best.s);
    findings.set(start + "load_at_best", best.Phi[0]);
    findings.set(start + "alone", empty.s);
    findings.set(start + "residual_at_one", one.rms);
    findings.set(start + "residual_at_best", best.rms);
    findings.set(start + "residual_alone", empty.rms);
    findings.set(start + "next_load", next_load);
    findings.set(start + "next_alone", next_scale);
    scales.push_back(best.s);
    alone.push_back(empty.s);
    cost.push_back(next_scale / next_load - 1.0);
    const auto three = [](double x) { return fmt::format("{:.3g}", x); };
    table.push_back({run.terrain, three(one.Phi[0]), three(one.rms), fmt::format("{:.2f}", best.s),
                     three(best.Phi[0]), three(best.rms), fmt::format("{:.2f}", empty.s),
                     three(empty.rms), three(next_load), three(next_scale)});
  }
  set_spread(findings, "measured.scale.best", scales);
  set_spread(findings, "measured.scale.alone", alone);
  set_spread(findings, "measured.scale.cost_of_scale_alone", cost);
  findings.tables["measured_scale"] = table;
  findings.plots["measured_scale"] = plot({residuals, masses});
}

// ------------------------------------------------------------------------- in the air

/// tau = a (rigid + rotor) + b dq + c sign(dq) of each kind of joint.
using DriveFit = std::array<Eigen::Vector3d, 3>;

double direction(double velocity) { return velocity > 0.0 ? 1.0 : -1.0; }

/// In the air nothing is carried: logged torque against what CAD legs and rotors need.
DriveFit fit_drives(const Cheetah& cheetah, const std::vector<Sample>& samples) {
  const Eigen::VectorXd Phi = stacked_parameters(cheetah.robot);
  std::array<std::vector<Eigen::Vector4d>, 3> rows;
  for (const Sample& s : samples) {
    const Eigen::VectorXd rigid = (reference::regressor(cheetah.robot, s) * Phi).tail(12);
    for (int j = 0; j < 12; ++j) {
      const double needed = rigid[j] + reflected_inertia(j) * s.ddq[j];
      rows[static_cast<std::size_t>(j % 3)].emplace_back(needed, s.dq[j], direction(s.dq[j]),
                                                         s.tau[j]);
    }
  }
  DriveFit fit;
  for (std::size_t kind = 0; kind < fit.size(); ++kind) {
    Eigen::MatrixXd A(std::ssize(rows[kind]), 3);
    Eigen::VectorXd tau(A.rows());
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      const Eigen::Vector4d& row = rows[kind][static_cast<std::size_t>(i)];
      A.row(i) = row.head<3>();
      tau[i] = row[3];
    }
    fit[kind] = A.colPivHouseholderQr().solve(tau);
  }
  return fit;
}

void air_scale(const Cheetah& cheetah, const std::vector<std::string>& logs, std::size_t every,
               Findings& findings) {
  Table table = {{"log", "abduction", "hip", "knee"}};
  std::map<std::string, std::vector<double>> all;
  for (const std::string& log : logs) {
    const DriveFit fit = fit_drives(cheetah, cheetah_samples(cheetah, log, every, false));
    table.push_back({log});
    for (std::size_t kind = 0; kind < fit.size(); ++kind) {
      const double a = fit[kind][0];
      findings.set(fmt::format("measured.air.{}.{}", log, kinds[kind]), a);
      all[kinds[kind]].push_back(a);
      table.back().push_back(fmt::format("{:.2f}", a));
    }
  }
  for (const auto& [kind, list] : all) set_spread(findings, "measured.air." + kind, list);
  findings.tables["measured_air"] = table;
}

// ------------------------------------------------------------------------- a known object

/// Torques of a log with what the drives need taken off: the rotors by CAD, or all of the fit.
std::vector<Sample> hung_samples(const Cheetah& cheetah, const std::string& log, std::size_t every,
                                 const DriveFit* fit) {
  std::vector<Sample> samples = cheetah_samples(cheetah, log, every, fit == nullptr);
  for (Sample& s : samples) {
    s.in_contact = {true};
    for (int j = 0; fit != nullptr && j < 12; ++j) {
      const Eigen::Vector3d& abc = (*fit)[static_cast<std::size_t>(j % 3)];
      const double drive = s.tau[j] - abc[1] * s.dq[j] - abc[2] * direction(s.dq[j]);
      s.tau[j] = drive / abc[0] - reflected_inertia(j) * s.ddq[j];
    }
  }
  return samples;
}

/// A link's CAD inertia is taken away and sought as a load where it was. In the air the base
/// hangs on something: an unknown wrench on it is projected out.
void known_object(const Cheetah& cheetah, const std::vector<std::string>& logs, std::size_t every,
                  Findings& findings) {
  Robot hung = cheetah.robot;
  hung.contacts = {{"base", 0, ContactKind::plane, Eigen::Isometry3d::Identity()}};
  const DriveFit fit = fit_drives(cheetah, cheetah_samples(cheetah, logs.front(), every, false));
  Table table = {{"log", "link", "CAD, kg", "found, kg", "place off by, mm",
                  "found with drives as on the first log, kg", "place off by, mm"}};
  struct Kept {
    std::vector<double> mass, place;
  };
  Kept plain, corrected;
  for (const std::string& log : logs) {
    const std::vector<Sample> raw = hung_samples(cheetah, log, every, nullptr),
                              better = hung_samples(cheetah, log, every, &fit);
    for (int link = 2; link < hung.link_count(); link += 3) {  // abduction 1, thigh 2, shank 3
      const InertialParameters truth = hung.links[static_cast<std::size_t>(link)].inertia;
      // A thigh and its motor, 21 cm long, hangs down from the hip.
      BodyModel model = load_region(hung, link, {-0.05, -0.05, -0.22}, {0.05, 0.05, 0.05});
      model.known.segment<10>(Eigen::Index{10} * link).setZero();
      table.push_back({log, hung.links[static_cast<std::size_t>(link)].name,
                       fmt::format("{:.3g}", truth.mass())});
      const auto seek = [&](const std::vector<Sample>& samples, Kept& kept) {
        const InertialParameters found{divided(model, whole(hung, model, samples), 0.5)};
        kept.mass.push_back(found.mass());
        kept.place.push_back(1e3 * (found.centre_of_mass() - truth.centre_of_mass()).norm());
        table.back().push_back(fmt::format("{:.3g}", kept.mass.back()));
        table.back().push_back(fmt::format("{:.0f}", kept.place.back()));
      };
      seek(raw, plain);
      seek(better, corrected);
    }
  }
  findings.set("measured.known.given", hung.links[2].inertia.mass());
  set_spread(findings, "measured.known.mass", plain.mass);
  set_spread(findings, "measured.known.place_mm", plain.place);
  set_spread(findings, "measured.known.corrected.mass", corrected.mass);
  set_spread(findings, "measured.known.corrected.place_mm", corrected.place);
  findings.tables["measured_known"] = table;
}

}  // namespace

Findings measured_logs(Form form) {
  Findings findings;
  const auto folder = cheetah_folder();
  if (!folder) {
    fmt::print(stderr, "measured: no folder mini_cheetah_umich in SHAPEID_DATA; left out\n");
    return findings;
  }
  const Cheetah cheetah = read_cheetah(*folder);
  std::vector<std::string> terrains = {"middle_pebble"};
  std::vector<std::string> in_air = {"air_jumping_gait_val"};
  std::size_t every = 20;  // samples
  if (form != Form::small) {
    terrains = {"concrete_right_circle", "concrete_galloping", "small_pebble", "middle_pebble",
                "asphalt_road"};
    in_air = {"air_jumping_gait_val", "air_jumping_gait_test", "air_walking_gait_val"};
    every = form == Form::full ? 2 : 10;
  }
  std::vector<Run> runs;
  runs.reserve(terrains.size());
  for (const std::string& terrain : terrains) {
    runs.push_back({terrain, standing(cheetah_samples(cheetah, terrain + "_val", every, true)),
                    standing(cheetah_samples(cheetah, terrain + "_test", every, true))});
  }
  base_and_load(cheetah, runs, findings);
  load_or_scale(cheetah, runs, findings);
  air_scale(cheetah, in_air, every, findings);
  known_object(cheetah, in_air, every, findings);
  return findings;
}

}  // namespace shapeid::experiments
