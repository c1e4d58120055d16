// Silhouettes from PNG images. The only file that sees libpng.
#include <png.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/silhouettes_file.h"
#include "file/input_file.h"

namespace blackleaf {
namespace {

// Deflate makes at most 1032 bytes of one, and a pixel has at least one bit.
constexpr std::uint64_t kPixelsPerByte = 8 * 1032;

// One line of libpng's reason.
std::string reason(const char* message) {
  std::string text;
  for (const char* c = message; *c != 0; ++c) text += std::isprint(static_cast<unsigned char>(*c)) ? *c : ' ';
  return text.empty() ? "no reason given" : text;
}

// The image without what it says of how bright its values are to be shown: libpng would change them by it, and a value
// above half is object whatever the gamma. Damaged files are left for libpng to complain of.
std::vector<std::uint8_t> with_plain_values(const std::vector<std::uint8_t>& bytes) {
  constexpr std::size_t kSignature = 8, kAround = 12;  // around a chunk's data: length, type and checksum
  std::vector<std::uint8_t> result(bytes.begin(), bytes.begin() + kSignature);
  std::size_t at = kSignature;
  while (bytes.size() - at >= kAround) {
    const std::size_t length = std::size_t{bytes[at]} << 24 | std::size_t{bytes[at + 1]} << 16 |
                               std::size_t{bytes[at + 2]} << 8 | std::size_t{bytes[at + 3]};
    const std::string_view type(reinterpret_cast<const char*>(bytes.data()) + at + 4, 4);
    if (type == "IDAT" || length > bytes.size() - at - kAround) break;
    const auto chunk = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    at += kAround + length;
    if (type != "gAMA" && type != "sRGB" && type != "iCCP" && type != "cHRM")
      result.insert(result.end(), chunk, bytes.begin() + static_cast<std::ptrdiff_t>(at));
  }
  result.insert(result.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end());
  return result;
}

struct Freer {
  void operator()(png_image* image) const { png_image_free(image); }
};

}  // namespace

void read_silhouette_image(const std::filesystem::path& path, Silhouette& silhouette) {
  const std::string name = path.string();
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw Error(ErrorCode::bad_input, name + ": " + what, remedy);
  };
  detail::InputFile file(path);
  if (!file.is_regular()) throw Error(ErrorCode::io, name + ": is not an ordinary file", "copy it to one first");
  constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 31;
  if (file.size() > kLargestFile) refuse("has more than 2^31 bytes", "make it smaller");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(file.size()));
  file.read_at(0, bytes);

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, Freer> freer(&image);
  const auto fail = [&] {
    refuse(fmt::format("cannot be read as PNG: {}", reason(image.message)), "the file is damaged or no PNG image");
  };
  if (bytes.size() < 8 || png_sig_cmp(bytes.data(), 0, 8) != 0) refuse("is not a PNG image", "convert it to PNG");
  bytes = with_plain_values(bytes);
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) fail();
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  if (pixels >= std::uint64_t{1} << 28)
    refuse(fmt::format("has {} x {} pixels", image.width, image.height), "scale it down to less than 2^28 pixels");
  // Sixteen bits are to be taken as eight are, by their values as they stand; libpng would have them linear in light.
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  if (pixels > bytes.size() * kPixelsPerByte)
    refuse(fmt::format("tells of {} x {} pixels but has only {} bytes", image.width, image.height, bytes.size()),
           "the file was cut off, get it again");

  const bool has_alpha = (image.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  image.format = PNG_FORMAT_GA;  // gray and alpha, 8 bits each, palettes, colours and 16 bits turned into those
  std::vector<std::uint8_t> values(2 * static_cast<std::size_t>(pixels));
  if (png_image_finish_read(&image, nullptr, values.data(), 0, nullptr) == 0) fail();

  bool see_through = false;
  for (std::size_t i = 1; has_alpha && i < values.size() && !see_through; i += 2) see_through = values[i] < 255;
  silhouette.width = static_cast<std::int32_t>(image.width);
  silhouette.height = static_cast<std::int32_t>(image.height);
  silhouette.pixels.resize(static_cast<std::size_t>(pixels));
  const std::size_t channel = see_through ? 1 : 0;
  for (std::size_t i = 0; i < silhouette.pixels.size(); ++i) silhouette.pixels[i] = values[2 * i + channel] > 127;
}

std::vector<std::uint8_t> to_png(const Silhouette& silhouette) {
  assert(silhouette.width > 0 && silhouette.height > 0);
  assert(silhouette.pixels.size() ==
         static_cast<std::size_t>(silhouette.width) * static_cast<std::size_t>(silhouette.height));
  std::vector<std::uint8_t> values(silhouette.pixels.size());
  std::transform(silhouette.pixels.begin(), silhouette.pixels.end(), values.begin(),
                 [](std::uint8_t pixel) { return pixel != 0 ? std::uint8_t{255} : std::uint8_t{0}; });
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(silhouette.width);
  image.height = static_cast<png_uint_32>(silhouette.height);
  image.format = PNG_FORMAT_GRAY;
  const std::unique_ptr<png_image, Freer> freer(&image);
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));  // more than it takes
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, values.data(), 0, nullptr) == 0)
    throw Error(ErrorCode::bad_argument, "a silhouette cannot be written as PNG: " + reason(image.message),
                "make it smaller");
  bytes.resize(size);
  return bytes;
}

}  // namespace blackleaf
