// ASEBA's messages in both framings, and the table of nodes behind them, fed with anything.
//
// Three uses of one input: its bytes as a payload of some type; as a byte stream; as a script of CAN frames that arrive
// at a network, most of them nearly right, while time passes and things are asked for. The promises: no crash, no
// undefined behaviour, what was decoded encodes to the same bytes, and no node is believed whose description cannot be.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/aseba/message.hpp"
#include "bridges/aseba/network.hpp"
#include "bridges/aseba/stream_messages.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/can/memory_bus.hpp"

namespace {

using namespace tandem::bridges;
using namespace tandem::bridges::aseba;

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

constexpr std::uint16_t kTypes[] = {0x0005, 0x7FFF, 0x8003, 0x8004, 0x8005, 0x8006, 0x9000, 0x9001,
                                    0x9002, 0x9003, 0x9004, 0x9005, 0x9006, 0x9009, 0x900A, 0x900C,
                                    0xA000, 0xA001, 0xA00B, 0xA00C, 0xA010, 0xA011, 0xB000, 0xFFFF};

void decode_alone(std::uint16_t type, std::span<const std::uint8_t> payload) {
  Message message;
  if (decode(type, payload, message) != Decoded::Good) return;
  Payload again;
  expect(type_of(message) == type);
  expect(encode(message, again));
  expect(std::ranges::equal(again.bytes(), payload));
}

void read_stream(std::span<const std::uint8_t> bytes) {
  StreamReader reader;
  const std::size_t all = bytes.size();
  while (reader.stepping() == Stepping::InStep && reader.take(bytes, 0)) {
    expect(reader.message().payload.size() <= kMostPayload);
    decode_alone(reader.message().type, reader.message().payload);
  }
  expect(bytes.size() <= all);
}

/// A network on a bus in memory whose time the script turns.
struct Bus {
  Bus() : bus([this] { return now; }, 256), link(bus.attach(), {}, [this] { return now; }), network(link) {
    for (auto& end : others) end = bus.attach();
  }
  void say(std::uint8_t source, std::uint16_t type, std::span<const std::uint8_t> payload) {
    for (std::size_t i = 0; i < frames_for(payload.size()); ++i) {
      others[0]->send(fragment(source, type, payload, i));
    }
  }
  tandem::hal::TimeNs now = 1;
  MemoryBus bus;
  CanMessages link;
  Network network;
  std::unique_ptr<CanLink> others[1];
};

/// A whole description of node `source`, spoilt as the script says.
void describe(Bus& bus, std::uint8_t source, Script& script) {
  Payload payload;
  const std::uint8_t flaw = script.next();
  const auto words = static_cast<std::uint16_t>(flaw == 1 ? 60000 : flaw == 2 ? 0 : 40);
  encode(Description{"n", 5, 100, 32, words, static_cast<std::uint16_t>(flaw == 3 ? 65535 : 2), 0, 0}, payload);
  bus.say(source, 0x9000, payload.bytes());
  encode(NamedVariable{static_cast<std::uint16_t>(flaw == 4 ? 65535 : 34), "args"}, payload);
  if (flaw != 5) bus.say(source, 0x9001, payload.bytes());
  encode(NamedVariable{static_cast<std::uint16_t>(flaw == 6 ? 0 : 2), flaw == 7 ? "args" : "v"}, payload);
  bus.say(source, 0x9001, payload.bytes());
}

void act(Bus& bus, Script& script) {
  const std::uint8_t op = script.next();
  const std::uint8_t argument = script.next();
  const auto source = static_cast<std::uint8_t>(argument % 4);
  switch (op % 9) {
    case 0:
      bus.others[0]->send(make_frame((script.next() % 5U) << 8U | source, script.take(argument % 9)));
      break;
    case 1:
      bus.say(source, kTypes[script.next() % std::size(kTypes)], script.take(argument));
      break;
    case 2:
    case 3:
      describe(bus, source, script);
      break;
    case 4:
      bus.now += argument * 5 * tandem::hal::kNsPerMs;
      break;
    case 5:
      (void)bus.network.want(source, script.next(), argument);
      break;
    case 6: {
      const std::int16_t values[3] = {1, 2, 3};
      (void)bus.network.write(source, script.next(), std::span(values).first(argument % 4U % 3U + 1U));
      break;
    }
    case 7: {
      Payload payload;
      const auto words = script.take(argument);
      encode(Variables{script.next(), Words(words)}, payload);
      bus.say(source, 0x9005, payload.bytes());
      break;
    }
    default:
      if (argument < 8) bus.bus.set_state(argument < 4 ? BusState::BusOff : BusState::Active);
      if (argument > 250) bus.network.forget_writes();
      break;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  if (size < 2) return 0;
  decode_alone(kTypes[data[0] % std::size(kTypes)], bytes.subspan(1, std::min(size - 1, kMostPayload)));
  read_stream(bytes);
  if (data[1] % 4 != 0) return 0;  // a network is large: not for every input
  Bus bus;
  Script script(bytes);
  Event event;
  while (!script.done()) {
    act(bus, script);
    bus.network.poll(bus.now);
    while (bus.network.take_event(event)) expect(event.count <= event.arguments.size() && event.number < 0x8000);
    for (const std::uint8_t id : bus.network.known()) {
      const Node& node = bus.network.node(id);
      if (!node.ready()) continue;
      expect(node.image.size() ==
             std::min<std::size_t>(node.description.variable_words, DescriptionDraft::kMostMemory));
      expect(node.description.named_words() <= node.description.variable_words);
    }
  }
  return 0;
}
