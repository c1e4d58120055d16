// Raw values through MPI-IO.
#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "box_source.h"
#include "io/volume_shape.h"
#include "mpi_file.h"

namespace blackleaf::mpi {
namespace {

// The stored bytes of a box's values, in order.
class BoxBytes : public detail::ValueBytes {
 public:
  BoxBytes(const MpiFile& file, const FileBox& box, std::mutex& turn)
      : file_(file), box_(box), turn_(turn), next_(box.low[2]) {}

  void read(std::span<std::uint8_t> bytes) override {
    const std::size_t slice = slice_bytes();
    // What a slice has left over from the last call, whole slices, the beginning of one.
    const auto take = [&] {
      const std::size_t count = std::min(bytes.size(), rest_.size() - taken_);
      if (count == 0) return;
      std::memcpy(bytes.data(), rest_.data() + taken_, count);
      taken_ += count;
      bytes = bytes.subspan(count);
    };
    take();
    if (const std::size_t slices = bytes.size() / slice; slices > 0) {
      read_slices(static_cast<std::int64_t>(slices), bytes.data());
      bytes = bytes.subspan(slices * slice);
    }
    if (bytes.empty()) return;
    rest_.resize(slice);
    taken_ = 0;
    read_slices(1, rest_.data());
    take();
  }

  // Who cuts the volume has looked for what is behind its last value.
  std::uint64_t surplus(std::uint64_t) override { return 0; }

 private:
  std::size_t slice_bytes() const {
    return static_cast<std::size_t>((box_.high[0] - box_.low[0]) * (box_.high[1] - box_.low[1])) * box_.value_bytes;
  }

  void read_slices(std::int64_t slices, std::uint8_t* values) {
    FileBox part = box_;
    part.low[2] = next_;
    part.high[2] = next_ += slices;
    const std::lock_guard lock(turn_);
    file_.read_box(part, values);
  }

  const MpiFile& file_;
  FileBox box_;
  std::mutex& turn_;
  std::int64_t next_;
  std::vector<std::uint8_t> rest_;
  std::size_t taken_ = 0;
};

class RawVolume : public SharedVolume {
 public:
  RawVolume(const std::filesystem::path& path, const detail::LocatedVolume& volume, std::mutex& turn)
      : path_(path), volume_(volume), turn_(turn), file_(volume.location.file.string(), path, MpiFile::Mode::read) {}

  std::unique_ptr<detail::VolumeSource> box(const VoxelBox& box) override {
    const auto size = detail::solid_size(volume_.information);
    FileBox in_file;
    in_file.value_bytes = detail::bytes_of(volume_.location.stored.value_or(*volume_.information.component));
    in_file.offset = detail::first_value_at(
        volume_.location, static_cast<std::uint64_t>(size[0] * size[1] * size[2]) * in_file.value_bytes);
    in_file.size = size;
    in_file.low = box.low;
    in_file.high = box.high;
    return detail::direct_source(path_, volume_.location, of_box(volume_.information, box),
                                 std::make_unique<BoxBytes>(file_, in_file, turn_));
  }

 private:
  std::filesystem::path path_;
  detail::LocatedVolume volume_;
  std::mutex& turn_;
  MpiFile file_;
};

}  // namespace

std::unique_ptr<SharedVolume> open_raw(const std::filesystem::path& path, const detail::LocatedVolume& volume,
                                       std::mutex& turn) {
  const std::lock_guard lock(turn);
  return std::make_unique<RawVolume>(path, volume, turn);
}

}  // namespace blackleaf::mpi
