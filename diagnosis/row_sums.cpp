#include "shapeid/diagnosis/row_sums.hpp"

#include <cstddef>
#include <numeric>
#include <utility>

namespace shapeid::diagnosis {

RowSums::RowSums(Eigen::Index columns, Eigen::Index most)
    : rows_(columns, 2 * columns + most),
      sums_(Eigen::MatrixXd::Zero(columns, columns)),
      part_(columns, columns),
      all_(static_cast<std::size_t>(columns)) {
  std::iota(all_.begin(), all_.end(), 0);
}

void RowSums::add(const Eigen::MatrixXd& rows) {
  if (used_ + rows.rows() > rows_.cols()) flush();
  rows_.middleCols(used_, rows.rows()) = rows.transpose();
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
  const Eigen::MatrixXd entries = rows_(columns, rows);
  if (columns.size() == all_.size()) {
    sums_.selfadjointView<Eigen::Lower>().rankUpdate(entries);
    return;
  }
  const auto n = static_cast<Eigen::Index>(columns.size());
  auto part = part_.topLeftCorner(n, n);
  part.setZero();
  part.selfadjointView<Eigen::Lower>().rankUpdate(entries);
  for (Eigen::Index column = 0; column < n; ++column) {
    auto to = sums_.col(columns[static_cast<std::size_t>(column)]);
    for (Eigen::Index row = column; row < n; ++row) {
      to[columns[static_cast<std::size_t>(row)]] += part(row, column);
    }
  }
}

/// Places of rows by the columns in which they are not zero, both in increasing order.
std::map<RowSums::Places, RowSums::Places> RowSums::rows_by_columns() const {
  std::map<Places, Places> rows;
  for (Eigen::Index row = 0; row < used_; ++row) {
    Places columns;
    for (const Eigen::Index column : all_) {
      if (rows_(column, row) != 0.0) columns.push_back(column);
    }
    rows[std::move(columns)].push_back(row);
  }
  return rows;
}

}  // namespace shapeid::diagnosis
