// Error: the one exception type for bad data, bad files and impossible requests. Caller's bugs are asserts.
#pragma once

#include <stdexcept>
#include <string>

namespace blackleaf {

enum class ErrorCode {
  bad_argument,     // a value outside its range
  bad_input,        // data that contradict themselves or their format
  io,               // a file that cannot be opened, read or written
  out_of_universe,  // a motion or a placement that leaves the universe
  cancelled,        // the caller's progress callback asked to stop
};

/// what() is one line: what is wrong and where, then "; " and how to mend it.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message, const std::string& remedy = {})
      : std::runtime_error(remedy.empty() ? message : message + "; " + remedy), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace blackleaf
