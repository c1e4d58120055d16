// HDF5 datasets through parallel HDF5. Each rank opens the file for itself and reads its own boxes.
#include <fmt/format.h>
#include <hdf5.h>
#include <mpi.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "blackleaf/error.h"
#include "box_source.h"

namespace blackleaf::mpi {
namespace {

namespace fs = std::filesystem;
using detail::Component;

// One of HDF5's numbers for things that are open, with what closes it.
class Open {
 public:
  using Close = herr_t (*)(hid_t);
  Open(hid_t id, Close close) : id_(id), close_(close) {}
  Open(Open&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  ~Open() {
    if (id_ >= 0) close_(id_);
  }
  Open(const Open&) = delete;
  Open& operator=(const Open&) = delete;
  Open& operator=(Open&&) = delete;
  explicit operator bool() const { return id_ >= 0; }
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

// The library prints its errors unless told not to.
void keep_quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const std::string& remedy) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path.string(), what), remedy);
}

Open open_file(const fs::path& path) {
  keep_quiet();
  const Open access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_mpio(access.get(), MPI_COMM_SELF, MPI_INFO_NULL);
  Open file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose);
  if (!file) refuse(path, "cannot be read as HDF5", "the file is damaged or of another format");
  return file;
}

std::vector<hsize_t> extent(const Open& dataset) {
  const Open space(H5Dget_space(dataset.get()), H5Sclose);
  const int dimensions = H5Sget_simple_extent_ndims(space.get());
  if (dimensions <= 0) return {};
  std::vector<hsize_t> size(static_cast<std::size_t>(dimensions));
  H5Sget_simple_extent_dims(space.get(), size.data(), nullptr);
  return size;
}

// Dimensions of more than one value, the leading ones of one left out.
std::vector<hsize_t> shape(const Open& dataset) {
  std::vector<hsize_t> size = extent(dataset);
  while (size.size() > 3 && size.front() == 1) size.erase(size.begin());
  return size;
}

std::vector<std::string> volumes_in(const Open& file) {
  std::vector<std::string> names;
  const auto visit = [](hid_t root, const char* name, const H5O_info_t* info, void* found) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Open dataset(H5Dopen2(root, name, H5P_DEFAULT), H5Dclose);
    if (dataset && shape(dataset).size() == 3) static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  H5Ovisit2(file.get(), H5_INDEX_NAME, H5_ITER_INC, visit, &names, H5O_INFO_BASIC);
  return names;
}

Open open_dataset(const fs::path& path, const Open& file, const std::string& name) {
  Open dataset(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset) refuse(path, fmt::format("has no dataset '{}'", name), "see what it holds with h5ls -r");
  return dataset;
}

std::optional<Component> component_of(const Open& dataset) {
  const Open type(H5Dget_type(dataset.get()), H5Tclose);
  const std::size_t bytes = H5Tget_size(type.get());
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind == H5T_FLOAT) {
    if (bytes == 4) return Component::f32;
    if (bytes == 8) return Component::f64;
  }
  if (kind == H5T_INTEGER) {
    const bool with_sign = H5Tget_sign(type.get()) != H5T_SGN_NONE;
    switch (bytes) {
      case 1:
        return with_sign ? Component::i8 : Component::u8;
      case 2:
        return with_sign ? Component::i16 : Component::u16;
      case 4:
        return with_sign ? Component::i32 : Component::u32;
      case 8:
        return with_sign ? Component::i64 : Component::u64;
      default:
        break;
    }
  }
  return std::nullopt;
}

hid_t native_type(Component component) {
  switch (component) {
    case Component::u8:
      return H5T_NATIVE_UINT8;
    case Component::i8:
      return H5T_NATIVE_INT8;
    case Component::u16:
      return H5T_NATIVE_UINT16;
    case Component::i16:
      return H5T_NATIVE_INT16;
    case Component::u32:
      return H5T_NATIVE_UINT32;
    case Component::i32:
      return H5T_NATIVE_INT32;
    case Component::u64:
      return H5T_NATIVE_UINT64;
    case Component::i64:
      return H5T_NATIVE_INT64;
    case Component::f32:
      return H5T_NATIVE_FLOAT;
    case Component::f64:
      break;
  }
  return H5T_NATIVE_DOUBLE;
}

// Sides of a voxel along x, y, z in millimetres.
std::array<double, 3> voxel_sides(const fs::path& path, const Open& dataset) {
  constexpr const char* kName = "element_size_um";
  if (H5Aexists(dataset.get(), kName) <= 0) return {1, 1, 1};
  const Open attribute(H5Aopen(dataset.get(), kName, H5P_DEFAULT), H5Aclose);
  const Open space(H5Aget_space(attribute.get()), H5Sclose);
  std::array<double, 3> zyx{};
  if (!attribute || H5Sget_simple_extent_npoints(space.get()) != 3 ||
      H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, zyx.data()) < 0)
    refuse(path, fmt::format("its attribute {} is not three numbers", kName), "mend or remove it");
  for (const double side : zyx)
    if (!std::isfinite(side) || side <= 0)
      refuse(path, fmt::format("its {} has {}, which is no side of a voxel", kName, side), "mend or remove it");
  return {zyx[2] / 1000, zyx[1] / 1000, zyx[0] / 1000};
}

class Hdf5Box : public detail::VolumeSource {
 public:
  Hdf5Box(const fs::path& path, const Open& dataset, detail::ImageInformation information, const VoxelBox& box,
          std::mutex& turn)
      : path_(path),
        dataset_(dataset),
        information_(std::move(information)),
        box_(box),
        turn_(turn),
        next_(box.low[2]) {}

  const detail::ImageInformation& information() const override { return information_; }

  void read(std::int64_t slices, void* values) override {
    const std::lock_guard lock(turn_);
    const Open space(H5Dget_space(dataset_.get()), H5Sclose);
    const auto dimensions = static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.get()));
    std::vector<hsize_t> start(dimensions, 0), count(dimensions, 1);
    const std::array<std::int64_t, 3> low = {box_.low[0], box_.low[1], next_};
    const std::array<std::int64_t, 3> part = {box_.high[0] - box_.low[0], box_.high[1] - box_.low[1], slices};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      start[dimensions - 1 - axis] = static_cast<hsize_t>(low[axis]);
      count[dimensions - 1 - axis] = static_cast<hsize_t>(part[axis]);
    }
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    const Open memory(H5Screate_simple(static_cast<int>(dimensions), count.data(), nullptr), H5Sclose);
    const Open transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
    H5Pset_dxpl_mpio(transfer.get(), H5FD_MPIO_INDEPENDENT);
    if (H5Dread(dataset_.get(), native_type(*information_.component), memory.get(), space.get(), transfer.get(),
                values) < 0)
      throw Error(ErrorCode::io, fmt::format("{}: its values from slice {} on cannot be read", path_.string(), next_),
                  "the file was cut off or is packed with a filter that is not installed");
    next_ += slices;
  }

 private:
  const fs::path& path_;
  const Open& dataset_;
  detail::ImageInformation information_;
  VoxelBox box_;
  std::mutex& turn_;
  std::int64_t next_;
};

class Hdf5Volume : public SharedVolume {
 public:
  Hdf5Volume(const fs::path& path, const std::string& dataset, detail::ImageInformation information, std::mutex& turn)
      : path_(path),
        information_(std::move(information)),
        turn_(turn),
        file_(open_file(path)),
        dataset_(open_dataset(path, file_, dataset)) {}

  std::unique_ptr<detail::VolumeSource> box(const VoxelBox& box) override {
    return std::make_unique<Hdf5Box>(path_, dataset_, of_box(information_, box), box, turn_);
  }

 private:
  fs::path path_;
  detail::ImageInformation information_;
  std::mutex& turn_;
  Open file_, dataset_;
};

}  // namespace

detail::ImageInformation hdf5_information(const fs::path& path, std::string& dataset) {
  const Open file = open_file(path);
  if (dataset.empty()) {
    const std::vector<std::string> names = volumes_in(file);
    if (names.empty()) refuse(path, "has no dataset of three dimensions", "a solid needs one");
    if (names.size() > 1)
      refuse(path, fmt::format("has {} datasets of three dimensions: {}", names.size(), fmt::join(names, ", ")),
             "name one with --dataset");
    dataset = names.front();
  }
  const Open data = open_dataset(path, file, dataset);
  const std::vector<hsize_t> size = shape(data);
  if (size.size() != 3)
    refuse(path, fmt::format("dataset '{}' has {} dimensions; a solid has three", dataset, extent(data).size()),
           "name another with --dataset");
  detail::ImageInformation information;
  for (std::size_t axis = 0; axis < 3; ++axis) information.size.push_back(static_cast<std::int64_t>(size[2 - axis]));
  information.component = component_of(data);
  const std::array<double, 3> sides = voxel_sides(path, data);
  for (std::size_t axis = 0; axis < 3; ++axis) information.geometry.axes[axis][axis] = sides[axis];
  return information;
}

std::unique_ptr<SharedVolume> open_hdf5(const fs::path& path, const std::string& dataset,
                                        const detail::ImageInformation& information, std::mutex& turn) {
  const std::lock_guard lock(turn);
  return std::make_unique<Hdf5Volume>(path, dataset, information, turn);
}

}  // namespace blackleaf::mpi
