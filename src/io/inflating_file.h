// InflatingFile: gzip and zlib data unpacked as they are read, with nothing believed that their checksums do not hold.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "file/input_file.h"

namespace blackleaf::detail {

class InflatingFile {
 public:
  /// The bytes [offset, offset + length) of `file`: gzip members one behind the other, or one zlib stream. Messages
  /// begin with `name`. Requires: the file has so many bytes.
  InflatingFile(std::filesystem::path name, const std::filesystem::path& file, std::uint64_t offset,
                std::uint64_t length);
  ~InflatingFile();
  InflatingFile(const InflatingFile&) = delete;
  InflatingFile& operator=(const InflatingFile&) = delete;

  /// Exactly the next bytes. Throws Error(bad_input) when the data are damaged or end before that.
  void read(std::span<std::uint8_t> bytes);
  /// Unpacks what is left, at most `most` bytes of it, and returns how many bytes that was. Throws Error(bad_input)
  /// when the member that held the last byte read is damaged; what comes after it and is no gzip data does not matter.
  std::uint64_t finish(std::uint64_t most);

 private:
  std::size_t some(std::span<std::uint8_t> bytes);
  [[noreturn]] void fail_damaged() const;

  std::filesystem::path name_;
  InputFile file_;
  std::uint64_t at_, end_;  // in the file
  std::uint64_t produced_ = 0;
  z_stream stream_{};
  bool member_ended_ = false;
  std::vector<std::uint8_t> in_;
};

}  // namespace blackleaf::detail
