#include "io/stl_text_reader.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "io/file_text.h"
#include "io/header_text.h"

namespace blackleaf::detail {
namespace {

class StlTextReader {
 public:
  StlTextReader(const InputFile& file, const std::string& name) : bytes_(file, 0), name_(name) {}

  TriangleMesh read() {
    constexpr std::size_t kLongestLine = std::size_t{1} << 24;
    std::string line;
    while (bytes_.line(line, kLongestLine)) {
      if (line.size() >= kLongestLine) refuse(name_, "has a line of 16 MiB or more", kDamaged);
      line = lower(std::move(line));
      for (const std::string_view word : words(line)) {
        if (coordinates_ < 3)
          take_coordinate(word);
        else if (word == "solid" || word == "endsolid") {
          in_solid_ = word == "solid";
          break;  // a name follows
        } else {
          take(word);
        }
      }
    }
    if (coordinates_ < 3) refuse(name_, fmt::format("facet {} ends within a vertex", facet()), kCutOff);
    end_facet(kCutOff);
    if (in_solid_) refuse(name_, "its last solid has no endsolid", kCutOff);
    if (mesh_.triangles.empty()) refuse(name_, "has no triangles", "give a surface, not points or lines");
    return std::move(mesh_);
  }

 private:
  std::size_t facet() const { return mesh_.triangles.size(); }

  void take(std::string_view word) {
    if (word == "facet") {
      end_facet(kDamaged);
      open_ = true;
    } else if (word == "endfacet") {
      end_facet(kDamaged);
    } else if (word == "vertex") {
      if (!open_) refuse(name_, fmt::format("has a vertex outside a facet before facet {}", facet()), kDamaged);
      if (mesh_.vertices.size() >= std::numeric_limits<std::uint32_t>::max())
        refuse(name_, "has 2^32 vertices or more", "simplify it first");
      coordinates_ = 0;
      mesh_.vertices.emplace_back(Eigen::Vector3d::Zero());
    }
  }

  void take_coordinate(std::string_view word) {
    const auto value = decimal(word);
    if (!value || !std::isfinite(*value))
      refuse(name_, fmt::format("facet {} has a vertex with {} where a finite number should be", facet(), shown(word)),
             kDamaged);
    mesh_.vertices.back()[coordinates_++] = *value;
  }

  void end_facet(const char* remedy) {
    if (!open_) return;
    const std::size_t first = 3 * facet(), vertices = mesh_.vertices.size() - first;
    if (vertices != 3)
      refuse(name_, fmt::format("facet {} has {} vertices", facet(), vertices),
             vertices > 3 ? "divide it into triangles first" : remedy);
    const auto a = static_cast<std::uint32_t>(first);
    mesh_.triangles.push_back({a, a + 1, a + 2});
    open_ = false;
  }

  Bytes bytes_;
  const std::string& name_;
  TriangleMesh mesh_;
  bool in_solid_ = false;  // between solid and endsolid
  bool open_ = false;      // within a facet
  int coordinates_ = 3;    // of the last vertex that have been read
};

}  // namespace

TriangleMesh read_stl_text(const InputFile& file, const std::string& name) { return StlTextReader(file, name).read(); }

}  // namespace blackleaf::detail
