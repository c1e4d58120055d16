// Exit codes: what the program answers to whoever started it, and the one place where exceptions become exit codes.
#pragma once

#include <string>

namespace blackleaf::cli {

enum ExitCode : int {
  kDone = 0,      // done
  kNo = 1,        // the answer to the question is "no", or "they interfere"
  kBadInput = 2,  // bad usage or bad input
  kFault = 3,     // a fault of the program or of the machine
  kSignal = 128   // plus the number of the signal that interrupted it, as shells count: 130 for Ctrl-C
};

/// How a run ends that cannot go on.
struct Ending {
  int code = kFault;
  std::string message;  // one line
};
/// Of the exception being handled. Requires: called from a catch clause.
Ending ending_of_current_exception();

/// Prints the exception being handled as one line on standard error and returns its exit code.
/// Requires: called from a catch clause.
int report_current_exception();

}  // namespace blackleaf::cli
