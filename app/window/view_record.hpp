// Shows a record to the viewers of a window: plays it, goes to any of its ticks, looks into what it holds.
#pragma once
#include <atomic>
#include <string>

#include "app/run_options.hpp"

namespace tandem::app {

/// Whether the file begins as a record does.
bool is_record(const std::string& path);

/// Until `stop`. @returns the exit code
int view_record(const std::string& path, const ViewRequest& request, const HoldOptions& hold,
                const std::atomic<bool>& stop);

}  // namespace tandem::app
