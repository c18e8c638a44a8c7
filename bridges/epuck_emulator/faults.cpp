#include "bridges/epuck_emulator/faults.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

constexpr std::array<FaultForm, 10> kForms = {{
    {"silent", FaultValue::None, false, kEndless, "silent@5s+2s", "its answers do not arrive; it hears and obeys"},
    {"deaf", FaultValue::None, false, kEndless, "deaf@5s+2s", "nothing that is sent arrives at it"},
    {"garbage", FaultValue::None, false, kEndless, "garbage@4s+1s", "random bytes arrive instead of its answers"},
    {"drop", FaultValue::Probability, false, kEndless, "drop=0.01", "loses each byte with this probability"},
    {"double", FaultValue::Probability, false, kEndless, "double=0.01", "brings each byte twice with this probability"},
    {"corrupt", FaultValue::Probability, false, kEndless, "corrupt=0.001",
     "flips a bit of each byte with this probability"},
    {"delay", FaultValue::Time, false, kEndless, "delay=20ms", "its bytes arrive later, as over Bluetooth"},
    {"reset", FaultValue::None, true, 0, "reset@3s", "it restarts"},
    {"truncate", FaultValue::None, true, 0, "truncate@2s", "loses the second half of its next answer"},
    {"hangup", FaultValue::None, true, hal::kNsPerSecond, "hangup@6s+1s", "the device disappears and comes back"},
}};

}  // namespace

const FaultTable<Fault> kFaults{kForms};

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
    if (f.kind == FaultKind::Drop && chance().hits(f.number)) return std::nullopt;
    if (f.kind == FaultKind::Corrupt && chance().hits(f.number)) {
      byte = static_cast<std::uint8_t>(byte ^ (1U << (chance().draw() >> 61U)));
    }
  }
  return byte;
}

std::uint8_t FaultPlan::garble(std::uint8_t byte) {
  return static_cast<std::uint8_t>(byte + 1 + (chance().draw() >> 56U) % 255);
}

}  // namespace tandem::bridges::epuck_emulator
