// Whether a test can limit its memory.
#pragma once

namespace blackleaf::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kMemoryLimits = false;  // sanitizers reserve address space by the terabyte
#else
inline constexpr bool kMemoryLimits = true;
#endif

}  // namespace blackleaf::test
