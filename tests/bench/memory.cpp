// Memory of the fast path, as bytes of the heap before and after: for each shape, for each link,
// and over a stream. Prints a piece of docs/benchmarks.md.
#include <fmt/format.h>
#include <malloc.h>

#include <memory>

#include "shapeid/fast/mass_solver.hpp"
#include "shapeid/fast/window.hpp"
#include "shapeid/tests/bench/problems/body.hpp"
#include "shapeid/tests/bench/problems/windows.hpp"

namespace shapeid::bench {
namespace {

/// In use on the heap, mapped blocks included.
double heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

/// Bytes that what `make` makes keeps.
template <typename Make>
double bytes_of(const Make& make) {
  const double before = heap();
  const auto made = make();
  return heap() - before;
}

double solver_bytes(int links, int shapes) {
  return bytes_of([&] { return std::make_unique<fast::MassSolver>(links, shapes); });
}

double window_bytes(const BodyModel& model) {
  return bytes_of([&] {
    return std::make_unique<fast::Window>(quadruped(), model, ContactTreatment::project,
                                          Eigen::VectorXd::Ones(quadruped().dof()));
  });
}

/// Growth of the heap while a window forgets its way through a stream.
double stream_bytes(std::size_t samples) {
  const std::vector<Sample> some =
      test::trot(quadruped(), some_truth(0), 0, 100, test::Noise::sensors);
  fast::Window window(quadruped(), base_shapes(), ContactTreatment::project,
                      Eigen::VectorXd::Ones(quadruped().dof()));
  const double before = heap();
  for (std::size_t i = 0; i < samples; ++i) {
    static_cast<void>(window.add(some[i % some.size()]));
    if (i % window_samples == 0) window.forget(0.5);
  }
  return heap() - before;
}

}  // namespace
}  // namespace shapeid::bench

int main() {
  using namespace shapeid::bench;
  fmt::print(
      "## Memory\n\nBytes on the heap, counted by the allocator.\n\n| what | bytes |\n|---|---|\n");
  const double one = solver_bytes(1, 1024), two = solver_bytes(1, 2048);
  fmt::print("| mass solver, one link, room for 1024 shapes | {:.0f} |\n", one);
  fmt::print("| ... each further shape | {:.1f} |\n", (two - one) / 1024.0);
  const double body = solver_bytes(13, 1024);
  fmt::print("| mass solver, 13 links, room for 1024 shapes | {:.0f} |\n", body);
  fmt::print("| ... a link, on average (its rows meet those of all others) | {:.0f} |\n",
             (body - one) / 12.0);
  fmt::print("| window, base link sought | {:.0f} |\n", window_bytes(base_shapes()));
  fmt::print("| window, 13 links sought | {:.0f} |\n", window_bytes(body_cuboids(1)));
  fmt::print("| growth over a stream of 100000 samples | {:.0f} |\n", stream_bytes(100000));
}
