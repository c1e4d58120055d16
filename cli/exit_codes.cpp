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
int report_current_exception() {
  try {
    throw;
  } catch (const Error& error) {
    // Whatever a signal made fail, the signal is the reason.
    if (const int signal = interrupt_signal(); signal != 0) {
      print_message(printed()               ? "interrupted; what was printed is incomplete"
                    : left_behind().empty() ? "interrupted; nothing was written"
                                            : "interrupted; " + left_behind());
      return kSignal + signal;
    }
    print_message(error.what());
    return kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {
    print_message(error.what());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    print_message("out of memory; try a smaller --depth");
    return kFault;
  } catch (const std::exception& error) {
    print_message(fmt::format("internal fault: {}; please report it with the command that caused it", error.what()));
    return kFault;
  } catch (...) {
    print_message("internal fault of unknown kind; please report it with the command that caused it");
    return kFault;
  }
}

}  // namespace blackleaf::cli
