// What programs made of subcommands have in common: help, version, and finding the subcommand.
#pragma once

#include <fmt/format.h>

#include <string>

#include "blackleaf/error.h"
#include "exit_codes.h"
#include "session.h"

namespace blackleaf::cli {

/// The part of a help text between `usage` and `ending`: subcommands, a line each, and the options that all share.
/// `ending` begins on a line of its own. Commands have a name and a description.
template <class Commands>
std::string help_text(const char* usage, const Commands& commands, const char* ending) {
  std::string text = fmt::format("{}\n\nCommands:\n", usage);
  for (const auto& command : commands) text += fmt::format("  {:<12}{}\n", command.name, command.description);
  return text +
         "\nOptions:\n"
         "  -h,--help   print this help, or that of a command after its name, and exit\n"
         "  --version   print the version and exit\n" +
         ending;
}

/// Answers an argument that asks about the program itself; false if it does not.
inline bool answered(const std::string& argument, const char* program, const std::string& help) {
  if (argument == "--help" || argument == "-h") {
    print_out(help);
  } else if (argument == "--version") {
    print_out(fmt::format("{} " BLACKLEAF_VERSION "\n", program));
  } else {
    return false;
  }
  return true;
}

/// The subcommand of that name. Throws Error(bad_argument) if there is none.
template <class Commands>
const auto& command_named(const std::string& name, const Commands& commands, const char* program) {
  for (const auto& command : commands)
    if (name == command.name) return command;
  throw Error(ErrorCode::bad_argument,
              name.starts_with('-') ? fmt::format("unknown option {} before a command", name)
                                    : fmt::format("unknown command '{}'", name),
              fmt::format("see {} --help", program));
}

}  // namespace blackleaf::cli
