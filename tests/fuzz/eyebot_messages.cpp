// The codec of eye-bots' messages, fed with anything: what it takes is a message, of just these bytes.
//
// The first byte says which type's fingerprint is put before the rest; sometimes none.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "bridges/eyebot_messages/codec.hpp"

namespace {

using namespace tandem::bridges::eyebot_messages;

template <class Message>
void feed(const std::uint8_t* data, std::size_t size, bool marked) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < 8 && marked; ++i) {
    bytes.push_back(static_cast<std::byte>(fingerprint<Message>() >> (56 - 8 * i)));
  }
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(std::byte{data[i]});
  Message message{};
  if (decode<Message>(bytes, message) != Flaw::None) return;
  std::vector<std::byte> again(bytes.size());
  if (encode(message, again).size() != bytes.size()) std::abort();
  Message twice{};
  if (decode<Message>(again, twice) != Flaw::None) std::abort();
}

template <class... Message>
void feed_one(std::size_t which, const std::uint8_t* data, std::size_t size, bool marked) {
  std::size_t i = 0;
  ((i++ == which ? feed<Message>(data, size, marked) : void()), ...);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t which = data[0] % 20U;
  feed_one<Heartbeat, Leds, Status, State, Altitude, Battery, Scan, Rab, Prox, Light, PanTilt, Blobs, Image, Ack,
           CmdMode, CmdPosition, CmdVelocity, CmdPanTilt, CmdScanner, CmdRab>(which, data + 1, size - 1, data[0] < 240);
  return 0;
}
