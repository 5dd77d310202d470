#pragma once
/// Ctrl-C as a question that a loop can ask.

namespace flexarm::cli {

/// From now on SIGINT and SIGTERM only set a flag; a second one ends the program as usual.
void catch_interruptions();
/// True once a signal has come.
bool is_interrupted();

}  // namespace flexarm::cli
