#include "mixed_reality/safety/proof.hpp"

#include <cmath>

#include "hal/unit.hpp"

namespace tandem::mixed_reality {
namespace {

std::string seconds(hal::TimeNs ns) {
  return hal::format_number(std::round(hal::to_seconds(ns) * 10.0) * 0.1) + " s";
}

void add(std::string& text, const std::string& more) {
  text += (text.empty() ? "" : "; ") + more;
}

std::string who(const bridges::RobotIdentity& identity) {
  const std::string words = to_text(identity);
  return (words.empty() ? "a robot that tells nothing of itself" : "'" + words + "'") + " answers on " +
         identity.device.value_or(identity.link);
}

}  // namespace

Doubt Proof::look(RunPhase phase, const bridges::RobotBridge& bridge, hal::TimeNs now_ns) {
  const bool answers = bridge.health() == bridges::LinkHealth::Active;
  const bool returns = answers && !answers_;
  const hal::TimeNs away_ns = answers ? now_ns - answered_ns_ : 0;  // or nobody looked
  const std::uint64_t version = bridge.stop_version();
  const bool changed = answers && (returns || version != version_ || away_ns > kAway_ns);
  if (changed) {
    identity_ = bridge.identity();
    version_ = version;
  }
  answers_ = answers;
  if (answers) answered_ns_ = now_ns;
  if (phase == RunPhase::Waiting || phase == RunPhase::Joining) {
    begun_ns_.reset();
    armed_.reset();
    if (answers) armed_ = identity_;
    detail_.clear();
    return Doubt::None;
  }
  if (!begun_ns_) begun_ns_ = now_ns;
  if (!answers) return Doubt::None;
  if (armed_) return changed ? compare(returns, away_ns) : Doubt::None;
  if (!joins_late_ && now_ns - *begun_ns_ <= kAway_ns) {
    armed_ = identity_;
    return Doubt::None;
  }
  if (!returns) return Doubt::None;
  detail_ = joins_late_ ? "" : "it did not answer before " + seconds(now_ns - *begun_ns_) + " after the start";
  add(detail_, who(identity_));
  return Doubt::Late;
}

Doubt Proof::compare(bool returns, hal::TimeNs away_ns) {
  const bool away = away_ns > kAway_ns;
  const bool anew = identity_.session != armed_->session;
  // Words may come one after the other while it answers all the time.
  const bool all_the_time = !returns && !away && !anew;
  const std::string other = all_the_time ? contradiction(*armed_, identity_) : difference(*armed_, identity_);
  if (!away && !anew && other.empty()) {
    fill_in_words();
    return Doubt::None;
  }
  detail_.clear();
  if (!other.empty()) add(detail_, other);
  if (away) add(detail_, "it was away for " + seconds(away_ns));
  if (anew) add(detail_, "its device was opened anew");
  add(detail_, who(identity_));
  return !other.empty() ? Doubt::Another : anew ? Doubt::OpenedAnew : Doubt::Away;
}

/// What it tells for the first time counts from now on.
void Proof::fill_in_words() {
  const bridges::RobotIdentity before = *armed_;
  armed_ = identity_;
  const auto keep = [](std::optional<std::string>& now, const std::optional<std::string>& was) {
    if (!now) now = was;
  };
  keep(armed_->firmware, before.firmware);
  keep(armed_->hardware, before.hardware);
  keep(armed_->address, before.address);
  keep(armed_->name, before.name);
}

void Proof::arm() {
  if (!answers_) return;
  armed_ = identity_;
  joins_late_ = false;
  detail_.clear();
}

}  // namespace tandem::mixed_reality
