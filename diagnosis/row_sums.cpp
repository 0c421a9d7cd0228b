#include "shapeid/diagnosis/row_sums.hpp"

#include <cstddef>
#include <numeric>
#include <utility>

namespace shapeid::diagnosis {

RowSums::RowSums(Eigen::Index columns, Eigen::Index most)
    : rows_(2 * columns + most, columns),
      sums_(Eigen::MatrixXd::Zero(columns, columns)),
      all_(static_cast<std::size_t>(columns)) {
  std::iota(all_.begin(), all_.end(), 0);
}

void RowSums::add(const Eigen::MatrixXd& rows) {
  if (used_ + rows.rows() > rows_.rows()) flush();
  rows_.middleRows(used_, rows.rows()) = rows;
  used_ += rows.rows();
}

Eigen::MatrixXd RowSums::finish() {
  flush();
  Eigen::MatrixXd whole = sums_.selfadjointView<Eigen::Lower>();
  sums_.setZero();
  return whole;
}

void RowSums::flush() {
  // Few rows are not worth sums of their own, which have to be added at their places.
  constexpr std::size_t few = 8;
  Places others;
  for (const auto& [columns, rows] : rows_by_columns()) {
    if (rows.size() < few) {
      others.insert(others.end(), rows.begin(), rows.end());
    } else {
      add_products(rows, columns);
    }
  }
  if (!others.empty()) add_products(others, all_);
  used_ = 0;
}

void RowSums::add_products(const Places& rows, const Places& columns) {
  const auto n = static_cast<Eigen::Index>(columns.size());
  const Eigen::MatrixXd entries = rows_(rows, columns);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(n, n);
  sums.selfadjointView<Eigen::Lower>().rankUpdate(entries.transpose());
  for (Eigen::Index column = 0; column < n; ++column) {
    auto to = sums_.col(columns[static_cast<std::size_t>(column)]);
    for (Eigen::Index row = column; row < n; ++row) {
      to[columns[static_cast<std::size_t>(row)]] += sums(row, column);
    }
  }
}

/// Places of rows by the columns in which they are not zero, both in increasing order.
std::map<RowSums::Places, RowSums::Places> RowSums::rows_by_columns() const {
  std::vector<Places> columns(static_cast<std::size_t>(used_));
  for (Eigen::Index column = 0; column < rows_.cols(); ++column) {
    for (Eigen::Index row = 0; row < used_; ++row) {
      if (rows_(row, column) != 0.0) columns[static_cast<std::size_t>(row)].push_back(column);
    }
  }
  std::map<Places, Places> rows;
  for (std::size_t row = 0; row < columns.size(); ++row) {
    rows[std::move(columns[row])].push_back(static_cast<Eigen::Index>(row));
  }
  return rows;
}

}  // namespace shapeid::diagnosis
