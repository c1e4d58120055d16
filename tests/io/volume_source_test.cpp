// Slices that are read one by one, against ITK's reading of the whole file: the same values, whatever the format, type,
// byte order and packing.
#include "io/volume_source.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "io/volume_shape.h"
#include "nrrd_text.h"

namespace blackleaf {
namespace {

namespace fs = std::filesystem;
using detail::Component;
using test::expect_error;

std::string packed(const std::string& bytes, bool gzip, int level = 6) {
  z_stream stream{};
  deflateInit2(&stream, level, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<unsigned>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<unsigned>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

struct Type {
  Component component;
  const char *nrrd, *meta;
  std::int16_t nifti;
};
constexpr std::array<Type, 10> kTypes = {{{Component::u8, "uint8", "MET_UCHAR", 2},
                                          {Component::i8, "int8", "MET_CHAR", 256},
                                          {Component::u16, "uint16", "MET_USHORT", 512},
                                          {Component::i16, "int16", "MET_SHORT", 4},
                                          {Component::u32, "uint32", "MET_UINT", 768},
                                          {Component::i32, "int32", "MET_INT", 8},
                                          {Component::u64, "uint64", "MET_ULONG_LONG", 1280},
                                          {Component::i64, "int64", "MET_LONG_LONG", 1024},
                                          {Component::f32, "float", "MET_FLOAT", 16},
                                          {Component::f64, "double", "MET_DOUBLE", 64}}};

class VolumeSources : public testing::Test {
 protected:
  using Size = std::array<std::int16_t, 3>;

  std::mt19937 random_{21};
  std::size_t next_scale_ = 0;
  const test::TemporaryFolder folder_;

  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  // Values in the byte order of a file; floats without NaN and infinities, which the NIfTI library turns into zeros.
  std::string values(const Type& type, const Size& size, bool big) {
    const std::size_t bytes = detail::bytes_of(type.component);
    const auto count = static_cast<std::size_t>(size[0] * size[1] * size[2]);
    std::string result(count * bytes, '\0');
    for (char& c : result) c = static_cast<char>(random_());
    for (std::size_t i = 0; i < count; ++i) {
      if (type.component == Component::f32) {
        const float value = static_cast<float>(pick(-1000, 1000)) / 7;
        std::memcpy(&result[4 * i], &value, 4);
      } else if (type.component == Component::f64) {
        const double value = pick(-1000, 1000) / 7.0;
        std::memcpy(&result[8 * i], &value, 8);
      }
      if (big) std::reverse(&result[i * bytes], &result[i * bytes] + bytes);
    }
    return result;
  }

  static std::string text(const Size& size) {
    return std::to_string(size[0]) + " " + std::to_string(size[1]) + " " + std::to_string(size[2]);
  }

  void nrrd(const std::string& name, const Type& type, const Size& size, bool big, bool gzip, bool detached,
            const std::string& bytes) {
    std::string header = "NRRD0004\n# encoding: hex\ntype: " + std::string(type.nrrd) +
                         "\ndimension: 3\nsizes: " + text(size) + "\nEncoding: " + (gzip ? "GZIP" : "raw") +
                         "\nencoding:=hex\nendian: " + (big ? "big" : "little") + "\n";
    const std::string data = gzip ? packed(bytes, true) : bytes;
    const bool skips = detached && !gzip && pick(0, 1);
    const bool at_end = skips && pick(0, 1);
    if (skips) header += at_end ? "byte skip: -1\n" : "byte skip: 5\n";
    if (detached) {
      test::write_file(folder_ / "data", (skips ? "12345" : "") + data);
      test::write_file(folder_ / name, header + "data file: data\n");
    } else {
      test::write_file(folder_ / name, header + "\n" + data);
    }
  }

  void meta(const std::string& name, const Type& type, const Size& size, bool big, bool zlib, bool detached,
            const std::string& bytes) {
    const std::string data = zlib ? packed(bytes, false) : bytes;
    std::string header = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = " +
                         std::string(big ? "True" : "False") + "\nDimSize = " + text(size) +
                         "\nElementType = " + type.meta + "\n";
    if (zlib) header += "CompressedData = True\nCompressedDataSize = " + std::to_string(data.size()) + "\n";
    const int skip = detached && !zlib ? pick(-1, 1) * 7 : 0;
    if (skip != 0) header += "HeaderSize = " + std::string(skip < 0 ? "-1" : "7") + "\n";
    if (detached) {
      test::write_file(folder_ / "data", (skip != 0 ? "1234567" : "") + data);
      test::write_file(folder_ / name, header + "ElementDataFile = data\n");
    } else {
      test::write_file(folder_ / name, header + "ElementDataFile = LOCAL\n" + data);
    }
  }

  static std::string nifti_header(const Type& type, const Size& size, bool big, bool two_files, float offset,
                                  float slope, float intercept) {
    std::string bytes(two_files ? 348 : 352, '\0');
    const auto put = [&]<class T>(std::size_t at, T value) {
      std::memcpy(bytes.data() + at, &value, sizeof value);
      if (big)
        std::reverse(bytes.begin() + static_cast<long>(at), bytes.begin() + static_cast<long>(at + sizeof value));
    };
    put(0, std::int32_t{348});
    for (std::size_t i = 0; i < 8; ++i)
      put(40 + 2 * i, i == 0 ? std::int16_t{3} : i < 4 ? size[i - 1] : std::int16_t{1});
    put(70, type.nifti);
    put(72, static_cast<std::int16_t>(8 * detail::bytes_of(type.component)));
    for (std::size_t i = 0; i < 8; ++i) put(76 + 4 * i, 1.0F);
    put(108, offset);
    put(112, slope);
    put(116, intercept);
    bytes.replace(344, 3, two_files ? "ni1" : "n+1");
    return bytes;
  }

  void nifti(const std::string& base, const Type& type, const Size& size, bool big, bool gzip, bool two_files,
             const std::string& bytes, float slope, float intercept) {
    const int skip = pick(0, 1) * 16;
    const std::string header =
        nifti_header(type, size, big, two_files, static_cast<float>((two_files ? 0 : 352) + skip), slope, intercept);
    const std::string data = std::string(static_cast<std::size_t>(skip), 'x') + bytes;
    const auto write = [&](const std::string& name, const std::string& content) {
      test::write_file(folder_ / (gzip && name.find(".hdr") == std::string::npos ? name + ".gz" : name),
                       gzip && name.find(".hdr") == std::string::npos ? packed(content, true) : content);
    };
    if (two_files) {
      write(base + ".hdr", header);
      write(base + ".img", data);
    } else {
      write(base + ".nii", header + data);
    }
  }

  // Reads the file both ways, slices a few at a time.
  void expect_same(const std::string& name) {
    const fs::path path = folder_ / name;
    detail::ImageReader reader(path, *detail::image_format(path));
    const auto size = detail::solid_size(reader.information());
    std::vector<std::uint8_t> whole(static_cast<std::size_t>(size[0] * size[1] * size[2]) *
                                    detail::bytes_of(*reader.information().component));
    reader.read(whole.data());
    expect_values(name, reader.information(), whole);
  }

  // The same with the standard's formula in place of the library's reader: slope * stored + intercept in doubles, which
  // are exact for whole numbers of up to 32 bits; no scaling at all where the slope is 0.
  void expect_scaled(const std::string& name, const Type& type, const std::string& bytes, bool big, float slope,
                     float intercept) {
    detail::ImageInformation information =
        detail::ImageReader(folder_ / name, detail::ImageFormat::nifti).information();
    const bool scaled = slope != 0 && (slope != 1 || intercept != 0);
    information.component = scaled ? Component::f64 : type.component;
    std::vector<std::uint8_t> expected;
    const std::size_t each = detail::bytes_of(type.component);
    for (std::size_t at = 0; at < bytes.size(); at += each) {
      std::string one = bytes.substr(at, each);
      if (big) std::reverse(one.begin(), one.end());
      if (scaled) {
        const double stored = detail::with_type_of(type.component, [&]<class T>(T value) {
          std::memcpy(&value, one.data(), sizeof value);
          return static_cast<double>(value);
        });
        const double value = stored * static_cast<double>(slope) + static_cast<double>(intercept);
        one.resize(sizeof value);
        std::memcpy(one.data(), &value, sizeof value);
      }
      expected.insert(expected.end(), one.begin(), one.end());
    }
    expect_values(name, information, expected);
  }

  void expect_values(const std::string& name, const detail::ImageInformation& information,
                     const std::vector<std::uint8_t>& whole) {
    const auto size = detail::solid_size(information);
    const std::size_t slice = static_cast<std::size_t>(size[0] * size[1]) * detail::bytes_of(*information.component);
    const auto source = detail::open_volume(folder_ / name);
    ASSERT_EQ(source->information().size, information.size);
    ASSERT_EQ(source->information().component, information.component);
    std::vector<std::uint8_t> values(whole.size());
    for (std::int64_t z = 0; z < size[2];) {
      const std::int64_t count = std::min<std::int64_t>(size[2] - z, pick(1, 5));
      source->read(count, values.data() + slice * static_cast<std::size_t>(z));
      z += count;
    }
    ASSERT_EQ(values, whole);
  }
};

TEST_F(VolumeSources, EveryTypeOrderAndPacking) {
  for (const Type& type : kTypes)
    for (const bool big : {false, true})
      for (const bool compressed : {false, true})
        for (const bool detached : {false, true}) {
          SCOPED_TRACE(testing::Message() << type.nrrd << (big ? " big" : " little") << (compressed ? " packed" : "")
                                          << (detached ? " detached" : ""));
          const Size size = {static_cast<std::int16_t>(pick(1, 9)), static_cast<std::int16_t>(pick(1, 9)),
                             static_cast<std::int16_t>(pick(1, 9))};
          const std::string bytes = values(type, size, big);
          nrrd("a.nrrd", type, size, big, compressed, detached, bytes);
          expect_same("a.nrrd");
          meta("a.mha", type, size, big, compressed, detached, bytes);
          expect_same("a.mha");
          // Neither slope nor intercept; a slope that is none; and values that are rescaled.
          constexpr std::array<std::pair<float, float>, 8> kScales = {{{0.0F, 0.0F},
                                                                       {1.0F, 0.0F},
                                                                       {0.0F, 3.0F},
                                                                       {1.0F, 0.5F},
                                                                       {0.1F, 0.0F},
                                                                       {-2.5F, 1e-3F},
                                                                       {1e-20F, 0.0F},
                                                                       {1.0F, 1e-17F}}};
          for (int i = 0; i < 3; ++i) {
            const auto [slope, intercept] = kScales[(next_scale_++) % kScales.size()];
            SCOPED_TRACE(testing::Message() << slope << " " << intercept);
            nifti("b", type, size, big, compressed, detached, bytes, slope, intercept);
            expect_scaled(detached ? "b.hdr" : compressed ? "b.nii.gz" : "b.nii", type, bytes, big, slope, intercept);
            fs::remove(folder_ / "b.img");
            fs::remove(folder_ / "b.img.gz");
          }
        }
}

}  // namespace
}  // namespace blackleaf
