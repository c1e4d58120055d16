#include "io/slice_stack.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"
#include "io/dicom_files.h"
#include "io/dicom_series.h"
#include "io/picture_slices.h"
#include "io/stack_files.h"
#include "io/stack_source.h"
#include "io/volume_shape.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

// One stack on its way from names to a source.
class StackJob {
 public:
  StackJob(const fs::path& path, const SourceOptions& options) : path_(path), options_(options) {}

  std::unique_ptr<VolumeSource> run() {
    if (options_.spacing)
      for (const double side : *options_.spacing)
        if (!(side > 0) || !std::isfinite(side))
          throw Error(ErrorCode::bad_argument, fmt::format("a spacing of {} mm between voxels makes no sense", side),
                      "give lengths above zero");
    std::error_code error;
    folder_ = fs::is_directory(path_, error);
    if (folder_)
      files_ = find_slices(path_);
    else
      files_ = {slice_kind(path_), {path_}, {}};
    if (files_.kind != SliceKind::dicom && !options_.series.empty())
      throw Error(ErrorCode::bad_argument, name() + ": a series is chosen, but it holds no DICOM files",
                  "leave it out");
    switch (files_.kind) {
      case SliceKind::dicom:
        return dicom();
      case SliceKind::png:
        return png();
      case SliceKind::tiff:
        return tiff();
      case SliceKind::none:
        break;
    }
    fail("is neither DICOM nor TIFF nor PNG", "its contents are not what its name says; check where it comes from");
  }

 private:
  std::string name() const { return path_.string(); }
  [[noreturn]] void fail(const std::string& what, const std::string& remedy) const {
    throw Error(ErrorCode::bad_input, fmt::format("{}: {}", name(), what), remedy);
  }
  void warn(const std::string& what) const {
    if (options_.warn) options_.warn(fmt::format("{}: {}", name(), what));
  }
  void warn_of_others() const {
    const auto& others = files_.passed_over;
    if (!others.empty())
      warn(fmt::format("{} file{} no slice{} and passed over: {}", others.size(), others.size() == 1 ? " is" : "s are",
                       others.size() == 1 ? "" : "s", some_of(others)));
  }

  // Voxels of side 1, or of the sides that were asked for or found; the corner of the first is the origin.
  static void set_geometry(ImageGeometry& geometry, const std::optional<std::array<double, 3>>& spacing) {
    geometry = {};
    geometry.unit = spacing ? "mm" : "voxel";
    for (std::size_t i = 0; i < 3; ++i) {
      if (spacing) geometry.axes[i][i] = (*spacing)[i];
      geometry.origin[i] = geometry.axes[i][i] / 2;
    }
  }

  std::unique_ptr<VolumeSource> dicom() {
    auto files = std::make_shared<std::vector<DicomFile>>(read_dicom_headers(files_.files));
    for (const DicomFile& file : *files)
      if (file.frames.empty()) files_.passed_over.push_back(file.path.filename().string());
    auto series = std::make_shared<DicomSeries>(choose_series(*files, options_.series, name()));
    warn_of_others();
    if (series->has_place && options_.spacing)
      throw Error(ErrorCode::bad_argument, name() + ": a spacing is given, but the files tell their own",
                  "leave it out");
    if (!series->has_place) set_geometry(series->geometry, options_.spacing);

    StackPlan plan;
    const DicomPixels& pixels = (*files)[series->slices[0].file].pixels;
    plan.information.size = {pixels.columns, pixels.rows, static_cast<std::int64_t>(series->slices.size())};
    plan.information.component = series->component;
    plan.information.geometry = series->geometry;
    for (const DicomSlice& slice : series->slices) {
      const DicomFile& file = (*files)[slice.file];
      plan.largest_file = std::max(plan.largest_file, file.bytes);
      if (file.pixels.frames > 1 && file.pixels.offset == 0)
        plan.kept_bytes = std::max(plan.kept_bytes, static_cast<std::uint64_t>(pixels.columns) *
                                                        static_cast<std::uint64_t>(pixels.rows) * file.frames.size() *
                                                        static_cast<std::uint64_t>(file.pixels.bits_allocated / 8));
    }
    plan.file_of = [files, series](std::int64_t i) {
      return (*files)[series->slices[static_cast<std::size_t>(i)].file].path.string();
    };
    plan.decode = [files, series, decoder = std::make_shared<DicomDecoder>()](std::int64_t i, void* values) {
      const DicomSlice& slice = series->slices[static_cast<std::size_t>(i)];
      decoder->decode((*files)[slice.file], slice.frame, series->component, values);
    };
    return std::make_unique<StackSource>(std::move(plan));
  }

  // Throws unless picture i is like the first.
  void check_alike(const Picture& first, const Picture& other, const std::string& first_name,
                   const std::string& other_name) const {
    if (first.width != other.width || first.height != other.height)
      fail(fmt::format("its slices differ in size: {} has {} x {} voxels, {} has {} x {}", first_name, first.width,
                       first.height, other_name, other.width, other.height),
           "keep the slices of one volume in a folder of their own");
    if (first.component != other.component)
      fail(fmt::format("its slices differ in the type of their values: {} and {}", first_name, other_name),
           "save all as one type");
  }

  StackPlan picture_plan(const Picture& picture, std::size_t slices,
                         const std::optional<std::array<double, 3>>& spacing) const {
    warn_of_others();
    if (const std::string oddity = oddity_of_names(files_.files); !oddity.empty()) warn(oddity);
    StackPlan plan;
    plan.information.size = {picture.width, picture.height, static_cast<std::int64_t>(slices)};
    plan.information.component = picture.component;
    set_geometry(plan.information.geometry, spacing);
    for (const fs::path& file : files_.files) plan.largest_file = std::max(plan.largest_file, InputFile(file).size());
    return plan;
  }

  std::unique_ptr<VolumeSource> png() {
    const std::vector<fs::path>& files = files_.files;
    const Picture first = png_header(files[0]);
    for (const fs::path& file : files)
      check_alike(first, png_header(file), files[0].filename().string(), file.filename().string());
    StackPlan plan = picture_plan(first, files.size(), options_.spacing);
    plan.file_of = [files](std::int64_t i) { return files[static_cast<std::size_t>(i)].string(); };
    plan.decode = [files, first](std::int64_t i, void* values) {
      decode_png(files[static_cast<std::size_t>(i)], first, values);
    };
    return std::make_unique<StackSource>(std::move(plan));
  }

  std::unique_ptr<VolumeSource> tiff() {
    const std::vector<fs::path>& files = files_.files;
    const std::vector<TiffFile> headers = read_tiff_headers(files);
    struct Page {
      std::size_t file = 0;
      std::uint32_t directory = 0;
    };
    std::vector<Page> pages;
    const Picture first = headers[0].pages[0];
    const auto page_name = [&](std::size_t i, std::size_t k) {
      const std::string file = files[i].filename().string();
      return headers[i].pages.size() == 1 ? file : fmt::format("page {} of {}", k + 1, file);
    };
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (files.size() > 1 && headers[i].pages.size() > 1)
        fail(fmt::format("{} of its {} files has {} pages", files[i].filename().string(), files.size(),
                         headers[i].pages.size()),
             "build from that file alone, or keep one page a file");
      for (std::size_t k = 0; k < headers[i].pages.size(); ++k) {
        check_alike(first, headers[i].pages[k], page_name(0, 0), page_name(i, k));
        pages.push_back({i, headers[i].directories[k]});
      }
    }
    // Only a stack in one file knows how far apart its slices are.
    const std::optional<std::array<double, 3>> own = files.size() == 1 ? headers[0].spacing : std::nullopt;
    StackPlan plan = picture_plan(first, pages.size(), options_.spacing ? options_.spacing : own);
    plan.file_of = [files, pages](std::int64_t i) { return files[pages[static_cast<std::size_t>(i)].file].string(); };
    plan.decode = [files, pages, first, decoder = std::make_shared<TiffDecoder>()](std::int64_t i, void* values) {
      const Page& page = pages[static_cast<std::size_t>(i)];
      decoder->decode(files[page.file], first, page.directory, values);
    };
    return std::make_unique<StackSource>(std::move(plan));
  }

  const fs::path& path_;
  const SourceOptions& options_;
  bool folder_ = false;
  StackFiles files_;
};

}  // namespace

bool has_slice_suffix(const fs::path& path) { return promised_kind(path) != SliceKind::none; }

bool is_stack(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return true;
  // The voxels of other volumes may begin with any bytes.
  if (image_format(path) || !fs::is_regular_file(path, error)) return false;
  try {
    return slice_kind(path) != SliceKind::none;
  } catch (const Error&) {
    return false;  // whoever reads it says why
  }
}

std::unique_ptr<VolumeSource> open_stack(const fs::path& path, const SourceOptions& options) {
  auto source = StackJob(path, options).run();
  check_shape(path, source->information());
  return source;
}

}  // namespace blackleaf::detail
