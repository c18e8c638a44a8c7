// Throughput of the foot-bot's codec and its two framings, in messages a second.
#include <algorithm>
#include <array>

#include "app/exit_code.hpp"
#include "app/outputs/report.hpp"
#include "app/process/measure.hpp"
#include "bench/bench.hpp"
#include "bridges/aseba/fragments.hpp"
#include "bridges/aseba/message.hpp"
#include "bridges/aseba/stream_messages.hpp"

namespace tandem::bench {
namespace {

using namespace bridges::aseba;

constexpr long long kMessages = 2'000'000;

/// Runs `once(i)` for each message; `once` returns something that depends on all it did, so that nothing is left out.
template <class F>
void measure(const char* what, F&& once) {
  std::uint64_t sum = 0;
  const double start = app::cpu_seconds();
  for (long long i = 0; i < kMessages; ++i) sum = sum * 31 + once(static_cast<std::uint16_t>(i));
  const double took_s = app::cpu_seconds() - start;
  print_line({{"bench", "codec"},
              {"what", what},
              {"messages", static_cast<std::int64_t>(kMessages)},
              {"cpu_s", took_s},
              {"messages_per_s", static_cast<double>(kMessages) / took_s},
              {"check", app::hash_text(sum)}});
}

/// Reads every word.
template <class M>
std::uint64_t all_of(const M& message) {
  std::uint64_t sum = message.start;
  for (std::size_t i = 0; i < message.words.size(); ++i) sum = sum * 3 + static_cast<std::uint16_t>(message.words[i]);
  return sum;
}

void measure_all() {
  Payload words;
  for (std::uint16_t i = 0; i < 24; ++i) words.append(i);
  Payload payload;
  Message message;

  measure("encode and decode VARIABLES of 24 words", [&](std::uint16_t i) {
    encode(Variables{i, words.words()}, payload);
    decode(0x9005, payload.bytes(), message);
    return all_of(std::get<Variables>(message));
  });
  measure("encode and decode SET_VARIABLES of 1 word", [&](std::uint16_t i) {
    encode(SetVariables{1, i, Words(words.bytes().first(2))}, payload);
    decode(0xA00C, payload.bytes(), message);
    return all_of(std::get<SetVariables>(message));
  });
  Assembler assembler;
  measure("VARIABLES of 24 words through CAN fragments and back", [&](std::uint16_t i) {
    encode(Variables{i, words.words()}, payload);
    std::uint64_t got = 0;
    for (std::size_t k = 0; k < frames_for(payload.size()); ++k) {
      if (const auto view = assembler.push(fragment(7, 0x9005, payload.bytes(), k))) {
        decode(view->type, view->payload, message);
        got = all_of(std::get<Variables>(message));
      }
    }
    return got;
  });
  StreamReader reader;
  std::array<std::uint8_t, kStreamHeader + kMostPayload> stream{};
  measure("VARIABLES of 24 words out of a byte stream", [&](std::uint16_t i) {
    encode(Variables{i, words.words()}, payload);
    write_u16(stream.data(), static_cast<std::uint16_t>(payload.size()));
    write_u16(stream.data() + 2, 7);
    write_u16(stream.data() + 4, 0x9005);
    std::copy(payload.bytes().begin(), payload.bytes().end(), stream.begin() + kStreamHeader);
    auto bytes = std::span<const std::uint8_t>(stream).first(kStreamHeader + payload.size());
    reader.take(bytes, 0);
    decode(reader.message().type, reader.message().payload, message);
    return all_of(std::get<Variables>(message));
  });
}

}  // namespace

hal::Result<int> bench_codec(const Call& call) {
  for (std::int64_t i = 0; i < call.options.repeat && !call.stop.load(); ++i) measure_all();
  return app::kDone;
}

}  // namespace tandem::bench
