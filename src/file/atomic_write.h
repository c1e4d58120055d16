// Writing files so that a crash or an error leaves the old file or the new one, never a part of either.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

namespace blackleaf::detail {

/// A file that is written under a temporary name beside its target and takes the target's name when it is complete.
///
///   AtomicFile file(path);             // creates an empty temporary in the target's folder
///   file.write(bytes);                 // or: let a library write to file.temporary()
///   file.commit();                     // fsync, the stop check (stop_check.h), rename, fsync of the folder
///
/// Destruction without commit() removes the temporary. A target that is a symbolic link is followed: the link stays and
/// what it points to is replaced. An existing target keeps its permissions. Folders, devices and pipes are refused, and
/// so is a file that is write-protected. All members throw Error(io) with the target's name.
class AtomicFile {
 public:
  /// `suffix`: how the temporary's name must end, for libraries that go by it (e.g. ".nii.gz").
  explicit AtomicFile(const std::filesystem::path& target, std::string_view suffix = ".tmp");
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  void write(std::span<const std::uint8_t> bytes);
  void commit();

 private:
  [[noreturn]] void fail(int error) const;

  std::filesystem::path named_, target_, temporary_;  // as the caller named it; with links followed; beside the latter
  std::optional<mode_t> mode_;                        // permissions of the file that is replaced
  int descriptor_ = -1;
  bool committed_ = false;
};

/// Writes a whole file through AtomicFile; a target that is a device or a pipe (/dev/stdout) is written to directly.
void write_atomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace blackleaf::detail
