// One solver of the mass problem, ours or someone else's, behind the smallest interface that lets
// each have the problem as it likes it best.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "shapeid/tests/bench/problems/dense_problem.hpp"

namespace shapeid::bench {

class MassPeer {
 public:
  MassPeer() = default;
  MassPeer(const MassPeer&) = delete;
  MassPeer& operator=(const MassPeer&) = delete;
  virtual ~MassPeer() = default;

  /// What it starts from. `prepare` has been called for it (or for more) before every solve.
  [[nodiscard]] virtual Form form() const = 0;

  /// Solves into `m`, kg. `warm` is the last answer, carried over to these columns, or null for a
  /// cold start. False if the solver itself says that it failed.
  virtual bool solve(const DenseProblem& problem, const Prepared& prepared,
                     const Eigen::VectorXd* warm, Eigen::VectorXd& m) = 0;
};

/// A way of using a solver. Names read "solver/option", e.g. "qpoases/mpc".
struct PeerKind {
  std::string name;
  bool warm = false;  ///< is given warm starts
  std::function<std::unique_ptr<MassPeer>()> make;
  bool density = false;  ///< solves for lambda > 0 as well
  /// Beyond this a single solve takes too long to be worth a row.
  Eigen::Index most_shapes = std::numeric_limits<Eigen::Index>::max();
};

/// Every solver that was found when this was built, and of the ones that were not the names.
[[nodiscard]] const std::vector<PeerKind>& mass_peers();
[[nodiscard]] const std::vector<std::string>& missing_peers();

// Defined in the file named after the solver, and called only if that file is compiled.
void add_reference(std::vector<PeerKind>& peers);
void add_fast(std::vector<PeerKind>& peers);
void add_lawson_hanson(std::vector<PeerKind>& peers);
void add_ceres(std::vector<PeerKind>& peers);
void add_qpoases(std::vector<PeerKind>& peers);
void add_proxqp(std::vector<PeerKind>& peers);
void add_piqp(std::vector<PeerKind>& peers);
void add_eigen_nnls(std::vector<PeerKind>& peers);

}  // namespace shapeid::bench
