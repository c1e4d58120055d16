#include "io/dicom_series.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vector& a) { return std::hypot(a[0], a[1], a[2]); }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector times(const Vector& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Of a voxel's sides: how far a slice may lie from where it should.
constexpr double kTolerance = 0.1;
// Of direction cosines and relative spacings, which files round to a few digits.
constexpr double kRounding = 1e-3;

class SeriesJob {
 public:
  SeriesJob(const std::vector<DicomFile>& files, const std::string& name) : files_(files), name_(name) {}

  DicomSeries run(const std::string& wanted) {
    choose(wanted);
    check_alike();
    if (result_.has_place)
      place();
    else
      order_by_number();
    choose_component();
    return result_;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", name_, what), remedy);
  }
  const DicomFile& file(const DicomSlice& slice) const { return files_[slice.file]; }
  const DicomFrame& frame(const DicomSlice& slice) const { return files_[slice.file].frames[slice.frame]; }
  std::string name_of(const DicomSlice& slice) const {
    const std::string file_name = file(slice).path.filename().string();
    return file(slice).frames.size() == 1 ? file_name : fmt::format("frame {} of {}", slice.frame + 1, file_name);
  }

  void choose(const std::string& wanted) {
    struct Series {
      std::size_t slices = 0;
      std::string description;
    };
    std::map<std::string, Series> all;
    for (const DicomFile& each : files_)
      if (!each.frames.empty()) {
        Series& series = all[each.series];
        series.slices += each.frames.size();
        if (series.description.empty()) series.description = each.description;
      }
    if (all.empty()) fail("holds no DICOM images", "name a folder with the slices of a volume");
    const auto list = [&] {
      constexpr std::size_t kMost = 8;
      std::vector<std::string> lines;
      for (const auto& [uid, series] : all) {
        if (lines.size() == kMost) break;
        lines.push_back(fmt::format("{} ('{}', {} slice{})", uid.empty() ? "no UID" : uid, series.description,
                                    series.slices, series.slices == 1 ? "" : "s"));
      }
      if (all.size() > kMost) lines.push_back(fmt::format("{} more", all.size() - kMost));
      return fmt::format("{}", fmt::join(lines, ", "));
    };
    std::vector<std::string> found;
    for (const auto& [uid, series] : all)
      if (wanted.empty() || uid.ends_with(wanted)) found.push_back(uid);
    if (!wanted.empty() && all.count(wanted) > 0) found = {wanted};
    if (found.empty())
      throw Error(ErrorCode::bad_argument, fmt::format("{}: no series has the UID {}", name_, wanted),
                  "there are " + list());
    if (found.size() > 1 && !wanted.empty())
      throw Error(ErrorCode::bad_argument, fmt::format("{}: several series have UIDs that end with {}", name_, wanted),
                  "there are " + list());
    if (found.size() > 1)
      fail(fmt::format("holds {} DICOM series: {}", all.size(), list()), "choose one with --series UID");
    for (std::size_t i = 0; i < files_.size(); ++i)
      if (files_[i].series == found[0])
        for (std::size_t k = 0; k < files_[i].frames.size(); ++k) result_.slices.push_back({i, k});
  }

  void check_alike() {
    const DicomSlice& first = result_.slices[0];
    const DicomPixels& pixels = file(first).pixels;
    const std::string first_name = file(first).path.filename().string();
    for (const DicomSlice& slice : result_.slices) {
      const DicomPixels& other = file(slice).pixels;
      const std::string other_name = file(slice).path.filename().string();
      if (other.columns != pixels.columns || other.rows != pixels.rows)
        fail(fmt::format("its slices differ in size: {} has {} x {} voxels, {} has {} x {}", first_name, pixels.columns,
                         pixels.rows, other_name, other.columns, other.rows),
             "keep the slices of one volume in a folder of their own");
      if (other.samples != 1 || other.palette)
        fail(fmt::format("{} is in colours", other_name), "convert it to gray values first");
      if (other.bits_allocated != 8 && other.bits_allocated != 16 && other.bits_allocated != 32)
        fail(fmt::format("{} has values of {} bits", other_name, other.bits_allocated),
             "convert them to 8, 16 or 32 bits first");
      if (other.bits_stored < 1 || other.bits_stored > other.high_bit + 1 || other.high_bit >= other.bits_allocated)
        fail(fmt::format("{} tells of {} bits up to bit {} of {}, which makes no sense", other_name, other.bits_stored,
                         other.high_bit, other.bits_allocated),
             "get it again from its source");
      if (frame(slice).has_place != frame(first).has_place)
        fail(fmt::format("{} tells where it lies and {} does not", name_of(frame(slice).has_place ? slice : first),
                         name_of(frame(slice).has_place ? first : slice)),
             "keep the slices of one volume in a folder of their own");
    }
    result_.has_place = frame(first).has_place;
  }

  void check_orientations() const {
    const DicomSlice& first = result_.slices[0];
    const DicomFrame& model = frame(first);
    for (const Vector* axis : {&model.along_x, &model.along_y})
      if (std::abs(length(*axis) - 1) > 0.01)
        fail(fmt::format("{} has an axis whose direction is of length {:.4g} instead of 1", name_of(first),
                         length(*axis)),
             "mend its Image Orientation or get it again from its source");
    if (std::abs(dot(model.along_x, model.along_y)) > 0.01)
      fail(fmt::format("{} has rows and columns that are not at right angles", name_of(first)),
           "mend its Image Orientation or get it again from its source");
    for (const DicomSlice& slice : result_.slices) {
      const DicomFrame& other = frame(slice);
      for (std::size_t i = 0; i < 3; ++i) {
        if (std::abs(other.along_x[i] - model.along_x[i]) > kRounding ||
            std::abs(other.along_y[i] - model.along_y[i]) > kRounding)
          fail(fmt::format("its slices are turned against each other: {} and {}", name_of(first), name_of(slice)),
               "keep the slices of one volume in a folder of their own");
        if (!(std::abs(other.position[i]) < 1e9))
          fail(fmt::format("{} lies beyond all bounds", name_of(slice)), "get it again from its source");
      }
      for (std::size_t i = 0; i < 2; ++i) {
        if (!(model.spacing[i] < 1e6 && model.spacing[i] > 1e-9))
          fail(fmt::format("{} has voxels {} mm wide", name_of(first), model.spacing[i]),
               "get it again from its source");
        if (std::abs(other.spacing[i] - model.spacing[i]) > kRounding * model.spacing[i])
          fail(fmt::format("its slices have voxels of different sizes: {:.6g} x {:.6g} mm in {}, {:.6g} x {:.6g} in {}",
                           model.spacing[0], model.spacing[1], name_of(first), other.spacing[0], other.spacing[1],
                           name_of(slice)),
               "keep the slices of one volume in a folder of their own");
      }
    }
  }

  // Sorts the slices along their normal and takes the volume's geometry from where they lie.
  void place() {
    check_orientations();
    std::vector<DicomSlice>& slices = result_.slices;
    const DicomFrame& model = frame(slices[0]);
    const Vector x = times(model.along_x, 1 / length(model.along_x));
    const Vector y = times(model.along_y, 1 / length(model.along_y));
    Vector normal = cross(x, y);
    normal = times(normal, 1 / length(normal));
    const auto height = [&](const DicomSlice& slice) { return dot(frame(slice).position, normal); };
    std::stable_sort(slices.begin(), slices.end(),
                     [&](const DicomSlice& a, const DicomSlice& b) { return height(a) < height(b); });

    const std::size_t count = slices.size();
    Vector step = times(normal, model.thickness > 0 ? model.thickness : 1);
    if (count > 1) {
      step = times(minus(frame(slices.back()).position, frame(slices.front()).position), 1.0 / double(count - 1));
      check_distances(height);
      check_line(step, normal);
    }
    result_.geometry.origin = frame(slices[0]).position;
    result_.geometry.axes = {times(x, model.spacing[0]), times(y, model.spacing[1]), step};
  }

  template <class Height>
  void check_distances(const Height& height) const {
    const std::vector<DicomSlice>& slices = result_.slices;
    std::vector<double> distances;
    for (std::size_t i = 1; i < slices.size(); ++i) distances.push_back(height(slices[i]) - height(slices[i - 1]));
    std::vector<double> sorted = distances;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double usual = *middle;
    for (std::size_t i = 0; i < distances.size(); ++i)
      if (!(distances[i] > kTolerance * usual) || !(distances[i] > 1e-6))
        fail(fmt::format("{} and {} lie in the same place", name_of(slices[i]), name_of(slices[i + 1])),
             "if they are one slice twice, remove one; if they belong to several volumes, give each a folder of its "
             "own");
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const double times_usual = distances[i] / usual;
      if (std::abs(times_usual - 1) <= 2 * kTolerance) continue;
      const double missing = std::round(times_usual) - 1;
      if (missing >= 1 && std::abs(times_usual - missing - 1) <= 2 * kTolerance)
        fail(fmt::format("{:.0f} slice{} missing between {} and {}, which lie {:.6g} mm apart instead of {:.6g}",
                         missing, missing == 1 ? " is" : "s are", name_of(slices[i]), name_of(slices[i + 1]),
                         distances[i], usual),
             "get the whole series from its source");
      fail(fmt::format("its slices lie unevenly: {:.6g} mm between {} and {}, but {:.6g} mm elsewhere", distances[i],
                       name_of(slices[i]), name_of(slices[i + 1]), usual),
           "resample it to even slices first");
    }
  }

  void check_line(const Vector& step, const Vector& normal) const {
    const std::vector<DicomSlice>& slices = result_.slices;
    const double voxel = dot(step, normal);
    const DicomFrame& first = frame(slices[0]);
    const double least = std::min({voxel, first.spacing[0], first.spacing[1]});
    for (std::size_t i = 1; i < slices.size(); ++i) {
      const Vector off = minus(minus(frame(slices[i]).position, first.position), times(step, double(i)));
      const double along = dot(off, normal);
      const double across = length(minus(off, times(normal, along)));
      if (std::abs(along) > kTolerance * voxel)
        fail(fmt::format("its slices lie unevenly: {} is {:.4g} mm off its place", name_of(slices[i]), along),
             "resample it to even slices first");
      if (across > kTolerance * least)
        fail(fmt::format("its slices do not lie in a row: {} is {:.4g} mm aside", name_of(slices[i]), across),
             "resample it to slices in a row first");
    }
  }

  void order_by_number() {
    std::vector<DicomSlice>& slices = result_.slices;
    std::stable_sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
      return file(a).number != file(b).number ? file(a).number < file(b).number : a.frame < b.frame;
    });
    for (std::size_t i = 1; i < slices.size(); ++i)
      if (slices[i].file != slices[i - 1].file && file(slices[i]).number == file(slices[i - 1]).number)
        fail(fmt::format("its slices cannot be ordered: {} and {} tell neither where they lie nor different numbers",
                         name_of(slices[i - 1]), name_of(slices[i])),
             "export them with Image Position and Orientation");
  }

  void choose_component() {
    double least = std::numeric_limits<double>::max(), most = std::numeric_limits<double>::lowest();
    bool whole = true;
    for (const DicomSlice& slice : result_.slices) {
      const DicomPixels& pixels = file(slice).pixels;
      const DicomFrame& meaning = frame(slice);
      if (!std::isfinite(meaning.slope) || !std::isfinite(meaning.intercept))
        fail(fmt::format("{} has a rescale slope or intercept that is not finite", name_of(slice)),
             "get it again from its source");
      whole = whole && meaning.slope == std::floor(meaning.slope) && meaning.intercept == std::floor(meaning.intercept);
      const double above = std::ldexp(1.0, pixels.bits_stored - (pixels.is_signed ? 1 : 0));
      for (const double end : {pixels.is_signed ? -above : 0.0, above - 1}) {
        least = std::min(least, meaning.slope * end + meaning.intercept);
        most = std::max(most, meaning.slope * end + meaning.intercept);
      }
    }
    result_.component = Component::f64;
    // Beyond 2^53 doubles round, and bounds are not exact any more; rescaled to that, values are no counts.
    if (!whole || least < -0x1p52 || most > 0x1p52) return;
    const auto fits = [&]<class T>(T) {
      return least >= static_cast<double>(std::numeric_limits<T>::min()) &&
             most <= static_cast<double>(std::numeric_limits<T>::max());
    };
    result_.component = fits(std::uint8_t{})    ? Component::u8
                        : fits(std::int8_t{})   ? Component::i8
                        : fits(std::uint16_t{}) ? Component::u16
                        : fits(std::int16_t{})  ? Component::i16
                        : fits(std::uint32_t{}) ? Component::u32
                        : fits(std::int32_t{})  ? Component::i32
                                                : Component::i64;
  }

  const std::vector<DicomFile>& files_;
  const std::string& name_;
  DicomSeries result_;
};

}  // namespace

DicomSeries choose_series(const std::vector<DicomFile>& files, const std::string& wanted, const std::string& name) {
  return SeriesJob(files, name).run(wanted);
}

}  // namespace blackleaf::detail
