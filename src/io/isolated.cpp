#include "io/isolated.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "blackleaf/error.h"
#include "file/stop_check.h"

namespace blackleaf::detail {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kLimitMemory = false;  // the sanitizers' shadow takes terabytes of address space
#else
constexpr bool kLimitMemory = true;
#endif

// Bytes of address space this process has; a child begins with as many.
std::uint64_t address_space() {
  unsigned long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// Never above what is allowed already.
void limit(__rlimit_resource resource, std::uint64_t soft, std::uint64_t hard) {
  rlimit value{};
  if (getrlimit(resource, &value) != 0) return;
  value.rlim_max = std::min<rlim_t>(value.rlim_max, hard);
  value.rlim_cur = std::min<rlim_t>({value.rlim_cur, value.rlim_max, soft});
  setrlimit(resource, &value);
}

// In the child: its own limits and signals, no files but the pipe, which becomes descriptor 3.
void settle(int pipe_end, pid_t parent, const IsolatedLimits& limits, std::uint64_t used) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it ended before that took effect
  // What the program around us does upon signals is for it alone; only what it ignores stays ignored.
  for (const int number : {SIGHUP, SIGINT, SIGQUIT, SIGTERM}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) std::signal(number, SIG_DFL);
  }
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU, SIGPIPE}) std::signal(number, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nothing = open("/dev/null", O_RDWR);
  if (nothing < 0) _exit(1);
  // The pipe may be one of 0 to 3 itself when this process has closed its own.
  const int high = fcntl(pipe_end, F_DUPFD, 10);
  if (high < 0) _exit(1);
  for (int i = 0; i < 3; ++i)
    if (dup2(nothing, i) < 0) _exit(1);
  if (dup2(high, 3) < 0) _exit(1);
  close_range(4, ~0U, 0);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, limits.seconds, limits.seconds + 2);
  if (kLimitMemory && used > 0) limit(RLIMIT_AS, used + limits.memory, used + limits.memory);
}

}  // namespace

void Answer::write(const void* bytes, std::size_t size) const {
  const auto* from = static_cast<const std::uint8_t*>(bytes);
  while (size > 0) {
    const ssize_t count = ::write(descriptor_, from, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) _exit(1);
    from += count;
    size -= static_cast<std::size_t>(count);
  }
}

Isolated::Isolated(const IsolatedLimits& limits, const std::function<void(const Answer&)>& work) {
  const std::uint64_t used = address_space();
  const pid_t parent = getpid();
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(ErrorCode::io, std::string("cannot make a pipe: ") + std::strerror(errno), "close some files");
  child_ = fork();
  if (child_ == 0) {
    settle(ends[1], parent, limits, used);
    try {
      work(Answer(3));
    } catch (...) {
      _exit(1);
    }
    _exit(0);  // no destructors, no flushing: all that belongs to the parent
  }
  const int error = errno;
  close(ends[1]);
  descriptor_ = ends[0];
  if (child_ < 0) {
    close(descriptor_);
    throw Error(ErrorCode::io, std::string("cannot start a process: ") + std::strerror(error),
                "end some programs or free memory");
  }
}

Isolated::~Isolated() { finish(true); }

bool Isolated::read(void* bytes, std::size_t size) {
  auto* to = static_cast<std::uint8_t*>(bytes);
  while (size > 0) {
    check_for_stop();
    // With an end to the wait: a signal that comes right before it would go unnoticed.
    pollfd wait{descriptor_, POLLIN, 0};
    const int ready = poll(&wait, 1, 200);
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    const ssize_t count = ::read(descriptor_, to, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    to += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool Isolated::interrupted() {
  finish(false);
  return WIFSIGNALED(status_) && (WTERMSIG(status_) == SIGINT || WTERMSIG(status_) == SIGTERM ||
                                  WTERMSIG(status_) == SIGQUIT || WTERMSIG(status_) == SIGHUP);
}

void Isolated::finish(bool at_once) {
  if (child_ < 0) return;
  close(descriptor_);
  if (at_once) kill(child_, SIGKILL);  // still ours: a process that has ended keeps its number until it is waited for
  pid_t ended = 0;
  int status = 0;
  do ended = waitpid(child_, &status, 0);
  while (ended < 0 && errno == EINTR);
  if (ended == child_) status_ = status;  // otherwise the program around us has waited for all its children
  child_ = -1;
}

}  // namespace blackleaf::detail
