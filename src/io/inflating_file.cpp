#include "io/inflating_file.h"

#include <algorithm>
#include <new>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "io/header_text.h"

namespace blackleaf::detail {

InflatingFile::InflatingFile(std::filesystem::path name, const std::filesystem::path& file, std::uint64_t offset,
                             std::uint64_t length)
    : name_(std::move(name)), file_(file), at_(offset), end_(offset + length), in_(std::size_t{1} << 17) {
  constexpr int kGzipOrZlib = 15 + 32;
  if (inflateInit2(&stream_, kGzipOrZlib) != Z_OK) throw std::bad_alloc();
}

InflatingFile::~InflatingFile() { inflateEnd(&stream_); }

void InflatingFile::fail_damaged() const {
  refuse(name_, fmt::format("its compressed values are damaged after {} bytes", produced_), kAgain);
}

// The next bytes, one at least; 0 at the end of the data.
std::size_t InflatingFile::some(std::span<std::uint8_t> bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;  // zlib counts in 32 bits
  bytes = bytes.first(std::min(bytes.size(), kMost));
  stream_.next_out = bytes.data();
  stream_.avail_out = static_cast<unsigned>(bytes.size());
  while (stream_.avail_out == bytes.size()) {
    if (stream_.avail_in == 0 && at_ < end_) {
      const auto part = std::span(in_).first(static_cast<std::size_t>(std::min<std::uint64_t>(in_.size(), end_ - at_)));
      file_.read_at(at_, part);
      at_ += part.size();
      stream_.next_in = part.data();
      stream_.avail_in = static_cast<unsigned>(part.size());
    }
    if (stream_.avail_in == 0) {
      // zlib may still hold unpacked bytes or a checksum that it can compare; if not, it says so.
      if (member_ended_) return 0;
    } else if (member_ended_) {
      member_ended_ = false;
      if (inflateReset(&stream_) != Z_OK) fail_damaged();
    }
    const int status = inflate(&stream_, Z_NO_FLUSH);
    if (status == Z_STREAM_END) {
      member_ended_ = true;
    } else if (status == Z_BUF_ERROR && stream_.avail_in == 0 && at_ == end_) {
      refuse(name_, fmt::format("its compressed values were cut off after {} bytes", produced_), kAgain);
    } else if (status != Z_OK) {
      fail_damaged();
    }
  }
  const std::size_t got = bytes.size() - stream_.avail_out;
  produced_ += got;
  return got;
}

void InflatingFile::read(std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const std::size_t got = some(bytes);
    if (got == 0)
      refuse(name_, fmt::format("its compressed values are {} bytes, fewer than its header tells of", produced_),
             "the file was cut off or its header is damaged; get it again from its source");
    bytes = bytes.subspan(got);
  }
}

std::uint64_t InflatingFile::finish(std::uint64_t most) {
  std::vector<std::uint8_t> scratch(std::size_t{1} << 16);
  std::uint64_t left = 0;
  // To the end of this member: only there is its checksum.
  while (!member_ended_ && left < most) left += some(scratch);
  try {
    for (std::size_t got = 1; left < most && got > 0; left += got) got = some(scratch);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_input) throw;  // padding, or whatever else is no gzip data
  }
  return left;
}

}  // namespace blackleaf::detail
