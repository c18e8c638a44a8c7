// Both sides' decoders of the lock-step protocol, fed with anything, behind a good checksum, too.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "bridges/peer/frame.hpp"
#include "bridges/peer/messages.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace {

using namespace tandem::bridges::peer;

void expect(bool condition) {
  if (!condition) std::abort();
}

template <class Port>
void decode_port(std::span<const std::uint8_t> payload) {
  static const RowForm form(tandem::hal::port_type<Port>());
  Port port;
  std::span<const std::uint8_t> in = payload;
  if (!form.unpack(in, &port)) return;
  std::vector<std::uint8_t> again;
  form.pack(&port, again);
  expect(again.size() == payload.size() - in.size());
}

void decode(std::span<const std::uint8_t> payload) {
  (void)read_hello(payload);
  if (const auto robot = read_robot(payload); robot.ok()) expect(read_robot(bytes_of(robot.value())).ok());
  if (const auto ready = read_ready(payload); ready.ok()) expect(read_ready(bytes_of(ready.value())).ok());
  (void)read_farewell(payload);
  TickHead head;
  std::span<const std::uint8_t> in = payload;
  if (take_head(in, head)) {
    decode_port<tandem::hal::Proximity>(in);
    decode_port<tandem::hal::RangeAndBearing>(in);
    decode_port<tandem::hal::RangeAndBearingSend>(in);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> all(data, size);
  FrameReader reader;
  for (std::size_t at = 0; at < size; at += 7) reader.push(all.subspan(at, std::min<std::size_t>(7, size - at)));
  while (const auto frame = reader.next()) decode(frame->payload);
  expect(reader.skipped_bytes() <= size);
  decode(all);
  // Found whatever stands before it, unless that swallows it as a payload of its own.
  const auto good = frame_of(MessageType::Commands, all);
  FrameReader clean;
  clean.push(good);
  const auto found = clean.next();
  expect(found && found->payload.size() == size);
  std::vector<std::uint8_t> json = {'{', '"', 's', 'e', 's', 's', 'i', 'o', 'n', '"', ':', '"', '1', '"', ','};
  json.insert(json.end(), data, data + size);
  json.push_back('}');
  decode(json);
  return 0;
}
