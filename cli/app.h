// App: the options and arguments of one subcommand. It stands on CLI11, which app.cpp alone knows: reading that library
// takes longer than compiling a subcommand.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace blackleaf::cli {

/// One option or argument. All functions return the option itself.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option* required();
  /// The two are not to be given together.
  Option* excludes(Option* other);
  /// The heading under which the help text lists it.
  Option* group(const std::string& heading);
  /// What stands behind its name in the help text.
  Option* type_name(const std::string& name);
  /// Whether several values may follow its name at once.
  Option* allow_extra_args(bool allowed);
  /// It may be given several times; every value counts.
  Option* repeatable();
  /// How many values it takes at once.
  Option* expected(int values);

 private:
  CLI::Option* option_;
};

class App {
 public:
  App(const std::string& description, const std::string& name);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  /// Options: `--name`, or `-n,--name`; arguments: a name without dashes. Targets are written by parse().
  Option* add_option(const std::string& name, std::string& target, const std::string& description);
  Option* add_option(const std::string& name, std::vector<std::string>& targets, const std::string& description);
  /// Calls `take` with the text of the option, when it is given.
  Option* add_option_function(const std::string& name, const std::function<void(const std::string&)>& take,
                              const std::string& description);
  Option* add_flag(const std::string& name, bool& target, const std::string& description);
  /// An option that is there already. Requires: it is.
  Option* get_option(const std::string& name);
  /// The last lines of the help text.
  void footer(const std::string& text);
  std::string help() const;

  /// Reads a command line. False when help was asked for. Throws Error(bad_argument) that names the command.
  bool parse(std::vector<std::string> arguments);

 private:
  struct Parser;
  Option* keep(CLI::Option* option);
  std::unique_ptr<Parser> parser_;
  std::deque<Option> options_;
};

}  // namespace blackleaf::cli
