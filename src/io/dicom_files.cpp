#include "io/dicom_files.h"

#include <gdcmAttribute.h>
#include <gdcmImageHelper.h>
#include <gdcmImageReader.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmSequenceOfItems.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "blackleaf/error.h"
#include "file/input_file.h"
#include "io/isolated.h"
#include "io/stack_source.h"

namespace blackleaf::detail {
namespace {

namespace fs = std::filesystem;
using gdcm::DataSet;
using gdcm::Tag;

constexpr const char* kAgain = "get it again from its source";

[[noreturn]] void refuse(const fs::path& path, const std::string& what, const std::string& remedy) {
  throw Error(ErrorCode::bad_input, fmt::format("{}: {}", path.string(), what), remedy);
}

// The element's bytes without padding; empty when it is not there.
std::string_view text(const DataSet& set, const Tag& tag) {
  if (!set.FindDataElement(tag)) return {};
  const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
  if (!value || !value->GetPointer()) return {};
  std::string_view result(value->GetPointer(), value->GetLength());
  const auto is_padding = [](char c) { return c == ' ' || c == '\0'; };
  while (!result.empty() && is_padding(result.back())) result.remove_suffix(1);
  while (!result.empty() && is_padding(result.front())) result.remove_prefix(1);
  return result;
}

std::string printable(std::string_view text) {
  std::string result(text.substr(0, 64));
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e) c = '?';
  return result;
}

// One finite number of a decimal string.
std::optional<double> number(std::string_view word) {
  while (!word.empty() && (word.front() == ' ' || word.front() == '+')) word.remove_prefix(1);
  while (!word.empty() && word.back() == ' ') word.remove_suffix(1);
  double value = 0;
  const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || last != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

// A decimal string of N numbers; none if there are fewer or one is no finite number.
template <std::size_t N>
std::optional<std::array<double, N>> numbers(const DataSet& set, const Tag& tag) {
  std::string_view rest = text(set, tag);
  std::array<double, N> result{};
  for (double& value : result) {
    const auto end = std::min(rest.find('\\'), rest.size());
    const auto found = number(rest.substr(0, end));
    if (!found) return std::nullopt;
    value = *found;
    rest.remove_prefix(std::min(rest.size(), end + 1));
  }
  return result;
}

// The first item of a sequence, or the item of that index.
const DataSet* item(const DataSet& set, const Tag& sequence, std::size_t index,
                    gdcm::SmartPointer<gdcm::SequenceOfItems>& keep) {
  if (!set.FindDataElement(sequence)) return nullptr;
  keep = set.GetDataElement(sequence).GetValueAsSQ();
  if (!keep || index >= keep->GetNumberOfItems()) return nullptr;
  return &keep->GetItem(index + 1).GetNestedDataSet();
}

const Tag kPixelData(0x7fe0, 0x0010);
const Tag kPosition(0x0020, 0x0032), kOrientation(0x0020, 0x0037), kPixelSpacing(0x0028, 0x0030);
const Tag kThickness(0x0018, 0x0050), kSliceSpacing(0x0018, 0x0088);

// The numbers of a tag; none if it is absent or empty. What is there but cannot be meant is an error: a place that is
// not understood must not pass for one that is not told.
template <std::size_t N>
std::optional<std::array<double, N>> told(const fs::path& path, const DataSet& set, Tag tag, const char* name) {
  const std::string_view words = text(set, tag);
  if (words.empty()) return std::nullopt;
  const auto found = numbers<N>(set, tag);
  const bool is_sound = found && (tag != kPixelSpacing || ((*found)[0] > 0 && (*found)[N - 1] > 0));
  if (!is_sound)
    refuse(path,
           fmt::format("its {} ({:04x},{:04x}) makes no sense: '{}'", name, tag.GetGroup(), tag.GetElement(),
                       printable(words)),
           kAgain);
  return found;
}

// What is known of a frame so far; functional groups of one frame replace what those of all frames say.
struct Facts {
  std::optional<std::array<double, 3>> position;
  std::optional<std::array<double, 6>> orientation;
  std::optional<std::array<double, 2>> spacing;
  std::optional<double> between, thickness, slope, intercept;

  void take(const fs::path& path, const DataSet& set) {
    if (const auto found = told<3>(path, set, kPosition, "Image Position")) position = found;
    if (const auto found = told<6>(path, set, kOrientation, "Image Orientation")) orientation = found;
    if (const auto found = told<2>(path, set, kPixelSpacing, "Pixel Spacing")) spacing = found;
    if (const auto found = told<1>(path, set, kSliceSpacing, "Spacing Between Slices")) between = (*found)[0];
    if (const auto found = told<1>(path, set, kThickness, "Slice Thickness")) thickness = (*found)[0];
  }
  void take_value_meaning(const DataSet& set) {
    if (const auto found = numbers<1>(set, Tag(0x0028, 0x1053))) slope = (*found)[0];
    if (const auto found = numbers<1>(set, Tag(0x0028, 0x1052))) intercept = (*found)[0];
  }
  // An item of the functional groups sequences.
  void take_groups(const fs::path& path, const DataSet& groups) {
    gdcm::SmartPointer<gdcm::SequenceOfItems> keep;
    for (const Tag& tag : {Tag(0x0020, 0x9113), Tag(0x0020, 0x9116), Tag(0x0028, 0x9110)})
      if (const DataSet* set = item(groups, tag, 0, keep)) take(path, *set);
    if (const DataSet* set = item(groups, Tag(0x0028, 0x9145), 0, keep)) take_value_meaning(*set);
  }

  DicomFrame frame() const {
    DicomFrame result;
    result.slope = slope.value_or(1);
    if (result.slope == 0) result.slope = 1;  // as GDCM has it
    result.intercept = intercept.value_or(0);
    for (const auto& distance : {thickness, between})
      if (distance && std::abs(*distance) > 0) result.thickness = std::abs(*distance);
    if (!position || !orientation || !spacing) return result;
    result.has_place = true;
    result.position = *position;
    std::copy_n(orientation->begin(), 3, result.along_x.begin());
    std::copy_n(orientation->begin() + 3, 3, result.along_y.begin());
    result.spacing = {(*spacing)[1], (*spacing)[0]};  // the file tells the distance of rows first
    return result;
  }
};

// Moves the frame along its normal.
DicomFrame moved(DicomFrame frame, double distance) {
  const auto& x = frame.along_x;
  const auto& y = frame.along_y;
  const std::array<double, 3> normal = {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2],
                                        x[0] * y[1] - x[1] * y[0]};
  for (std::size_t i = 0; i < 3; ++i) frame.position[i] += distance * normal[i];
  return frame;
}

DicomPixels pixels_of(const gdcm::File& file) {
  const DataSet& set = file.GetDataSet();
  DicomPixels pixels;
  const std::vector<unsigned> size = gdcm::ImageHelper::GetDimensionsValue(file);
  const gdcm::PixelFormat format = gdcm::ImageHelper::GetPixelFormatValue(file);
  pixels.columns = size.at(0);
  pixels.rows = size.at(1);
  pixels.frames = std::max(1u, size.at(2));
  pixels.samples = format.GetSamplesPerPixel();
  pixels.bits_allocated = format.GetBitsAllocated();
  pixels.bits_stored = format.GetBitsStored();
  pixels.high_bit = format.GetHighBit();
  pixels.is_signed = format.GetPixelRepresentation() != 0;
  pixels.palette = text(set, Tag(0x0028, 0x0004)).starts_with("PALETTE");
  pixels.encapsulated = file.GetHeader().GetDataSetTransferSyntax().IsEncapsulated();
  return pixels;
}

void take_frames(const gdcm::File& file, DicomFile& result) {
  const DataSet& set = file.GetDataSet();
  const auto count = static_cast<std::size_t>(result.pixels.frames);
  gdcm::SmartPointer<gdcm::SequenceOfItems> keep, per_frame;
  Facts common;
  if (const DataSet* detector = item(set, Tag(0x0054, 0x0022), 0, keep)) common.take(result.path, *detector);
  common.take(result.path, set);
  const bool enhanced = set.FindDataElement(Tag(0x5200, 0x9230)) || set.FindDataElement(Tag(0x5200, 0x9229));
  for (const auto& [tag, what] : {std::pair(Tag(0x0028, 0x1053), "slope"), std::pair(Tag(0x0028, 0x1052), "intercept")})
    if (!text(set, tag).empty() && !numbers<1>(set, tag))
      refuse(result.path, fmt::format("its rescale {} is no finite number", what), kAgain);
  if (!enhanced) {
    const std::vector<double> meaning = gdcm::ImageHelper::GetRescaleInterceptSlopeValue(file);
    common.intercept = meaning.at(0);
    common.slope = meaning.at(1);
    result.frames.assign(count, common.frame());
    if (count == 1) return;
    // Frames without places of their own lie one behind the other, where the header tells how far apart.
    const std::string_view offsets = text(set, Tag(0x3004, 0x000c));
    std::vector<double> offset;
    for (std::size_t at = 0; at < offsets.size();) {
      const std::size_t end = std::min(offsets.find('\\', at), offsets.size());
      offset.push_back(number(offsets.substr(at, end - at)).value_or(HUGE_VAL));
      at = end + 1;
    }
    if (!offset.empty() &&
        (offset.size() != count || std::find(offset.begin(), offset.end(), HUGE_VAL) != offset.end()))
      refuse(result.path, fmt::format("its Grid Frame Offset Vector (3004,000c) does not hold {} numbers", count),
             kAgain);
    for (std::size_t i = 0; i < count; ++i) {
      DicomFrame& frame = result.frames[i];
      if (!offset.empty())
        frame = moved(frame, offset[i] - offset[0]);
      else if (common.between && *common.between != 0)
        frame = moved(frame, static_cast<double>(i) * std::abs(*common.between));
      else
        frame.has_place = false;
    }
    return;
  }
  if (const DataSet* shared = item(set, Tag(0x5200, 0x9229), 0, keep)) common.take_groups(result.path, *shared);
  for (std::size_t i = 0; i < count; ++i) {
    Facts facts = common;
    if (per_frame ? i < per_frame->GetNumberOfItems() : item(set, Tag(0x5200, 0x9230), i, per_frame) != nullptr)
      facts.take_groups(result.path, per_frame->GetItem(i + 1).GetNestedDataSet());
    result.frames.push_back(facts.frame());
  }
}

bool is_deflated(const gdcm::File& file) {
  return file.GetHeader().GetDataSetTransferSyntax() == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian;
}

DicomFile header_of(const fs::path& path) {
  DicomFile result;
  result.path = path;
  // Up to the values, which are skipped. In deflated files GDCM cannot skip what unpacks to more than the file.
  gdcm::Reader reader, whole;
  reader.SetFileName(path.c_str());
  whole.SetFileName(path.c_str());
  const bool skipped = reader.ReadUpToTag(kPixelData, {kPixelData});
  if (!skipped && (!is_deflated(reader.GetFile()) || !whole.Read())) refuse(path, "cannot be read as DICOM", kAgain);
  const gdcm::File& file = skipped ? reader.GetFile() : whole.GetFile();
  const DataSet& set = file.GetDataSet();
  result.series = printable(text(set, Tag(0x0020, 0x000e)));
  result.description = printable(text(set, Tag(0x0008, 0x103e)));
  if (const auto number = numbers<1>(set, Tag(0x0020, 0x0013)); number && std::abs((*number)[0]) < 0x1p53)
    result.number = static_cast<std::int64_t>((*number)[0]);
  // DICOMDIR, structured reports, radiotherapy plans and so on have no rows of pixels.
  if (!set.FindDataElement(Tag(0x0028, 0x0010)) || !set.FindDataElement(Tag(0x0028, 0x0011))) return result;
  result.pixels = pixels_of(file);
  const DicomPixels& pixels = result.pixels;
  if (pixels.columns == 0 || pixels.rows == 0) refuse(path, "has no voxels", kAgain);
  // Before anything is counted by what the header says: each frame takes a byte at the least, and raw ones all theirs.
  const InputFile input(path);
  const std::uint64_t bytes = input.size();
  const auto values = static_cast<double>(pixels.columns) * static_cast<double>(pixels.rows) *
                      static_cast<double>(pixels.frames) * pixels.samples;
  const gdcm::TransferSyntax& syntax = file.GetHeader().GetDataSetTransferSyntax();
  // deflate packs 1032 bytes into one at the very best, blank JPEG 2000 images more than anything else.
  const double most = pixels.encapsulated ? 1e5 : is_deflated(file) ? 1040 : 1;
  if (values * std::max(1, pixels.bits_allocated / 8) > most * static_cast<double>(bytes) ||
      static_cast<std::uint64_t>(pixels.frames) > 1040 * bytes)
    refuse(path,
           fmt::format("its header tells of {} x {} x {} voxels, more than its {} bytes can hold", pixels.columns,
                       pixels.rows, pixels.frames, bytes),
           "the file was cut off or its header is damaged; get it again from its source");
  if (syntax == gdcm::TransferSyntax::ImplicitVRLittleEndian ||
      syntax == gdcm::TransferSyntax::ExplicitVRLittleEndian) {
    // The reader stands at the values, behind the four bytes of their length; at the end if there are none.
    const std::uint64_t offset = reader.GetStreamCurrentPosition();
    std::uint32_t length = 0;
    if (offset < bytes && offset >= 4) {
      std::array<std::uint8_t, 4> four{};
      input.read_at(offset - 4, four);
      length = four[0] | std::uint32_t{four[1]} << 8 | std::uint32_t{four[2]} << 16 | std::uint32_t{four[3]} << 24;
    }
    const std::uint64_t there = offset < bytes ? std::min<std::uint64_t>(length, bytes - offset) : 0;
    const unsigned bytes_each = static_cast<unsigned>(pixels.bits_allocated) / 8;
    const double needed = values * bytes_each;
    // An odd byte is padded; whole frames more than told mean that their number was lost.
    const bool too_many = needed > 0 && static_cast<double>(there) >= std::max(2 * needed, needed + 2);
    if (static_cast<double>(there) < needed || too_many)
      refuse(path,
             fmt::format("its header tells of {} x {} x {} voxels, but it has values of {} bytes", pixels.columns,
                         pixels.rows, pixels.frames, there),
             too_many ? "its header is damaged, perhaps its Number of Frames; get it again from its source"
                      : "the file was cut off or its header is damaged; get it again from its source");
    result.pixels.offset = offset;
  }
  take_frames(file, result);
  return result;
}

// What the other process tells of each file: this, then the texts and the frames.
struct HeaderAnswer {
  std::uint64_t error_size = 0, series_size = 0, description_size = 0, frames = 0;
  std::int64_t number = 0;
  ErrorCode code = ErrorCode::bad_input;
  DicomPixels pixels;
};

void answer_header(const fs::path& path, const Answer& answer) {
  HeaderAnswer head;
  DicomFile file;
  std::string error_text;
  try {
    file = header_of(path);
  } catch (const Error& error) {
    error_text = error.what();
    head.code = error.code();
  }
  head.error_size = error_text.size();
  head.series_size = file.series.size();
  head.description_size = file.description.size();
  head.frames = file.frames.size();
  head.number = file.number;
  head.pixels = file.pixels;
  answer.write(&head, sizeof head);
  for (const std::string* part : {&error_text, &file.series, &file.description})
    answer.write(part->data(), part->size());
  answer.write(file.frames.data(), file.frames.size() * sizeof(DicomFrame));
}

template <class Stored, class Value>
void convert(const char* bytes, std::size_t count, const DicomPixels& pixels, const DicomFrame& frame, Value* values) {
  // Only the stored bits count; what is above and below them may be anything.
  const int up = static_cast<int>(8 * sizeof(Stored)) - 1 - pixels.high_bit;
  const int down = static_cast<int>(8 * sizeof(Stored)) - pixels.bits_stored;
  for (std::size_t i = 0; i < count; ++i) {
    std::make_unsigned_t<Stored> stored;
    std::memcpy(&stored, bytes + i * sizeof stored, sizeof stored);
    stored = static_cast<std::make_unsigned_t<Stored>>(stored << up);
    const auto number = static_cast<Stored>(static_cast<Stored>(stored) >> down);
    if constexpr (std::is_floating_point_v<Value>)
      values[i] = static_cast<Value>(frame.slope * static_cast<double>(number) + frame.intercept);
    else
      values[i] = static_cast<Value>(static_cast<std::int64_t>(frame.slope) * static_cast<std::int64_t>(number) +
                                     static_cast<std::int64_t>(frame.intercept));
  }
}

template <class Value>
void convert(const char* bytes, std::size_t count, const DicomPixels& pixels, const DicomFrame& frame, void* to) {
  auto* values = static_cast<Value*>(to);
  switch (pixels.bits_allocated) {
    case 8:
      return pixels.is_signed ? convert<std::int8_t>(bytes, count, pixels, frame, values)
                              : convert<std::uint8_t>(bytes, count, pixels, frame, values);
    case 16:
      return pixels.is_signed ? convert<std::int16_t>(bytes, count, pixels, frame, values)
                              : convert<std::uint16_t>(bytes, count, pixels, frame, values);
    default:
      return pixels.is_signed ? convert<std::int32_t>(bytes, count, pixels, frame, values)
                              : convert<std::uint32_t>(bytes, count, pixels, frame, values);
  }
}

void convert(const char* bytes, std::size_t count, const DicomPixels& pixels, const DicomFrame& frame,
             Component component, void* values) {
  with_type_of(component, [&]<class T>(T) { convert<T>(bytes, count, pixels, frame, values); });
}

// How many fragments of packed values begin a frame: with the first marker of JPEG, JPEG-LS or JPEG 2000, or with the
// header of RLE, whose first segment lies behind its 64 bytes.
std::size_t frames_begun(const gdcm::SequenceOfFragments& fragments) {
  std::size_t result = 0;
  for (std::size_t i = 0; i < fragments.GetNumberOfFragments(); ++i) {
    const gdcm::ByteValue* value = fragments.GetFragment(i).GetByteValue();
    if (!value || !value->GetPointer() || value->GetLength() < 8) continue;
    const std::string_view bytes(value->GetPointer(), 8);
    const bool rle = bytes[0] >= 1 && bytes[0] <= 15 && bytes.substr(1) == std::string_view("\0\0\0\x40\0\0\0", 7);
    if (rle || bytes.starts_with("\xff\xd8\xff") || bytes.starts_with("\xff\x4f\xff\x51")) ++result;
  }
  return result;
}

}  // namespace

std::vector<DicomFile> read_dicom_headers(const std::vector<fs::path>& files) {
  std::uint64_t largest = 0, total = 0;
  std::vector<DicomFile> result(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    result[i].path = files[i];
    result[i].bytes = InputFile(files[i]).size();
    largest = std::max(largest, result[i].bytes);
    total += result[i].bytes;
  }
  // Headers are a part of the file; a deflated one is unpacked as a whole.
  const IsolatedLimits limits{(std::uint64_t{512} << 20) + 64 * largest, 10 + files.size() / 20 + (total >> 20)};
  Isolated child(limits, [&](const Answer& answer) {
    gdcm::ImageHelper::SetForceRescaleInterceptSlope(true);  // as ITK does
    for (const fs::path& file : files) answer_header(file, answer);
  });
  for (DicomFile& file : result) {
    HeaderAnswer head;
    std::string error_text;
    if (!child.read(&head, sizeof head) || !read_items(child, head.error_size, error_text) ||
        !read_items(child, head.series_size, file.series) ||
        !read_items(child, head.description_size, file.description) || !read_items(child, head.frames, file.frames))
      fail_abnormally(child, file.path.string());
    if (head.error_size > 0) throw Error(head.code, error_text);
    file.number = head.number;
    file.pixels = head.pixels;
  }
  return result;
}

struct DicomDecoder::Gdcm {
  fs::path path;                    // of the file that is held
  std::unique_ptr<InputFile> file;  // where values are as they are meant,
  std::vector<char> values;         // one frame of it; or all values, unpacked
};

DicomDecoder::DicomDecoder() : gdcm_(std::make_unique<Gdcm>()) {}
DicomDecoder::~DicomDecoder() = default;

void DicomDecoder::decode(const DicomFile& file, std::size_t frame, Component component, void* values) {
  const DicomPixels& pixels = file.pixels;
  const auto count = static_cast<std::size_t>(pixels.columns * pixels.rows);
  const std::size_t frame_bytes = count * static_cast<std::size_t>(pixels.bits_allocated / 8);
  const auto damaged = [&](const char* what) { refuse(file.path, what, kAgain); };
  std::vector<char>& held = gdcm_->values;
  if (pixels.offset > 0) {
    if (gdcm_->path != file.path) gdcm_->file = std::make_unique<InputFile>(file.path);
    held.resize(frame_bytes);
    gdcm_->file->read_at(pixels.offset + frame * frame_bytes,
                         {reinterpret_cast<std::uint8_t*>(held.data()), frame_bytes});
  } else if (gdcm_->path != file.path) {
    gdcm_->path.clear();
    gdcm::ImageReader reader;
    reader.SetFileName(file.path.c_str());
    if (!reader.Read()) damaged("its image cannot be read");
    const gdcm::Image& image = reader.GetImage();
    const gdcm::PixelFormat& format = image.GetPixelFormat();
    const std::size_t all_bytes = frame_bytes * file.frames.size();
    // The values themselves may tell otherwise than the header around them.
    if (format.GetSamplesPerPixel() != pixels.samples || format.GetBitsAllocated() != pixels.bits_allocated ||
        image.GetBufferLength() != all_bytes)
      damaged("its values are damaged or of another size than its header tells");
    const gdcm::ByteValue* raw = image.GetDataElement().GetByteValue();
    if (!pixels.encapsulated && (!raw || raw->GetLength() < all_bytes))
      damaged("its values are fewer than its header tells");
    if (!pixels.encapsulated && raw->GetLength() >= std::max(2 * all_bytes, all_bytes + 2))
      damaged("its values are more than its header tells");
    const gdcm::SequenceOfFragments* fragments = image.GetDataElement().GetSequenceOfFragments();
    if (fragments && frames_begun(*fragments) > file.frames.size())
      damaged("its values are more than its header tells");
    held.resize(all_bytes);
    if (!image.GetBuffer(held.data())) damaged("its values are damaged");
  }
  gdcm_->path = file.path;
  convert(held.data() + (pixels.offset > 0 ? 0 : frame * frame_bytes), count, pixels, file.frames[frame], component,
          values);
}

}  // namespace blackleaf::detail
