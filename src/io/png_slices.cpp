// The only file that sees libpng.
#include <png.h>
#include <setjmp.h>

#include <array>
#include <cstdio>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"
#include "io/picture_slices.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAgain = "get it again from its source";

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const std::string& remedy) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path.string(), what), remedy);
}

// libpng leaves by longjmp: this function has nothing that would need destroying.
bool read_rows(std::FILE* file, const Picture& picture, png_bytep* rows) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  if (!png) return false;
  png_infop info = png_create_info_struct(png);
  if (!info || setjmp(png_jmpbuf(png)) != 0) {  // NOLINT(cert-err52-cpp): libpng has no other way
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  // Sizes are believed already; chunks of text and colour profiles are of no use.
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
  png_init_io(png, file);
  png_read_info(png, info);
  if (png_get_image_width(png, info) != picture.width || png_get_image_height(png, info) != picture.height ||
      png_get_channels(png, info) != 1)
    png_error(png, "changed");
  png_set_packing(png);
  if (png_get_bit_depth(png, info) == 16) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

}  // namespace

Picture png_header(const fs::path& path) {
  // Signature, then the header's chunk: length 13, "IHDR", width, height, bits, colour type, packing.
  std::array<std::uint8_t, 33> head{};
  const InputFile file(path);
  if (!file.is_regular() || file.size() < head.size()) refuse(path, "is cut off", kAgain);
  file.read_at(0, head);
  const auto number = [&](std::size_t at) {
    return std::int64_t{head[at]} << 24 | head[at + 1] << 16 | head[at + 2] << 8 | head[at + 3];
  };
  constexpr std::int64_t kHeaderName = 0x49484452;  // "IHDR"
  if (number(8) != 13 || number(12) != kHeaderName) refuse(path, "has no PNG header", kAgain);
  const int bits = head[24], colour = head[25];
  const std::string convert = "save it as gray values, 8 or 16 bits each";
  if (colour == 3) refuse(path, "has a palette of colours", convert);
  if (colour == 2 || colour == 6) refuse(path, "is in colours", convert);
  if (colour == 4) refuse(path, "has an alpha channel", convert);
  if (colour != 0 || (bits != 1 && bits != 2 && bits != 4 && bits != 8 && bits != 16))
    refuse(path, "has a damaged header", kAgain);
  Picture picture{number(16), number(20), bits == 16 ? Component::u16 : Component::u8};
  if (picture.width <= 0 || picture.height <= 0 || picture.width > 0x7fffffff || picture.height > 0x7fffffff)
    refuse(path, fmt::format("has no voxels ({} x {})", picture.width, picture.height), kAgain);
  // deflate packs 1032 bytes into one at the very best.
  const double bytes = static_cast<double>(picture.width) * static_cast<double>(picture.height) * bits / 8;
  if (bytes > 1040 * static_cast<double>(file.size()))
    refuse(path,
           fmt::format("its header tells of {} x {} pixels, more than its {} bytes can hold", picture.width,
                       picture.height, file.size()),
           "the file was cut off or its header is damaged; get it again from its source");
  return picture;
}

void decode_png(const fs::path& path, const Picture& picture, void* values) {
  const std::size_t row_bytes = static_cast<std::size_t>(picture.width) * bytes_of(picture.component);
  std::vector<png_bytep> rows(static_cast<std::size_t>(picture.height));
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = static_cast<png_bytep>(values) + y * row_bytes;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), std::fclose);
  if (!file) throw Error(ErrorCode::io, path.string() + ": cannot be read", "check its permissions");
  if (!read_rows(file.get(), picture, rows.data())) refuse(path, "is damaged: its values cannot be unpacked", kAgain);
}

}  // namespace blackleaf::detail
