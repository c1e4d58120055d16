// Voxel volumes in and out: NRRD, NIfTI and MetaImage files, DICOM series, stacks of TIFF and PNG pictures.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "blackleaf/label_voxels.h"
#include "blackleaf/octree.h"
#include "blackleaf/work.h"

namespace blackleaf {

struct VolumeOptions {
  /// Values from low to high, both included, are inside; a side left out is unbounded. NaN is never inside.
  /// Bounds are doubles: among 64-bit whole numbers beyond 2^53, the bound is the double nearest to what was meant.
  std::optional<double> low = {}, high = {};
  /// Exactly this value is inside. At most one of range and label may be given; without either, any value > 0 is
  /// inside. For volumes of 64-bit whole numbers a label from 2^53 to 2^64 in size is an Error(bad_argument): doubles
  /// beyond do not tell neighbours apart.
  std::optional<double> label = {};
  int depth = 0;        // 0: the smallest universe that holds the volume
  bool centre = false;  // centre the volume in the universe instead of putting it at the corner
  /// Of a folder with several DICOM series: the Series Instance UID of the one that is meant, or how it ends, if that
  /// tells it from the others.
  std::string series = {};
  /// Sides of a voxel in mm along x, y and z, for pictures, which do not tell them: the frame's unit is then mm instead
  /// of voxel. An Error(bad_argument) for volumes that have a geometry of their own.
  std::optional<std::array<double, 3>> spacing = {};
  /// Called with one line about what a careful user would like to know: files of a folder that were passed over,
  /// pictures whose names leave a number out. The octree is made all the same.
  std::function<void(const std::string&)> warn = {};
};

/// The octree of a volume file or of a folder of slices (docs/VOLUMES.md). Raw values and those under gzip or zlib are
/// read a few slices at a time, so memory holds the octree and about 16 MiB of slices (four slices twice, if larger, or
/// one twice from 64 MiB on); values as text, hex, under bzip2 or in several files are read in one piece; DICOM, TIFF
/// and PNG slice by slice. Values are whatever the format means by them (NIfTI's slope and intercept are applied). Its
/// frame is the file's geometry (ITK's LPS convention, unit mm; for universe corner, not first voxel centre), or voxels
/// of side 1 for pictures. Throws Error(io) when the file cannot be read, Error(bad_input) when it is not a volume, has
/// no voxels, not three dimensions (trailing dimensions of one are fine), several components a voxel, does not fit the
/// universe, has only NaN for values, fewer values than its header tells, a whole slice more of them, or compressed
/// ones whose checksum is wrong; Error(cancelled) when progress refuses. Progress is the fraction of slices.
Octree read_volume(const std::filesystem::path& path, const VolumeOptions& options = {}, const Work& work = {});

struct LabelVolumeOptions {
  std::optional<Bands> bands = {};  // without them the values themselves are the labels
  /// The frame of the universe, with `depth` its depth: the volume must lie on its voxels, shifted by whole ones, and
  /// what reaches beyond it must have label 0, else Error(bad_input). Without it the volume lies as `centre` says.
  std::optional<Frame> frame = {};
  /// As in VolumeOptions.
  int depth = 0;
  bool centre = false;
  std::string series = {};
  std::optional<std::array<double, 3>> spacing = {};
  std::function<void(const std::string&)> warn = {};
};

/// The labels of a volume file, as label_map_from_voxels() makes them; frame and errors as of read_volume(). Read slice
/// by slice: memory is that of the label map and of some slices. Error(bad_input) also for a value that is no label,
/// with its voxel, and when every value is NaN.
LabelMap read_label_volume(const std::filesystem::path& path, const LabelVolumeOptions& options = {},
                           const Work& work = {});

/// True iff the suffix is one that volumes have: .nrrd .nhdr .nii .nii.gz .mha .mhd .hdr .img(.gz) .dcm .dicom .ima
/// .tif .tiff .png.
bool is_volume_name(const std::filesystem::path& path);
/// True iff read_volume takes the path for a volume: by its name, because it is a folder, or because it begins as a
/// DICOM file does, which often have no suffix. Looks at the file.
bool is_volume(const std::filesystem::path& path);

/// Writes the solid as a 0/1 volume (uint8, x fastest) of the whole universe, or of its bounding box if `crop` (one
/// white voxel for an empty solid), with the frame's geometry: .nrrd, .nii, .nii.gz, .mha by suffix. Atomic.
/// Throws Error(io), and Error(bad_argument) for other suffixes and for volumes beyond 2^33 voxels.
void write_volume(const Octree& octree, const std::filesystem::path& path, bool crop = false);
/// The same for labels: the values are the labels, in the smallest of uint8, uint16 and uint32 that holds them all; the
/// bounding box is that of all labels but 0.
void write_volume(const LabelMap& labels, const std::filesystem::path& path, bool crop = false);

/// Writes the solid as write_volume() does, but as a .nrrd file of raw values, written slab by slab: volumes may be
/// larger than memory. The file that blackleaf-mpi build reads.
void write_raw_volume(const Octree& octree, const std::filesystem::path& path, bool crop = false);

}  // namespace blackleaf
