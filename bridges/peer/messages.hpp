// Messages of the lock-step protocol that agree on who steps what; those of every tick are in the two sides.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/peer/controller_copy.hpp"
#include "bridges/peer/row_form.hpp"
#include "hal/json/json.hpp"
#include "hal/port.hpp"
#include "hal/published.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::peer {

inline constexpr std::int64_t kVersion = 1;

/// Bits of the flags in Tick and Commands.
inline constexpr std::uint8_t kActuatorsFollow = 1;  ///< Tick: the commands as they are now come after the readings
inline constexpr std::uint8_t kThrew = 1;            ///< Commands: the controller threw; text follows, and nothing else

/// A port, by what both sides must agree on.
struct PortName {
  hal::Role role = hal::Role::Sensor;
  std::string name;
  std::string digest;  ///< of RowForm

  bool operator==(const PortName&) const = default;
};

/// What a controller publishes, as it is on the wire.
struct PublishedForm {
  std::string name;
  std::string type;  ///< of a scalar
  std::size_t count = 1;

  bool operator==(const PublishedForm&) const = default;
};
PublishedForm form_of(const hal::PublishedField& field);

/// Of a peer that wants to begin, or to go on after its link was lost.
struct Hello {
  std::string robot;        ///< empty: any that has no peer yet
  std::string session;      ///< empty: it begins; else as the hub gave it in Robot
  hal::Tick answered = -1;  ///< the last tick that it answered, of that session
  std::int64_t version = kVersion;
};

/// Of the hub: the peer's identity.
struct RobotMessage {
  std::string session;
  std::string robot, kind, experiment;
  std::int64_t ticks_per_second = 10;
  std::uint64_t seed = 0;  ///< of the run
  hal::Tick tick = 0;      ///< the first that it will be asked for, or a later one
  std::vector<PortName> ports;
  std::vector<hal::Json> fields;  ///< parallel: `RowForm::fields`
  std::vector<PublishedForm> publishes;
  std::int64_t version = kVersion;
};

/// Of a peer: what its controller took, in the order in which ticks and commands have them.
struct Ready {
  std::string session;
  std::vector<PortName> takes;
  std::vector<PublishedForm> publishes;
  std::optional<ControllerCopy> controller = {};  ///< nothing: the peer does not tell which one it runs
};

/// Of both sides: why nothing more will come.
struct Farewell {
  bool error = false;
  std::string text;
};

std::vector<std::uint8_t> bytes_of(const Hello& message);
std::vector<std::uint8_t> bytes_of(const RobotMessage& message);
std::vector<std::uint8_t> bytes_of(const Ready& message);
std::vector<std::uint8_t> bytes_of(const Farewell& message);

/// Errors: no JSON object; a member is missing or of another type. Members that are not known are left out.
hal::Result<Hello> read_hello(std::span<const std::uint8_t> payload);
hal::Result<RobotMessage> read_robot(std::span<const std::uint8_t> payload);
hal::Result<Ready> read_ready(std::span<const std::uint8_t> payload);
hal::Result<Farewell> read_farewell(std::span<const std::uint8_t> payload);

/// "sensor 'proximity'".
std::string name_of(const PortName& port);

/// Numbers at the front of Tick and Commands.
void append_tick(std::vector<std::uint8_t>& out, hal::Tick tick, std::uint8_t flags);
struct TickHead {
  hal::Tick tick = 0;
  std::uint8_t flags = 0;
};
/// False: too short.
bool take_head(std::span<const std::uint8_t>& in, TickHead& head) noexcept;

}  // namespace tandem::bridges::peer
