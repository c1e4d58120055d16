#include "io/off_reader.h"

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "io/file_text.h"
#include "io/header_text.h"
#include "io/polygon.h"

namespace blackleaf::detail {
namespace {

// The whole numbers at the beginning of a line, one after the other.
class Numbers {
 public:
  explicit Numbers(std::string_view line) : at_(line.data()), end_(at_ + line.size()) {}

  std::optional<std::uint64_t> next() {
    while (at_ < end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\v' || *at_ == '\f')) ++at_;
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(at_, end_, value);
    if (error == std::errc::invalid_argument) return std::nullopt;
    if (error == std::errc::result_out_of_range) value = std::numeric_limits<std::uint64_t>::max();
    at_ = stop;
    return value;
  }
  /// What has not been taken.
  std::string_view rest() const { return {at_, end_}; }

 private:
  const char* at_;
  const char* end_;
};

class OffReader {
 public:
  OffReader(const InputFile& file, const std::string& name) : bytes_(file, 0), size_(file.size()), name_(name) {}

  TriangleMesh read() {
    read_header();
    read_vertices();
    read_faces();
    if (mesh_.triangles.empty()) refuse(name_, "has no triangles", "give a surface, not points or lines");
    require_end(bytes_, name_, "the last face that its header tells of");
    return std::move(mesh_);
  }

 private:
  // A line of this many bytes holds a polygon of a million corners.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 24;

  // What stands before OFF; false when that is no OFF file.
  bool read_keyword(std::string_view word) {
    if (!word.ends_with("OFF")) return false;
    word.remove_suffix(3);
    for (const std::string_view prefix : {"ST", "C", "N", "4", "n"})
      if (word.starts_with(prefix)) {
        homogeneous_ = homogeneous_ || prefix == "4";
        if (prefix == "n") refuse(name_, "is an OFF file of any dimension (nOFF)", "give one of three, without the n");
        word.remove_prefix(prefix.size());
      }
    return word.empty();
  }

  void read_header() {
    std::vector<std::uint64_t> counts;  // vertices, faces, edges; may be spread over lines
    for (bool first = true; counts.size() < 2; first = false) {
      if (!bytes_.line(line_)) refuse(name_, "its header has no numbers of vertices and faces", kCutOff);
      auto parts = words(line_);
      if (first && !number<std::uint64_t>(parts.front())) {
        if (!read_keyword(parts.front())) refuse(name_, "does not begin with OFF", "give an OFF file, or rename it");
        parts.erase(parts.begin());
      }
      for (const auto part : parts) {
        const auto count = number<std::uint64_t>(part);
        if (part == "BINARY") refuse(name_, "is a binary OFF file", "save it as text, or as PLY or STL");
        if (!count) refuse(name_, fmt::format("its header has {} where a number should be", shown(part)), kDamaged);
        counts.push_back(*count);
      }
    }
    vertices_ = counts[0];
    faces_ = counts[1];
    if (vertices_ > size_ / 2 || faces_ > size_ / 2)  // a line has two bytes at least
      refuse(name_, fmt::format("{} but there are {} bytes", promise(), size_), kCutOff);
    if (vertices_ > std::numeric_limits<std::uint32_t>::max())
      refuse(name_, "has 2^32 vertices or more", "simplify it first");
    // Without the number of edges on its line, a line of one number is that, and any other is a vertex.
    if (counts.size() == 2 && bytes_.line(line_)) read_ahead_ = words(line_).size() != 1;
  }

  std::string promise() const { return fmt::format("its header tells of {} vertices and {} faces", vertices_, faces_); }

  void next_line(const char* what, std::uint64_t found) {
    if (!read_ahead_ && !bytes_.line(line_, kLongestLine))
      refuse(name_, fmt::format("{} but there are {} {}", promise(), found, what), kCutOff);
    read_ahead_ = false;
  }

  void read_vertices() {
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      next_line("vertices", i);
      const auto parts = words(line_);
      Eigen::Vector4d v(0, 0, 0, 1);
      for (int k = 0; k < (homogeneous_ ? 4 : 3); ++k) {
        const auto at = static_cast<std::size_t>(k);
        const auto number = at < parts.size() ? decimal(parts[at]) : std::nullopt;
        if (!number)
          refuse(name_, fmt::format("vertex {} has {} coordinates", i, k), bytes_.left() == 0 ? kCutOff : kDamaged);
        v[k] = *number;
      }
      const Eigen::Vector3d position =
          homogeneous_ ? Eigen::Vector3d(v.head<3>() / v[3]) : Eigen::Vector3d(v.head<3>());
      if (!position.allFinite()) refuse(name_, fmt::format("vertex {} is not finite", i), "export it again");
      mesh_.vertices.push_back(position);
    }
  }

  void read_faces() {
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < faces_; ++i) {
      next_line("faces", i);
      Numbers numbers(line_);
      const auto size = numbers.next();
      if (!size) refuse(name_, fmt::format("face {} does not begin with its number of vertices", i), kDamaged);
      corners.clear();
      for (std::uint64_t k = 0; k < *size; ++k) {
        const auto vertex = numbers.next();
        if (!vertex && numbers.rest().starts_with('-'))
          refuse(name_, fmt::format("face {} refers to vertex {}, below 0", i, words(numbers.rest()).front()),
                 kDamaged);
        if (!vertex && line_.size() >= kLongestLine)
          refuse(name_, fmt::format("face {} takes more than 16 MiB", i), "divide it into triangles first");
        if (!vertex)
          refuse(name_, fmt::format("face {} tells of {} vertices but names {}", i, *size, k),
                 bytes_.left() == 0 ? kCutOff : kDamaged);
        if (*vertex >= vertices_)
          refuse(name_,
                 fmt::format("face {} refers to vertex {}, and the last is {}", i, *vertex,
                             static_cast<std::int64_t>(vertices_) - 1),
                 kDamaged);
        corners.push_back(static_cast<std::uint32_t>(*vertex));
      }
      append_polygon(mesh_.vertices, corners, mesh_.triangles);
    }
  }

  Bytes bytes_;
  const std::uint64_t size_;
  const std::string& name_;
  std::string line_;
  bool read_ahead_ = false, homogeneous_ = false;
  std::uint64_t vertices_ = 0, faces_ = 0;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_off(const InputFile& file, const std::string& name) { return OffReader(file, name).read(); }

}  // namespace blackleaf::detail
