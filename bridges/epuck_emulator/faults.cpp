#include "bridges/epuck_emulator/faults.hpp"

#include <algorithm>

namespace tandem::bridges::epuck_emulator {
namespace {

enum class Value : std::uint8_t { None, Probability, Time };

using Entry = FaultEntry<FaultKind, Value>;

constexpr std::array<Entry, 10> kEntries = {{
    {FaultKind::Silent, "silent", Value::None, false, kEndless, "silent@5s+2s",
     "its answers do not arrive; it hears and obeys"},
    {FaultKind::Deaf, "deaf", Value::None, false, kEndless, "deaf@5s+2s", "nothing that is sent arrives at it"},
    {FaultKind::Garbage, "garbage", Value::None, false, kEndless, "garbage@4s+1s",
     "random bytes arrive instead of its answers"},
    {FaultKind::Drop, "drop", Value::Probability, false, kEndless, "drop=0.01",
     "loses each byte with this probability"},
    {FaultKind::Double, "double", Value::Probability, false, kEndless, "double=0.01",
     "brings each byte twice with this probability"},
    {FaultKind::Corrupt, "corrupt", Value::Probability, false, kEndless, "corrupt=0.001",
     "flips a bit of each byte with this probability"},
    {FaultKind::Delay, "delay", Value::Time, false, kEndless, "delay=20ms",
     "its bytes arrive later, as over Bluetooth"},
    {FaultKind::Reset, "reset", Value::None, true, kEndless, "reset@3s", "it restarts"},
    {FaultKind::Truncate, "truncate", Value::None, true, kEndless, "truncate@2s",
     "loses the second half of its next answer"},
    {FaultKind::Hangup, "hangup", Value::None, true, hal::kNsPerSecond, "hangup@6s+1s",
     "the device disappears and comes back"},
}};

hal::Status read_value(const Entry& entry, std::string_view text, Fault& fault) {
  if (entry.value == Value::Probability) {
    const auto probability = parse_probability(text);
    if (!probability.ok()) return probability.error();
    fault.probability = probability.value();
  } else {
    const auto delay = parse_time(text);
    if (!delay.ok()) return delay.error();
    fault.delay_ns = delay.value();
  }
  return {};
}

}  // namespace

std::string fault_manual() {
  return manual_of_faults(kEntries, 18);
}

hal::Result<Fault> parse_fault(std::string_view text) {
  return read_fault<Fault>(text, kEntries, fault_manual(), &read_value);
}

std::optional<std::uint8_t> FaultPlan::to_robot(std::uint8_t byte, hal::TimeNs at) {
  if (active(FaultKind::Deaf, at)) return std::nullopt;
  return through_the_air(byte, at);
}

std::optional<std::uint8_t> FaultPlan::to_host(std::uint8_t byte, hal::TimeNs at) {
  if (active(FaultKind::Silent, at)) return std::nullopt;
  if (active(FaultKind::Garbage, at)) return static_cast<std::uint8_t>(chance().draw() >> 56U);
  return through_the_air(byte, at);
}

std::optional<std::uint8_t> FaultPlan::through_the_air(std::uint8_t byte, hal::TimeNs at) {
  for (const Fault& f : faults()) {
    if (!is_at_work(f, at)) continue;
    if (f.kind == FaultKind::Drop && chance().hits(f.probability)) return std::nullopt;
    if (f.kind == FaultKind::Corrupt && chance().hits(f.probability)) {
      byte = static_cast<std::uint8_t>(byte ^ (1U << (chance().draw() >> 61U)));
    }
  }
  return byte;
}

std::uint8_t FaultPlan::garble(std::uint8_t byte) {
  return static_cast<std::uint8_t>(byte + 1 + (chance().draw() >> 56U) % 255);
}

}  // namespace tandem::bridges::epuck_emulator
