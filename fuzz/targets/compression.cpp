// Rows compressed as they come, merged and taken out again, against one QR of all of them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "shapeid/fast/sliding_triangle.hpp"
#include "shapeid/fast/triangle.hpp"
#include "shapeid/fuzz/support/bytes.hpp"
#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/reference/triangle.hpp"
#include "shapeid/tests/fast/triangles.hpp"
#include "shapeid/tests/support/scaled.hpp"

using namespace shapeid;
using test::few_hundred_eps, test::gram_error;

namespace {

Eigen::MatrixXd any_rows(fuzz::Bytes& bytes, Eigen::Index columns) {
  constexpr int decades = 60;  // squares and their sums stay doubles
  Eigen::MatrixXd rows(bytes.count(0, 20), columns);
  const bool wild = bytes.flag();
  for (double& entry : rows.reshaped()) entry = wild ? bytes.wild(decades) : bytes.unit();
  if (columns > 1 && bytes.flag()) rows.col(columns - 1) = bytes.unit() * rows.col(0);
  return rows;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes(data, size);
  const Eigen::Index columns = bytes.count(1, 40);
  const auto most = static_cast<std::size_t>(bytes.count(1, 6));
  fast::Triangle streamed(columns - 1), merged(columns - 1);
  fast::SlidingTriangle sliding(columns - 1, most);
  std::vector<Eigen::MatrixXd> blocks;
  Eigen::MatrixXd all(0, columns);
  for (int count = bytes.count(1, 12); count > 0; --count) {
    const Eigen::MatrixXd rows = any_rows(bytes, columns);
    const fast::Triangle block = test::triangle_of(rows);
    test::add(streamed, rows);
    merged.merge(block);
    sliding.push(block);
    blocks.push_back(rows);
    all = reference::stacked(all, rows);
    Eigen::MatrixXd present(0, columns);
    for (std::size_t i = blocks.size() - std::min(most, blocks.size()); i < blocks.size(); ++i) {
      present = reference::stacked(present, blocks[i]);
    }
    fuzz::check(gram_error(sliding.triangle().R(), present) < few_hundred_eps,
                "the sliding triangle is that of its blocks");
  }
  fuzz::check(gram_error(reference::triangle(all), all) < few_hundred_eps, "the reference's is");
  fuzz::check(gram_error(streamed.R(), all) < few_hundred_eps, "the streamed triangle is");
  fuzz::check(gram_error(merged.R(), all) < few_hundred_eps, "the merged triangle is");
  return 0;
}
