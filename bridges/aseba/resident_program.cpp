#include "bridges/aseba/resident_program.hpp"

#include <algorithm>
#include <utility>

namespace tandem::bridges::aseba {
namespace {

using hal::TimeNs;

constexpr int kBeatStands = 10;                     // beats; from then on the program does not run
constexpr TimeNs kLoadAgain = 400 * hal::kNsPerMs;  // for a program that was sent to begin
constexpr int kLook = 2;                            // beats between looks whether it has begun
constexpr std::size_t kMostBytecode = 250;          // words of a program in one message

}  // namespace

/// FNV-1a [Fowler, Noll, Vo].
std::int16_t signature_of(const std::vector<std::uint16_t>& words) noexcept {
  std::uint32_t hash = 2166136261U;
  for (const std::uint16_t word : words) hash = (hash ^ word) * 16777619U;
  return static_cast<std::int16_t>(((hash ^ hash >> 16U) & 0x3FFFU) | 0x4000U);
}

int number_of(const std::vector<std::string>& names, std::string_view name) noexcept {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

void ResidentProgram::begin(NodeProgram program, const Timing& timing) {
  const bool ran = ran_;
  *this = ResidentProgram();
  ran_ = ran;
  program_ = std::move(program);
  timing_ = timing;
}

ResidentProgram::Heard ResidentProgram::hear(const Node& node) noexcept {
  Heard heard;
  const TimeNs taken = node.taken_ns(program_.mailbox, timing_.told);
  // What was measured before the program was sent says nothing of it.
  if (taken == 0 || taken <= std::max(heard_ns_, loaded_ns_)) return heard;
  heard.taken_ns = heard_ns_ = taken;
  heard.ours = mail(node, mail_head::kSignature) == program_.signature;
  const std::int16_t beat = mail(node, mail_head::kBeat);
  const std::int16_t lapses = mail(node, mail_head::kLapses);
  const bool beats = heard.ours && beat_known_ && beat != beat_;
  if (!beat_known_ || beat != beat_ || !heard.ours) beat_ns_ = taken;
  beat_ = beat;
  beat_known_ = heard.ours;
  // The beat counts since the reset.
  const bool settled = static_cast<std::uint16_t>(beat) * timing_.beat_ns >= timing_.settle_ns;
  heard.began = beats && settled && !running();
  if (heard.began) {
    state_ = State::Running;
    ran_ = true;
  } else {
    heard.lapsed = running() && heard.ours && lapses != lapses_;
  }
  lapses_ = lapses;
  const bool stands = heard.ours && taken - beat_ns_ >= kBeatStands * timing_.beat_ns;
  if (heard.ours && !stands) return heard;
  heard.gone = std::exchange(ran_, false);
  if (state_ == State::Loading) return heard;  // it may yet begin
  state_ = State::Unknown;
  heard.absent = true;
  return heard;
}

void ResidentProgram::load(Network& network, const Node& node, TimeNs now) noexcept {
  Payload words;
  for (std::size_t at = 0; at < program_.words.size(); at += kMostBytecode) {
    words.clear();
    const std::size_t behind = std::min(at + kMostBytecode, program_.words.size());
    for (std::size_t i = at; i < behind; ++i) words.append(program_.words[i]);
    if (!network.send(SetBytecode{node.id, static_cast<std::uint16_t>(at), words.words()})) return;
  }
  if (!network.send(Run{node.id})) return;
  state_ = State::Loading;
  loaded_ns_ = now;
  beat_known_ = false;
  ++loads_;
}

bool ResidentProgram::pursue(Network& network, const Node& node, TimeNs now) noexcept {
  if (running()) return false;
  if (state_ == State::Loading && now - loaded_ns_ >= kLoadAgain) {
    load(network, node, now);
    return true;
  }
  if (now - looked_ns_ < kLook * timing_.beat_ns) return false;
  looked_ns_ = now;
  return network.want(node.id, program_.mailbox, timing_.told);
}

}  // namespace tandem::bridges::aseba
