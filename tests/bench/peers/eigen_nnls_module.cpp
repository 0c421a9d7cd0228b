// Eigen's newest NNLS behind one C function. It is a module of its own, with everything hidden but
// that function, because it contains another version of Eigen than the rest of the program.
#include <unsupported/Eigen/NNLS>

extern "C" __attribute__((visibility("default"))) int shapeid_eigen_nnls(const double* A,
                                                                         const double* b, int rows,
                                                                         int columns, double* m) {
  thread_local Eigen::NNLS<Eigen::MatrixXd> solver;
  // Twice the columns, its default, is too few for some problems; the tolerance is on the gradient.
  solver = Eigen::NNLS<Eigen::MatrixXd>(Eigen::Map<const Eigen::MatrixXd>(A, rows, columns),
                                        10 * columns + 100, 1e-12);
  Eigen::Map<Eigen::VectorXd>(m, columns) =
      solver.solve(Eigen::Map<const Eigen::VectorXd>(b, rows));
  return solver.info() == Eigen::Success ? 1 : 0;
}
