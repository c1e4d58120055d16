// The vertices of PLY files as points.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include <fmt/format.h>

#include "io/file_text.h"
#include "io/number_bytes.h"
#include "io/ply_header.h"
#include "io/point_readers.h"

namespace blackleaf::detail {
namespace {

constexpr std::size_t kNone = ~std::size_t{0};

// Where x, y and z stand among an element's properties.
using Places = std::array<std::size_t, 3>;

Places places_of(const PlyElement& vertices, const std::string& name) {
  Places places = {kNone, kNone, kNone};
  for (std::size_t i = 0; i < vertices.properties.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (vertices.properties[i].name == std::string(1, "xyz"[axis])) {
        if (vertices.properties[i].is_list())
          refuse(name, fmt::format("its {} is a list", "xyz"[axis]), "export it again");
        places[axis] = i;
      }
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (places[axis] == kNone) refuse(name, fmt::format("its vertices have no {}", "xyz"[axis]), "export it again");
  return places;
}

[[noreturn]] void ends_early(const std::string& name, const PlyElement& element, std::uint64_t found) {
  refuse(name, fmt::format("its header tells of {} of \"{}\" but there are {}", element.count, element.name, found),
         kCutOff);
}

class TextVertices {
 public:
  TextVertices(Bytes& bytes, const std::string& name, PointSink& sink) : bytes_(bytes), name_(name), sink_(sink) {}

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;
    for (std::uint64_t i = 0; i < element.count; ++i)
      if (!bytes_.line(line_)) ends_early(name_, element, i);
  }

  void read(const PlyElement& element) {
    const Places places = places_of(element, name_);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (!bytes_.line(line_)) ends_early(name_, element, i);
      sink_.reached(bytes_.position());
      sink_.add(vertex(element, places, i));
    }
  }

 private:
  Eigen::Vector3d vertex(const PlyElement& element, const Places& places, std::uint64_t index) {
    WordsOfLine words(line_);
    Eigen::Vector3d point;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      const std::string_view word = words.next();
      if (property.is_list()) {
        const std::optional<std::uint64_t> length = whole_number(word);
        if (!length || *length > line_.size()) fail(index, property);
        for (std::uint64_t item = 0; item < *length; ++item)
          if (words.next().empty()) fail(index, property);
        continue;
      }
      if (word.empty()) fail(index, property);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (places[axis] != k) continue;
        const std::optional<double> value = decimal(word);
        if (!value) fail(index, property);
        point[static_cast<Eigen::Index>(axis)] = *value;
      }
    }
    return point;
  }

  [[noreturn]] void fail(std::uint64_t index, const PlyProperty& property) const {
    refuse(name_, fmt::format("vertex {} has no good \"{}\"", index, property.name), kDamaged);
  }

  Bytes& bytes_;
  const std::string& name_;
  PointSink& sink_;
  std::string line_;
};

class BinaryVertices {
 public:
  BinaryVertices(Bytes& bytes, bool big, const std::string& name, PointSink& sink)
      : bytes_(bytes), swapped_(big == (std::endian::native == std::endian::little)), name_(name), sink_(sink) {}

  void skip(const PlyElement& element) {
    const std::uint64_t size = check(element);
    if (!has_lists(element)) {
      bytes_.skip(element.count * size);
      return;
    }
    for (std::uint64_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties)
        if (!pass(property)) ends_early(name_, element, i);
  }

  void read(const PlyElement& element) {
    const Places places = places_of(element, name_);
    check(element);
    if (has_lists(element))
      read_with_lists(element, places);
    else
      read_rows(element, places);
  }

 private:
  static bool has_lists(const PlyElement& element) {
    return std::any_of(element.properties.begin(), element.properties.end(),
                       [](const PlyProperty& property) { return property.is_list(); });
  }

  // The least bytes of one; Error if there are not enough for all.
  std::uint64_t check(const PlyElement& element) const {
    std::uint64_t size = 0;
    for (const PlyProperty& property : element.properties)
      size += property.is_list() ? property.count_size() : property.size();
    if (size > 0 && element.count > bytes_.left() / size) ends_early(name_, element, bytes_.left() / size);
    return size;
  }

  // Rows of one length, many at a time.
  void read_rows(const PlyElement& element, const Places& places) {
    std::uint64_t size = 0;
    std::array<std::size_t, 3> offsets{};
    std::array<Component, 3> types{};
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (places[axis] == k) {
          offsets[axis] = static_cast<std::size_t>(size);
          types[axis] = *element.properties[k].type;
        }
      size += element.properties[k].size();
    }
    const std::uint64_t rows = std::max<std::uint64_t>(1, 65536 / std::max<std::uint64_t>(1, size));
    std::vector<std::uint8_t> buffer(static_cast<std::size_t>(rows * size));
    for (std::uint64_t done = 0; done < element.count;) {
      const std::uint64_t part = std::min(rows, element.count - done);
      if (bytes_.read(std::span(buffer).first(static_cast<std::size_t>(part * size))) < part * size)
        ends_early(name_, element, done);
      sink_.reached(bytes_.position());
      for (std::uint64_t i = 0; i < part; ++i) {
        const std::uint8_t* const row = buffer.data() + i * size;
        sink_.add({number_at(types[0], row + offsets[0], swapped_), number_at(types[1], row + offsets[1], swapped_),
                   number_at(types[2], row + offsets[2], swapped_)});
      }
      done += part;
    }
  }

  void read_with_lists(const PlyElement& element, const Places& places) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Eigen::Vector3d point;
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        const auto place = std::find(places.begin(), places.end(), k);
        if (place == places.end()) {
          if (!pass(element.properties[k])) ends_early(name_, element, i);
          continue;
        }
        const std::optional<double> value = next(*element.properties[k].type);
        if (!value) ends_early(name_, element, i);
        point[place - places.begin()] = *value;
      }
      sink_.reached(bytes_.position());
      sink_.add(point);
    }
  }

  std::optional<double> next(Component type) {
    std::array<std::uint8_t, 8> raw{};
    const std::size_t size = bytes_of(type);
    if (bytes_.read(std::span(raw).first(size)) < size) return std::nullopt;
    return number_at(type, raw.data(), swapped_);
  }

  // Passes over one property; false at the end of the file.
  bool pass(const PlyProperty& property) {
    if (!property.is_list()) return bytes_.skip(property.size());
    const std::optional<double> length = next(*property.count_type);
    // Lengths have four bytes at most; one below zero, or a fraction, is damage.
    if (length && !(*length >= 0 && *length <= 0x1p32))
      refuse(name_, fmt::format("\"{}\" has a list of {} numbers", property.name, *length), kDamaged);
    return length && bytes_.skip(static_cast<std::uint64_t>(*length) * property.size());
  }

  Bytes& bytes_;
  const bool swapped_;
  const std::string& name_;
  PointSink& sink_;
};

// All elements: what follows the vertices tells whether the header counts them right.
template <class Vertices>
void read_with(Vertices vertices, const PlyHeader& header) {
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex")
      vertices.read(element);
    else
      vertices.skip(element);
}

}  // namespace

void read_ply_points(const InputFile& file, const std::string& name, PointSink& sink) {
  const std::optional<PlyHeader> header = read_ply_header(file, name);
  if (!header) refuse(name, "does not begin with \"ply\"", "its contents are not what its name says");
  if (!header->known) refuse(name, "its header has a property of an unknown type", kDamaged);
  const auto vertices = std::find_if(header->elements.begin(), header->elements.end(),
                                     [](const PlyElement& element) { return element.name == "vertex"; });
  if (vertices == header->elements.end() || vertices->count == 0)
    refuse(name, "has no vertices", "give a file with points");
  Bytes bytes(file, header->end);
  if (header->format == "ascii") {
    read_with(TextVertices(bytes, name, sink), *header);
    const bool lines = std::none_of(header->elements.begin(), header->elements.end(),
                                    [](const PlyElement& element) { return element.properties.empty(); });
    if (lines) require_end(bytes, name, "the last element that its header tells of");
  } else if (header->format == "binary_little_endian" || header->format == "binary_big_endian") {
    read_with(BinaryVertices(bytes, header->format == "binary_big_endian", name, sink), *header);
    check_ply_end(*header, bytes.left(), name);
  } else {
    refuse(name, fmt::format("its format is \"{}\", which is unknown", header->format.substr(0, 40)),
           "use ascii, binary_little_endian or binary_big_endian");
  }
}

}  // namespace blackleaf::detail
