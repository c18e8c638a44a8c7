// Interface of a stopper: stops one real robot of one kind once its hub is gone. Runs in the guardian process alone.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "bridges/stop_messages.hpp"
#include "hal/surface.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::guardian {

enum class StopState : std::uint8_t {
  Unreachable,  ///< the link does not open, or nothing comes back
  Stopping,     ///< it answers, and has not confirmed that it rests
  Confirmed     ///< the robot itself says that it rests
};

/// Frozen: the hub may come back, the robot is to wait. Gone: the robot will get no more commands.
enum class StopCause : std::uint8_t { HubFrozen, HubGone };

/// Stops one robot. Has a thread of its own in the guardian: nothing that it does delays another robot's stop.
class Stopper {
 public:
  virtual ~Stopper() = default;
  /// Opens the link where it is not open, says stop, listens. Returns within 50 ms, but for the time that the kernel
  /// takes to open a link; called again until Confirmed, however long that takes.
  virtual StopState step(hal::TimeNs now) = 0;
  /// What is known, for people: "/dev/rfcomm0 does not open: …".
  virtual std::string trouble() const = 0;
};

/// One kind's stopper. `make` neither blocks nor throws.
struct StopperType {
  static constexpr std::string_view kCategory = "stopper";
  using Crosses = hal::Layouts<Stopper, StopMessages>;
  std::string_view kind;
  std::unique_ptr<Stopper> (*make)(const StopMessages& messages, StopCause cause);

  std::string_view catalog_name() const noexcept { return kind; }
};

}  // namespace tandem::bridges::guardian
