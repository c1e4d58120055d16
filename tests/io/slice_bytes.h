// DICOM, PNG and TIFF files written by hand, so that the readers are not tested against the libraries that they use.
#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace blackleaf::test {

/// A number's bytes, least first.
template <class T>
std::string little(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}
template <class T>
std::string big(T value) {
  const std::string bytes = little(value);
  return {bytes.rbegin(), bytes.rend()};
}

/// An element of explicit VR, little endian.
inline std::string element(std::uint16_t group, std::uint16_t number, const char* type, std::string value) {
  const std::string vr = type;
  if (value.size() % 2 != 0) value += vr == "UI" || vr == "OB" ? '\0' : ' ';
  const bool wide = vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN";
  const auto size = static_cast<std::uint32_t>(value.size());
  return little(group) + little(number) + vr +
         (wide ? std::string(2, '\0') + little(size) : little(static_cast<std::uint16_t>(size))) + value;
}
inline std::string item(const std::string& content) {
  return little(std::uint16_t{0xfffe}) + little(std::uint16_t{0xe000}) +
         little(static_cast<std::uint32_t>(content.size())) + content;
}
inline std::string decimals(const std::vector<double>& numbers) {
  std::vector<std::string> words;
  for (const double number : numbers) words.push_back(fmt::format("{:.12g}", number));
  return fmt::format("{}", fmt::join(words, "\\"));
}

/// One DICOM file; a CT slice unless told otherwise.
struct DicomBytes {
  std::string sop_class = "1.2.840.10008.5.1.4.1.1.2", series = "1.2.3.4", description = "test";
  std::string syntax = "1.2.840.10008.1.2.1";
  int columns = 1, rows = 1, frames = 0;  // 0: no number of frames
  int allocated = 16, stored = 16, high = 15, is_signed = 0, samples = 1;
  std::string meaning = "MONOCHROME2";
  std::vector<double> position, orientation = {1, 0, 0, 0, 1, 0}, spacing = {1, 1};
  std::string slope, intercept;
  double thickness = 0, between = 0;
  int number = 0;
  std::string groups;  // functional groups: elements of group 5200
  std::string doses;   // elements of group 3004
  std::string pixels;
  bool encapsulated = false;  // pixels are a sequence of fragments
  bool deflated = false;      // all but the meta information

  std::string bytes() const {
    const std::string meta = element(2, 0x01, "OB", std::string("\0\1", 2)) + element(2, 0x02, "UI", sop_class) +
                             element(2, 0x03, "UI", "1.2.3.9") + element(2, 0x10, "UI", syntax);
    const auto us = [](int value) { return little(static_cast<std::uint16_t>(value)); };
    std::string set = element(8, 0x16, "UI", sop_class) + element(8, 0x18, "UI", "1.2.3.9") +
                      element(8, 0x60, "CS", "CT") + element(8, 0x103e, "LO", description);
    if (thickness != 0) set += element(0x18, 0x50, "DS", decimals({thickness}));
    if (between != 0) set += element(0x18, 0x88, "DS", decimals({between}));
    set += element(0x20, 0x0d, "UI", "1.2.3") + element(0x20, 0x0e, "UI", series);
    if (number != 0) set += element(0x20, 0x13, "IS", std::to_string(number));
    if (!position.empty())
      set += element(0x20, 0x32, "DS", decimals(position)) + element(0x20, 0x37, "DS", decimals(orientation));
    set += element(0x28, 0x02, "US", us(samples)) + element(0x28, 0x04, "CS", meaning);
    if (samples > 1) set += element(0x28, 0x06, "US", us(0));
    if (frames > 0) set += element(0x28, 0x08, "IS", std::to_string(frames));
    set += element(0x28, 0x10, "US", us(rows)) + element(0x28, 0x11, "US", us(columns));
    if (!position.empty()) set += element(0x28, 0x30, "DS", decimals(spacing));
    set += element(0x28, 0x100, "US", us(allocated)) + element(0x28, 0x101, "US", us(stored)) +
           element(0x28, 0x102, "US", us(high)) + element(0x28, 0x103, "US", us(is_signed));
    if (!intercept.empty()) set += element(0x28, 0x1052, "DS", intercept);
    if (!slope.empty()) set += element(0x28, 0x1053, "DS", slope);
    set += doses + groups;
    if (encapsulated)
      set += little(std::uint16_t{0x7fe0}) + little(std::uint16_t{0x10}) + "OB" + std::string(2, '\0') +
             little(0xffffffffu) + pixels + little(std::uint16_t{0xfffe}) + little(std::uint16_t{0xe0dd}) +
             little(std::uint32_t{0});
    else
      set += element(0x7fe0, 0x10, allocated == 8 ? "OB" : "OW", pixels);
    if (deflated) {
      z_stream stream{};
      deflateInit2(&stream, 9, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
      std::string packed(deflateBound(&stream, set.size()), '\0');
      stream.next_in = reinterpret_cast<Bytef*>(set.data());
      stream.avail_in = static_cast<uInt>(set.size());
      stream.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream, Z_FINISH);
      packed.resize(stream.total_out);
      deflateEnd(&stream);
      set = packed;
    }
    return std::string(128, '\0') + "DICM" + element(2, 0x00, "UL", little(static_cast<std::uint32_t>(meta.size()))) +
           meta + set;
  }
};

/// A gray PNG file, or one of another colour type; `values` are its rows without filter bytes.
inline std::string png_bytes(std::uint32_t width, std::uint32_t height, int bits, const std::string& values,
                             int colour = 0, const std::string& more = {}) {
  const auto chunk = [](const std::string& name, const std::string& content) {
    const std::string both = name + content;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(both.data()), static_cast<uInt>(both.size()));
    return big(static_cast<std::uint32_t>(content.size())) + both + big(static_cast<std::uint32_t>(crc));
  };
  std::string rows;
  const std::size_t row = values.size() / height;
  for (std::size_t y = 0; y < height; ++y) rows += '\0' + values.substr(y * row, row);
  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
            static_cast<uLong>(rows.size()), 9);
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR",
               big(width) + big(height) + static_cast<char>(bits) + static_cast<char>(colour) + std::string(3, '\0')) +
         more + chunk("IDAT", packed) + chunk("IEND", "");
}

/// One page of a TIFF file.
struct TiffPage {
  std::uint32_t width = 1, height = 1;
  int bits = 8, format = 1, samples = 1, meaning = 1, kind = 0;
  std::string values;  // rows, each from a byte of its own
  std::string description;
  double pixels_a_unit = 0;  // 0: no resolution
  std::uint32_t tile = 0;    // side of the tiles; 0: one strip
  bool deflate = false;
};

/// A TIFF file of these pages, little or big endian (values are then expected so, too).
inline std::string tiff_bytes(const std::vector<TiffPage>& pages, bool big_endian = false) {
  const auto u16 = [&](std::uint16_t v) { return big_endian ? big(v) : little(v); };
  const auto u32 = [&](std::uint32_t v) { return big_endian ? big(v) : little(v); };
  std::string file = (big_endian ? "MM" : "II") + u16(42) + u32(0);
  std::size_t link = 4;  // where the next directory's place is to be written
  for (const TiffPage& page : pages) {
    const std::size_t value_bytes = static_cast<std::size_t>(page.bits * page.samples) / 8;
    std::vector<std::string> parts = {page.values};
    if (page.tile > 0) {
      parts.clear();
      for (std::uint32_t y = 0; y < page.height; y += page.tile)
        for (std::uint32_t x = 0; x < page.width; x += page.tile) {
          std::string part(page.tile * page.tile * value_bytes, '\x55');
          for (std::uint32_t r = 0; r < page.tile && y + r < page.height; ++r)
            for (std::uint32_t c = 0; c < page.tile && x + c < page.width; ++c)
              part.replace((r * page.tile + c) * value_bytes, value_bytes,
                           page.values.substr(((y + r) * page.width + x + c) * value_bytes, value_bytes));
          parts.push_back(part);
        }
    }
    std::string places, sizes;
    for (std::string& part : parts) {
      if (page.deflate) {
        uLongf size = compressBound(static_cast<uLong>(part.size()));
        std::string packed(size, '\0');
        compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(part.data()),
                  static_cast<uLong>(part.size()), 6);
        part = packed.substr(0, size);
      }
      places += u32(static_cast<std::uint32_t>(file.size()));
      sizes += u32(static_cast<std::uint32_t>(part.size()));
      file += part + std::string(part.size() % 2, '\0');
    }
    std::vector<std::string> entries;
    const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t count, std::string value) {
      if (value.size() > 4) {
        const std::string place = u32(static_cast<std::uint32_t>(file.size()));
        file += value + std::string(value.size() % 2, '\0');
        value = place;
      }
      value.resize(4, '\0');
      entries.push_back(u16(tag) + u16(type) + u32(count) + value);
    };
    const auto brief = [&](std::uint16_t tag, int value) { entry(tag, 3, 1, u16(static_cast<std::uint16_t>(value))); };
    const auto count = static_cast<std::uint32_t>(parts.size());
    if (page.kind != 0) entry(254, 4, 1, u32(static_cast<std::uint32_t>(page.kind)));
    entry(256, 4, 1, u32(page.width));
    entry(257, 4, 1, u32(page.height));
    brief(258, page.bits);
    brief(259, page.deflate ? 8 : 1);
    brief(262, page.meaning);
    if (!page.description.empty())
      entry(270, 2, static_cast<std::uint32_t>(page.description.size() + 1), page.description + '\0');
    if (page.tile == 0) entry(273, 4, count, places);
    brief(277, page.samples);
    if (page.tile == 0) {
      entry(278, 4, 1, u32(page.height));
      entry(279, 4, count, sizes);
    }
    if (page.pixels_a_unit > 0)
      for (const std::uint16_t tag : {std::uint16_t{282}, std::uint16_t{283}})
        entry(tag, 5, 1, u32(static_cast<std::uint32_t>(page.pixels_a_unit * 1000)) + u32(1000));
    if (page.meaning == 3) entry(320, 3, 768, std::string(1536, '\1'));
    if (page.tile > 0) {
      entry(322, 4, 1, u32(page.tile));
      entry(323, 4, 1, u32(page.tile));
      entry(324, 4, count, places);
      entry(325, 4, count, sizes);
    }
    brief(339, page.format);
    const std::size_t place = file.size();
    file.replace(link, 4, u32(static_cast<std::uint32_t>(place)));
    file += u16(static_cast<std::uint16_t>(entries.size()));
    for (const std::string& each : entries) file += each;
    link = file.size();
    file += u32(0);
  }
  return file;
}

}  // namespace blackleaf::test
