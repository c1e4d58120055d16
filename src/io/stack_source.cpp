#include "io/stack_source.h"

#include <cassert>
#include <exception>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "blackleaf/error.h"

namespace blackleaf::detail {
namespace {

std::size_t bytes_of_slice(const ImageInformation& information) {
  assert(information.size.size() == 3 && information.component);
  return static_cast<std::size_t>(information.size[0]) * static_cast<std::size_t>(information.size[1]) *
         bytes_of(*information.component);
}

// What comes before each slice: the length of an error's text, or 0 and then the values.
struct SliceHead {
  std::uint32_t error_size = 0;
  ErrorCode code = ErrorCode::bad_input;
};

}  // namespace

void fail_abnormally(Isolated& child, const std::string& file) {
  if (child.interrupted()) throw Error(ErrorCode::cancelled, file + ": reading it was interrupted");
  throw Error(ErrorCode::bad_input, file + ": is damaged: reading it ended abnormally", "get it again from its source");
}

StackSource::StackSource(StackPlan plan) : plan_(std::move(plan)), slice_bytes_(bytes_of_slice(plan_.information)) {}

void StackSource::start() {
  const auto slices = static_cast<std::uint64_t>(plan_.information.size[2]);
  IsolatedLimits limits;
  // Decoders hold a file as it is, unpacked, and in wider numbers; they unpack some megabytes a second at the least.
  limits.memory = (std::uint64_t{512} << 20) + 16 * (plan_.largest_file + slice_bytes_) + 4 * plan_.kept_bytes;
  limits.seconds = 10 + slices / 20 + ((slices * (slice_bytes_ + 1)) >> 20);
  child_ = std::make_unique<Isolated>(limits, [this, slices](const Answer& answer) {
    const std::unique_ptr<std::uint8_t[]> values(new std::uint8_t[slice_bytes_]);
    for (std::uint64_t i = 0; i < slices; ++i) {
      SliceHead head;
      std::string text;
      try {
        plan_.decode(static_cast<std::int64_t>(i), values.get());
      } catch (const Error& error) {
        text = error.what();
        head = {static_cast<std::uint32_t>(text.size()), error.code()};
      }
      answer.write(&head, sizeof head);
      if (text.empty())
        answer.write(values.get(), slice_bytes_);
      else
        return answer.write(text.data(), text.size());
    }
  });
}

void StackSource::read(std::int64_t slices, void* values) {
  assert(slices >= 0 && slices <= plan_.information.size[2] - next_);
  if (slices > 0 && !child_) start();
  auto* to = static_cast<std::uint8_t*>(values);
  for (std::int64_t i = 0; i < slices; ++i, ++next_, to += slice_bytes_) {
    SliceHead head;
    if (!child_->read(&head, sizeof head)) fail_abnormally(*child_, plan_.file_of(next_));
    if (head.error_size > 0) {
      std::string text;
      if (!read_items(*child_, head.error_size, text)) fail_abnormally(*child_, plan_.file_of(next_));
      throw Error(head.code, text);
    }
    if (!child_->read(to, slice_bytes_)) fail_abnormally(*child_, plan_.file_of(next_));
  }
}

}  // namespace blackleaf::detail
