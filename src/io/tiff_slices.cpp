// The only file that sees libtiff.
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"
#include "io/picture_slices.h"
#include "io/stack_source.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAgain = "get it again from its source";
constexpr const char* kConvert = "save it as gray values of 8, 16 or 32 bits";

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const std::string& remedy) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path.string(), what), remedy);
}

struct Closer {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Handle = std::unique_ptr<TIFF, Closer>;

Handle open(const fs::path& path) {
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  Handle tiff(TIFFOpen(path.c_str(), "r"));
  if (!tiff) refuse(path, "cannot be read as TIFF", kAgain);
  return tiff;
}

template <class T>
T field(TIFF* tiff, ttag_t tag, T otherwise) {
  T value{};
  return TIFFGetField(tiff, tag, &value) == 1 ? value : otherwise;
}
template <class T>
T field_or_default(TIFF* tiff, ttag_t tag) {
  T value{};
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

std::optional<Component> component_of(unsigned bits, unsigned format) {
  const bool is_signed = format == SAMPLEFORMAT_INT;
  if (format == SAMPLEFORMAT_IEEEFP)
    return bits == 32 ? std::optional(Component::f32) : bits == 64 ? std::optional(Component::f64) : std::nullopt;
  if (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_VOID && !is_signed) return std::nullopt;
  switch (bits) {
    case 1:
    case 2:
    case 4:
      return is_signed ? std::nullopt : std::optional(Component::u8);
    case 8:
      return is_signed ? Component::i8 : Component::u8;
    case 16:
      return is_signed ? Component::i16 : Component::u16;
    case 32:
      return is_signed ? Component::i32 : Component::u32;
    case 64:
      return is_signed ? Component::i64 : Component::u64;
    default:
      return std::nullopt;
  }
}

// How many times its size a packing can shrink values at the very best.
double most_packed(std::uint16_t packing) {
  switch (packing) {
    case COMPRESSION_NONE:
      return 1;
    case COMPRESSION_PACKBITS:
      return 64;
    case COMPRESSION_DEFLATE:
    case COMPRESSION_ADOBE_DEFLATE:
      return 1040;
    case COMPRESSION_LZW:
      return 4096;
    default:
      return 1e6;  // fax codes, zstd, LZMA and JPEG shrink blank pictures without a bound worth telling
  }
}

// The page that libtiff stands at.
Picture page_of(TIFF* tiff, const fs::path& path, std::uint64_t file_bytes) {
  const auto width = field(tiff, TIFFTAG_IMAGEWIDTH, std::uint32_t{0});
  const auto height = field(tiff, TIFFTAG_IMAGELENGTH, std::uint32_t{0});
  const auto bits = field_or_default<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE);
  const auto samples = field_or_default<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL);
  const auto format = field_or_default<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT);
  const auto packing = field_or_default<std::uint16_t>(tiff, TIFFTAG_COMPRESSION);
  const auto meaning = field(tiff, TIFFTAG_PHOTOMETRIC, std::uint16_t{PHOTOMETRIC_MINISBLACK});
  if (width == 0 || height == 0) refuse(path, fmt::format("has no voxels ({} x {})", width, height), kAgain);
  if (meaning == PHOTOMETRIC_PALETTE) refuse(path, "has a palette of colours", kConvert);
  if (samples != 1)
    refuse(path,
           samples == 2   ? "has an alpha channel"
           : samples <= 4 ? "is in colours"
                          : fmt::format("has {} numbers a pixel", samples),
           kConvert);
  if (meaning != PHOTOMETRIC_MINISBLACK && meaning != PHOTOMETRIC_MINISWHITE && meaning != PHOTOMETRIC_MASK)
    refuse(path, "is not in gray values", kConvert);
  if (const auto place = field(tiff, TIFFTAG_ORIENTATION, std::uint16_t{ORIENTATION_TOPLEFT});
      place != ORIENTATION_TOPLEFT)
    refuse(path, fmt::format("is to be shown turned or mirrored (its orientation is {})", place),
           "save it as it is to be seen, with orientation 1");
  const auto component = component_of(bits, format);
  const bool turned = meaning == PHOTOMETRIC_MINISWHITE;
  if (!component || (turned && (format != SAMPLEFORMAT_UINT || bits > 16)))
    refuse(path,
           fmt::format("has {}values of {} bits{}", format == SAMPLEFORMAT_IEEEFP ? "floating-point " : "", bits,
                       turned ? ", white being 0" : ""),
           kConvert);
  if (TIFFIsCODECConfigured(packing) == 0)
    refuse(path, fmt::format("is compressed in a way that is not known here ({})", packing),
           "save it uncompressed or with deflate");
  if (static_cast<double>(width) * height * bits / 8 > most_packed(packing) * static_cast<double>(file_bytes))
    refuse(
        path,
        fmt::format("its header tells of {} x {} pixels, more than its {} bytes can hold", width, height, file_bytes),
        "the file was cut off or its header is damaged; get it again from its source");
  return {width, height, *component};
}

// Whether the file holds all of the directory that libtiff stands at, up to the place of the next one. Without that
// place libtiff takes the directory for the last.
bool is_whole_directory(TIFF* tiff, const InputFile& file) {
  const bool big = TIFFIsBigTIFF(tiff) != 0;
  const std::uint64_t at = TIFFCurrentDirOffset(tiff), bytes = file.size();
  const std::size_t count_bytes = big ? 8 : 2, entry_bytes = big ? 20 : 12, place_bytes = big ? 8 : 4;
  if (at > bytes || bytes - at < count_bytes + place_bytes) return false;
  std::array<std::uint8_t, 8> written{};
  file.read_at(at, {written.data(), count_bytes});
  std::uint64_t entries = 0;
  for (std::size_t i = 0; i < count_bytes; ++i)
    entries = entries << 8 | written[TIFFIsBigEndian(tiff) != 0 ? i : count_bytes - 1 - i];
  return entries <= (bytes - at - count_bytes - place_bytes) / entry_bytes;
}

TiffFile header_of(const fs::path& path) {
  const InputFile input(path);
  const std::uint64_t bytes = input.size();
  const Handle tiff = open(path);
  TiffFile result;
  std::string description;
  std::array<double, 2> resolution{};
  std::uint32_t directory = 0;
  for (bool is_last = false; !is_last; ++directory) {
    // libtiff takes a chain that cannot be read for its end, so it is asked before whether the chain goes on.
    if (directory > 0 && TIFFReadDirectory(tiff.get()) != 1)
      refuse(path, fmt::format("is damaged behind page {}", directory), kAgain);
    if (!is_whole_directory(tiff.get(), input))
      refuse(path, fmt::format("is cut off in page {}", directory + 1), kAgain);
    is_last = TIFFLastDirectory(tiff.get()) != 0;
    const auto kind = field(tiff.get(), TIFFTAG_SUBFILETYPE, std::uint32_t{0});
    if (directory == 0) {
      if (const char* text = field<char*>(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, nullptr)) description = text;
      resolution = {double{field(tiff.get(), TIFFTAG_XRESOLUTION, 0.0F)},
                    double{field(tiff.get(), TIFFTAG_YRESOLUTION, 0.0F)}};
    }
    if ((kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0) {
      result.pages.push_back(page_of(tiff.get(), path, bytes));
      result.directories.push_back(directory);
    }
  }
  if (result.pages.empty()) refuse(path, "has no full picture", kAgain);
  result.spacing = spacing_of_description(path.string(), description, resolution, result.pages.size());
  return result;
}

// What the other process tells of each file: this, then the text or the pages.
struct HeaderAnswer {
  std::uint64_t error_size = 0, pages = 0;
  ErrorCode code = ErrorCode::bad_input;
  bool has_spacing = false;
  std::array<double, 3> spacing{};
};

void answer_header(const fs::path& path, const Answer& answer) {
  HeaderAnswer head;
  TiffFile file;
  std::string error_text;
  try {
    file = header_of(path);
  } catch (const Error& error) {
    file = {};
    error_text = error.what();
    head.code = error.code();
  }
  head.error_size = error_text.size();
  head.pages = file.pages.size();
  head.has_spacing = file.spacing.has_value();
  head.spacing = file.spacing.value_or(std::array<double, 3>{});
  answer.write(&head, sizeof head);
  answer.write(error_text.data(), error_text.size());
  answer.write(file.pages.data(), file.pages.size() * sizeof file.pages[0]);
  answer.write(file.directories.data(), file.directories.size() * sizeof file.directories[0]);
}

// One row of 1, 2 or 4 bits a value, the first in the highest bits.
void unpack(const std::uint8_t* packed, std::size_t count, unsigned bits, std::uint8_t* values) {
  const unsigned mask = (1u << bits) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t bit = i * bits;
    values[i] = static_cast<std::uint8_t>(packed[bit / 8] >> (8 - bits - bit % 8) & mask);
  }
}

template <class T>
void turn(void* values, std::size_t count, unsigned bits) {
  const auto most = static_cast<T>((1u << bits) - 1);
  auto* each = static_cast<T*>(values);
  for (std::size_t i = 0; i < count; ++i) each[i] = static_cast<T>(most - each[i]);
}

}  // namespace

std::vector<TiffFile> read_tiff_headers(const std::vector<fs::path>& files) {
  std::uint64_t largest = 0, total = 0;
  for (const fs::path& file : files) {
    const std::uint64_t bytes = InputFile(file).size();
    largest = std::max(largest, bytes);
    total += bytes;
  }
  const IsolatedLimits limits{(std::uint64_t{512} << 20) + 2 * largest, 10 + files.size() / 20 + (total >> 20)};
  Isolated child(limits, [&](const Answer& answer) {
    for (const fs::path& file : files) answer_header(file, answer);
  });
  std::vector<TiffFile> result(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    HeaderAnswer head;
    std::string error_text;
    if (!child.read(&head, sizeof head) || !read_items(child, head.error_size, error_text) ||
        !read_items(child, head.pages, result[i].pages) || !read_items(child, head.pages, result[i].directories))
      fail_abnormally(child, files[i].string());
    if (head.error_size > 0) throw Error(head.code, error_text);
    if (head.has_spacing) result[i].spacing = head.spacing;
  }
  return result;
}

struct TiffDecoder::Tiff {
  fs::path path;
  Handle handle;
  std::uint32_t directory = 0;
  std::vector<std::uint8_t> part;
};

TiffDecoder::TiffDecoder() : tiff_(std::make_unique<Tiff>()) {}
TiffDecoder::~TiffDecoder() = default;

void TiffDecoder::decode(const fs::path& path, const Picture& page, std::uint32_t directory, void* values) {
  const auto damaged = [&] { refuse(path, "is damaged: its values cannot be unpacked", kAgain); };
  if (tiff_->path != path || tiff_->directory > directory) {
    tiff_->handle = open(path);
    tiff_->path = path;
    tiff_->directory = 0;
  }
  TIFF* tiff = tiff_->handle.get();
  for (; tiff_->directory < directory; ++tiff_->directory)
    if (TIFFReadDirectory(tiff) != 1) damaged();
  if (page_of(tiff, path, InputFile(path).size()) != page)
    refuse(path, "has changed while it was read", "read it again");

  const auto bits = field_or_default<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE);
  const auto width = static_cast<std::size_t>(page.width), height = static_cast<std::size_t>(page.height);
  const std::size_t value_bytes = bytes_of(page.component);
  auto* to = static_cast<std::uint8_t*>(values);
  // `count` values of a row from `packed` to column x of row y.
  const auto put = [&](const std::uint8_t* packed, std::size_t count, std::size_t x, std::size_t y) {
    std::uint8_t* row = to + (y * width + x) * value_bytes;
    if (bits < 8)
      unpack(packed, count, bits, row);
    else
      std::memcpy(row, packed, count * value_bytes);
  };
  std::vector<std::uint8_t>& part = tiff_->part;
  if (TIFFIsTiled(tiff) != 0) {
    const auto tile_width = field(tiff, TIFFTAG_TILEWIDTH, std::uint32_t{0});
    const auto tile_height = field(tiff, TIFFTAG_TILELENGTH, std::uint32_t{0});
    const auto tile_bytes = static_cast<std::uint64_t>(TIFFTileSize64(tiff));
    const std::size_t row_bytes = (std::size_t{tile_width} * bits + 7) / 8;
    if (tile_width == 0 || tile_height == 0 || tile_bytes < row_bytes * tile_height) damaged();
    // Tiles may be larger than the picture, but there is no reason for very large ones.
    if (tile_bytes > std::max<std::uint64_t>(4 * width * height * value_bytes, std::uint64_t{1} << 26)) damaged();
    part.resize(static_cast<std::size_t>(tile_bytes));
    for (std::size_t y = 0; y < height; y += tile_height)
      for (std::size_t x = 0; x < width; x += tile_width) {
        if (TIFFReadTile(tiff, part.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0) < 0)
          damaged();
        const std::size_t rows = std::min<std::size_t>(tile_height, height - y);
        const std::size_t columns = std::min<std::size_t>(tile_width, width - x);
        for (std::size_t i = 0; i < rows; ++i) put(part.data() + i * row_bytes, columns, x, y + i);
      }
  } else {
    const auto row_bytes = static_cast<std::uint64_t>(TIFFScanlineSize64(tiff));
    if (row_bytes != (width * bits + 7) / 8) damaged();
    part.resize(static_cast<std::size_t>(row_bytes));
    for (std::size_t y = 0; y < height; ++y) {
      if (TIFFReadScanline(tiff, part.data(), static_cast<std::uint32_t>(y), 0) < 0) damaged();
      put(part.data(), width, 0, y);
    }
  }
  if (field(tiff, TIFFTAG_PHOTOMETRIC, std::uint16_t{PHOTOMETRIC_MINISBLACK}) == PHOTOMETRIC_MINISWHITE) {
    if (value_bytes == 1)
      turn<std::uint8_t>(values, width * height, bits);
    else
      turn<std::uint16_t>(values, width * height, bits);
  }
}

}  // namespace blackleaf::detail
