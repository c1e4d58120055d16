#include "file/old_runs.h"

#include <xxhash.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "blackleaf/runs.h"

namespace blackleaf::detail::format {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Pulls the runs out of the chunks, one at a time, with two small buffers.
class RunReader {
 public:
  RunReader(const ByteSource& source, std::string_view name, const Header& header)
      : source_(source),
        name_(name),
        header_(header),
        context_(ZSTD_createDCtx()),
        hash_(XXH3_createState()),
        voxels_(chunk_voxels(header.depth)),
        in_(std::size_t{1} << 16),
        out_(std::size_t{1} << 16) {
    if (!context_ || !hash_) throw std::bad_alloc();
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  }

  bool next(std::uint64_t& count, bool& black) {
    if (left_ == 0) {
      if (chunk_ == header_.chunks.size()) return false;
      const ChunkEntry& entry = header_.chunks[chunk_];
      if (entry.kind == ChunkKind::uniform) {
        count = voxels_;
        black = entry.colour != 0;
        ++chunk_;
        return true;
      }
      begin_chunk(entry);
    }
    const ChunkEntry& entry = header_.chunks[chunk_];
    if (runs_ == entry.runs) fail("its runs do not add up to its voxels");
    count = varint();
    black = runs_ % 2 == 0;
    if (count == 0 && runs_ > 0) fail(fmt::format("run {} has no length", runs_));
    if (count > left_) fail("its runs add up to more than its voxels");
    if (count == voxels_) fail("is of one colour and yet has runs");
    ++runs_;
    left_ -= count;
    if (left_ == 0) end_chunk(entry);
    return true;
  }

 private:
  struct FreeContext {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: chunk {}: {}", name_, chunk_, what), std::string(kDamaged));
  }

  void begin_chunk(const ChunkEntry& entry) {
    XXH3_64bits_reset(hash_.get());
    for (std::uint64_t done = 0; done < entry.stored_bytes;) {
      const std::span part = piece(done, entry);
      XXH3_64bits_update(hash_.get(), part.data(), part.size());
      done += part.size();
    }
    if (XXH3_64bits_digest(hash_.get()) != entry.checksum) fail("checksum does not match");
    ZSTD_DCtx_reset(context_.get(), ZSTD_reset_session_only);
    left_ = voxels_;
    runs_ = fed_ = produced_ = 0;
    input_ = {in_.data(), 0, 0};
    out_at_ = out_end_ = 0;
    frame_ended_ = false;
  }

  // Reads bytes of the current chunk from `done` on into in_, as many as fit.
  std::span<const std::uint8_t> piece(std::uint64_t done, const ChunkEntry& entry) {
    const std::uint64_t size = std::min<std::uint64_t>(in_.size(), entry.stored_bytes - done);
    const std::span part = std::span(in_).first(static_cast<std::size_t>(size));
    source_.read_at(header_.chunks[chunk_].offset + done, part);
    return part;
  }

  // Decompresses the next bytes into out_; false at the end of the frame.
  bool refill() {
    const ChunkEntry& entry = header_.chunks[chunk_];
    out_at_ = out_end_ = 0;
    while (out_end_ == 0 && !frame_ended_) {
      if (input_.pos == input_.size && fed_ < entry.stored_bytes) {
        const std::span part = piece(fed_, entry);
        input_ = {part.data(), part.size(), 0};
        fed_ += part.size();
      }
      ZSTD_outBuffer output{out_.data(), out_.size(), 0};
      const std::size_t before = input_.pos;
      const std::size_t code = ZSTD_decompressStream(context_.get(), &output, &input_);
      if (ZSTD_isError(code)) fail(fmt::format("cannot be decompressed ({})", ZSTD_getErrorName(code)));
      frame_ended_ = code == 0;
      out_end_ = output.pos;
      if (out_end_ == 0 && !frame_ended_ && input_.pos == before && fed_ == entry.stored_bytes)
        fail("its compressed data end too early");
    }
    produced_ += out_end_;
    if (produced_ > entry.raw_bytes) fail("its compressed data hold more than its entry says");
    return out_end_ > 0;
  }

  std::uint8_t byte() {
    if (out_at_ == out_end_ && !refill()) fail("its compressed data hold less than its entry says");
    return out_[out_at_++];
  }

  std::uint64_t varint() {
    return read_varint([&] { return byte(); }, [&](const char* what) { fail(fmt::format("run {} {}", runs_, what)); });
  }

  void end_chunk(const ChunkEntry& entry) {
    if (runs_ != entry.runs) fail(fmt::format("has {} runs where its entry says {}", runs_, entry.runs));
    if (out_at_ != out_end_ || refill()) fail("bytes follow its last run");
    if (produced_ != entry.raw_bytes)
      fail(fmt::format("has {} bytes where its entry says {}", produced_, entry.raw_bytes));
    if (input_.pos != input_.size || fed_ != entry.stored_bytes) fail("bytes follow its compressed data");
    ++chunk_;
  }

  const ByteSource& source_;
  const std::string_view name_;
  const Header& header_;
  std::unique_ptr<ZSTD_DCtx, FreeContext> context_;
  std::unique_ptr<XXH3_state_t, FreeContext> hash_;
  const std::uint64_t voxels_;            // in every chunk
  std::size_t chunk_ = 0;                 // the current chunk, or the next one when left_ is 0
  std::uint64_t left_ = 0;                // voxels of the current chunk not yet told
  std::uint64_t runs_ = 0;                // counts read of the current chunk
  std::uint64_t fed_ = 0, produced_ = 0;  // compressed bytes taken, raw bytes made
  Bytes in_, out_;
  ZSTD_inBuffer input_{nullptr, 0, 0};
  std::size_t out_at_ = 0, out_end_ = 0;
  bool frame_ended_ = false;
};

}  // namespace

Octree read_old_runs(const ByteSource& source, std::string_view name, const Header& header) {
  RunReader runs(source, name, header);
  return octree_from_source([&](std::uint64_t& count, bool& black) { return runs.next(count, black); }, header.depth,
                            header.frame);
}

}  // namespace blackleaf::detail::format
