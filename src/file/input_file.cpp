#include "file/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/stop_check.h"

namespace blackleaf::detail {

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
  struct stat status {};
  const int error = ::fstat(descriptor_, &status) != 0 ? errno : S_ISDIR(status.st_mode) ? EISDIR : 0;
  if (error != 0) {
    ::close(descriptor_);
    fail(error);
  }
  regular_ = S_ISREG(status.st_mode);
  if (regular_) size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::fail(int error) const {
  const std::string name = path_.string();
  if (error == ENOENT) throw Error(ErrorCode::io, fmt::format("{}: no such file", name), "check the name");
  if (error == EISDIR)
    throw Error(ErrorCode::io, fmt::format("{}: is a folder, not a file", name), "name a file in it");
  throw Error(ErrorCode::io, fmt::format("{}: cannot be read: {}", name, std::generic_category().message(error)),
              error == EACCES ? "its permissions forbid it" : "");
}

std::size_t InputFile::read_some(std::span<std::uint8_t> bytes) {
  for (;;) {
    const ssize_t got = ::read(descriptor_, bytes.data(), bytes.size());
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) fail(errno);
    check_for_stop();
  }
}

void InputFile::read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const ssize_t got = ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got < 0) {
      if (errno != EINTR) fail(errno);
      check_for_stop();
      continue;
    }
    if (got == 0)
      throw Error(ErrorCode::io, fmt::format("{}: became shorter while it was read", path_.string()), "read it again");
    offset += static_cast<std::uint64_t>(got);
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

}  // namespace blackleaf::detail
