#pragma once
/// Catches signals that end a program, so that loops can ask for them and end cleanly.

namespace flexarm::cli {

/// From then on SIGINT, SIGTERM and SIGHUP are only noted. A second signal of the same kind ends the program as usual.
/// Signals that are already ignored stay ignored: nohup and shells (for background jobs) set them so.
void catch_interruptions();
/// The number of the first signal that was noted; 0: none.
int interruption();

/// Ignores the signals of failed output, so that the function that writes gets an error instead.
void ignore_signals_of_output();

}  // namespace flexarm::cli
