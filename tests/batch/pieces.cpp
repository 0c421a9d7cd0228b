#include "shapeid/tests/batch/pieces.hpp"

#include <fmt/format.h>

#include <array>

#include "shapeid/tests/app/command.hpp"
#include "shapeid/tests/track/logs.hpp"

namespace shapeid::test {
namespace {

/// Rows at which the pieces begin and end.
constexpr std::array<std::size_t, pieces + 1> cuts = {0, 310, 560, 1000, 1180, 1450, 1620, 2000};

struct Pieces {
  std::string names, whole = "whole.csv";

  Pieces() {
    Lines log = trot_log();
    log.resize(cuts.back() + 1);
    for (std::size_t k = 0; k < pieces; ++k) {
      change(log, "time", cuts[k], cuts[k + 1],
             [&](double t) { return t + static_cast<double>(k); });
      Lines piece = {log.front()};
      for (std::size_t row = cuts[k]; row < cuts[k + 1]; ++row) piece.push_back(log.at(row + 1));
      const std::string name = fmt::format("piece{}.csv", k);
      scratch_file(name, joined(piece));
      names += name + " ";
    }
    scratch_file(whole, joined(log));
  }
};

const Pieces& cut() {
  static const Pieces made;
  return made;
}

}  // namespace

const std::string& piece_names() { return cut().names; }
const std::string& whole_name() { return cut().whole; }

}  // namespace shapeid::test
