// Logs as tests want them: those of the command with something changed in every row.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace shapeid::test {

/// A row's values by the names of their columns.
class NamedRow {
 public:
  /// Both must outlive this.
  NamedRow(const std::vector<std::string>& columns, std::vector<double>& values)
      : columns_(columns), values_(values) {}

  /// Throws std::out_of_range with the name if there is no such column.
  [[nodiscard]] double& operator[](const std::string& column);
  /// Calls `change` with every value whose column's name begins so, one at least expected.
  void each(const std::string& prefix, const std::function<void(double&)>& change);

 private:
  const std::vector<std::string>& columns_;
  std::vector<double>& values_;
};

/// The change of a row that only lacks columns.
inline void as_it_is(NamedRow& /*row*/) {}

/// Writes the log `to` in scratch(): `from`, which is there, each row changed, without the columns
/// whose names begin with one of `without`, each of which is expected to be there.
void write_changed(const std::string& from, const std::string& to,
                   const std::function<void(NamedRow&)>& change,
                   const std::vector<std::string>& without = {});

}  // namespace shapeid::test
