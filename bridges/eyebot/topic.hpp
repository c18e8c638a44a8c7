// The channels of one eye-bot. "eyebot/NAME/state" and so on, commands on "eyebot/NAME/cmd/…", a hub's heartbeat on
// "hub/HUB/heartbeat".
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/time.hpp"

namespace tandem::bridges::eyebot {

/// Topics from a robot.
enum class Topic : std::uint8_t {
  Heartbeat,
  Status,
  State,
  Altitude,
  Battery,
  Scan,
  Rab,
  Prox,
  Light,
  PanTilt,
  Blobs,
  Ack
};
inline constexpr std::size_t kTopics = 12;

/// Topics to a robot.
enum class Told : std::uint8_t { Heartbeat, Mode, Position, Velocity, Leds, PanTilt, Scanner, Rab };
inline constexpr std::size_t kTold = 8;

/// The last part of the topic's channel, such as "state".
std::string_view topic_name(Topic topic) noexcept;
/// Longest time from one message of a robot to the next.
hal::TimeNs topic_period_ns(Topic topic) noexcept;
/// The number that stands before every message of this topic.
std::uint64_t topic_fingerprint(Topic topic) noexcept;

/// Whether a robot may be called so: 1 to 24 letters, digits, '_' and '-'.
bool is_robot_name(std::string_view name) noexcept;

std::string channel_of(std::string_view robot, Topic topic);
/// `hub`: name of the hub, which only the heartbeat's channel needs.
std::string channel_of(std::string_view robot, std::string_view hub, Told told);
/// The name in the channel of a robot, "eyebot/NAME/…", or of a hub, "hub/NAME/…"; empty for others, and for names that
/// cannot be.
std::string_view robot_of(std::string_view channel) noexcept;
std::string_view hub_of(std::string_view channel) noexcept;
/// The topic of a channel of that robot; nothing for others.
std::optional<Topic> topic_of(std::string_view robot, std::string_view channel) noexcept;

}  // namespace tandem::bridges::eyebot
