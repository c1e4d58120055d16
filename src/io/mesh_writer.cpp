#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "blackleaf/error.h"
#include "blackleaf/mesh_file.h"
#include "file/atomic_write.h"
#include "io/image_io.h"

namespace blackleaf {
namespace {

// Collects output and passes it on in large pieces.
class Output {
 public:
  explicit Output(detail::AtomicFile& file) : file_(file) {}

  fmt::appender text() { return fmt::appender(buffer_); }
  template <class T>
  void binary(T value) {
    static_assert(std::endian::native == std::endian::little);
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    buffer_.append(bytes.data(), bytes.data() + bytes.size());
  }
  void pass_on(std::size_t at_least = 0) {
    if (buffer_.size() < at_least) return;
    file_.write(std::span(reinterpret_cast<const std::uint8_t*>(buffer_.data()), buffer_.size()));
    buffer_.clear();
  }

 private:
  detail::AtomicFile& file_;
  fmt::memory_buffer buffer_;
};

constexpr std::size_t kPiece = std::size_t{1} << 20;

// STL: 80 bytes of title, count, then for each triangle its normal, three corners (all float) and two zero bytes.
void write_stl(const TriangleMesh& mesh, Output& out) {
  // The title must not begin with "solid", which is how text STL begins.
  fmt::format_to(out.text(), "{:<80}", "binary STL written by blackleaf");
  out.binary(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                          &c = mesh.vertices[triangle[2]];
    Eigen::Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (length > 0 && std::isfinite(length))
      normal /= length;
    else
      normal.setZero();
    for (const Eigen::Vector3d& v : {normal, a, b, c})
      for (int i = 0; i < 3; ++i) out.binary(static_cast<float>(v[i]));
    out.binary(std::uint16_t{0});
    out.pass_on(kPiece);
  }
}

void write_obj(const TriangleMesh& mesh, Output& out) {
  fmt::format_to(out.text(), "# written by blackleaf\n");
  for (const auto& v : mesh.vertices) {
    fmt::format_to(out.text(), "v {} {} {}\n", v[0], v[1], v[2]);  // shortest text that gives the same double
    out.pass_on(kPiece);
  }
  for (const auto& t : mesh.triangles) {
    fmt::format_to(out.text(), "f {} {} {}\n", t[0] + std::uint64_t{1}, t[1] + std::uint64_t{1},
                   t[2] + std::uint64_t{1});
    out.pass_on(kPiece);
  }
}

void write_ply(const TriangleMesh& mesh, Output& out) {
  fmt::format_to(
      out.text(),
      "ply\nformat binary_little_endian 1.0\ncomment written by blackleaf\nelement vertex {}\nproperty double x\n"
      "property double y\nproperty double z\nelement face {}\nproperty list uchar uint vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.triangles.size());
  for (const auto& v : mesh.vertices) {
    for (int i = 0; i < 3; ++i) out.binary(v[i]);
    out.pass_on(kPiece);
  }
  for (const auto& triangle : mesh.triangles) {
    out.binary(std::uint8_t{3});
    for (const std::uint32_t index : triangle) out.binary(index);
    out.pass_on(kPiece);
  }
}

void check(const TriangleMesh& mesh, const std::filesystem::path& path, bool stl) {
  const auto fail = [&](const std::string& what, const std::string& remedy) {
    throw Error(ErrorCode::bad_argument, fmt::format("{}: {}", path.string(), what), remedy);
  };
  const double largest = stl ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!(mesh.vertices[i].cwiseAbs().maxCoeff() <= largest) || !mesh.vertices[i].allFinite())
      fail(fmt::format("vertex {} is not finite or too large for this format", i),
           stl ? "write .ply or .obj instead" : "");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle)
      if (index >= mesh.vertices.size())
        fail(fmt::format("a triangle refers to vertex {} of {}", index, mesh.vertices.size()), "");
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    fail("has 2^32 triangles or more", "simplify it first");
}

}  // namespace

void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path) {
  const std::string suffix = detail::image_suffix(path);
  if (suffix != ".stl" && suffix != ".obj" && suffix != ".ply")
    throw Error(ErrorCode::bad_argument, fmt::format("{}: meshes are not written as '{}'", path.string(), suffix),
                "use .stl, .obj or .ply");
  check(mesh, path, suffix == ".stl");
  detail::AtomicFile file(path);
  Output out(file);
  if (suffix == ".stl")
    write_stl(mesh, out);
  else if (suffix == ".obj")
    write_obj(mesh, out);
  else
    write_ply(mesh, out);
  out.pass_on();
  file.commit();
}

}  // namespace blackleaf
