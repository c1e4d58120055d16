// Points as text: a point a line.
#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "io/file_text.h"
#include "io/point_readers.h"

namespace blackleaf::detail {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

class TextReader {
 public:
  TextReader(const InputFile& file, const std::string& name, PointSink& sink)
      : bytes_(file, 0), name_(name), sink_(sink) {}

  void read() {
    std::string text;
    while (bytes_.line(text)) {
      std::string_view line = text;
      if (bytes_.line_number() == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
      line = trimmed(line.substr(0, line.find("//")));
      if (line.empty()) continue;
      split(line);
      if (fields_.size() == 1 && count(fields_[0])) continue;
      if (!begun_ && columns_by_name()) continue;
      begun_ = true;
      point(line);
    }
    if (told_ && found_ != *told_)
      refuse(name_, fmt::format("tells of {} points but has {}", *told_, found_), found_ < *told_ ? kCutOff : kDamaged);
    if (found_ == 0) refuse(name_, "has no points", "give a file with a point a line");
  }

 private:
  [[noreturn]] void fail(const std::string& what, const char* remedy) const {
    refuse(name_, fmt::format("line {} {}", bytes_.line_number(), what), remedy);
  }

  // Fields are separated by semicolons if there are any, else by commas if there are any, else by blanks. So a comma in
  // a number shows as a field that holds two, or none.
  void split(std::string_view line) {
    fields_.clear();
    const char separator = line.find(';') != std::string_view::npos   ? ';'
                           : line.find(',') != std::string_view::npos ? ','
                                                                      : ' ';
    if (separator == ' ') {
      WordsOfLine words(line);
      for (std::string_view word = words.next(); !word.empty(); word = words.next()) fields_.push_back(word);
      return;
    }
    for (;;) {
      const std::size_t end = line.find(separator);
      fields_.push_back(trimmed(line.substr(0, end)));
      if (end == std::string_view::npos) return;
      line.remove_prefix(end + 1);
    }
  }

  // A line of one whole number: how many points follow. A file may have several such parts.
  bool count(std::string_view field) {
    const std::optional<std::uint64_t> points = whole_number(field);
    if (!points) return false;
    if (found_ != told_.value_or(0))
      fail(fmt::format("tells of {} more points, after {} instead of {}", *points, found_, told_.value_or(0)),
           "a point needs three numbers");
    if (*points > bytes_.left())
      fail(fmt::format("tells of {} points but there are {} bytes", *points, bytes_.left()), kCutOff);
    told_ = told_.value_or(0) + *points;
    return true;
  }

  // Names in place of numbers, which may stand in the first line.
  bool columns_by_name() {
    if (std::any_of(fields_.begin(), fields_.end(), [](std::string_view field) { return decimal(field).has_value(); }))
      return false;
    std::array<std::optional<std::size_t>, 3> columns;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      std::string_view field = fields_[i];
      if (field.size() >= 2 && (field.front() == '"' || field.front() == '\'') && field.back() == field.front())
        field = field.substr(1, field.size() - 2);
      const std::string column = lower(std::string(field));
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (column.size() == 1 && column[0] == "xyz"[axis] && !columns[axis]) columns[axis] = i;
    }
    if (!columns[0] || !columns[1] || !columns[2]) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) columns_[axis] = *columns[axis];
    begun_ = true;
    return true;
  }

  void point(std::string_view line) {
    Eigen::Vector3d p;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::optional<double> value =
          columns_[axis] < fields_.size() ? decimal(fields_[columns_[axis]]) : std::nullopt;
      if (!value) {
        std::string shown(line.substr(0, 40));
        std::replace_if(
            shown.begin(), shown.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7F; }, '?');
        fail(fmt::format("is \"{}\", which has no {}", shown, "xyz"[axis]),
             "give x, y and z as decimal numbers with points");
      }
      p[static_cast<Eigen::Index>(axis)] = *value;
    }
    ++found_;
    sink_.reached(bytes_.position());
    sink_.add(p);
  }

  Bytes bytes_;
  const std::string& name_;
  PointSink& sink_;
  std::vector<std::string_view> fields_;
  std::array<std::size_t, 3> columns_ = {0, 1, 2};
  bool begun_ = false;  // names or points have been read
  std::uint64_t found_ = 0;
  std::optional<std::uint64_t> told_;
};

}  // namespace

void read_text_points(const InputFile& file, const std::string& name, PointSink& sink) {
  TextReader(file, name, sink).read();
}

}  // namespace blackleaf::detail
