// Messages to viewers that runs and records have in common (docs/view-protocol.md).
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"
#include "window/window.hpp"

namespace tandem::app {

struct ViewRequest;  // app/command/command.hpp

/// Opens the window that is asked for.
hal::Result<std::unique_ptr<window::Window>> open_window(const ViewRequest& request);

/// Prints its addresses on standard error, and opens a browser where that is wanted. To be called when the window takes
/// commands: an emergency stop before that would be refused.
void announce(const window::Window& window, const ViewRequest& request);

/// {"type": "hello", …} without layers, controls, kinds and controllers.
hal::Json hello_message(std::string_view experiment, std::string_view mode, std::uint64_t seed,
                        std::int64_t ticks_per_second, const std::vector<std::string>& can,
                        const core::SafetyConfig& safety);

/// An action for people to read: files by their names alone.
std::string action_text(const hal::Json& action);

/// Numbers entries of the log.
class LogMessages {
 public:
  /// {"type": "log", "entries": [one]}. The robot is the one that the text names first: "robot 'ep1'".
  hal::Json entry(hal::Tick tick, std::string_view kind, std::string_view text);

 private:
  std::uint64_t count_ = 0;
};

/// The picture as a file of this name: "picture.svg" or "picture.png".
window::WindowFile picture_file(const std::string& name, const std::string& svg);

}  // namespace tandem::app
