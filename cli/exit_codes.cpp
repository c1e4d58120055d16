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

Ending ending_of_current_exception() {
  try {
    throw;
  } catch (const Error& error) {
    // Whatever a signal made fail, the signal is the reason.
    if (const int signal = interrupt_signal(); signal != 0)
      return {kSignal + signal, printed()               ? "interrupted; what was printed is incomplete"
                                : left_behind().empty() ? "interrupted; nothing was written"
                                                        : "interrupted; " + left_behind()};
    return {kBadInput, error.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    return {kBadInput, error.what()};
  } catch (const std::bad_alloc&) {
    return {kFault, "out of memory; try a smaller --depth"};
  } catch (const std::exception& error) {
    return {kFault, fmt::format("internal fault: {}; please report it with the command that caused it", error.what())};
  } catch (...) {
    return {kFault, "internal fault of unknown kind; please report it with the command that caused it"};
  }
}

int report_current_exception() {
  const Ending ending = ending_of_current_exception();
  print_message(ending.message);
  return ending.code;
}

}  // namespace blackleaf::cli
