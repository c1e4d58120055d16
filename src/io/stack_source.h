// A volume source whose slices are decoded one by one in a process of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/isolated.h"
#include "io/volume_source.h"

namespace blackleaf::detail {

/// What there is to decode.
struct StackPlan {
  ImageInformation information;  // three sizes, one component
  /// Writes slice `index` to `values`, information.component a value. Called in the other process, with increasing
  /// indices. Throws Error.
  std::function<void(std::int64_t index, void* values)> decode;
  /// The name of the file that slice `index` comes from, for messages.
  std::function<std::string(std::int64_t index)> file_of;
  std::uint64_t largest_file = 0;  // bytes
  std::uint64_t kept_bytes = 0;    // of values that decode keeps beyond one slice
};

class StackSource : public VolumeSource {
 public:
  explicit StackSource(StackPlan plan);

  const ImageInformation& information() const override { return plan_.information; }
  void read(std::int64_t slices, void* values) override;

 private:
  void start();

  StackPlan plan_;
  std::size_t slice_bytes_;
  std::int64_t next_ = 0;
  std::unique_ptr<Isolated> child_;
};

/// Throws what there is to say of a file at which the child ended before its time.
[[noreturn]] void fail_abnormally(Isolated& child, const std::string& file);

}  // namespace blackleaf::detail
