// Lawson and Hanson's NNLS, their Fortran as Debian ships it inside r-cran-nnls.
#include <dlfcn.h>

#include <stdexcept>

#include "shapeid/tests/bench/peers/mass_peer.hpp"

namespace shapeid::bench {
namespace {

using Nnls = void (*)(double* a, const int* mda, const int* m, const int* n, double* b, double* x,
                      double* rnorm, double* w, double* zz, int* index, int* mode, int* nsetp);

Nnls load() {
  void* library = dlopen(SHAPEID_NNLS_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  void* symbol = library == nullptr ? nullptr : dlsym(library, "nnls_");
  if (symbol == nullptr) throw std::runtime_error("no nnls_ in " SHAPEID_NNLS_LIBRARY);
  return reinterpret_cast<Nnls>(symbol);
}

class LawsonHanson final : public MassPeer {
 public:
  [[nodiscard]] Form form() const override { return Form::rows; }

  bool solve(const DenseProblem&, const Prepared& prepared, const Eigen::VectorXd*,
             Eigen::VectorXd& m) override {
    A_ = prepared.A;  // overwritten by the solver, so the copies are part of its work
    b_ = prepared.b;
    const int rows = static_cast<int>(A_.rows()), columns = static_cast<int>(A_.cols());
    m.resize(columns);
    w_.resize(columns);
    zz_.resize(rows);
    index_.resize(columns);
    double rnorm = 0.0;
    int mode = 0, passive = 0;
    nnls_(A_.data(), &rows, &rows, &columns, b_.data(), m.data(), &rnorm, w_.data(), zz_.data(),
          index_.data(), &mode, &passive);
    return mode == 1;
  }

 private:
  Nnls nnls_ = load();
  Eigen::MatrixXd A_;
  Eigen::VectorXd b_, w_, zz_;
  Eigen::VectorXi index_;
};

}  // namespace

void add_lawson_hanson(std::vector<PeerKind>& peers) {
  peers.push_back({"lawson_hanson", false, [] { return std::make_unique<LawsonHanson>(); }});
}

}  // namespace shapeid::bench
