// Steps one robot's controller instead of the hub: a program elsewhere, or a bridge and its emulated firmware.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "bridges/peer/controller_copy.hpp"
#include "core/sim/world.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// What one partner did, for the report.
struct PartnerReport {
  std::string robot;
  std::string link;                  ///< as it is or was open
  std::string state;                 ///< "in step", "waiting", "simulated", …
  bool ready = false;                ///< it may be asked for the next tick
  std::uint64_t ticks = 0;           ///< that it answered
  std::uint64_t doubled = 0;         ///< answers that came once more
  std::uint64_t wrong_tick = 0;      ///< answers to ticks that it was not asked for
  std::uint64_t not_understood = 0;  ///< messages that made no sense
  std::uint64_t garbled = 0;         ///< frames with a wrong checksum
  std::uint64_t asked_again = 0;     ///< questions sent once more, for want of an answer
  std::uint64_t links = 0;           ///< times that a link was open
  std::uint64_t bytes_in = 0, bytes_out = 0;
  hal::TimeNs longest_wait_ns = 0;  ///< of wall time, for one answer
  /// Its controller and the hub's copy; nothing: it has not said, or there is no comparison.
  std::optional<bridges::peer::CopyComparison> controller = {};
};

/// All calls come from the thread that steps. Ticks: `ask`, then `pump` until `answered`, then `write_commands`.
class Partner {
 public:
  virtual ~Partner() = default;

  virtual core::RobotId robot() const noexcept = 0;
  /// Works on its link; never waits.
  virtual void pump(hal::TimeNs now) = 0;
  /// What `poll` can wait on; -1: there is none at present.
  virtual int descriptor() const noexcept { return -1; }
  /// It may be asked for the first tick.
  virtual bool ready() const noexcept = 0;
  /// Hands it the readings of this tick, as the world has them.
  virtual void ask(core::World& world, hal::TimeNs now) = 0;
  virtual bool answered() const noexcept = 0;
  /// Writes what it answered into the world. Error: it makes no sense.
  virtual hal::Status write_commands(core::World& world) = 0;
  /// What keeps it from answering, for people: "nobody has connected", "link lost".
  virtual std::string trouble() const = 0;
  /// The robot is gone, or the run: says so.
  virtual void end(bool error, const std::string& why) = 0;
  virtual PartnerReport report() const = 0;
};

}  // namespace tandem::mixed_reality
