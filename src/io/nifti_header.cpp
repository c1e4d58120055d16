#include "io/nifti_header.h"

#include "io/header_text.h"

namespace blackleaf::detail {

namespace fs = std::filesystem;

NiftiFiles nifti_files(const fs::path& path) {
  const std::string suffix = image_suffix(path);
  if (suffix == ".nii" || suffix == ".nii.gz") return {path, path, suffix == ".nii.gz"};
  NiftiFiles files;
  fs::path base = path;
  if (suffix == ".img.gz") base.replace_extension();
  files.header = base.replace_extension(".hdr");
  files.data = base.replace_extension(".img");
  if (std::error_code error; !fs::exists(files.data, error) && fs::exists(files.data.string() + ".gz", error)) {
    files.data += ".gz";
    files.compressed = true;
  }
  return files;
}

NiftiHeader::NiftiHeader(const NiftiFiles& files)
    : bytes_(files.header == files.data && files.compressed ? unpacked_head_of(files.header, kBytes)
                                                            : head_of(files.header, kBytes)) {
  constexpr std::int32_t kOrdinary = kBytes, kSecond = 540;
  if (bytes_.size() < kBytes) refuse(files.header, "is too short for a NIfTI file", kAgain);
  const bool second = get<std::int32_t>(0) == kSecond;
  swapped_ = get<std::int32_t>(0) != kOrdinary;
  if (second || get<std::int32_t>(0) == kSecond)
    refuse(files.header, "is a NIfTI-2 file", "convert it to NIfTI-1 or .nrrd");
  if (get<std::int32_t>(0) != kOrdinary)
    refuse(files.header, "is not a NIfTI file", "its contents are not what its name says; check where it comes from");
}

std::uint64_t NiftiHeader::bytes_per_voxel() const {
  switch (type()) {
    case 2:
    case 256:
      return 1;
    case 4:
    case 512:
      return 2;
    case 128:
      return 3;
    case 8:
    case 16:
    case 768:
    case 2304:
      return 4;
    case 32:
    case 64:
    case 1024:
    case 1280:
      return 8;
    case 1536:
    case 1792:
      return 16;
    case 2048:
      return 32;
    default:
      return 0;
  }
}

std::optional<Component> NiftiHeader::component() const {
  switch (type()) {
    case 2:
      return Component::u8;
    case 4:
      return Component::i16;
    case 8:
      return Component::i32;
    case 16:
      return Component::f32;
    case 64:
      return Component::f64;
    case 256:
      return Component::i8;
    case 512:
      return Component::u16;
    case 768:
      return Component::u32;
    case 1024:
      return Component::i64;
    case 1280:
      return Component::u64;
    default:
      return std::nullopt;
  }
}

}  // namespace blackleaf::detail
