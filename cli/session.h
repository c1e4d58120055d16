// Session: one run of one subcommand: its command line, the options every subcommand has, its stages and what it tells.
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app.h"
#include "blackleaf/work.h"
#include "interrupt.h"
#include "machine.h"

namespace blackleaf::cli {

using Json = nlohmann::ordered_json;

class Session {
 public:
  /// `arguments` are those after the subcommand's name. The machine must outlive the session.
  Session(const std::string& command, const std::string& description, std::vector<std::string> arguments,
          Machine& machine);

  /// Where a subcommand declares its own options, before parse().
  App& app() { return app_; }
  /// Declares --json.
  void add_json();
  /// The last line of the help text.
  void set_example(const std::string& command_line) { app_.footer("Example:\n  " + command_line); }

  /// Reads the command line. False when only help was asked for (and has been printed). Throws Error(bad_argument).
  [[nodiscard]] bool parse();

  const std::string& command() const { return command_; }
  /// Who works on the command.
  Machine& machine() const { return machine_; }
  bool json() const { return json_; }
  bool quiet() const { return quiet_; }

  /// Runs `work(options)` as a stage of the given name, e.g. "read": its seconds are added up under that name, it shows
  /// progress and can be interrupted: an interrupt is honoured when the stage ends at the latest. Returns what the
  /// function returns.
  template <class Function>
  auto stage(const std::string& name, Function&& function) {
    const Stage running(*this, name);
    if constexpr (std::is_void_v<std::invoke_result_t<Function, const Work&>>) {
      std::forward<Function>(function)(running.work());
      check_interrupt();
    } else {
      auto result = std::forward<Function>(function)(running.work());
      check_interrupt();
      return result;
    }
  }
  /// The same for the stage "write", the last: what is in place when it ends stays there, and the run counts as done.
  template <class Function>
  auto write_stage(Function&& function) {
    const Stage running(*this, "write");
    return std::forward<Function>(function)();
  }

  /// One line on standard error, not under --quiet: of what may be a mistake; of what is only good to know. Held back
  /// until the command is done: an error stands alone.
  void warn(const std::string& message) const;
  void note(const std::string& message) const;
  void print_remarks() const;
  /// Prints --timings, if asked for.
  void print_timings() const;

 private:
  using Clock = std::chrono::steady_clock;

  // Times a stage from construction to destruction.
  class Stage {
   public:
    Stage(Session& session, std::string name);
    ~Stage();
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
    const Work& work() const { return work_; }

   private:
    Session& session_;
    std::string name_;
    Clock::time_point start_ = Clock::now();
    std::shared_ptr<class ProgressBar> bar_;
    Work work_;
  };

  std::string command_;
  std::vector<std::string> arguments_;
  Machine& machine_;
  App app_;
  std::optional<int> threads_;
  std::shared_ptr<void> thread_limit_;  // TBB's, for as long as the session lives
  bool json_ = false, quiet_ = false, timings_ = false;
  Clock::time_point start_ = Clock::now();
  mutable std::vector<std::string> remarks_;             // what warn() and note() were told
  std::vector<std::pair<std::string, double>> seconds_;  // by stage, in order of first use
};

/// The program's name in messages, and whether this process prints at all. "blackleaf" and true unless set.
void set_program(const std::string& name, bool speaks);
const std::string& program();

/// Writes text or bytes to standard output and makes sure they arrive. Throws Error(io).
void print_out(const std::string& text);
/// True iff anything went that way.
bool printed();
/// A message on standard error: one line, even where file names in it hold line breaks.
void print_message(std::string message);
/// From here on, what a run that is interrupted leaves behind, e.g. "3 of 8 frames were written"; empty: nothing.
void set_left_behind(const std::string& what);
const std::string& left_behind();
/// The object on one line.
void print_out(const Json& object);

}  // namespace blackleaf::cli
