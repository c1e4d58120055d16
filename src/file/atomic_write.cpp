#include "file/atomic_write.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/stop_check.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

[[noreturn]] void cannot_write(const fs::path& path, int error) {
  const char* remedy = "";
  if (error == EACCES || error == EPERM || error == EROFS) remedy = "choose a folder that may be written to";
  if (error == ENOENT || error == ENOTDIR) {
    // Folders that the system makes up, like /proc, are there and take no files all the same.
    std::error_code ignored;
    remedy = fs::is_directory(folder_of(path), ignored) ? "choose another folder" : "create the folder first";
  }
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) remedy = "make room or write elsewhere";
  if (error == ELOOP) remedy = "its symbolic links lead in a circle";
  if (error == EISDIR) remedy = "name a file in it";
  throw Error(ErrorCode::io,
              fmt::format("{}: cannot be written: {}", path.string(), std::generic_category().message(error)), remedy);
}

// The file that a name stands for: symbolic links are followed, also one that points to nothing yet.
fs::path follow_links(const fs::path& named) {
  fs::path path = named;
  for (int steps = 0; steps < 40; ++steps) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(path, error))) return path;
    const fs::path next = fs::read_symlink(path, error);
    if (error) cannot_write(named, error.value());
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  cannot_write(named, ELOOP);
}

void write_all(int descriptor, std::span<const std::uint8_t> bytes, const fs::path& named) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) {
        check_for_stop();
        continue;
      }
      cannot_write(named, errno);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target, std::string_view suffix)
    : named_(target), target_(follow_links(target)) {
  struct stat status {};
  if (!target_.has_filename()) fail(EISDIR);
  if (::stat(target_.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) fail(EISDIR);
    if (!S_ISREG(status.st_mode))
      throw Error(ErrorCode::io, fmt::format("{}: cannot be written: it is a device or a pipe", named_.string()),
                  "name an ordinary file");
    if (::access(target_.c_str(), W_OK) != 0)
      throw Error(ErrorCode::io, fmt::format("{}: cannot be written: it is write-protected", named_.string()),
                  "remove it or choose another name");
    mode_ = status.st_mode & 07777;
  }
  std::random_device random;
  for (int attempt = 0; attempt < 100 && descriptor_ < 0; ++attempt) {
    const std::uint64_t number = std::uint64_t{random()} << 32 | random();
    temporary_ = folder_of(target_) / fmt::format(".blackleaf-{:016x}{}", number, suffix);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) fail(errno);
  }
  if (descriptor_ < 0) fail(EEXIST);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!committed_) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(int error) const { cannot_write(named_, error); }

void AtomicFile::write(std::span<const std::uint8_t> bytes) { write_all(descriptor_, bytes, named_); }

void AtomicFile::commit() {
  // Opened anew by name: a library may have replaced the file that the constructor made.
  ::close(descriptor_);
  descriptor_ = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
  if (mode_ && ::fchmod(descriptor_, *mode_) != 0) fail(errno);
  if (::fsync(descriptor_) != 0) fail(errno);
  check_for_stop();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  committed_ = true;
  // The new name is safe once the folder is on disk. Some file systems cannot sync folders; the file is whole anyhow.
  const int folder = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    static_cast<void>(::fsync(folder));
    ::close(folder);
  }
}

void write_atomically(const fs::path& path, std::span<const std::uint8_t> bytes) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
    struct Closer {
      int descriptor;
      ~Closer() { ::close(descriptor); }
    };
    check_for_stop();
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) cannot_write(path, errno);
    const Closer closer{descriptor};
    write_all(descriptor, bytes, path);
    return;
  }
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void write_atomically(const fs::path& path, std::string_view text) {
  write_atomically(path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace blackleaf::detail
