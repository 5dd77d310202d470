#pragma once
/// Signals that end a program, for loops to ask about.

namespace flexarm::cli {

/// From now on SIGINT, SIGTERM and SIGHUP are only noted; a second one of the same kind ends the program as usual.
/// What is ignored already, as nohup has it and shells for what runs in the background, stays so.
void catch_interruptions();
/// The number of the first signal that has come; 0: none.
int interruption();

/// What cannot be written is an error of the function that writes, not a signal that ends the program.
void ignore_signals_of_output();

}  // namespace flexarm::cli
