#include "mpi_file.h"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>

#include "blackleaf/error.h"
#include "ranks.h"

namespace blackleaf::mpi {
namespace {

constexpr std::int64_t kMostValues = std::int64_t{1} << 28;  // of one call: MPI counts in int
constexpr std::size_t kMostBytes = std::size_t{1} << 28;

// A datatype of MPI's for as long as it is needed.
class Datatype {
 public:
  explicit Datatype(MPI_Datatype type) : type_(type) { MPI_Type_commit(&type_); }
  ~Datatype() { MPI_Type_free(&type_); }
  Datatype(const Datatype&) = delete;
  Datatype& operator=(const Datatype&) = delete;
  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_;
};

MPI_Datatype contiguous(int count, MPI_Datatype of) {
  MPI_Datatype type{};
  MPI_Type_contiguous(count, of, &type);
  return type;
}

MPI_Datatype subarray(const FileBox& box, MPI_Datatype value) {
  std::array<int, 3> sizes{}, parts{}, starts{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sizes[axis] = static_cast<int>(box.size[axis]);  // at most 2^20
    parts[axis] = static_cast<int>(box.high[axis] - box.low[axis]);
    starts[axis] = static_cast<int>(box.low[axis]);
  }
  MPI_Datatype type{};
  MPI_Type_create_subarray(3, sizes.data(), parts.data(), starts.data(), MPI_ORDER_FORTRAN, value, &type);
  return type;
}

}  // namespace

struct MpiFile::Handle {
  MPI_File file = MPI_FILE_NULL;
};

MpiFile::MpiFile(const std::string& path, const std::filesystem::path& shown, Mode mode)
    : handle_(std::make_unique<Handle>()), shown_(shown), mode_(mode) {
  const int error = MPI_File_open(MPI_COMM_SELF, path.c_str(), mode == Mode::read ? MPI_MODE_RDONLY : MPI_MODE_WRONLY,
                                  MPI_INFO_NULL, &handle_->file);
  if (error != MPI_SUCCESS) fail(error);
}

MpiFile::~MpiFile() {
  if (handle_->file != MPI_FILE_NULL) MPI_File_close(&handle_->file);
}

void MpiFile::fail(int error) const {
  int kind = 0;
  MPI_Error_class(error, &kind);
  const bool room = kind == MPI_ERR_NO_SPACE || kind == MPI_ERR_QUOTA;
  if (mode_ == Mode::write)
    throw Error(ErrorCode::io, fmt::format("{}: cannot be written: {}", shown_.string(), error_text(error)),
                room ? "make room or write elsewhere" : "check the disk, or write elsewhere");
  throw Error(ErrorCode::io, fmt::format("{}: cannot be read: {}", shown_.string(), error_text(error)),
              "every rank must be able to read it");
}

void MpiFile::write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), kMostBytes);
    MPI_Status status;
    const int error = MPI_File_write_at(handle_->file, static_cast<MPI_Offset>(offset), bytes.data(),
                                        static_cast<int>(count), MPI_BYTE, &status);
    if (error != MPI_SUCCESS) fail(error);
    int written = 0;
    MPI_Get_count(&status, MPI_BYTE, &written);
    if (written != static_cast<int>(count)) fail(MPI_ERR_NO_SPACE);
    bytes = bytes.subspan(count);
    offset += count;
  }
}

void MpiFile::read_box(const FileBox& box, std::uint8_t* values) const {
  const std::array<std::int64_t, 3> part = {box.high[0] - box.low[0], box.high[1] - box.low[1],
                                            box.high[2] - box.low[2]};
  const std::int64_t count = part[0] * part[1] * part[2];
  if (count > kMostValues) {  // by slices, and a slice by rows
    const std::size_t axis = part[2] > 1 ? 2 : 1;
    const std::int64_t middle = box.low[axis] + part[axis] / 2;
    FileBox lower = box, upper = box;
    lower.high[axis] = upper.low[axis] = middle;
    read_box(lower, values);
    read_box(upper, values + static_cast<std::size_t>(part[0] * (axis == 2 ? part[1] * (part[2] / 2) : part[1] / 2)) *
                                 box.value_bytes);
    return;
  }
  const Datatype value(contiguous(static_cast<int>(box.value_bytes), MPI_BYTE));
  const bool full_rows = part[0] == box.size[0], full_slices = full_rows && part[1] == box.size[1];
  MPI_Status status;
  int error = MPI_SUCCESS;
  if (full_slices || (full_rows && part[2] == 1)) {
    const auto first = static_cast<std::uint64_t>((box.low[2] * box.size[1] + box.low[1]) * box.size[0]);
    const auto place = box.offset + first * box.value_bytes;
    error = MPI_File_set_view(handle_->file, 0, MPI_BYTE, MPI_BYTE, "native", MPI_INFO_NULL);
    if (error == MPI_SUCCESS)
      error = MPI_File_read_at(handle_->file, static_cast<MPI_Offset>(place), values, static_cast<int>(count),
                               value.get(), &status);
  } else {
    const Datatype type(subarray(box, value.get()));
    error = MPI_File_set_view(handle_->file, static_cast<MPI_Offset>(box.offset), value.get(), type.get(), "native",
                              MPI_INFO_NULL);
    if (error == MPI_SUCCESS)
      error = MPI_File_read_at(handle_->file, 0, values, static_cast<int>(count), value.get(), &status);
  }
  if (error != MPI_SUCCESS) fail(error);
  int read = 0;
  MPI_Get_count(&status, value.get(), &read);
  if (read != static_cast<int>(count))
    throw Error(ErrorCode::io, fmt::format("{}: ends early", shown_.string()),
                "the file was cut off while it was read; get it again from its source");
}

void MpiFile::sync() const {
  const int error = MPI_File_sync(handle_->file);
  if (error != MPI_SUCCESS) fail(error);
}

}  // namespace blackleaf::mpi
