// From the headers of DICOM files to one volume: which series, in which order, where it lies, what type its values
// have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/dicom_files.h"

namespace blackleaf::detail {

struct DicomSlice {
  std::size_t file = 0, frame = 0;
};

struct DicomSeries {
  std::vector<DicomSlice> slices;  // in order of z
  bool has_place = false;          // false: geometry is left as it is made
  ImageGeometry geometry;
  Component component = Component::u8;
};

/// The series of the given UID, or the one whose UID ends so; without `wanted`, the only one there is. Slices are
/// ordered along row x column, the normal of the slices, whatever the names of their files; the axes are the directions
/// of columns, rows and of the line from the first slice to the last, each as long as a voxel, in mm and LPS. Slices
/// without places are ordered by instance number. The component is the smallest that holds slope * stored + intercept
/// for all stored values that the headers allow, double where slope or intercept are not whole.
/// Throws Error(bad_input) unless all slices are of one size, type and orientation and lie evenly, each within a
/// tenth of a voxel of its place, and Error(bad_argument) when no series is like the wanted one. `name` is what
/// messages begin with. O(n log n) in slices.
DicomSeries choose_series(const std::vector<DicomFile>& files, const std::string& wanted, const std::string& name);

}  // namespace blackleaf::detail
