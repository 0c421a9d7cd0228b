// NNLS of Eigen newer than 3.4, which has none: see eigen_nnls_module.cpp.
#include <dlfcn.h>

#include <stdexcept>

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

using Nnls = int (*)(const double* A, const double* b, int rows, int columns, double* m);

Nnls load() {
  void* module = dlopen(SHAPEID_EIGEN_NNLS_MODULE, RTLD_NOW | RTLD_LOCAL);
  void* symbol = module == nullptr ? nullptr : dlsym(module, "shapeid_eigen_nnls");
  if (symbol == nullptr) throw std::runtime_error("no function in " SHAPEID_EIGEN_NNLS_MODULE);
  return reinterpret_cast<Nnls>(symbol);
}

class EigenNnls final : public MassPeer {
 public:
  [[nodiscard]] Form form() const override { return Form::rows; }

  bool solve(const DenseProblem&, const Prepared& prepared, const Eigen::VectorXd*,
             Eigen::VectorXd& m) override {
    m.resize(prepared.A.cols());
    return nnls_(prepared.A.data(), prepared.b.data(), static_cast<int>(prepared.A.rows()),
                 static_cast<int>(prepared.A.cols()), m.data()) == 1;
  }

 private:
  Nnls nnls_ = load();
};

}  // namespace

void add_eigen_nnls(std::vector<PeerKind>& peers) {
  peers.push_back({"eigen_nnls", false, [] { return std::make_unique<EigenNnls>(); }});
}

}  // namespace shapeid::bench
