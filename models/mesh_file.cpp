#include "shapeid/models/mesh_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>

#include "shapeid/models/error.hpp"
#include "shapeid/models/number.hpp"
#include "shapeid/models/text.hpp"

namespace shapeid {
namespace {

constexpr std::size_t largest_mesh = std::size_t{1} << 26;
constexpr std::size_t binary_header = 84;    // 80 bytes of anything, then the count
constexpr std::size_t binary_triangle = 50;  // normal, three corners, two bytes of attributes
constexpr std::size_t binary_normal = 12;

/// Gives equal corners one number.
class Corners {
 public:
  int number_of(const Eigen::Vector3d& v) {
    const auto [found, fresh] =
        numbers_.emplace(std::array<double, 3>{v.x(), v.y(), v.z()}, static_cast<int>(all_.size()));
    if (fresh) all_.push_back(v);
    return found->second;
  }
  std::vector<Eigen::Vector3d> take() { return std::move(all_); }

 private:
  std::map<std::array<double, 3>, int> numbers_;
  std::vector<Eigen::Vector3d> all_;
};

std::uint32_t little_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8U * i);
  }
  return value;
}

bool is_binary(std::string_view bytes) {
  return bytes.size() >= binary_header &&
         bytes.size() - binary_header == binary_triangle * little_endian(bytes, 80);
}

MeshFile read_binary(std::string_view bytes, const std::string& path) {
  Corners corners;
  MeshFile mesh;
  for (std::size_t at = binary_header; at < bytes.size(); at += binary_triangle) {
    std::array<int, 3> face{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d v;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t place = at + binary_normal + 12 * corner + 4 * axis;
        v[static_cast<Eigen::Index>(axis)] =
            static_cast<double>(std::bit_cast<float>(little_endian(bytes, place)));
      }
      if (!v.allFinite()) {
        throw InputError(Place{path, 0, {}},
                         fmt::format("triangle {} has a corner that is not finite",
                                     (at - binary_header) / binary_triangle + 1),
                         "export it again");
      }
      face[corner] = corners.number_of(v);
    }
    mesh.faces.push_back(face);
  }
  mesh.vertices = corners.take();
  return mesh;
}

/// Words of a text one after the other, with the line of the last one.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view next() {
    const std::size_t begin = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    for (; at_ < begin; ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
    at_ = std::min(text_.find_first_of(" \t\r\n", begin), text_.size());
    return text_.substr(begin, at_ - begin);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  [[nodiscard]] int line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class AsciiReader {
 public:
  AsciiReader(std::string_view text, const std::string& path) : words_(text), path_(path) {}

  /// All solids of the file are one mesh.
  MeshFile read() {
    MeshFile mesh;
    Corners corners;
    expect("solid");
    read_solid(mesh, corners);
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) {
      if (word != "solid") refuse(word, "another solid or the end");
      read_solid(mesh, corners);
    }
    mesh.vertices = corners.take();
    return mesh;
  }

 private:
  /// Behind its first word.
  void read_solid(MeshFile& mesh, Corners& corners) {
    words_.skip_line();  // the name, of any number of words
    std::string_view word = words_.next();
    for (; word == "facet"; word = words_.next()) {
      expect("normal");
      for (int i = 0; i < 3; ++i) number();
      expect("outer");
      expect("loop");
      std::array<int, 3> face{};
      for (int& corner : face) {
        expect("vertex");
        const double x = number();
        const double y = number();
        const double z = number();
        corner = corners.number_of({x, y, z});
      }
      expect("endloop");
      expect("endfacet");
      mesh.faces.push_back(face);
    }
    if (word != "endsolid") refuse(word, "facet or endsolid");
    words_.skip_line();  // the name again
  }

  [[noreturn]] void refuse(std::string_view found, std::string_view wanted) const {
    throw InputError({path_, words_.line(), {}}, fmt::format("\"{}\" is not STL here", found),
                     fmt::format("expected {}", wanted));
  }
  void expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    if (word != wanted) refuse(word, wanted);
  }
  double number() {
    const std::string_view word = words_.next();
    const std::optional<double> value = parse_number(word);
    if (!value) refuse(word, "a finite number");
    return *value;
  }

  Words words_;
  const std::string& path_;
};

}  // namespace

MeshFile read_stl(const std::string& path) {
  const std::string bytes = read_small_file(path, largest_mesh);
  // A binary file may begin with "solid" too: its size tells.
  if (is_binary(bytes)) return read_binary(bytes, path);
  if (bytes.starts_with("solid")) return AsciiReader(bytes, path).read();
  throw InputError(Place{path, 0, {}},
                   "neither a binary STL (its size does not fit its count of "
                   "triangles) nor an ASCII one",
                   "export the mesh as STL");
}

}  // namespace shapeid
