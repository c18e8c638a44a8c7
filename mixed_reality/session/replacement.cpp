// Another real robot takes the place of one while the run goes on.
#include <algorithm>
#include <chrono>
#include <system_error>

#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/settings/tracker_check.hpp"

namespace tandem::mixed_reality {
namespace {

std::vector<std::string> names_of(const Replacement& by) {
  return by.names.empty() ? std::vector<std::string>{by.id} : by.names;
}

const core::RobotItem* item_of(const core::Scenario& scenario, const std::string& id) {
  const auto found = std::ranges::find(scenario.robots, id, &core::RobotItem::id);
  return found != scenario.robots.end() && found->bridge ? &*found : nullptr;
}

}  // namespace

hal::Status MixedSession::replace(std::string_view robot, const Replacement& by) {
  const auto chosen = real_robots(robot);
  if (!chosen.ok()) return chosen.error();
  if (robot == "*" || chosen.value().size() != 1) return hal::Error{"one robot at a time is replaced: name it"};
  const std::size_t index = chosen.value().front();
  Twin& old = *twins_[index];
  const core::RobotItem* const item = item_of(world_->scenario(), old.id());
  if (item == nullptr) return hal::Error{"robot '" + old.id() + "' has no <bridge> in the file"};
  for (const Candidate& candidate : candidates_) {
    if (candidate.robot == old.id())
      return hal::Error{"robot '" + old.id() + "' is being replaced by '" + candidate.by.id + "' already"};
  }
  std::vector<std::pair<std::string, std::string>> taken;  // ids and links
  for (std::size_t i = 0; i < twins_.size(); ++i) taken.emplace_back(last_[i].device, bridges_[i].link);
  for (const Candidate& candidate : candidates_) taken.emplace_back(candidate.by.id, candidate.by.link);
  for (const Retired& retired : retired_) taken.emplace_back(retired.device, retired.link);
  leave_out_closed();
  for (const GivenUp& one : given_up_) {
    if (one.device == by.id || one.link == by.link)
      return hal::Error{"the link " + one.link + " of '" + one.device +
                        "' is being closed after the last attempt; try again in a few seconds"};
  }
  for (const auto& [id, link] : taken) {
    if (id == by.id) return hal::Error{"'" + by.id + "' takes part already, or has; give the other robot another id"};
    if (link == by.link) return hal::Error{"the link " + by.link + " is that of '" + id + "'"};
  }
  bridges::BridgeRequest request = bridge_request(world_->scenario(), *item, world_->seed());
  request.robot = by.id;
  request.link = by.link;
  auto twin = make_twin(*item, old.robot(), {}, request, by.pose.value_or(old.pose()));
  if (!twin.ok()) return twin.error();
  Candidate candidate{old.id(), by, std::move(twin).value(), now_.monotonic_ns, 0};
  bridges::RobotBridge& real = candidate.made.twin->real();
  if (options_.on_joined) {
    if (const hal::Status may = options_.on_joined(real); !may.ok()) {
      if (options_.on_left_out) options_.on_left_out(real);
      return may;
    }
  }
  old.real_robot().retire(time_.now_ns());
  real.stop(time_.now_ns());
  real.start();
  candidates_.push_back(std::move(candidate));
  return {};
}

/// Candidates stand and are asked for readings until they answer, or too long has passed; those who were replaced are
/// heard out.
void MixedSession::follow_candidates() {
  for (const Retired& retired : retired_) retired.twin->real().latch(0, now_.monotonic_ns);
  leave_out_closed();
  for (std::size_t c = 0; c < candidates_.size();) {
    Candidate& candidate = candidates_[c];
    bridges::RobotBridge& real = candidate.made.twin->real();
    real.set_origin(now_.monotonic_ns - now_.run_ns);
    real.latch(0, now_.monotonic_ns);
    if (now_.monotonic_ns >= candidate.commit_ns) {
      candidate.commit_ns = now_.monotonic_ns + hal::time_of_tick(1, world_->ticks_per_second());
      real.commit(now_.monotonic_ns);
    }
    const auto found = std::ranges::find(twins_, candidate.robot, [](const auto& twin) { return twin->id(); });
    const auto index = static_cast<std::size_t>(found - twins_.begin());
    const bool late = hal::to_seconds(now_.monotonic_ns - candidate.began_ns) >= bridges_[index].connect_s;
    if (real.health() == LinkHealth::Active && !real.mismatched()) {
      take_place(index, std::move(candidate.made), candidate.by);
    } else if (late || real.mismatched()) {
      const std::string trouble = real.trouble();
      options_.log.warning("robot '" + candidate.robot + "' is not replaced: '" + candidate.by.id + "' on " +
                           candidate.by.link + " did not answer: " + (trouble.empty() ? "" : trouble + "; ") +
                           real.advice());
      twins_[index]->real_robot().stay();
      give_up(std::move(candidate));
    } else {
      ++c;
      continue;
    }
    candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(c));
  }
}

void MixedSession::give_up(Candidate candidate) {
  bridges::RobotBridge& real = candidate.made.twin->real();
  GivenUp one{std::move(candidate.made.twin), candidate.by.id, candidate.by.link, {}};
  try {
    one.closing = std::async(std::launch::async, [&real] { real.shut_down(); });
  } catch (const std::system_error&) {  // no more threads
    real.shut_down();
  }
  given_up_.push_back(std::move(one));
}

/// Guardians need not stop robots that never came, once their links are closed; the same may be tried again.
void MixedSession::leave_out_closed() {
  std::erase_if(given_up_, [this](GivenUp& one) {
    if (one.closing.valid() && one.closing.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    if (options_.on_left_out) options_.on_left_out(one.twin->real());
    left_out_.push_back(std::move(one.twin));
    return true;
  });
}

void MixedSession::take_place(std::size_t index, MadeTwin other, const Replacement& by) {
  std::unique_ptr<Twin> old = std::exchange(twins_[index], std::move(other.twin));
  FusedPose* const seen = std::exchange(fused_[index], other.fused);
  Twin& twin = *twins_[index];
  if (seen != nullptr) trackers_.remove_robot(*seen);
  if (index < links_.size()) links_.forget(index);
  if (other.fused != nullptr) {
    const core::RobotItem& item = *item_of(world_->scenario(), twin.id());
    trackers_.add_robot(names_of(by), tag_of(item), *other.fused);
  }
  core::SpaceInputs rows;
  twin.list(rows);
  auto next = rows.rows.begin();
  for (core::InputRow& row : inputs_.rows) {  // as many as the old one's: they are the controller's
    if (row.robot == twin.robot() && next != rows.rows.end()) row = *next++;
  }
  ++inputs_.version;
  last_[index].incidents.insert(last_[index].incidents.end(), old->incidents().begin(), old->incidents().end());
  replaced_.push_back({twin.id(), last_[index].device, by.id, by.link, world_->tick()});
  options_.log.warning("robot '" + twin.id() + "': '" + by.id + "' on " + by.link + " takes the place of '" +
                       last_[index].device + "', and waits to be armed");
  retired_.push_back({std::move(old), last_[index].device, bridges_[index].link, bridges_[index].stop_s});
  last_[index].device = by.id;
  bridges_[index].link = by.link;
  retired_.back().twin->leave();
  twin.join(barrier_);
  twin.real_robot().join_late();
  twin.real().resume();
}

}  // namespace tandem::mixed_reality
