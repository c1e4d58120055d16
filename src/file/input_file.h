// Reading files: opening with clear messages, and reads that never go beyond what is really there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace blackleaf::detail {

/// An open file. Throws Error(io) when it is missing, a folder, or may not be read.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// False for pipes and devices, which have no size and no positions.
  bool is_regular() const { return regular_; }
  /// Bytes in the file when it was opened; 0 unless is_regular().
  std::uint64_t size() const { return size_; }
  /// The next bytes, as many as fit and are there; 0 at the end of the file.
  std::size_t read_some(std::span<std::uint8_t> bytes);
  /// Exactly these bytes; Error(io) when the file has shrunk since it was opened. Requires: is_regular().
  void read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const;

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  int descriptor_ = -1;
  bool regular_ = false;
  std::uint64_t size_ = 0;
};

}  // namespace blackleaf::detail
