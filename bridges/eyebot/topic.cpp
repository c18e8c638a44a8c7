#include "bridges/eyebot/topic.hpp"

#include <algorithm>

#include "bridges/eyebot_messages/codec.hpp"

namespace tandem::bridges::eyebot {
namespace {

namespace messages = eyebot_messages;

struct Row {
  std::string_view name;
  hal::TimeNs period_ns;
  std::uint64_t (*fingerprint)() noexcept;
};

constexpr hal::TimeNs ms(std::int64_t n) {
  return n * hal::kNsPerMs;
}

// In the order of Topic.
constexpr std::array<Row, kTopics> kRows = {{{"heartbeat", ms(200), &messages::fingerprint<messages::Heartbeat>},
                                             {"status", ms(100), &messages::fingerprint<messages::Status>},
                                             {"state", ms(20), &messages::fingerprint<messages::State>},
                                             {"altitude", ms(50), &messages::fingerprint<messages::Altitude>},
                                             {"battery", ms(1000), &messages::fingerprint<messages::Battery>},
                                             {"scan", ms(100), &messages::fingerprint<messages::Scan>},
                                             {"rab", ms(100), &messages::fingerprint<messages::Rab>},
                                             {"prox", ms(100), &messages::fingerprint<messages::Prox>},
                                             {"light", ms(100), &messages::fingerprint<messages::Light>},
                                             {"pan_tilt", ms(100), &messages::fingerprint<messages::PanTilt>},
                                             {"blobs", ms(100), &messages::fingerprint<messages::Blobs>},
                                             {"ack", ms(0), &messages::fingerprint<messages::Ack>}}};

// In the order of Told, but for the heartbeat.
constexpr std::array<std::string_view, kTold> kTolds = {"",     "mode",     "position", "velocity",
                                                        "leds", "pan_tilt", "scanner",  "rab"};

std::string_view name_behind(std::string_view head, std::string_view channel) noexcept {
  if (!channel.starts_with(head)) return {};
  channel.remove_prefix(head.size());
  const std::size_t end = channel.find('/');
  return end == std::string_view::npos ? std::string_view() : channel.substr(0, end);
}

const Row& row(Topic topic) noexcept {
  return kRows[static_cast<std::size_t>(topic)];
}

}  // namespace

std::string_view topic_name(Topic topic) noexcept {
  return row(topic).name;
}

hal::TimeNs topic_period_ns(Topic topic) noexcept {
  return row(topic).period_ns;
}

std::uint64_t topic_fingerprint(Topic topic) noexcept {
  return row(topic).fingerprint();
}

bool is_robot_name(std::string_view name) noexcept {
  const auto allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= 24 && std::all_of(name.begin(), name.end(), allowed);
}

std::string channel_of(std::string_view robot, Topic topic) {
  return "eyebot/" + std::string(robot) + "/" + std::string(topic_name(topic));
}

std::string channel_of(std::string_view robot, std::string_view hub, Told told) {
  if (told == Told::Heartbeat) return "hub/" + std::string(hub) + "/heartbeat";
  return "eyebot/" + std::string(robot) + "/cmd/" + std::string(kTolds[static_cast<std::size_t>(told)]);
}

std::string_view robot_of(std::string_view channel) noexcept {
  const std::string_view name = name_behind("eyebot/", channel);
  return is_robot_name(name) ? name : std::string_view();
}

std::string_view hub_of(std::string_view channel) noexcept {
  return name_behind("hub/", channel);
}

std::optional<Topic> topic_of(std::string_view robot, std::string_view channel) noexcept {
  constexpr std::string_view kHead = "eyebot/";
  if (!channel.starts_with(kHead)) return {};
  channel.remove_prefix(kHead.size());
  if (!channel.starts_with(robot) || channel.size() <= robot.size() || channel[robot.size()] != '/') return {};
  channel.remove_prefix(robot.size() + 1);
  for (std::size_t i = 0; i < kTopics; ++i) {
    if (kRows[i].name == channel) return static_cast<Topic>(i);
  }
  return {};
}

}  // namespace tandem::bridges::eyebot
