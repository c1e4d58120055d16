// EveryKernel: the same with every SIMD kernel that the machine can run, forced in turn, the scalar one included.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "octree/simd_kernels.h"

namespace blackleaf::reference {

/// Says which kernels the machine has not; puts the best in force again in the end.
class EveryKernel {
 public:
  EveryKernel() {
    EXPECT_EQ(kernels_.back(), "scalar");
    static bool told = false;
    if (std::exchange(told, true)) return;
    for (const std::string wanted : {"AVX2", "AVX3"})
      if (std::ranges::find(kernels_, wanted) == kernels_.end())
        std::cout << "the kernel " << wanted << " is not available on this machine, so it is not tested\n";
  }
  ~EveryKernel() { detail::use_simd_kernel(""); }
  EveryKernel(const EveryKernel&) = delete;
  EveryKernel& operator=(const EveryKernel&) = delete;

  template <class Test>
  void run(Test test) const {
    for (const std::string& kernel : kernels_) {
      SCOPED_TRACE(kernel);
      detail::use_simd_kernel(kernel);
      test();
    }
  }

 private:
  std::vector<std::string> kernels_ = detail::simd_kernels();
};

}  // namespace blackleaf::reference
