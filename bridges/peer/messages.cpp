#include "bridges/peer/messages.hpp"

#include <cstring>
#include <exception>

#include "hal/scalar_name.hpp"

namespace tandem::bridges::peer {
namespace {

using hal::Json;

std::vector<std::uint8_t> bytes_of(const Json& json) {
  const std::string text = hal::to_text(json);
  return {text.begin(), text.end()};
}

Json to_json(const PortName& port) {
  return {
      {"role", port.role == hal::Role::Sensor ? "sensor" : "actuator"}, {"name", port.name}, {"digest", port.digest}};
}

Json to_json(const std::vector<PublishedForm>& publishes) {
  Json all = Json::array();
  for (const PublishedForm& p : publishes) all.push_back({{"name", p.name}, {"type", p.type}, {"count", p.count}});
  return all;
}

PortName port_from(const Json& json) {
  const auto role = json.at("role").get<std::string>();
  return {role == "actuator" ? hal::Role::Actuator : hal::Role::Sensor, json.at("name").get<std::string>(),
          json.at("digest").get<std::string>()};
}

std::vector<PublishedForm> publishes_from(const Json& json) {
  std::vector<PublishedForm> all;
  for (const Json& p : json.value("publishes", Json::array()))
    all.push_back({p.at("name").get<std::string>(), p.at("type").get<std::string>(), p.at("count").get<std::size_t>()});
  return all;
}

/// What `read` makes of the object; errors are the library's exceptions in words of ours.
template <class Message, class Read>
hal::Result<Message> read_object(std::span<const std::uint8_t> payload, std::string_view what, const Read& read) {
  const auto json = hal::parse_json_object({reinterpret_cast<const char*>(payload.data()), payload.size()});
  if (!json.ok()) return hal::Error{"message " + std::string(what) + ": " + json.error().message};
  try {
    return read(json.value());
  } catch (const std::exception& e) {
    return hal::Error{"message " + std::string(what) + ": " + e.what()};
  }
}

}  // namespace

PublishedForm form_of(const hal::PublishedField& field) {
  return {field.name, std::string(name_of(field.scalar)), field.count};
}

std::string name_of(const PortName& port) {
  return (port.role == hal::Role::Sensor ? "sensor '" : "actuator '") + port.name + "'";
}

std::vector<std::uint8_t> bytes_of(const Hello& m) {
  Json json = {{"protocol", "tandem lockstep"}, {"version", m.version}, {"robot", m.robot}};
  if (!m.session.empty()) {
    json["session"] = m.session;
    json["answered"] = m.answered;
  }
  return bytes_of(json);
}

hal::Result<Hello> read_hello(std::span<const std::uint8_t> payload) {
  return read_object<Hello>(payload, "Hello", [](const Json& json) -> hal::Result<Hello> {
    if (json.value("protocol", "") != "tandem lockstep")
      return hal::Error{"message Hello: its protocol is not \"tandem lockstep\""};
    Hello m;
    m.version = json.at("version").get<std::int64_t>();
    m.robot = json.value("robot", "");
    m.session = json.value("session", "");
    m.answered = json.value("answered", hal::Tick{-1});
    return m;
  });
}

std::vector<std::uint8_t> bytes_of(const RobotMessage& m) {
  Json json = {{"protocol", "tandem lockstep"},
               {"version", m.version},
               {"session", m.session},
               {"experiment", m.experiment},
               {"robot", m.robot},
               {"kind", m.kind},
               {"ticks_per_second", m.ticks_per_second},
               {"seed", m.seed},
               {"tick", m.tick},
               {"ports", Json::array()},
               {"publishes", to_json(m.publishes)}};
  for (std::size_t i = 0; i < m.ports.size(); ++i) {
    Json port = to_json(m.ports[i]);
    port["fields"] = m.fields[i];
    json["ports"].push_back(std::move(port));
  }
  return bytes_of(json);
}

hal::Result<RobotMessage> read_robot(std::span<const std::uint8_t> payload) {
  return read_object<RobotMessage>(payload, "Robot", [](const Json& json) -> hal::Result<RobotMessage> {
    RobotMessage m;
    m.version = json.at("version").get<std::int64_t>();
    m.session = json.at("session").get<std::string>();
    m.experiment = json.value("experiment", "");
    m.robot = json.at("robot").get<std::string>();
    m.kind = json.at("kind").get<std::string>();
    m.ticks_per_second = json.at("ticks_per_second").get<std::int64_t>();
    m.seed = json.at("seed").get<std::uint64_t>();
    m.tick = json.at("tick").get<hal::Tick>();
    for (const Json& port : json.at("ports")) {
      m.ports.push_back(port_from(port));
      m.fields.push_back(port.value("fields", Json::array()));
    }
    m.publishes = publishes_from(json);
    return m;
  });
}

std::vector<std::uint8_t> bytes_of(const Ready& m) {
  Json json = {{"session", m.session}, {"takes", Json::array()}, {"publishes", to_json(m.publishes)}};
  for (const PortName& port : m.takes) json["takes"].push_back(to_json(port));
  if (m.controller) json["controller"] = to_json(*m.controller);
  return bytes_of(json);
}

hal::Result<Ready> read_ready(std::span<const std::uint8_t> payload) {
  return read_object<Ready>(payload, "Ready", [](const Json& json) -> hal::Result<Ready> {
    Ready m;
    m.session = json.at("session").get<std::string>();
    for (const Json& port : json.at("takes")) m.takes.push_back(port_from(port));
    m.publishes = publishes_from(json);
    if (const auto controller = json.find("controller"); controller != json.end())
      m.controller = controller_copy_from(*controller);
    return m;
  });
}

std::vector<std::uint8_t> bytes_of(const Farewell& m) {
  return bytes_of(Json{{"error", m.error}, {"text", m.text}});
}

hal::Result<Farewell> read_farewell(std::span<const std::uint8_t> payload) {
  return read_object<Farewell>(payload, "End", [](const Json& json) -> hal::Result<Farewell> {
    return Farewell{json.value("error", false), json.value("text", "")};
  });
}

void append_tick(std::vector<std::uint8_t>& out, hal::Tick tick, std::uint8_t flags) {
  const auto bits = static_cast<std::uint64_t>(tick);
  for (unsigned shift = 0; shift < 64; shift += 8) out.push_back(static_cast<std::uint8_t>(bits >> shift));
  out.push_back(flags);
}

bool take_head(std::span<const std::uint8_t>& in, TickHead& head) noexcept {
  if (in.size() < sizeof head.tick + 1) return false;
  std::uint64_t bits = 0;
  for (unsigned i = 0; i < 8; ++i) bits |= std::uint64_t{in[i]} << (8 * i);
  head.tick = static_cast<hal::Tick>(bits);
  head.flags = in[8];
  in = in.subspan(9);
  return true;
}

}  // namespace tandem::bridges::peer
