#include "blackleaf/silhouettes_file.h"

#include <png.h>
#include <zlib.h>

#include <array>

#include "blackleaf/error.h"
#include "file/temporary_folder.h"

namespace blackleaf::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

class SilhouettesFile : public ::testing::Test {
 protected:
  // Values as libpng's simplified interface has them, `format` one of PNG_FORMAT_*.
  void write_png(const std::string& name, std::uint32_t width, std::uint32_t height, std::uint32_t format,
                 const Bytes& values, const Bytes& colours = {}) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = format;
    image.colormap_entries = static_cast<std::uint32_t>(colours.size() / 3);
    ASSERT_NE(png_image_write_to_file(&image, (folder_ / name).c_str(), 0, values.data(), 0, colours.data()), 0)
        << image.message;
  }
  void write_gray(const std::string& name, std::uint32_t width, std::uint32_t height, std::uint8_t value = 255) const {
    write_png(name, width, height, PNG_FORMAT_GRAY, Bytes(std::size_t{width} * height, value));
  }
  Bytes pixels(const std::string& name) const {
    Silhouette s;
    read_silhouette_image(folder_ / name, s);
    EXPECT_EQ(s.pixels.size(), static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height));
    return s.pixels;
  }
  SilhouetteSet set(const std::string& text, std::optional<int> depth = {}, const std::string& name = "v.json") const {
    write_file(folder_ / name, text);
    return read_silhouettes(folder_ / name, depth);
  }
  void refused(const std::string& text, const std::vector<std::string>& pieces,
               ErrorCode code = ErrorCode::bad_input) const {
    expect_error(code, pieces, [&] { set(text); });
  }

  TemporaryFolder folder_;
};

TEST_F(SilhouettesFile, BrighterThanHalfIsObject) {
  write_png("gray.png", 4, 1, PNG_FORMAT_GRAY, {0, 127, 128, 255});
  EXPECT_EQ(pixels("gray.png"), (Bytes{0, 0, 1, 1}));
  // Green looks brighter than blue.
  write_png("rgb.png", 4, 1, PNG_FORMAT_RGB, {255, 255, 255, 0, 255, 0, 0, 0, 255, 100, 100, 100});
  EXPECT_EQ(pixels("rgb.png"), (Bytes{1, 1, 0, 0}));
  write_png("map.png", 4, 1, PNG_FORMAT_RGB_COLORMAP, {0, 1, 2, 1}, {9, 9, 9, 250, 250, 250, 40, 40, 40});
  EXPECT_EQ(pixels("map.png"), (Bytes{0, 1, 0, 1}));
}

// Whatever a file says of how bright its values are to be shown, it is the values that count.
TEST_F(SilhouettesFile, GammaIsNotApplied) {
  const auto chunk = [](const std::string& name, const std::string& content) {
    const std::string both = name + content;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(both.data()), static_cast<uInt>(both.size()));
    const auto big = [](std::uint32_t value) {
      return std::string{static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
                         static_cast<char>(value)};
    };
    return big(static_cast<std::uint32_t>(content.size())) + both + big(static_cast<std::uint32_t>(crc));
  };
  const std::string linear("\0\1\x86\xa0", 4), steep("\0\0\x27\x10", 4), srgb("\0", 1);
  write_png("plain.png", 4, 1, PNG_FORMAT_GRAY, {60, 127, 128, 190});
  const std::string plain = read_text(folder_ / "plain.png");
  const std::size_t behind_header = 8 + 25;
  for (const std::string& more : {chunk("gAMA", linear), chunk("gAMA", steep), chunk("sRGB", srgb),
                                  chunk("gAMA", steep) + chunk("tEXt", std::string("Title\0x", 7))}) {
    write_file(folder_ / "g.png", plain.substr(0, behind_header) + more + plain.substr(behind_header));
    EXPECT_EQ(pixels("g.png"), (Bytes{0, 0, 1, 1}));
  }
}

TEST_F(SilhouettesFile, WhereThereIsAnAlphaChannelOpaqueIsObject) {
  write_png("ga.png", 4, 1, PNG_FORMAT_GA, {255, 0, 0, 255, 0, 128, 255, 127});
  EXPECT_EQ(pixels("ga.png"), (Bytes{0, 1, 1, 0}));
  // A channel that is opaque throughout says nothing; many programs write one.
  write_png("opaque.png", 3, 1, PNG_FORMAT_RGBA, {0, 0, 0, 255, 255, 255, 255, 255, 10, 10, 10, 255});
  EXPECT_EQ(pixels("opaque.png"), (Bytes{0, 1, 0}));
}

TEST_F(SilhouettesFile, RowsRunDownward) {
  write_png("rows.png", 2, 3, PNG_FORMAT_GRAY, {255, 0, 0, 0, 0, 255});
  Silhouette s;
  read_silhouette_image(folder_ / "rows.png", s);
  EXPECT_EQ(s.width, 2);
  EXPECT_EQ(s.height, 3);
  EXPECT_EQ(s.pixels, (Bytes{1, 0, 0, 0, 0, 1}));
}

TEST_F(SilhouettesFile, SixteenBitsCountByTheirValues) {
  std::FILE* const file = std::fopen((folder_ / "values.png").c_str(), "wb");
  ASSERT_NE(file, nullptr);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, 4, 1, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::array<png_byte, 8> row = {0x38, 0x00, 0x7F, 0x00, 0x81, 0x00, 0xFF, 0xFF};
  png_write_row(png, row.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  EXPECT_EQ(pixels("values.png"), (Bytes{0, 0, 1, 1}));
}

TEST_F(SilhouettesFile, SixteenBitsLinearInLight) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 2;
  image.height = 1;
  image.format = PNG_FORMAT_LINEAR_Y;
  const std::array<std::uint16_t, 2> linear = {2000, 60000};
  ASSERT_NE(png_image_write_to_file(&image, (folder_ / "deep.png").c_str(), 0, linear.data(), 0, nullptr), 0);
  EXPECT_EQ(pixels("deep.png"), (Bytes{0, 1}));
}

TEST_F(SilhouettesFile, JsonAndTomlSayTheSame) {
  write_gray("a.png", 4, 2);
  write_gray("b.png", 3, 3, 0);
  const SilhouetteSet json = set(R"({"depth": 5, "views": [
      {"image": "a.png", "view": [1, 2.5, -3], "up": "front", "pixel_size": 0.25}, {"image": "b.png"}]})");
  const SilhouetteSet toml =
      set("depth = 5\n[[views]]\nimage = \"a.png\"\nview = [1, 2.5, -3]\nup = \"front\"\npixel_size = 0.25\n"
          "[[views]] # a comment\nimage = \"b.png\"\n",
          {}, "v.toml");
  for (const SilhouetteSet& s : {json, toml}) {
    EXPECT_EQ(s.depth, 5);
    ASSERT_EQ(s.silhouettes.size(), 2u);
    const Silhouette &a = s.silhouettes[0], &b = s.silhouettes[1];
    EXPECT_EQ(a.view, Eigen::Vector3d(1, 2.5, -3));
    EXPECT_EQ(a.up, Eigen::Vector3d(0, -1, 0));
    EXPECT_EQ(a.pixel_size, 0.25);
    EXPECT_EQ(a.pixels, Bytes(8, 1));
    EXPECT_EQ(b.view, Eigen::Vector3d(0, -1, 0));  // the first view without one
    EXPECT_FALSE(b.up || b.pixel_size);
    EXPECT_EQ(b.pixels, Bytes(9, 0));
  }
}

TEST_F(SilhouettesFile, ThreeImagesAreFrontRightAndTop) {
  write_gray("a.png", 33, 20);
  const SilhouetteSet s = set(R"({"views": ["a.png", {"image": "a.png"}, "a.png"]})");
  EXPECT_EQ(s.depth, 6);  // the smallest with a voxel a pixel
  ASSERT_EQ(s.silhouettes.size(), 3u);
  EXPECT_EQ(s.silhouettes[0].view, Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(s.silhouettes[1].view, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(s.silhouettes[2].view, Eigen::Vector3d(0, 0, 1));
  refused(R"({"views": ["a.png", "a.png", "a.png", "a.png"]})", {"v.json", "views[3].view", "missing"});
}

TEST_F(SilhouettesFile, AnotherDepthKeepsTheProportions) {
  write_gray("a.png", 8, 8);
  const std::string text = R"({"depth": 4, "views": [{"image": "a.png", "pixel_size": 1.5}, {"image": "a.png"}]})";
  const SilhouetteSet finer = set(text, 6);
  EXPECT_EQ(finer.depth, 6);
  EXPECT_EQ(finer.silhouettes[0].pixel_size, 6.0);
  EXPECT_FALSE(finer.silhouettes[1].pixel_size);
  EXPECT_EQ(set(text, 3).silhouettes[0].pixel_size, 0.75);
  // Without a depth of the file's own, pixel sizes are in voxels of the depth that is asked for.
  EXPECT_EQ(set(R"({"views": [{"image": "a.png", "pixel_size": 1.5}]})", 6).silhouettes[0].pixel_size, 1.5);
}

TEST_F(SilhouettesFile, WrongEntriesAreNamed) {
  write_gray("a.png", 2, 2);
  write_file(folder_ / "text.png", "no picture");
  const auto view = [](const std::string& more) { return R"({"views": [{"image": "a.png", )" + more + "}]}"; };
  refused("[1]", {"v.json", "no table of entries"});
  refused("{\n\"views\": [\n", {"v.json: is not JSON: line 3"});
  refused("{}", {"views is missing"});
  refused(R"({"views": []})", {"views is no list"});
  refused(R"({"views": "a.png"})", {"views is no list"});
  refused(R"({"views": [7]})", {"views[0] is 7"});
  refused(R"({"views": ["a.png"], "dept": 3})", {"dept is unknown", "use depth, views"});
  for (const char* depth : {"0", "21", "3.5", "\"4\"", "-1", "null", "99999999999999999999"})
    refused(R"({"views": ["a.png"], "depth": )" + std::string(depth) + "}", {"depth is "});
  refused(view(R"("views": [1,0,0])"), {"views[0].views is unknown"});
  refused(R"({"views": [{"view": [1,0,0]}]})", {"views[0].image is missing"});
  refused(R"({"views": [{"image": 3}]})", {"views[0].image is 3"});
  refused(R"({"views": ["a.png", ""]})", {"views[1].image is"});
  refused(R"({"views": ["a\u0000.png"]})", {"views[0].image has a zero byte"});
  for (const char* bad : {"[1,0]", "[1,0,0,0]", "7", "\"north\"", "[1,\"0\",0]", "[0,0,0]", "null"}) {
    refused(view(R"("view": )" + std::string(bad)), {"views[0].view is "});
    refused(view(R"("up": )" + std::string(bad)), {"views[0].up is "});
  }
  refused(view(R"("view": [2,4,-6], "up": [-1,-2,3])"), {"views[0].up is parallel to the view"});
  for (const char* bad : {"0", "-1", "1e300", "1e-30", "\"1\"", "[1]", "true"})
    refused(view(R"("pixel_size": )" + std::string(bad)), {"views[0].pixel_size is "});
  refused(R"({"views": ["none.png"]})", {"v.json: views[0].image", "none.png: no such file"}, ErrorCode::io);
  refused(R"({"views": ["."]})", {"views[0].image", "folder"}, ErrorCode::io);
  refused(R"({"views": ["text.png"]})", {"views[0].image", "text.png: is not a PNG image"});
  refused(R"({"views":[{"image":"a.png","view":[1e999,0,1]}]})", {"has a number beyond floating point"});
  refused(R"({"views": )" + std::string(200, '[') + std::string(200, ']') + "}", {"nested too deeply"});
  expect_error(ErrorCode::bad_input, {"v.toml: is not TOML: line 2"},
               [&] { set("depth = 3\nviews = [", {}, "v.toml"); });
  expect_error(ErrorCode::bad_input, {"v.toml: depth is null"}, [&] { set("depth = 1979-05-27", {}, "v.toml"); });
  expect_error(ErrorCode::bad_input, {"views[0].pixel_size"},
               [&] { set("[[views]]\nimage = \"a.png\"\npixel_size = nan", {}, "v.toml"); });
  expect_error(ErrorCode::bad_argument, {"depth 21"}, [&] { set(view(R"("up": "top")"), 21); });
  expect_error(ErrorCode::io, {"no such file"}, [&] { read_silhouettes(folder_ / "nothing.json"); });
}

TEST_F(SilhouettesFile, DamagedImagesNeverCrash) {
  Bytes values(40 * 40);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i * 37);
  write_png("whole.png", 40, 40, PNG_FORMAT_GRAY, values);
  const Bytes whole = read_bytes(folder_ / "whole.png");
  std::size_t refusals = 0;
  const auto attempt = [&](const Bytes& damaged) {
    write_file(folder_ / "damaged.png", damaged);
    try {
      pixels("damaged.png");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_NE(std::string(error.what()).find("damaged.png"), std::string::npos);
      ++refusals;
    }
  };
  // Pixels end sixteen bytes before the file does: the checksum of the compressed data, and the chunk IEND.
  const std::size_t needed = whole.size() - 16;
  for (std::size_t size = 0; size < needed; size += 7) attempt({whole.begin(), whole.begin() + std::ptrdiff_t(size)});
  EXPECT_EQ(refusals, (needed + 6) / 7);  // every cut shows
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    Bytes damaged = whole;
    damaged[at] ^= 0x41;
    attempt(damaged);
  }
  // A header of 100,000 x 2,000 pixels, with a good checksum, over the data of 40 x 40.
  Bytes huge = whole;
  const Bytes size = {0, 1, 0x86, 0xA0, 0, 0, 0x07, 0xD0};
  std::copy(size.begin(), size.end(), huge.begin() + 16);
  std::uint32_t crc = 0xFFFFFFFF;
  for (std::size_t i = 12; i < 29; ++i) {
    crc ^= huge[i];
    for (int k = 0; k < 8; ++k) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320 : crc >> 1;
  }
  for (std::size_t i = 0; i < 4; ++i) huge[29 + i] = static_cast<std::uint8_t>(~crc >> (24 - 8 * i));
  write_file(folder_ / "huge.png", huge);
  expect_error(ErrorCode::bad_input, {"100000 x 2000 pixels", "bytes"}, [&] { pixels("huge.png"); });
}

}  // namespace
}  // namespace blackleaf::test
