// What a blind trial can contain: every effect put into the simulated robot or its signals, by
// equations of its own, and effects that the diagnosis does not know.
#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "shapeid/models/sample.hpp"
#include "shapeid/models/simbody/disturbance.hpp"
#include "shapeid/models/simbody/ground.hpp"
#include "shapeid/models/simbody/load.hpp"
#include "shapeid/models/simbody/random.hpp"
#include "shapeid/tests/blind/parts/machine.hpp"

namespace shapeid::blind {

/// One instant: what the sensors would read without noise.
struct Reading {
  Sample sample;
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};
using Readings = std::vector<Reading>;

/// A robot that differs from its model, about to be simulated.
struct Ingredients {
  Robot robot;
  std::vector<std::function<void(const DisturbedState&, DisturbingForces&)>> forces;
  std::optional<Load> load;
  double load_from = 0.0;  ///< s
  Ground ground;
  std::vector<std::function<void(Readings&)>> signals;  ///< in this order, after the simulation
  [[nodiscard]] Disturbance disturbance() const;
};

enum class Place { joint, link, contact, accelerometer, whole };

/// Numbers that an effect was put in with.
struct Amount {
  int site = 0;
  double size = 0.0;          ///< in the unit of the kind
  Eigen::Vector3d direction;  ///< unit vector, for kinds that have one
};

struct Kind {
  std::string id;  ///< the catalogue's, or the name of a foreign effect
  Place place = Place::joint;
  bool foreign = false;
  /// In the forward simulation; else on the signals of any motion.
  bool dynamic = false;
  double nominal = 1.0;  ///< a size that is easy to see
  double largest = 1.0;  ///< beyond it no robot would be run, or the equation no longer holds
  void (*put)(Ingredients&, const Machine&, const Amount&) = nullptr;
  /// It changes what is said of contacts: no number says how much that is, and no model is told the
  /// truth.
  bool flags = false;
  bool load = false;  ///< something is carried, of which a robot has room for one
  /// Values of the catalogue's parameters for an amount. Null if foreign, or if it changes flags.
  std::vector<double> (*values)(const Machine&, const Amount&) = nullptr;
  std::vector<double> shape;
  /// Of a foreign effect: catalogue ids that describe a part of it rightly, on its site.
  std::vector<std::string> described_by;
  bool arm = true, quadruped = true;  ///< robots that it makes sense on
};

/// All of them.
[[nodiscard]] const std::vector<Kind>& kinds();
/// Throws std::out_of_range for an unknown id.
[[nodiscard]] const Kind& kind(const std::string& id);

/// Whether both can be in one trial: no kind twice, and no two loads.
[[nodiscard]] bool fit_together(const Kind& one, const Kind& other);

/// "knee", "base.accel", "all": as the diagnosis names it.
[[nodiscard]] std::string place_name(const Machine& machine, Place place, int site);
/// Sites on the machine where the kind can be put.
[[nodiscard]] std::vector<int> sites(const Machine& machine, const Kind& kind);

/// The moment at which a load is put on, s.
inline constexpr double load_moment = 6.0;

}  // namespace shapeid::blind
