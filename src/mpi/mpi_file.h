// MpiFile: one rank's hold on a file, through MPI-IO.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace blackleaf::mpi {

/// A box of a volume in a file: the values [low, high) on every axis of `size` values of `value_bytes`, x fastest, the
/// first at `offset`.
struct FileBox {
  std::uint64_t offset = 0;
  std::size_t value_bytes = 1;
  std::array<std::int64_t, 3> size{}, low{}, high{};
};

/// Opened by each rank for itself (MPI_COMM_SELF), so that one that cannot open it fails alone, and says so. All
/// members throw Error(io) that begins with `shown`, the name that messages give.
class MpiFile {
 public:
  enum class Mode { read, write };

  MpiFile(const std::string& path, const std::filesystem::path& shown, Mode mode);
  ~MpiFile();
  MpiFile(const MpiFile&) = delete;
  MpiFile& operator=(const MpiFile&) = delete;

  void write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) const;
  /// All values of a box, x fastest, as they stand in the file. Requires: room for them.
  void read_box(const FileBox& box, std::uint8_t* values) const;
  /// What was written is on disk.
  void sync() const;

 private:
  [[noreturn]] void fail(int error) const;

  struct Handle;
  std::unique_ptr<Handle> handle_;
  std::filesystem::path shown_;
  Mode mode_;
};

}  // namespace blackleaf::mpi
