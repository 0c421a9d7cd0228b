// Sums of products of columns, over rows that come few at a time.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

namespace shapeid::diagnosis {

/// A joint's row feels the links beyond it and what acts at that joint, so most products are zero:
/// rows with entries in the same columns are summed together.
class RowSums {
 public:
  /// Of rows with so many columns, at most `most` of which come at once.
  RowSums(Eigen::Index columns, Eigen::Index most);

  void add(const Eigen::MatrixXd& rows);

  /// M^T M of all rows M since the last time, columns x columns.
  [[nodiscard]] Eigen::MatrixXd finish();

 private:
  using Places = std::vector<Eigen::Index>;

  void flush();
  void add_products(const Places& rows, const Places& columns);
  [[nodiscard]] std::map<Places, Places> rows_by_columns() const;

  Eigen::MatrixXd rows_;  ///< a row in each of the first `used_` columns: to be summed
  Eigen::MatrixXd sums_;  ///< the lower half
  Eigen::MatrixXd part_;  ///< sums of rows that have entries in the same columns
  Eigen::Index used_ = 0;
  Places all_;  ///< every column
};

}  // namespace shapeid::diagnosis
