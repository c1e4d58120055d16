// Work: how a long computation is run. The answer never depends on it.
#pragma once

#include <functional>

namespace blackleaf {

struct Work {
  /// Threads to use; 0 means all that the machine has.
  int threads = 0;
  /// Called now and then, from one thread at a time, with the fraction done in [0, 1]; returning false makes the
  /// computation throw Error(cancelled). May be empty.
  std::function<bool(double)> progress;
};

}  // namespace blackleaf
