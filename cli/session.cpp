#include "session.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>
#include <thread>

#include "blackleaf/error.h"
#include "interrupt.h"
#include "options.h"
#include "progress.h"

namespace blackleaf::cli {
namespace {

constexpr int kMaxThreads = 1024;

// Most memory this process has held at once, in bytes.
std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  return static_cast<std::uint64_t>(usage.ru_maxrss);  // bytes there, kilobytes elsewhere
#else
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
#endif
}

bool printed_something = false;
std::string left_behind_text;
std::string program_name = "blackleaf";
bool program_speaks = true;

}  // namespace

Session::Session(const std::string& command, const std::string& description, std::vector<std::string> arguments,
                 Machine& machine)
    : command_(command),
      arguments_(std::move(arguments)),
      machine_(machine),
      app_(description, program() + " " + command) {}

void Session::add_json() { app_.add_flag("--json", json_, "report as one JSON object"); }

bool Session::parse() {
  // Declared last, to stand below the subcommand's own options.
  const std::string group = "Options of every command";
  add_integer(app_, "--threads", threads_, 1, kMaxThreads, "threads to use (default: all of the machine)")
      ->group(group);
  app_.add_flag("--quiet", quiet_, "no summary, warnings or progress bar")->group(group);
  app_.add_flag("--timings", timings_,
                "last line of standard error: one JSON object with seconds by stage, threads, peak memory in bytes")
      ->group(group);
  machine_.add_options(app_);
  if (!app_.parse(arguments_)) {
    print_out(app_.help());
    return false;
  }
  // TBB is told before its first task: it makes no more workers than the machine has cores unless asked beforehand,
  // and some stages have no Work to hand it.
  using Control = oneapi::tbb::global_control;
  if (threads_)
    thread_limit_ = std::make_shared<Control>(Control::max_allowed_parallelism, static_cast<std::size_t>(*threads_));
  return true;
}

void Session::warn(const std::string& message) const { remarks_.push_back("warning: " + message); }

void Session::note(const std::string& message) const { remarks_.push_back("note: " + message); }

void Session::print_remarks() const {
  if (quiet_) return;
  for (const std::string& remark : remarks_) print_message(remark);
}

void Session::print_timings() const {
  if (!timings_ || !program_speaks) return;
  Json times;
  for (const auto& [name, seconds] : seconds_) times[name] = seconds;
  times["total"] = std::chrono::duration<double>(Clock::now() - start_).count();
  times["threads"] = threads_ ? *threads_ : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  times["peak_memory"] = peak_memory();
  fmt::print(stderr, "{}\n", times.dump());
}

Session::Stage::Stage(Session& session, std::string name)
    : session_(session),
      name_(std::move(name)),
      bar_(std::make_shared<ProgressBar>(name_, !session.quiet_ && program_speaks)) {
  check_interrupt();
  work_.threads = session.threads_.value_or(0);
  work_.progress = [bar = bar_, &machine = session.machine_](double fraction) {
    bar->show(fraction);
    machine.look_out();
    return interrupt_signal() == 0;
  };
}

Session::Stage::~Stage() {
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  auto& all = session_.seconds_;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.first == name_; });
  if (found == all.end())
    all.emplace_back(name_, seconds);
  else
    found->second += seconds;
}

void set_program(const std::string& name, bool speaks) {
  program_name = name;
  program_speaks = speaks;
}
const std::string& program() { return program_name; }

void print_out(const std::string& text) {
  if (!program_speaks) return;
  printed_something = printed_something || !text.empty();
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return;
  throw Error(ErrorCode::io, "cannot write to standard output: " + std::generic_category().message(errno),
              "free some space or redirect it elsewhere");
}

bool printed() { return printed_something; }

void print_message(std::string message) {
  if (!program_speaks) return;
  for (char& c : message)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  fmt::print(stderr, "{}: {}\n", program(), message);
}
void set_left_behind(const std::string& what) { left_behind_text = what; }
const std::string& left_behind() { return left_behind_text; }

void print_out(const Json& object) { print_out(object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"); }

}  // namespace blackleaf::cli
