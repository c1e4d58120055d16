// Interrupt: Ctrl-C and its like as a question that computations may ask.
#pragma once

namespace blackleaf::cli {

/// From here on the first SIGINT, SIGTERM or SIGHUP sets a flag instead of ending the program, and keeps files that are
/// not finished by then from being put in place; a second one ends the program at once.
void watch_for_interrupt();
/// The signal that came, 0 if none did. Any thread.
int interrupt_signal();
/// Throws Error(cancelled) if one came. Any thread.
void check_interrupt();

}  // namespace blackleaf::cli
