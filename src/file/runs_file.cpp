#include "blackleaf/runs_file.h"

#include <array>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/runs.h"
#include "file/atomic_write.h"
#include "file/input_file.h"

namespace blackleaf {
namespace {

constexpr std::uint64_t kLargestUniverse = std::uint64_t{1} << (3 * kMaxDepth);

// Lines to runs: calls take(count, colour) for each, count 0 left out.
template <class Take>
class RunLines {
 public:
  RunLines(const std::filesystem::path& path, Take take) : name_(path.string()), take_(std::move(take)) {}

  void line(std::string_view text) {
    ++line_;
    if (text.ends_with('\r')) text.remove_suffix(1);
    std::string_view rest = text;
    skip_blanks(rest);
    if (rest.empty()) return;
    std::uint64_t count = 0;
    std::uint32_t colour = 0;
    if (!number(rest, count) || !number(rest, colour) || !rest.empty())
      fail("is not \"count colour\", two whole numbers");
    if (count > kLargestUniverse - total_) fail("brings the counts above the 8^20 voxels of the largest universe");
    total_ += count;
    if (count > 0) take_(count, colour);
  }

  [[noreturn]] void fail_next(const std::string& what) {
    ++line_;
    fail(what);
  }

  // The depth of the universe that the runs fill.
  int depth() const {
    if (line_ == 0)
      throw Error(ErrorCode::bad_input, fmt::format("{}: is empty", name_),
                  "write one \"count colour\" line for every run");
    int depth = 1;
    while (depth < kMaxDepth && std::uint64_t{1} << (3 * depth) < total_) ++depth;
    if (total_ != std::uint64_t{1} << (3 * depth))
      throw Error(ErrorCode::bad_input,
                  fmt::format("{}: line {}, the last: the counts add up to {}, which is not 8^n for any n from 1 to 20",
                              name_, line_, total_),
                  "lines are missing or doubled");
    return depth;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: line {} {}", name_, line_, what), "mend or remove the line");
  }

  static void skip_blanks(std::string_view& text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  }

  // Takes a number and the blanks behind it; a number must end at a blank or at the end.
  template <class T>
  static bool number(std::string_view& text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{}) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && text.front() != ' ' && text.front() != '\t') return false;
    skip_blanks(text);
    return true;
  }

  const std::string name_;
  std::uint64_t line_ = 0;
  std::uint64_t total_ = 0;
  Take take_;
};

// Calls take(count, colour) for every run of a file and returns the depth.
template <class Take>
int read_lines(const std::filesystem::path& path, Take take) {
  constexpr std::size_t kLongestLine = 1024;  // far more than two numbers need
  detail::InputFile file(path);
  RunLines<Take> lines(path, std::move(take));
  std::array<std::uint8_t, 1 << 16> buffer;
  std::string carried;  // the beginning of a line whose end is not yet read
  while (const std::size_t got = file.read_some(buffer)) {
    std::string_view text(reinterpret_cast<const char*>(buffer.data()), got);
    for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
      if (carried.empty()) {
        lines.line(text.substr(0, end));
      } else {
        carried += text.substr(0, end);
        lines.line(carried);
        carried.clear();
      }
    }
    carried += text;
    if (carried.size() > kLongestLine) lines.fail_next("has no end; this is not a text file of runs");
  }
  if (!carried.empty()) lines.line(carried);
  return lines.depth();
}

// Writes the runs that for_each(visit) tells of as visit(count, colour).
template <class ForEach>
void write_lines(const std::filesystem::path& path, const ForEach& for_each) {
  detail::AtomicFile file(path);
  fmt::memory_buffer text;
  const auto flush = [&] {
    file.write(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    text.clear();
  };
  for_each([&](std::uint64_t count, std::uint32_t colour) {
    fmt::format_to(fmt::appender(text), "{} {}\n", count, colour);
    if (text.size() > (std::size_t{1} << 16)) flush();
  });
  flush();
  file.commit();
}

}  // namespace

void write_runs(const Octree& octree, const std::filesystem::path& path) {
  write_lines(path, [&](const auto& visit) {
    for_each_run(octree, [&](std::uint64_t count, bool black) { visit(count, black ? 1 : 0); });
  });
}

void write_runs(const LabelMap& labels, const std::filesystem::path& path) {
  write_lines(path, [&](const auto& visit) {
    for (std::size_t run = 0; run < labels.run_count(); ++run) visit(labels.count(run), labels.labels()[run]);
  });
}

Octree read_runs(const std::filesystem::path& path) {
  // As the monochrome form: neighbours of one colour merged, black first.
  std::vector<std::uint64_t> counts;
  const int depth = read_lines(path, [&](std::uint64_t count, std::uint32_t colour) {
    const bool black = colour != 0;
    if (!counts.empty() && black == (counts.size() % 2 == 1)) {
      counts.back() += count;
    } else {
      if (counts.empty() && !black) counts.push_back(0);
      counts.push_back(count);
    }
  });
  return octree_from_monochrome(counts, depth);
}

LabelMap read_label_runs(const std::filesystem::path& path) {
  std::vector<Run> runs;
  const int depth = read_lines(path, [&](std::uint64_t count, std::uint32_t colour) {
    runs.push_back({count, colour});
  });
  return LabelMap(runs, depth);
}

}  // namespace blackleaf
