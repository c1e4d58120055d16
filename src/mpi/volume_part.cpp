#include "volume_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "blackleaf/error.h"
#include "box_source.h"
#include "io/volume_octree.h"
#include "octree/parallel.h"

namespace blackleaf::mpi {
namespace {

namespace fs = std::filesystem;
using detail::Component;
using detail::ImageInformation;
using detail::LocatedVolume;

// What the first rank has found out, as bytes for the others: JSON for what is of any length, doubles by their bits.
std::vector<std::uint8_t> packed(const LocatedVolume& volume, const std::string& dataset) {
  const detail::ValueLocation& l = volume.location;
  std::vector<std::uint64_t> geometry;
  const auto add = [&](double value) { geometry.push_back(std::bit_cast<std::uint64_t>(value)); };
  for (const double value : volume.information.geometry.origin) add(value);
  for (const auto& axis : volume.information.geometry.axes)
    for (const double value : axis) add(value);
  add(l.slope);
  add(l.intercept);
  const std::string file = l.file.string();
  const nlohmann::json told = {{"size", volume.information.size},
                               {"component", static_cast<int>(*volume.information.component)},
                               {"unit", std::vector<std::uint8_t>(volume.information.geometry.unit.begin(),
                                                                  volume.information.geometry.unit.end())},
                               {"doubles", geometry},
                               {"file", std::vector<std::uint8_t>(file.begin(), file.end())},
                               {"offset", l.offset},
                               {"available", l.available},
                               {"at_end", l.at_end},
                               {"swapped", l.swapped},
                               {"stored", l.stored ? static_cast<int>(*l.stored) : -1},
                               {"dataset", std::vector<std::uint8_t>(dataset.begin(), dataset.end())}};
  return nlohmann::json::to_cbor(told);
}

LocatedVolume unpacked(const std::vector<std::uint8_t>& bytes, std::string& dataset) {
  const nlohmann::json told = nlohmann::json::from_cbor(bytes);
  const auto text = [&](const char* name) {
    const auto letters = told.at(name).get<std::vector<std::uint8_t>>();
    return std::string(letters.begin(), letters.end());
  };
  LocatedVolume volume;
  volume.information.size = told.at("size").get<std::vector<std::int64_t>>();
  volume.information.component = static_cast<Component>(told.at("component").get<int>());
  volume.information.geometry.unit = text("unit");
  const auto doubles = told.at("doubles").get<std::vector<std::uint64_t>>();
  std::size_t at = 0;
  const auto next = [&] { return std::bit_cast<double>(doubles.at(at++)); };
  for (double& value : volume.information.geometry.origin) value = next();
  for (auto& axis : volume.information.geometry.axes)
    for (double& value : axis) value = next();
  volume.location.slope = next();
  volume.location.intercept = next();
  volume.location.file = text("file");
  volume.location.offset = told.at("offset").get<std::uint64_t>();
  volume.location.available = told.at("available").get<std::uint64_t>();
  volume.location.at_end = told.at("at_end").get<bool>();
  volume.location.swapped = told.at("swapped").get<bool>();
  if (const int stored = told.at("stored").get<int>(); stored >= 0)
    volume.location.stored = static_cast<Component>(stored);
  dataset = text("dataset");
  return volume;
}

// What the first rank does before the others hear of the volume.
LocatedVolume look_up(const fs::path& path, const VolumePartOptions& options, std::string& dataset) {
  LocatedVolume volume;
  if (is_hdf5_name(path)) {
    if (!options.volume.series.empty() || options.volume.spacing)
      throw Error(ErrorCode::bad_argument, path.string() + ": a series or a spacing is given, but it is HDF5",
                  "leave it out");
    volume.information = hdf5_information(path, dataset);
    detail::check_shape(path, volume.information);
    return volume;
  }
  if (!dataset.empty())
    throw Error(ErrorCode::bad_argument, path.string() + ": a dataset is named, but it is not HDF5", "leave it out");
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw Error(ErrorCode::bad_argument, path.string() + ": folders of slices are read by one process",
                "build it with blackleaf, or make one raw file of them");
  volume = detail::locate_volume(path, {options.volume.series, options.volume.spacing, options.volume.warn});
  const detail::ValueLocation& location = volume.location;
  if (!location.direct || location.packing != detail::Packing::raw)
    throw Error(ErrorCode::bad_argument,
                path.string() + ": its values are packed, and only one process can unpack them",
                "build it with blackleaf, or save it raw");
  const auto size = detail::solid_size(volume.information);
  const std::size_t value = detail::bytes_of(location.stored.value_or(*volume.information.component));
  const std::uint64_t slice = static_cast<std::uint64_t>(size[0] * size[1]) * value;
  const std::uint64_t all = slice * static_cast<std::uint64_t>(size[2]);
  if (!location.at_end) detail::check_surplus(path, size[2], slice, location.available - all);
  return volume;
}

std::string shown(std::uint64_t bytes) {
  return bytes < (std::uint64_t{10} << 20) ? fmt::format("{} KiB", (bytes + 1023) >> 10)
                                           : fmt::format("{} MiB", (bytes + (1 << 20) - 1) >> 20);
}

// At most what building from a box takes beside the octree: twice the slices that are read at once, the bricks of 64
// slices with every one of them gray, the blocks' table.
std::uint64_t memory_for(const VoxelBox& box, std::size_t value_bytes) {
  const auto side = [&](std::size_t i) { return static_cast<std::uint64_t>(box.high[i] - box.low[i]); };
  const std::uint64_t slice = side(0) * side(1) * value_bytes;
  const std::uint64_t at_once =
      std::max<std::uint64_t>({std::uint64_t{4} << 20, slice, slice <= (64u << 20) ? 4 * slice : 0});
  const std::uint64_t columns = (side(0) / 4 + 2) * (side(1) / 4 + 2);
  const std::uint64_t blocks = (side(0) / 64 + 2) * (side(1) / 64 + 2) * (side(2) / 64 + 2);
  return 2 * std::min(at_once, slice * side(2)) + columns * 16 * (8 + 1) + 16 * blocks;
}

}  // namespace

bool is_hdf5_name(const fs::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix == ".h5" || suffix == ".hdf5" || suffix == ".hdf" || suffix == ".nxs";
}

SharedOctree read_volume(Ranks& ranks, const fs::path& path, const VolumePartOptions& options, const Work& work) {
  detail::check_options(options.volume);
  std::string dataset = options.dataset;
  std::vector<std::uint8_t> told;
  if (ranks.first()) told = packed(look_up(path, options, dataset), dataset);
  ranks.broadcast(told);
  const LocatedVolume volume = unpacked(told, dataset);
  const ImageInformation& information = volume.information;
  const auto size = detail::solid_size(information);

  detail::PlacedVolume placed = detail::place_volume(path, information, options.volume.depth, options.volume.centre);
  if (options.frame) {
    const auto corner = detail::corner_in(path, information, *options.frame);
    for (std::size_t i = 0; i < 3; ++i) {
      if (corner[i] < 0 || corner[i] + size[i] > std::int64_t{1} << placed.placement.depth)
        throw Error(ErrorCode::bad_input,
                    path.string() + ": the volume reaches out of the universe that it is to lie in",
                    "build it with blackleaf, which clips nothing but white voxels, or crop it first");
      placed.placement.corner[i] = static_cast<std::int32_t>(corner[i]);
    }
    placed.frame = *options.frame;
  }
  VoxelBox all;
  for (std::size_t i = 0; i < 3; ++i) {
    all.low[i] = placed.placement.corner[i];
    all.high[i] = all.low[i] + size[i];
  }
  const int depth = placed.placement.depth;
  const Cuts cuts = cuts_by_voxels(depth, all, ranks.size());
  const std::vector<VoxelBox> boxes = depth > kBlockLevel ? boxes_of(depth, stretch_of(cuts, ranks.rank()), all)
                                      : ranks.first()     ? std::vector<VoxelBox>{all}
                                                          : std::vector<VoxelBox>{};

  std::uint64_t needed = 0;
  for (const VoxelBox& box : boxes)
    needed = std::max(needed, memory_for(box, detail::bytes_of(*information.component)));
  needed = ranks.largest(needed);
  if (options.memory_limit > 0 && needed > options.memory_limit)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("{}: a rank of {} needs {} for the slices that it reads, beside its part of the octree, and "
                    "may have {}",
                    path.string(), ranks.size(), shown(needed), shown(options.memory_limit)),
        "give more memory, or use more ranks");

  const auto source = boxes.empty()        ? nullptr
                      : is_hdf5_name(path) ? open_hdf5(path, dataset, information, ranks.turn())
                                           : open_raw(path, volume, ranks.turn());
  std::int64_t voxels = 0, done = 0;
  for (const VoxelBox& box : boxes) voxels += box.voxels();
  detail::NanCount nan;
  std::vector<Octree> parts;
  for (const VoxelBox& box : boxes) {
    VoxelBox in_file = box;
    detail::PlacedVolume of_box = placed;
    for (std::size_t i = 0; i < 3; ++i) {
      in_file.low[i] -= all.low[i];
      in_file.high[i] -= all.low[i];
      of_box.placement.corner[i] = static_cast<std::int32_t>(box.low[i]);
    }
    const auto share = [&](std::int64_t v) { return static_cast<double>(v) / static_cast<double>(voxels); };
    const Work part = detail::part_of(work, share(done), share(done + box.voxels()));
    parts.push_back(detail::octree_of(*source->box(in_file), path, of_box, options.volume, nan, part));
    done += box.voxels();
  }
  if (parts.empty()) parts.emplace_back(depth, Colour::white, placed.frame);
  std::array<std::uint64_t, 2> counts = {nan.nan(), nan.all()};
  ranks.sum(counts);
  detail::tell_nan({counts[0], counts[1]}, *information.component, path,
                   ranks.first() ? options.volume.warn : std::function<void(const std::string&)>());
  Octree part = join(parts);
  parts.clear();
  return by_chunks(ranks, part, cuts);
}

}  // namespace blackleaf::mpi
