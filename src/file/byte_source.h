// ByteSource: where the bytes of a file come from.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "file/input_file.h"

namespace blackleaf::detail {

// Where the bytes come from: a file or memory.
class ByteSource {
 public:
  ByteSource() = default;
  virtual ~ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  virtual std::uint64_t size() const = 0;
  /// Requires: offset + bytes.size() <= size().
  virtual void read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const = 0;
};

class FileBytes : public ByteSource {
 public:
  explicit FileBytes(const InputFile& file) : file_(file) {}
  std::uint64_t size() const override { return file_.size(); }
  void read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const override { file_.read_at(offset, bytes); }

 private:
  const InputFile& file_;
};

class MemoryBytes : public ByteSource {
 public:
  explicit MemoryBytes(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  void read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const override {
    if (!bytes.empty()) std::memcpy(bytes.data(), bytes_.data() + offset, bytes.size());
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
};

}  // namespace blackleaf::detail
