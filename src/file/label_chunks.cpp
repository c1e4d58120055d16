#include "file/label_chunks.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "file/damage.h"
#include "file/octree_format.h"

namespace blackleaf::detail {
namespace {

using namespace format;
using Bytes = std::vector<std::uint8_t>;

constexpr int kCompressionLevel = 9;

void put_varint(Bytes& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(value | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

// Bytes and varints out of one zstd frame, through a small buffer.
class FrameReader {
 public:
  explicit FrameReader(std::span<const std::uint8_t> frame)
      : context_(ZSTD_createDCtx()), input_{frame.data(), frame.size(), 0}, out_(std::size_t{1} << 16) {
    if (!context_) throw std::bad_alloc();
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  }

  std::uint64_t varint() {
    return read_varint([&] { return byte(); }, [](const char* what) { throw Damage{std::string("a number ") + what}; });
  }

  void expect_end() {
    if (at_ != end_ || refill()) throw Damage{"bytes follow its last run"};
    if (input_.pos != input_.size) throw Damage{"bytes follow its compressed data"};
  }

 private:
  struct FreeContext {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };

  std::uint8_t byte() {
    if (at_ == end_ && !refill()) throw Damage{"its compressed data hold less than its voxels"};
    return out_[at_++];
  }

  // False at the end of the frame.
  bool refill() {
    at_ = end_ = 0;
    while (end_ == 0 && !frame_ended_) {
      ZSTD_outBuffer output{out_.data(), out_.size(), 0};
      const std::size_t before = input_.pos;
      const std::size_t code = ZSTD_decompressStream(context_.get(), &output, &input_);
      if (ZSTD_isError(code)) throw Damage{fmt::format("cannot be decompressed ({})", ZSTD_getErrorName(code))};
      frame_ended_ = code == 0;
      end_ = output.pos;
      if (end_ == 0 && !frame_ended_ && input_.pos == before) throw Damage{"its compressed data end too early"};
    }
    return end_ > 0;
  }

  std::unique_ptr<ZSTD_DCtx, FreeContext> context_;
  ZSTD_inBuffer input_;
  Bytes out_;
  std::size_t at_ = 0, end_ = 0;
  bool frame_ended_ = false;
};

}  // namespace

Bytes encode_labels(std::span<const Run> runs) {
  std::vector<std::uint32_t> labels;
  for (const Run& run : runs) labels.push_back(run.colour);
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());

  Bytes raw;
  put_varint(raw, labels.size());
  std::uint32_t last = 0;
  for (const std::uint32_t label : labels) put_varint(raw, label - std::exchange(last, label));
  for (const Run& run : runs) {
    put_varint(raw,
               static_cast<std::uint64_t>(std::lower_bound(labels.begin(), labels.end(), run.colour) - labels.begin()));
    put_varint(raw, run.count);
  }
  Bytes bytes(ZSTD_compressBound(raw.size()));
  const std::size_t size = ZSTD_compress(bytes.data(), bytes.size(), raw.data(), raw.size(), kCompressionLevel);
  if (ZSTD_isError(size)) throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(size)));
  bytes.resize(size);
  return bytes;
}

void decode_labels(std::span<const std::uint8_t> bytes, std::uint64_t voxels,
                   const std::function<void(std::uint64_t, std::uint32_t)>& visit) {
  FrameReader in(bytes);
  const std::uint64_t count = in.varint();
  if (count < 2 || count > voxels) throw Damage{fmt::format("has {} labels", count)};
  std::vector<std::uint32_t> labels;  // grows as the labels come, never by what is claimed
  std::uint64_t label = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t step = in.varint();
    label += step;
    if ((i > 0 && step == 0) || label > 0xFFFFFFFFu) throw Damage{"its labels are not in order"};
    labels.push_back(static_cast<std::uint32_t>(label));
  }
  std::vector<bool> seen(labels.size(), false);
  std::uint64_t last = count;
  while (voxels > 0) {
    const std::uint64_t index = in.varint(), length = in.varint();
    if (index >= count || index == last) throw Damage{"a run has no label of its own"};
    if (length == 0) throw Damage{"a run has no length"};
    if (length > voxels) throw Damage{"its runs add up to more than its voxels"};
    seen[index] = true;
    visit(length, labels[index]);
    last = index;
    voxels -= length;
  }
  in.expect_end();
  if (std::find(seen.begin(), seen.end(), false) != seen.end()) throw Damage{"tells of a label that does not occur"};
}

}  // namespace blackleaf::detail
