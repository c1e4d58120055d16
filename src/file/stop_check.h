// The stop check: how a program that was told to stop keeps this library from putting more files in place.
#pragma once

namespace blackleaf::detail {

/// A function that returns, or throws Error(cancelled) when the program is to stop.
using StopCheck = void (*)();

/// From here on `check` is called right before a finished file takes its name, before anything is sent to a device or a
/// pipe, and when a signal arrives while a pipe keeps us waiting. If it throws then, no file is put in place and the
/// temporary one is removed. Null, as at the start, means never. Any thread; the library's answers do not depend on it.
void set_stop_check(StopCheck check);

/// Calls the check, if there is one.
void check_for_stop();

}  // namespace blackleaf::detail
