// A real robot as mixed reality needs it: readings in, commands out. Bridges are fitted to this.
#pragma once
#include <cstdint>
#include <string>

#include "hal/port.hpp"
#include "hal/time.hpp"
#include "mixed_reality/safety/supervisor.hpp"
#include "mixed_reality/time/moment.hpp"

namespace tandem::mixed_reality {

/// For the report: how the conversation with one robot went.
struct LinkReport {
  std::uint64_t packets = 0;         ///< sent
  std::uint64_t answers = 0;         ///< whole and plausible
  std::uint64_t time_outs = 0;       ///< answers that did not come, or not whole
  std::uint64_t bad_answers = 0;     ///< implausible ones
  std::uint64_t resynchronised = 0;  ///< times it was lost and found again
  std::uint64_t links_lost = 0;
  hal::TimeNs mean_round_trip_ns = 0;
  hal::TimeNs max_round_trip_ns = 0;
};

/// The readings that it gives out stay at their addresses as long as it lives. All calls come from one thread and do
/// not wait for the robot.
class RealRobot {
 public:
  virtual ~RealRobot() = default;

  /// Takes over the newest readings with a stamp of at most `now`; stamps them on the run's clock.
  virtual void latch(const Moment& now) noexcept = 0;
  /// As of the last `latch`. A robot that stopped of its own accord since the one before, and be it well again, is
  /// Suspect.
  virtual LinkHealth health() const noexcept = 0;
  /// What is wrong, for people; empty when nothing is.
  virtual std::string trouble() const = 0;

  /// The reading of a device, or null when the robot has none such.
  virtual const void* reading(const hal::PortType& type) const noexcept = 0;
  /// Whether the robot has such an actuator; takes over the command if so, to be sent with the next `commit`.
  virtual bool command(const hal::PortType& type, const void* port) noexcept = 0;
  /// Sends the commands and asks for new readings. Once a tick, also while the robot is to stand still.
  virtual void commit(const Moment& now) noexcept = 0;

  /// Stops the wheels now, whatever else goes on, and keeps trying until `stopped`.
  virtual void stop(const Moment& now) noexcept = 0;
  /// Whether the robot has confirmed the last `stop`, and nothing that moves it was sent since.
  virtual bool stopped() const noexcept = 0;

  virtual LinkReport report() const = 0;
};

}  // namespace tandem::mixed_reality
