// Interrupt: Ctrl-C as a question that computations may ask.
#pragma once

namespace blackleaf::cli {

/// From here on SIGINT sets a flag instead of ending the program; a second SIGINT ends it at once.
void watch_for_interrupt();
/// True iff SIGINT has come. Any thread.
bool interrupted();

}  // namespace blackleaf::cli
