#include "simd_kernels.h"

#include <hwy/targets.h>

#include <atomic>

namespace blackleaf::detail {
namespace {

std::atomic<bool> scalar_wanted = false;

}  // namespace

std::vector<std::string> simd_kernels() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) names.emplace_back(hwy::TargetName(target));
  names.emplace_back("scalar");
  return names;
}

bool scalar_kernel_wanted() { return scalar_wanted; }

void use_simd_kernel(const std::string& name) {
  scalar_wanted = name == "scalar";
  std::int64_t wanted = 0;  // all that there are
  hwy::SetSupportedTargetsForTest(0);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    if (name == hwy::TargetName(target)) wanted = target;
  hwy::SetSupportedTargetsForTest(wanted);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace blackleaf::detail
