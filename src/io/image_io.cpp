#include "io/image_io.h"

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <nifti1_io.h>
#include <stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <exception>
#include <iostream>
#include <mutex>
#include <streambuf>

#include <fmt/format.h>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;

// While ITK works: no words of its own on stderr or stdout; what is worth telling comes as an Error. ITK's switches are
// global to the process, so only one thread at a time is inside.
class Quiet {
 public:
  Quiet()
      : lock_(mutex()),
        warnings_(itk::Object::GetGlobalWarningDisplay()),
        cerr_(std::cerr.rdbuf(&nothing_)),
        cout_(std::cout.rdbuf(&nothing_)) {
    itk::Object::SetGlobalWarningDisplay(false);
    nifti_set_debug_level(0);
  }
  ~Quiet() {
    nifti_set_debug_level(1);  // its default; it has no way to ask
    std::cout.rdbuf(cout_);
    std::cerr.rdbuf(cerr_);
    itk::Object::SetGlobalWarningDisplay(warnings_);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  class Nothing : public std::streambuf {
    int_type overflow(int_type c) override { return traits_type::not_eof(c); }
  };
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::lock_guard<std::mutex> lock_;
  Nothing nothing_;
  bool warnings_;
  std::streambuf* cerr_;
  std::streambuf* cout_;
};

// ITK's reasons run over many lines, with addresses and file names: what remains is the last thing they say.
std::string reason(const std::exception& exception) {
  const auto* itk_exception = dynamic_cast<const itk::ExceptionObject*>(&exception);
  std::string text = itk_exception ? itk_exception->GetDescription() : exception.what();
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (const auto line = text.find_last_of('\n'); line != std::string::npos) text.erase(0, line + 1);
  if (const auto prefix = text.rfind("): "); prefix != std::string::npos) text.erase(0, prefix + 3);
  while (!text.empty() && (std::isspace(static_cast<unsigned char>(text.front())) || text.front() == '['))
    text.erase(0, text.front() == '[' ? std::min(text.find("] "), text.size() - 2) + 2 : 1);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  if (text.size() > 200) text.resize(200);
  return text;
}

itk::ImageIOBase::Pointer make(ImageFormat format) {
  switch (format) {
    case ImageFormat::nrrd:
      return itk::NrrdImageIO::New().GetPointer();
    case ImageFormat::nifti: {
      const auto nifti = itk::NiftiImageIO::New();
      nifti->SetLegacyAnalyze75Mode(itk::NiftiImageIOEnums::Analyze75Flavor::AnalyzeITK4);
      return nifti.GetPointer();
    }
    case ImageFormat::meta: {
      const auto meta = itk::MetaImageIO::New();
      meta->SetDoublePrecision(17);
      return meta.GetPointer();
    }
  }
  return nullptr;
}

std::optional<Component> component_of(itk::IOComponentEnum type, std::size_t bytes) {
  using enum itk::IOComponentEnum;
  switch (type) {
    case UCHAR:
      return Component::u8;
    case CHAR:
      return Component::i8;
    case USHORT:
      return Component::u16;
    case SHORT:
      return Component::i16;
    case UINT:
    case ULONG:
    case ULONGLONG:
      return bytes == 8 ? Component::u64 : Component::u32;
    case INT:
    case LONG:
    case LONGLONG:
      return bytes == 8 ? Component::i64 : Component::i32;
    case FLOAT:
      return Component::f32;
    case DOUBLE:
      return Component::f64;
    default:
      return std::nullopt;
  }
}

}  // namespace

const char* format_name(ImageFormat format) {
  return format == ImageFormat::nrrd ? "NRRD" : format == ImageFormat::nifti ? "NIfTI" : "MetaImage";
}

std::string image_suffix(const fs::path& path) {
  const auto lower = [](std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  std::string last = lower(path.extension().string());
  if (last != ".gz") return last;
  const std::string before = lower(path.stem().extension().string());
  return before == ".nii" || before == ".img" || before == ".nia" ? before + last : last;
}

std::optional<ImageFormat> image_format(const fs::path& path) {
  const std::string suffix = image_suffix(path);
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), suffix) != names.end();
  };
  if (is({".nrrd", ".nhdr"})) return ImageFormat::nrrd;
  if (is({".nii", ".nii.gz", ".hdr", ".img", ".img.gz"})) return ImageFormat::nifti;
  if (is({".mha", ".mhd"})) return ImageFormat::meta;
  return std::nullopt;
}

std::size_t bytes_of(Component component) {
  switch (component) {
    case Component::u8:
    case Component::i8:
      return 1;
    case Component::u16:
    case Component::i16:
      return 2;
    case Component::u32:
    case Component::i32:
    case Component::f32:
      return 4;
    default:
      return 8;
  }
}

// Another name for a single-file NIfTI image, in a folder of its own. The NIfTI library looks for a file's data by its
// name without suffix, so beside scan.nii it reads scan.nii.gz's header with scan.nii's voxels.
class LonelyName {
 public:
  explicit LonelyName(const fs::path& path) {
    const std::string suffix = image_suffix(path);
    if (suffix != ".nii" && suffix != ".nii.gz") return;
    std::string pattern = (fs::temp_directory_path() / "blackleaf-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr)
      throw Error(ErrorCode::io, pattern + ": cannot make a temporary folder",
                  "set TMPDIR to a folder you can write to");
    folder_ = pattern;
    link_ = folder_ / ("image" + suffix);
    std::error_code error;
    fs::create_symlink(fs::absolute(path), link_, error);
    if (!error) return;
    const std::string where = folder_.string();
    remove();
    throw Error(ErrorCode::io, fmt::format("{}: cannot make a link there: {}", where, error.message()),
                "set TMPDIR to a folder that can hold links");
  }
  ~LonelyName() { remove(); }
  LonelyName(const LonelyName&) = delete;
  LonelyName& operator=(const LonelyName&) = delete;

  fs::path of(const fs::path& path) const { return folder_.empty() ? path : link_; }
  /// The text with the true name in place of the other one.
  std::string told(std::string text, const std::string& name) const {
    for (const std::string& other : {link_.string(), folder_.string()})
      for (std::size_t at = 0; !other.empty() && (at = text.find(other, at)) != std::string::npos; at += name.size())
        text.replace(at, other.size(), name);
    return text;
  }

 private:
  void remove() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }

  fs::path folder_, link_;
};

struct ImageReader::Itk {
  Itk(const fs::path& path, ImageFormat image_format) : name(path.string()), format(image_format), lonely(path) {}

  itk::ImageIOBase::Pointer io;
  std::string name;
  ImageFormat format;
  LonelyName lonely;

  // Requires: called while an exception is handled.
  [[noreturn]] void fail() const {
    std::string why = "for an unknown reason";
    try {
      throw;
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw Error(ErrorCode::bad_input, name + ": needs more memory than there is", "crop or resample it first");
    } catch (const std::exception& exception) {
      why = lonely.told(reason(exception), name);
    } catch (...) {  // some of ITK's libraries throw what is no std::exception
    }
    if (why.find("rthonormal") != std::string::npos)
      throw Error(ErrorCode::bad_input, name + ": its axes are not orthogonal", "use .nrrd, which can hold such axes");
    throw Error(ErrorCode::bad_input, fmt::format("{}: cannot be read as {}: {}", name, format_name(format), why),
                "the file is damaged or of another format");
  }
};

ImageReader::ImageReader(const fs::path& path, ImageFormat format) : itk_(std::make_unique<Itk>(path, format)) {
  const Quiet quiet;
  try {
    const std::string name = itk_->lonely.of(path).string();
    itk_->io = make(format);
    if (!itk_->io->CanReadFile(name.c_str()))
      throw Error(ErrorCode::bad_input, fmt::format("{}: is not a {} file", path.string(), format_name(format)),
                  "its contents are not what its name says; check where it comes from");
    itk_->io->SetFileName(name);
    itk_->io->ReadImageInformation();
    take_information();
  } catch (...) {
    itk_->fail();
  }
}

void ImageReader::take_information() {
  const auto& io = *itk_->io;
  information_.components = static_cast<int>(io.GetNumberOfComponents());
  if (io.GetComponentType() != itk::IOComponentEnum::UNKNOWNCOMPONENTTYPE)  // which has no size
    information_.component = component_of(io.GetComponentType(), io.GetComponentSize());
  const unsigned dimensions = io.GetNumberOfDimensions();
  for (unsigned i = 0; i < dimensions; ++i) information_.size.push_back(static_cast<std::int64_t>(io.GetDimensions(i)));
  for (unsigned i = 0; i < std::min(dimensions, 3u); ++i) {
    information_.geometry.origin[i] = io.GetOrigin(i);
    const std::vector<double> direction = io.GetDirection(i);
    for (unsigned row = 0; row < 3; ++row)
      information_.geometry.axes[i][row] = row < direction.size() ? direction[row] * io.GetSpacing(i) : 0.0;
  }
}

ImageReader::~ImageReader() = default;

void ImageReader::read(void* values) {
  const Quiet quiet;
  try {
    const unsigned dimensions = itk_->io->GetNumberOfDimensions();
    itk::ImageIORegion region(dimensions);
    for (unsigned i = 0; i < dimensions; ++i) {
      region.SetIndex(i, 0);
      region.SetSize(i, itk_->io->GetDimensions(i));
    }
    itk_->io->SetIORegion(region);
    itk_->io->Read(values);
  } catch (...) {
    itk_->fail();
  }
}

void write_image(const fs::path& path, ImageFormat format, const std::array<std::int64_t, 3>& size,
                 const ImageGeometry& geometry, Component component, const void* values) {
  using Type = itk::IOComponentEnum;
  const Quiet quiet;
  try {
    const itk::ImageIOBase::Pointer io = make(format);
    io->SetFileName(path.string());
    io->SetNumberOfDimensions(3);
    io->SetPixelType(itk::IOPixelEnum::SCALAR);
    io->SetComponentType(component == Component::u8    ? Type::UCHAR
                         : component == Component::u16 ? Type::USHORT
                                                       : Type::UINT);
    io->SetNumberOfComponents(1);
    itk::ImageIORegion region(3);
    for (unsigned i = 0; i < 3; ++i) {
      const std::array<double, 3>& axis = geometry.axes[i];
      const double spacing = std::hypot(axis[0], axis[1], axis[2]);
      io->SetDimensions(i, static_cast<itk::SizeValueType>(size[i]));
      io->SetOrigin(i, geometry.origin[i]);
      io->SetSpacing(i, spacing);
      io->SetDirection(i, std::vector<double>{axis[0] / spacing, axis[1] / spacing, axis[2] / spacing});
      region.SetIndex(i, 0);
      region.SetSize(i, static_cast<itk::SizeValueType>(size[i]));
    }
    io->SetIORegion(region);
    io->SetUseCompression(format != ImageFormat::nifti);  // NIfTI goes by the suffix
    io->WriteImageInformation();
    io->Write(values);
  } catch (const std::exception& exception) {
    throw Error(ErrorCode::io, fmt::format("cannot be written as {}: {}", format_name(format), reason(exception)));
  }
}

}  // namespace blackleaf::detail
