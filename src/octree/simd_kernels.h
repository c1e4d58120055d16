// Which instruction set the kernels use that Highway compiles for several; each has a plain twin besides.
#pragma once

#include <string>
#include <vector>

namespace blackleaf::detail {

/// Those that this machine can run, best first; the last is "scalar", the plain twins.
std::vector<std::string> simd_kernels();
/// Makes all kernels use one of them from now on; the empty name is the best. For tests; not while a kernel runs.
void use_simd_kernel(const std::string& name);
/// True while it is "scalar".
bool scalar_kernel_wanted();

}  // namespace blackleaf::detail
