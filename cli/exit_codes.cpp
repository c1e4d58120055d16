#include "exit_codes.h"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>

#include "blackleaf/error.h"
#include "interrupt.h"
#include "session.h"

namespace blackleaf::cli {
namespace {

// File names may hold line breaks; a message is one line all the same.
void print_line(std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  fmt::print(stderr, "blackleaf: {}\n", message);
}

}  // namespace

int report_current_exception() {
  try {
    throw;
  } catch (const Error& error) {
    // Whatever a signal made fail, the signal is the reason.
    if (const int signal = interrupt_signal(); signal != 0) {
      print_line(printed()               ? "interrupted; what was printed is incomplete"
                 : left_behind().empty() ? "interrupted; nothing was written"
                                         : "interrupted; " + left_behind());
      return kSignal + signal;
    }
    print_line(error.what());
    return kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {
    print_line(error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    print_line("out of memory; try a smaller --depth");
    return kFault;
  } catch (const std::exception& error) {
    print_line(fmt::format("internal fault: {}; please report it with the command that caused it", error.what()));
    return kFault;
  } catch (...) {
    print_line("internal fault of unknown kind; please report it with the command that caused it");
    return kFault;
  }
}

}  // namespace blackleaf::cli
