#include "shapeid/tests/app/changed_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>

#include "shapeid/models/log.hpp"
#include "shapeid/models/log_writer.hpp"
#include "shapeid/tests/app/command.hpp"

namespace shapeid::test {

double& NamedRow::operator[](const std::string& column) {
  const auto at = std::find(columns_.begin(), columns_.end(), column);
  if (at == columns_.end()) throw std::out_of_range(column);
  return values_[static_cast<std::size_t>(at - columns_.begin())];
}

void NamedRow::each(const std::string& prefix, const std::function<void(double&)>& change) {
  bool any = false;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (!columns_[i].starts_with(prefix)) continue;
    any = true;
    change(values_[i]);
  }
  EXPECT_TRUE(any) << prefix;
}

void write_changed(const std::string& from, const std::string& to,
                   const std::function<void(NamedRow&)>& change,
                   const std::vector<std::string>& without) {
  LogReader log(scratch() + "/" + from);
  std::vector<std::size_t> kept;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < log.columns().size(); ++i) {
    const std::string& name = log.columns()[i];
    const auto begins_name = [&](const std::string& prefix) { return name.starts_with(prefix); };
    if (std::any_of(without.begin(), without.end(), begins_name)) continue;
    kept.push_back(i);
    names.push_back(name);
  }
  for (const std::string& prefix : without) {
    EXPECT_TRUE(std::any_of(log.columns().begin(), log.columns().end(),
                            [&](const std::string& name) { return name.starts_with(prefix); }))
        << prefix;
  }
  LogWriter out(scratch() + "/" + to, names);
  while (std::optional<LogRow> row = log.next()) {
    NamedRow named(log.columns(), row->values);
    change(named);
    std::vector<double> values;
    values.reserve(kept.size());
    for (const std::size_t i : kept) values.push_back(row->values[i]);
    out.write(values);
  }
  out.close();
}

}  // namespace shapeid::test
