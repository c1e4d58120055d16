// The points of PCD files, the format of the Point Cloud Library.
#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include <fmt/format.h>

#include "io/file_text.h"
#include "io/lzf.h"
#include "io/number_bytes.h"
#include "io/point_readers.h"

namespace blackleaf::detail {
namespace {

struct Field {
  std::string name;
  std::uint64_t size = 4;  // bytes of a number
  char type = 'F';         // I, U or F
  std::uint64_t count = 1;

  std::optional<Component> component() const {
    using enum Component;
    if (type == 'F') return size == 4 ? std::optional(f32) : size == 8 ? std::optional(f64) : std::nullopt;
    const bool sign = type == 'I';
    switch (size) {
      case 1:
        return sign ? i8 : u8;
      case 2:
        return sign ? i16 : u16;
      case 4:
        return sign ? i32 : u32;
      case 8:
        return sign ? i64 : u64;
      default:
        return std::nullopt;
    }
  }
};

// A coordinate: its field, where the field begins in a point, in bytes and in numbers.
struct Place {
  std::size_t field = 0;
  std::uint64_t offset = 0, word = 0;
  Component type = Component::f32;
};

class PcdReader {
 public:
  PcdReader(const InputFile& file, const std::string& name, PointSink& sink)
      : bytes_(file, 0), name_(name), sink_(sink) {}

  void read() {
    const std::string data = header();
    locate();
    if (points_ == 0) refuse(name_, "has no points", "give a file with points");
    if (data == "ascii")
      read_text();
    else if (data == "binary")
      read_binary();
    else if (data == "binary_compressed")
      read_compressed();
    else
      refuse(name_, fmt::format("its DATA are \"{}\", which is unknown", data.substr(0, 40)),
             "use ascii, binary or binary_compressed");
  }

 private:
  // More than any file has; keeps all sums below 2^64.
  static constexpr std::uint64_t kMany = 65536;

  // Reads up to DATA and returns what it says.
  std::string header() {
    std::string line;
    std::optional<std::uint64_t> width, height, points;
    // A header is short: what goes on for longer is no PCD file.
    for (int entries = 0; entries < 64 && bytes_.line(line); ++entries) {
      const std::vector<std::string_view> parts = words(line);
      const std::string_view key = parts.front();
      const auto each = [&](const auto& assign) {
        if (key == "FIELDS" || key == "COLUMNS") fields_.resize(parts.size() - 1);
        if (parts.size() - 1 != fields_.size() || fields_.empty() || fields_.size() > kMany)
          refuse(name_, fmt::format("its {} has {} entries for {} fields", key, parts.size() - 1, fields_.size()),
                 kDamaged);
        for (std::size_t i = 0; i < fields_.size(); ++i) assign(fields_[i], parts[i + 1]);
      };
      const auto whole = [&](std::string_view word) {
        const std::optional<std::uint64_t> value = whole_number(word);
        if (!value) refuse(name_, fmt::format("its {} is \"{}\"", key, word.substr(0, 40)), kDamaged);
        return *value;
      };
      const auto only = [&] { return whole(parts.size() == 2 ? parts[1] : std::string_view{}); };
      if (key == "FIELDS" || key == "COLUMNS") {
        each([](Field& field, std::string_view word) { field.name = word; });
      } else if (key == "SIZE") {
        each([&](Field& field, std::string_view word) { field.size = whole(word); });
      } else if (key == "TYPE") {
        each([&](Field& field, std::string_view word) {
          if (word != "I" && word != "U" && word != "F")
            refuse(name_, fmt::format("its TYPE \"{}\" is unknown", word.substr(0, 40)), "use I, U or F");
          field.type = word[0];
        });
      } else if (key == "COUNT") {
        each([&](Field& field, std::string_view word) { field.count = whole(word); });
      } else if (key == "WIDTH") {
        width = only();
      } else if (key == "HEIGHT") {
        height = only();
      } else if (key == "POINTS") {
        points = only();
      } else if (key == "DATA") {
        if (fields_.empty()) refuse(name_, "its header has no FIELDS", kDamaged);
        settle(width, height, points);
        return lower(std::string(parts.size() == 2 ? parts[1] : ""));
      } else if (key != "VERSION" && key != "VIEWPOINT") {
        refuse(name_, fmt::format("its header has \"{}\", which is unknown", key.substr(0, 40)),
               "its contents are not what its name says");
      }
    }
    refuse(name_, "its header has no DATA", kCutOff);
  }

  void settle(const std::optional<std::uint64_t>& width, const std::optional<std::uint64_t>& height,
              const std::optional<std::uint64_t>& points) {
    if (!points && !width) refuse(name_, "its header has neither POINTS nor WIDTH", kDamaged);
    constexpr std::uint64_t kMost = std::uint64_t{1} << 40;  // of points
    const std::uint64_t w = width.value_or(points.value_or(0)), h = height.value_or(1);
    if (w > kMost || h > kMost || points.value_or(0) > kMost || (h > 0 && w > kMost / h))
      refuse(name_, "its header tells of more than 2^40 points", kDamaged);
    points_ = points.value_or(w * h);
    if (points_ != w * h)
      refuse(name_, fmt::format("its header tells of {} points, but of {} x {}", points_, w, h), kDamaged);
  }

  void locate() {
    std::array<bool, 3> found{};
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const Field& field = fields_[i];
      if (field.size > kMany || field.count > kMany) refuse(name_, "its fields are too large", kDamaged);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (field.name != std::string(1, "xyz"[axis])) continue;
        const std::optional<Component> type = field.component();
        if (!type || field.count != 1)
          refuse(name_,
                 fmt::format("its {} is {} numbers of {} bytes of type {}", field.name, field.count, field.size,
                             field.type),
                 "give coordinates as single numbers");
        places_[axis] = {i, stride_, words_, *type};
        found[axis] = true;
      }
      stride_ += field.size * field.count;
      words_ += field.count;
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!found[axis]) refuse(name_, fmt::format("its points have no {}", "xyz"[axis]), "give points in space");
  }

  [[noreturn]] void ends_early(std::uint64_t found) const {
    refuse(name_, fmt::format("its header tells of {} points but there are {}", points_, found), kCutOff);
  }

  void read_text() {
    std::string line;
    for (std::uint64_t i = 0; i < points_; ++i) {
      if (!bytes_.line(line)) ends_early(i);
      WordsOfLine rest(line);
      Eigen::Vector3d point;
      for (std::uint64_t k = 0; k < words_; ++k) {
        const std::string_view word = rest.next();
        if (word.empty()) refuse(name_, fmt::format("point {} has {} numbers instead of {}", i, k, words_), kDamaged);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (places_[axis].word != k) continue;
          const std::optional<double> value = decimal(word);
          if (!value)
            refuse(name_, fmt::format("point {} has \"{}\" for its {}", i, word.substr(0, 40), "xyz"[axis]), kDamaged);
          point[static_cast<Eigen::Index>(axis)] = *value;
        }
      }
      sink_.reached(bytes_.position());
      sink_.add(point);
    }
    if (bytes_.line(line))
      refuse(name_, fmt::format("its header tells of {} points but there are more", points_), kDamaged);
  }

  double value(const std::uint8_t* at, const Place& place) const {
    return number_at(place.type, at, std::endian::native != std::endian::little);
  }

  void read_binary() {
    if (points_ > bytes_.left() / stride_) ends_early(bytes_.left() / stride_);
    const std::uint64_t rows = std::max<std::uint64_t>(1, 65536 / stride_);
    std::vector<std::uint8_t> buffer(static_cast<std::size_t>(rows * stride_));
    for (std::uint64_t done = 0; done < points_;) {
      const std::uint64_t part = std::min(rows, points_ - done);
      if (bytes_.read(std::span(buffer).first(static_cast<std::size_t>(part * stride_))) < part * stride_)
        ends_early(done);
      sink_.reached(bytes_.position());
      for (std::uint64_t i = 0; i < part; ++i) {
        const std::uint8_t* const row = buffer.data() + i * stride_;
        sink_.add({value(row + places_[0].offset, places_[0]), value(row + places_[1].offset, places_[1]),
                   value(row + places_[2].offset, places_[2])});
      }
      done += part;
    }
    check_end();
  }

  // Some bytes of padding do no harm; another point is one that the header has forgotten.
  void check_end() const {
    if (bytes_.left() >= stride_)
      refuse(name_,
             fmt::format("its header tells of {} points but there are {} bytes behind them", points_, bytes_.left()),
             "mend the numbers in its header");
  }

  // Two lengths, then LZF of all first fields, all second fields, ...
  void read_compressed() {
    std::array<std::uint8_t, 8> lengths{};
    if (bytes_.read(lengths) < lengths.size()) ends_early(0);
    const auto length = [&](std::size_t at) {
      return static_cast<std::uint64_t>(
          number_at(Component::u32, lengths.data() + at, std::endian::native != std::endian::little));
    };
    const std::uint64_t packed = length(0), unpacked = length(4);
    if (packed > bytes_.left())
      refuse(name_, fmt::format("tells of {} compressed bytes but there are {}", packed, bytes_.left()), kCutOff);
    if (points_ > unpacked / stride_ || points_ * stride_ != unpacked)
      refuse(name_, fmt::format("tells of {} points of {} bytes, but of {} bytes in all", points_, stride_, unpacked),
             kDamaged);
    if (unpacked / kLzfBest > packed)
      refuse(name_, fmt::format("{} bytes cannot hold the {} that it tells of", packed, unpacked), kDamaged);
    std::vector<std::uint8_t> from(static_cast<std::size_t>(packed)), to(static_cast<std::size_t>(unpacked));
    if (bytes_.read(from) < from.size() || !lzf_unpack(from, to))
      refuse(name_, "its compressed points cannot be unpacked", kDamaged);
    check_end();
    sink_.reached(bytes_.position());
    for (std::uint64_t i = 0; i < points_; ++i) {
      Eigen::Vector3d point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Place& place = places_[axis];
        point[static_cast<Eigen::Index>(axis)] =
            value(to.data() + points_ * place.offset + i * fields_[place.field].size, place);
      }
      sink_.add(point);
    }
  }

  Bytes bytes_;
  const std::string& name_;
  PointSink& sink_;
  std::vector<Field> fields_;
  std::array<Place, 3> places_;
  std::uint64_t points_ = 0;
  std::uint64_t stride_ = 0, words_ = 0;  // bytes and numbers of a point
};

}  // namespace

void read_pcd_points(const InputFile& file, const std::string& name, PointSink& sink) {
  PcdReader(file, name, sink).read();
}

}  // namespace blackleaf::detail
