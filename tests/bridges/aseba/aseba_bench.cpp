// Messages a second: `bench_bridges_aseba [messages]`. Run by hand. One JSON object a line.
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "bridges/aseba/fragments.hpp"
#include "bridges/aseba/message.hpp"
#include "bridges/aseba/stream_messages.hpp"

namespace {

using namespace tandem::bridges::aseba;
using tandem::bridges::CanFrame;

/// Runs `once(i)` for each message; `once` returns something that depends on all it did, so that nothing is left out.
template <class F>
void measure(const char* what, long long messages, F&& once) {
  std::uint64_t sum = 0;
  const auto start = std::chrono::steady_clock::now();
  for (long long i = 0; i < messages; ++i) sum = sum * 31 + once(static_cast<std::uint16_t>(i));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("{\"bench\": \"%s\", \"messages\": %lld, \"messages_per_s\": %.0f, \"check\": %llu}\n", what, messages,
              static_cast<double>(messages) / took.count(), static_cast<unsigned long long>(sum));
}

}  // namespace

int main(int argc, char** argv) {
  const long long messages = argc > 1 ? std::atoll(argv[1]) : 2'000'000;
  Payload words;
  for (std::uint16_t i = 0; i < 24; ++i) words.append(i);
  Payload payload;
  Message message;

  measure("encode and decode VARIABLES of 24 words", messages, [&](std::uint16_t i) {
    encode(Variables{i, words.words()}, payload);
    decode(0x9005, payload.bytes(), message);
    return static_cast<std::uint64_t>(std::get<Variables>(message).start);
  });
  measure("encode and decode SET_VARIABLES of 1 word", messages, [&](std::uint16_t i) {
    encode(SetVariables{1, i, Words(words.bytes().first(2))}, payload);
    decode(0xA00C, payload.bytes(), message);
    return static_cast<std::uint64_t>(std::get<SetVariables>(message).start);
  });
  Assembler assembler;
  measure("VARIABLES of 24 words through CAN fragments and back", messages, [&](std::uint16_t i) {
    encode(Variables{i, words.words()}, payload);
    std::uint64_t got = 0;
    for (std::size_t k = 0; k < frames_for(payload.size()); ++k) {
      if (const auto view = assembler.push(fragment(7, 0x9005, payload.bytes(), k))) {
        decode(view->type, view->payload, message);
        got = std::get<Variables>(message).start;
      }
    }
    return got;
  });
  StreamReader reader;
  std::array<std::uint8_t, kStreamHeader + kMostPayload> stream{};
  measure("VARIABLES of 24 words out of a byte stream", messages, [&](std::uint16_t i) {
    encode(Variables{i, words.words()}, payload);
    write_u16(stream.data(), static_cast<std::uint16_t>(payload.size()));
    write_u16(stream.data() + 2, 7);
    write_u16(stream.data() + 4, 0x9005);
    std::copy(payload.bytes().begin(), payload.bytes().end(), stream.begin() + kStreamHeader);
    auto bytes = std::span<const std::uint8_t>(stream).first(kStreamHeader + payload.size());
    reader.take(bytes, 0);
    decode(reader.message().type, reader.message().payload, message);
    return static_cast<std::uint64_t>(std::get<Variables>(message).start);
  });
  return 0;
}
