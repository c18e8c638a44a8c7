// Eye-bots on a network, in real time.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/emulation/server.hpp"
#include "bridges/eyebot_emulator/eyebot.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "bridges/lcm/lcm_link.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::eyebot_emulator {

/// Its link is "lcm:" and what `LcmLink::open` reads. Every robot has all faults.
struct Options : ServerOptions {
  Options() { link = "lcm:udpm://239.255.76.67:7667?ttl=0"; }

  std::shared_ptr<lcm_bus::LcmLink> shared{};  ///< instead of `link`: one in this process; not yet started
  Eyebot::Options robot{};                     ///< its session is drawn at the start
  int count = 1;                               ///< how many robots: eb0, eb1, … after `robot.name`
  EmulatedBody* body = nullptr;  ///< must outlive the run, for one robot; none: bodies of their own, in `room`
  std::optional<Room> room = Room{};

  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kClocks = {"synced", "unsynced"};
    std::string clock(kClocks[robot.clock_synced ? 0 : 1]);
    std::int64_t many = count;
    v.text("name", robot.name, "Its name, or that of the first.");
    v.integer("count", many, {}, "How many: eb0, eb1, ….");
    v.choice("clock", clock, kClocks, "synced: it refuses commands whose stamps are 250 ms off its clock.");
    v.number("images", robot.image_hz, hal::unit::hz, {0.0, 2.0}, "Images that it sends a second.");
    v.number("body_delay", robot.delays.body_s, hal::unit::s, {0.0, 2.0},
             "By which its body is later than its motors.");
    robot.delays.describe(v);
    robot.clock_synced = clock == kClocks[0];
    count = static_cast<int>(std::clamp<std::int64_t>(many, -1, 1'000'000));
  }
  std::string shown(const std::string& url) const {
    const std::string who = count > 1 ? std::to_string(count) + " eye-bots" : "eye-bot " + robot.name;
    return who + " on " + url + ": connect with --link lcm:" + url;
  }
};

/// Events for the log beside the robot's own: `fault` (fault, phase: begin or end) and `late` (by_ms: see turn_until).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Stamps in the log are exact, which puts lines out
/// of order by up to some milliseconds: a message's is when the link's thread took it, CLOCK_MONOTONIC. Errors: a fault
/// that there is not, a name that cannot be part of a channel's, a link or log that cannot be opened.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

/// "eb0", "eb1", … for `first` "eb0" and `count`. "hawk" becomes "hawk0", … when there are several.
std::vector<std::string> names_of(const std::string& first, int count);

}  // namespace tandem::bridges::eyebot_emulator
