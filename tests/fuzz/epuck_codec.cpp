// The e-puck's decoders and its whole session, fed with anything.
//
// An input is a script: each op byte says what happens next (bytes from the input arrive, something that the firmware
// could say arrives, time passes, a request or a stop is made, the link goes and comes). Mostly right answers take the
// session deep; the rest tries to break it.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "bridges/epuck/conversation.hpp"
#include "bridges/epuck/conversions.hpp"
#include "hal/robot/epuck.hpp"

namespace {

const tandem::bridges::epuck::Conversions kUnits{tandem::hal::epuck::kind()};

using namespace tandem::bridges::epuck;

void expect(bool condition) {
  if (!condition) std::abort();
}

class Script {
 public:
  explicit Script(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool done() const { return at_ >= bytes_.size(); }
  std::uint8_t next() { return done() ? std::uint8_t{0} : bytes_[at_++]; }
  std::span<const std::uint8_t> take(std::size_t n) {
    const auto part = bytes_.subspan(at_, std::min(n, bytes_.size() - at_));
    at_ += part.size();
    return part;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

constexpr std::string_view kSayings[] = {
    "v,Version 1.2.2 August 2008 GCtronic\r\nHW version: 1\r\ns\r\n",
    "v,Version 2.0.0 January 2008\r\ns\r\n",
    "v,Version 2.0 January 2018 GCtronic\r\nHW version: FFFFFFFF\r\ns\r\n",
    "v,Version 1.5.3 November 2016 (Webots)\r\ns\r\n",
    "s\r\n",
    "z,Command not found\r\n",
    "\x0C\x07WELCOME to the SerCom protocol on e-Puck\r\nthe EPFL education robot type \"H\" for help\r\n",
    "HW version: 123456789\r\n"};

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

void decode_alone(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 3) return;
  QuantitySet asked;
  for (unsigned i = 0; i < kQuantityCount; ++i) {
    if (((bytes[0] | bytes[1] << 8) >> i & 1) != 0) asked.add(static_cast<Quantity>(i));
  }
  const AnswerLayout layout{static_cast<std::uint8_t>(bytes[2] % 6 * 2),
                            static_cast<std::uint8_t>(bytes[2] & 2U),
                            6,
                            static_cast<std::uint8_t>(bytes[2] & 4U ? 8 : 6),
                            static_cast<std::uint8_t>(bytes[2] & 8U ? 2 : 0),
                            static_cast<std::uint8_t>(bytes[2] & 16U ? 103 : 0)};
  RawSensors sensors;
  decode_answer(bytes.subspan(3), asked, layout, sensors);
  for (const std::uint16_t v : sensors.proximity) expect(kUnits.proximity_distance_m(v) >= 0.0);
  AllSensors all;
  decode_all_sensors(bytes, all);
  Identity identity;
  std::uint32_t hardware = 0;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  parse_version(text, identity);
  expect(identity.version_text().size() < identity.version.size());
  parse_hardware(text, hardware);
}

/// However the stream is cut, the radio's packets are the same.
void cut_alone(std::span<const std::uint8_t> bytes) {
  WifiReader reader;
  bool lost = false;
  for (const std::uint8_t byte : bytes) {
    const WifiReader::Event event = reader.push(byte);
    expect(!lost || event == WifiReader::Event::OutOfStep);
    lost = event == WifiReader::Event::OutOfStep;
    AllSensors all;
    if (event == WifiReader::Event::Sensors) expect(decode_all_sensors(reader.sensors(), all) != Decoded::WrongLength);
  }
}

/// A packet of the radio's: plausible but for what `argument` says.
void hear_radio(Conversation& session, std::uint8_t argument, tandem::hal::TimeNs now) {
  std::array<std::uint8_t, 105> packet{2};
  packet[1 + 79] = argument;                   // the left wheel's counter
  packet[1 + 38] = argument > 250 ? 0xFF : 0;  // a proximity beyond 12 bits
  session.on_bytes(std::span(packet).first(argument % 7 == 6 ? 60 : 105), now);
}

void act(Conversation& session, Script& script, tandem::hal::TimeNs& now) {
  static constexpr std::uint8_t kZeros[128] = {};
  const std::uint8_t op = script.next();
  const std::uint8_t argument = script.next();
  switch (op % 15) {
    case 0:
      session.on_bytes(script.take(argument), now);
      break;
    case 1:
    case 2:
      session.on_bytes(bytes_of(kSayings[argument % std::size(kSayings)]), now);
      break;
    case 3:
      session.on_bytes(std::span(kZeros).first(argument % 128), now);
      break;
    case 4:
      now += argument * tandem::hal::kNsPerMs;
      break;
    case 5: {
      Actuation a;
      a.left.value = static_cast<std::int16_t>(argument * 8 - 1000);
      a.ring[argument % 8].r = argument;
      QuantitySet asked;
      for (unsigned i = 0; i < 8; ++i) {
        if ((argument >> i & 1) != 0) asked.add(static_cast<Quantity>(i));
      }
      session.request(a, asked, now);
      break;
    }
    case 6:
      session.stop(now);
      break;
    case 7:
      session.link_down(now);
      break;
    case 8:
      session.link_up(now);
      break;
    case 10: {
      Actuation a;
      a.right.value = static_cast<std::int16_t>(argument * 8 - 1000);
      session.command(a, now);
      break;
    }
    case 11:
      session.ask({Quantity::Proximity, Quantity::Acceleration}, now);
      break;
    case 13:
      hear_radio(session, argument, now);
      break;
    case 14:
      session.sent_in_part();
      break;
    case 12:
      session.stalled(argument * tandem::hal::kNsPerMs);
      break;
    case 9:
      argument > 250 ? session.shut_down(now) : session.poll(now);
      break;
    default:
      break;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  decode_alone(bytes);
  cut_alone(bytes);
  Script script(bytes);
  const auto wire = script.next() % 3 == 0 ? WireForm::Wifi : WireForm::Serial;
  const auto made = make_conversation(wire, {});
  Conversation& session = *made;
  tandem::hal::TimeNs now = 0;
  session.link_up(now);
  while (!script.done()) {
    expect(session.output().size() <= Packet::kCapacity);
    session.clear_output();
    act(session, script, now);
    session.poll(now);
    expect(session.state() <= SessionState::Lost);
    expect(session.next_deadline() > now || session.state() == SessionState::Absent);
    expect(wire == WireForm::Serial || session.output().size() % kWifiCommandSize == 0);
    for (const std::uint16_t v : session.samples().raw.proximity) expect(v <= 4095);
  }
  return 0;
}
