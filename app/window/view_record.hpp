// Shows a record to the viewers of a window, and as a table on the terminal: plays it, goes to any of its ticks, looks
// into what it holds.
#pragma once
#include <atomic>
#include <string>

#include "app/run_options.hpp"

namespace tandem::app {

/// Whether the file begins as a record does.
bool is_record(const std::string& path);

/// Of `options`, those of the window, the table and of who holds a run count; the record is the experiment. Until
/// `stop`. @returns the exit code
int view_record(const RunOptions& options, const std::atomic<bool>& stop);

}  // namespace tandem::app
