// shapes.yaml: what is read is a model whose columns and volumes can be computed with.
#include <cstdint>

#include "shapeid/fuzz/support/check.hpp"
#include "shapeid/fuzz/support/memory_file.hpp"
#include "shapeid/fuzz/support/robots.hpp"
#include "shapeid/models/shapes_yaml.hpp"

using namespace shapeid;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Robot robot = fuzz::hopper();
  const fuzz::MemoryFile file(data, size);
  fuzz::taken([&] {
    const BodyModel model = read_shapes_yaml(file.path(), robot);
    fuzz::check(!why_malformed(model, robot), "a model that was read is well-formed");
    fuzz::check(shape_columns(model).allFinite(), "columns are finite");
    const Eigen::VectorXd V = shape_volumes(model);
    fuzz::check(V.allFinite() && V.minCoeff() > 0.0, "volumes are finite and positive");
  });
  return 0;
}
