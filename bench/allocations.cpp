#include "allocations.h"

#include <malloc.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>

// The C library's own functions, for which the ones below stand in the whole program. Outside of peak_allocated() they
// only pass on.
extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* memory, std::size_t size);            // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT(bugprone-reserved-identifier)
void __libc_free(void* memory);                                  // NOLINT(bugprone-reserved-identifier)
}

namespace {

std::atomic<bool> counting = false;
std::atomic<std::int64_t> now = 0, most = 0;

void add(std::int64_t bytes) {
  const std::int64_t total = now += bytes;
  std::int64_t known = most;
  while (total > known && !most.compare_exchange_weak(known, total)) {
  }
}

std::int64_t bytes_of(void* memory) { return static_cast<std::int64_t>(malloc_usable_size(memory)); }

void* counted(void* memory) {
  if (counting && memory != nullptr) add(bytes_of(memory));
  return memory;
}

// Large blocks are mappings of their own, which the C library marks in the word before them; the kernel lets them grow.
bool is_mapping(void* memory) {
  std::size_t head = 0;
  std::memcpy(&head, static_cast<const char*>(memory) - sizeof head, sizeof head);
  return (head & 2) != 0;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) { return counted(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) { return counted(__libc_calloc(count, size)); }
void* memalign(std::size_t alignment, std::size_t size) { return counted(__libc_memalign(alignment, size)); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = memalign(alignment, size);
  return *memory == nullptr && size != 0 ? ENOMEM : 0;
}

void* realloc(void* memory, std::size_t size) {
  if (!counting || memory == nullptr || size == 0) return counted(__libc_realloc(memory, size));
  const std::int64_t before = bytes_of(memory);
  const bool mapping = is_mapping(memory);
  void* const moved = __libc_realloc(memory, size);
  if (moved == nullptr) return moved;
  if (moved == memory || (mapping && is_mapping(moved))) {
    add(bytes_of(moved) - before);
  } else {
    add(bytes_of(moved));
    now -= before;
  }
  return moved;
}

void free(void* memory) {
  if (counting && memory != nullptr) now -= bytes_of(memory);
  __libc_free(memory);
}

}  // extern "C"

namespace blackleaf::bench {

std::size_t peak_allocated(const std::function<void()>& work) {
  now = most = 0;
  counting = true;
  work();
  counting = false;
  return static_cast<std::size_t>(most.load());
}

}  // namespace blackleaf::bench
