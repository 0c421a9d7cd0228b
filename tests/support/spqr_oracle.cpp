#include "shapeid/tests/support/spqr_oracle.hpp"

#include <SuiteSparseQR.hpp>
#include <cstddef>
#include <stdexcept>

namespace shapeid::test {
namespace {

/// CHOLMOD's workspace, in its long-integer interface (SPQR has no other).
struct Workspace {
  Workspace() { cholmod_l_start(&common); }
  ~Workspace() { cholmod_l_finish(&common); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  cholmod_common common;
};

// What is left of a dependent column is rounding. SPQR orders columns for sparsity and not by size,
// so a small pivot before it may have amplified that: at SPQR's default of a few 1e-13 one
// redundant contact in some thousands was taken for independent, with forces of 1e15 N. Columns are
// of size one here, and a column independent by less than this would hardly move the objective.
constexpr double dependent = 1e-9;

struct Entry {
  Eigen::Index row, column;
  double value;
};

void add_block(std::vector<Entry>& entries, Eigen::Index row, Eigen::Index column,
               const Eigen::MatrixXd& block) {
  for (Eigen::Index j = 0; j < block.cols(); ++j) {
    for (Eigen::Index i = 0; i < block.rows(); ++i) {
      if (block(i, j) != 0.0) entries.push_back({row + i, column + j, block(i, j)});
    }
  }
}

std::size_t size(Eigen::Index n) { return static_cast<std::size_t>(n); }

cholmod_sparse* sparse(const std::vector<Entry>& entries, Eigen::Index rows, Eigen::Index columns,
                       cholmod_common& common) {
  constexpr int unsymmetric = 0;
  cholmod_triplet* triplet = cholmod_l_allocate_triplet(size(rows), size(columns), entries.size(),
                                                        unsymmetric, CHOLMOD_REAL, &common);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    static_cast<SuiteSparse_long*>(triplet->i)[k] = entries[k].row;
    static_cast<SuiteSparse_long*>(triplet->j)[k] = entries[k].column;
    static_cast<double*>(triplet->x)[k] = entries[k].value;
  }
  triplet->nnz = entries.size();
  cholmod_sparse* A = cholmod_l_triplet_to_sparse(triplet, entries.size(), &common);
  cholmod_l_free_triplet(&triplet, &common);
  return A;
}

/// A basic solution of min || A z - b ||.
Eigen::VectorXd least_squares(const std::vector<Entry>& entries, Eigen::Index columns,
                              const Eigen::VectorXd& b) {
  Workspace workspace;
  cholmod_common& common = workspace.common;
  cholmod_sparse* A = sparse(entries, b.size(), columns, common);
  cholmod_dense* rhs =
      cholmod_l_allocate_dense(size(b.size()), 1, size(b.size()), CHOLMOD_REAL, &common);
  Eigen::Map<Eigen::VectorXd>(static_cast<double*>(rhs->x), b.size()) = b;

  cholmod_dense* z = SuiteSparseQR<double>(SPQR_ORDERING_DEFAULT, dependent, A, rhs, &common);
  Eigen::VectorXd answer;
  if (z) answer = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(z->x), columns);
  cholmod_l_free_dense(&z, &common);
  cholmod_l_free_dense(&rhs, &common);
  cholmod_l_free_sparse(&A, &common);
  if (answer.size() != columns) throw std::runtime_error("SPQR returned no answer");
  return answer;
}

/// Norms of the weighted columns of x over all samples; one for a column of zeros.
Eigen::VectorXd column_sizes(const std::vector<RowsWithForces>& samples) {
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(samples.front().Y.cols());
  for (const RowsWithForces& s : samples) {
    squares += s.Y.cwiseAbs2().transpose() * s.weight;
  }
  return (squares.array() > 0.0).select(squares.cwiseSqrt(), 1.0);
}

}  // namespace

ForceAugmentedAnswer solve_with_forces(const std::vector<RowsWithForces>& samples) {
  const Eigen::Index unknowns = samples.front().Y.cols();
  // SPQR takes a column as dependent by what is left of it against the largest of all. Columns of Y
  // are accelerations, up to thousands times those of J: they are brought to the same size.
  const Eigen::VectorXd unit = column_sizes(samples).cwiseInverse();
  std::vector<Entry> entries;
  Eigen::VectorXd b(0);
  Eigen::Index columns = unknowns;
  for (const RowsWithForces& s : samples) {
    const Eigen::VectorXd root = s.weight.cwiseSqrt();
    const Eigen::Index row = b.size();
    add_block(entries, row, 0, root.asDiagonal() * s.Y * unit.asDiagonal());
    add_block(entries, row, columns, -(root.asDiagonal() * s.J.transpose()));
    columns += s.J.rows();
    b.conservativeResize(row + s.F.size());
    b.tail(s.F.size()) = root.asDiagonal() * s.F;
  }

  const Eigen::VectorXd z = least_squares(entries, columns, b);
  ForceAugmentedAnswer answer;
  answer.x = unit.cwiseProduct(z.head(unknowns));
  Eigen::Index column = unknowns;
  for (const RowsWithForces& s : samples) {
    answer.f.push_back(z.segment(column, s.J.rows()));
    column += s.J.rows();
    const Eigen::VectorXd residual = s.Y * answer.x - s.F - s.J.transpose() * answer.f.back();
    answer.objective += residual.dot(s.weight.cwiseProduct(residual));
  }
  return answer;
}

}  // namespace shapeid::test
