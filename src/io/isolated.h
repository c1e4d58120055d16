// Work that may crash, hang or eat memory, done in a process of its own.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace blackleaf::detail {

/// What the child may use at most.
struct IsolatedLimits {
  std::uint64_t memory = 0;   // bytes of address space beyond what this process has already
  std::uint64_t seconds = 0;  // of processor time
};

/// The child's end: writes to the parent, and ends the process at once when the parent is gone.
class Answer {
 public:
  explicit Answer(int descriptor) : descriptor_(descriptor) {}
  void write(const void* bytes, std::size_t size) const;

 private:
  int descriptor_;
};

/// A child process, forked off to do one piece of work whose answer comes back through a pipe. Nothing of this process
/// changes, whatever the work does. The child has only the calling thread, no open files but the pipe, no output, and
/// leaves no core file. However it ends, the destructor has seen it off: no process is left behind.
class Isolated {
 public:
  /// Throws Error(io) when no process can be started. `work` must use no other threads and no locks of this program.
  Isolated(const IsolatedLimits& limits, const std::function<void(const Answer&)>& work);
  ~Isolated();
  Isolated(const Isolated&) = delete;
  Isolated& operator=(const Isolated&) = delete;

  /// The next bytes of the answer; false when it ends before, which is how crashes and limits show. Asks
  /// check_for_stop() upon signals and several times a second, so it may throw Error(cancelled); the destructor then
  /// ends the child.
  bool read(void* bytes, std::size_t size);
  /// After read() has given false: whether the child was ended by a signal that asks a program to stop (Ctrl-C, ...).
  bool interrupted();

 private:
  void finish(bool at_once);

  int descriptor_ = -1;
  pid_t child_ = -1;
  int status_ = 0;
};

/// Reads `count` things from the child piece by piece, so that a count that is not true takes no memory. False when its
/// answer ends before.
template <class Container>
bool read_items(Isolated& child, std::uint64_t count, Container& items) {
  constexpr std::uint64_t kPiece = std::uint64_t{1} << 16;
  while (items.size() < count) {
    const std::size_t done = items.size();
    items.resize(static_cast<std::size_t>(std::min(count, done + std::max<std::uint64_t>(done, kPiece))));
    if (!child.read(items.data() + done, (items.size() - done) * sizeof items[0])) return false;
  }
  return true;
}

}  // namespace blackleaf::detail
