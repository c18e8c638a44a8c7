// Interface of an inspector: looks at a link for robots and their readings. Moves nothing.
#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

struct InspectRequest {
  std::string link;
  double seconds = 2.0;  ///< how long to listen
  hal::Log log = {};
  const std::atomic<bool>& stop;
  std::function<void(const std::string& line)> print;
  std::function<void(const std::vector<std::pair<std::string, std::string>>& rows)> print_table;
};

struct InspectorType {
  static constexpr std::string_view kCategory = "inspector";
  using Crosses = hal::Layouts<InspectRequest, RobotBridge, PortView, hal::Log>;
  std::string_view name;     ///< the kind of robot
  std::string_view summary;  ///< over which links
  /// Whether it understands what passes on such a link. The first of the catalog that does is asked.
  bool (*reads)(const std::string& link) = nullptr;
  /// Error: the link does not open, no answer comes.
  hal::Status (*run)(const InspectRequest& request) = nullptr;
};

/// As `printf` writes it.
std::string formatted(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// CLOCK_MONOTONIC.
hal::TimeNs inspector_now_ns() noexcept;
/// @returns whether it was waited until then, and not stopped before.
bool wait_until(hal::TimeNs at, const std::atomic<bool>& stop);

/// Latches every bridge ten times a second, as long as the request says, and has `each(bridge)` follow it.
template <class Bridges, class Each>
void latch_for(const InspectRequest& request, const Bridges& bridges, Each&& each) {
  constexpr hal::TimeNs kTick_ns = 100 * hal::kNsPerMs;
  const hal::TimeNs begin = inspector_now_ns();
  const auto ticks = static_cast<hal::Tick>(request.seconds * 10.0);
  for (const auto& bridge : bridges) bridge->set_origin(begin);
  for (hal::Tick tick = 0; tick <= ticks; ++tick) {
    for (const auto& bridge : bridges) {
      bridge->latch(tick, inspector_now_ns());
      if (tick < ticks) each(*bridge);
    }
    if (tick == ticks || !wait_until(begin + (tick + 1) * kTick_ns, request.stop)) return;
  }
}

/// "readings", and every port of `views`, one a line.
void print_readings(const InspectRequest& request, const std::vector<PortView>& views);

}  // namespace tandem::bridges
