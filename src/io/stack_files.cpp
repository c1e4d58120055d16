#include "io/stack_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"
#include "io/image_io.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

const char* kind_name(SliceKind kind) {
  return kind == SliceKind::dicom ? "DICOM" : kind == SliceKind::png ? "PNG" : "TIFF";
}

// A name with '#' for every number in it, and those numbers as texts.
std::pair<std::string, std::vector<std::string>> pattern_of(const std::string& name) {
  std::pair<std::string, std::vector<std::string>> result;
  for (std::size_t i = 0; i < name.size();) {
    if (!is_digit(name[i])) {
      result.first += name[i++];
      continue;
    }
    std::size_t end = i;
    while (end < name.size() && is_digit(name[end])) ++end;
    result.first += '#';
    result.second.push_back(name.substr(i, end - i));
    i = end;
  }
  return result;
}

}  // namespace

SliceKind promised_kind(const fs::path& path) {
  const std::string suffix = image_suffix(path);
  if (suffix == ".png") return SliceKind::png;
  if (suffix == ".tif" || suffix == ".tiff") return SliceKind::tiff;
  if (suffix == ".dcm" || suffix == ".dicom" || suffix == ".ima") return SliceKind::dicom;
  return SliceKind::none;
}

SliceKind slice_kind(const fs::path& path) {
  std::array<std::uint8_t, 132> head{};
  InputFile file(path);
  if (!file.is_regular()) return SliceKind::none;
  std::size_t size = 0;
  while (size < head.size()) {
    const std::size_t got = file.read_some(std::span(head).subspan(size));
    if (got == 0) break;
    size += got;
  }
  const std::string_view bytes(reinterpret_cast<const char*>(head.data()), size);
  using namespace std::string_view_literals;
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return SliceKind::png;
  // The second of each is BigTIFF.
  for (const auto magic : {"II*\0"sv, "II+\0"sv, "MM\0*"sv, "MM\0+"sv})
    if (bytes.starts_with(magic)) return SliceKind::tiff;
  if (bytes.size() == head.size() && bytes.substr(128) == "DICM") return SliceKind::dicom;
  // Old DICOM files begin at once with an element of group 2 or 8, with its type in two letters or a small length.
  if (bytes.size() == head.size() && (head[0] == 2 || head[0] == 8) && head[1] == 0 && head[2] <= 0x18 &&
      head[3] == 0) {
    const bool typed = std::isupper(head[4]) != 0 && std::isupper(head[5]) != 0;
    const bool small = head[5] == 0 && head[6] == 0 && head[7] == 0 && head[4] <= 64 && head[4] % 2 == 0;
    if (typed || small) return SliceKind::dicom;
  }
  return SliceKind::none;
}

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (is_digit(a[i]) && is_digit(b[k])) {
      while (i < a.size() && a[i] == '0') ++i;
      while (k < b.size() && b[k] == '0') ++k;
      std::size_t a_end = i, b_end = k;
      while (a_end < a.size() && is_digit(a[a_end])) ++a_end;
      while (b_end < b.size() && is_digit(b[b_end])) ++b_end;
      // Without leading zeros the longer number is the larger one.
      if (a_end - i != b_end - k) return a_end - i < b_end - k;
      const int order = a.substr(i, a_end - i).compare(b.substr(k, b_end - k));
      if (order != 0) return order < 0;
      i = a_end;
      k = b_end;
    } else {
      if (a[i] != b[k]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[k]);
      ++i;
      ++k;
    }
  }
  if (i < a.size() || k < b.size()) return k < b.size();
  return a < b;
}

std::string some_of(const std::vector<std::string>& names) {
  if (names.size() <= 1) return names.empty() ? std::string() : names[0];
  if (names.size() == 2) return names[0] + " and " + names[1];
  return fmt::format("{}, {} and {} more", names[0], names[1], names.size() - 2);
}

StackFiles find_slices(const fs::path& folder) {
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", folder.string(), what), remedy);
  };
  std::vector<fs::path> all;
  std::size_t folders = 0;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    if (i->path().filename().string().starts_with('.')) continue;
    std::error_code none;
    if (i->is_directory(none))
      ++folders;
    else
      all.push_back(i->path());
  }
  if (error)
    throw Error(ErrorCode::io, fmt::format("{}: its files cannot be listed: {}", folder.string(), error.message()),
                "check its permissions");
  std::sort(all.begin(), all.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  std::array<std::vector<fs::path>, 4> of_kind;  // by SliceKind
  for (const fs::path& file : all) {
    const bool plain = fs::is_regular_file(file, error);  // opening a pipe could wait for ever
    of_kind[static_cast<std::size_t>(plain ? slice_kind(file) : SliceKind::none)].push_back(file);
  }
  const auto& [others, dicom, png, tiff] = of_kind;

  StackFiles result;
  if (!dicom.empty()) {
    result.kind = SliceKind::dicom;
  } else if (!png.empty() && !tiff.empty()) {
    refuse(fmt::format("holds both PNG and TIFF pictures ({} and {})", png[0].filename().string(),
                       tiff[0].filename().string()),
           "keep the slices of one volume in a folder of their own");
  } else if (!png.empty() || !tiff.empty()) {
    result.kind = png.empty() ? SliceKind::tiff : SliceKind::png;
  } else {
    const std::string remedy = "name a folder with the slices of a volume: DICOM, TIFF or PNG files";
    if (folders > 0)
      refuse(fmt::format("holds no slices itself, but {} folder{}", folders, folders == 1 ? "" : "s"), remedy);
    if (all.empty()) refuse("is an empty folder", remedy);
    for (const fs::path& file : others)
      if (const SliceKind promised = promised_kind(file); promised != SliceKind::none)
        throw Error(ErrorCode::bad_input, fmt::format("{}: is not a {} file", file.string(), kind_name(promised)),
                    "its contents are not what its name says; check where it comes from");
    refuse(fmt::format("holds no slices: its {} file{} neither DICOM nor TIFF nor PNG", all.size(),
                       all.size() == 1 ? " is" : "s are"),
           remedy);
  }
  for (const fs::path& file : others)
    if (promised_kind(file) == result.kind)
      throw Error(ErrorCode::bad_input, fmt::format("{}: is not a {} file", file.string(), kind_name(result.kind)),
                  "get it again from its source, or remove it from the stack");
  for (std::size_t kind = 0; kind < of_kind.size(); ++kind)
    if (kind != static_cast<std::size_t>(result.kind))
      for (const fs::path& file : of_kind[kind]) result.passed_over.push_back(file.filename().string());
  result.files = std::move(of_kind[static_cast<std::size_t>(result.kind)]);
  return result;
}

std::string oddity_of_names(const std::vector<fs::path>& files) {
  if (files.size() < 2) return {};
  std::vector<std::vector<std::string>> numbers;
  const std::string first = files[0].filename().string();
  const std::string pattern = pattern_of(first).first;
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    auto [its_pattern, its_numbers] = pattern_of(name);
    if (its_pattern != pattern)
      return fmt::format(
          "the names of its pictures follow no single pattern ({} and {}); all {} are taken as one stack", first, name,
          files.size());
    numbers.push_back(std::move(its_numbers));
  }
  // Where exactly one number varies, it should do so in equal steps.
  std::optional<std::size_t> varying;
  for (std::size_t column = 0; column < numbers[0].size(); ++column)
    if (std::any_of(numbers.begin(), numbers.end(),
                    [&](const auto& row) { return row[column] != numbers[0][column]; })) {
      if (varying) return {};
      varying = column;
    }
  if (!varying) return {};
  std::vector<std::uint64_t> values;
  for (const auto& row : numbers) {
    constexpr std::size_t kMostDigits = 18;  // fits 64 bits
    if (row[*varying].size() > kMostDigits) return {};
    values.push_back(std::stoull(row[*varying]));
  }
  std::uint64_t step = values[1] - values[0];
  for (std::size_t i = 1; i < values.size(); ++i) step = std::min(step, values[i] - values[i - 1]);
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] != step)
      return fmt::format("its pictures are not numbered evenly: {} follows {}; all {} are taken as one stack",
                         files[i].filename().string(), files[i - 1].filename().string(), files.size());
  return {};
}

}  // namespace blackleaf::detail
