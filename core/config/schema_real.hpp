// Elements of experiment files about real robots: how they are reached and seen, what keeps them safe, who commands
// them.
#pragma once
#include <array>
#include <string>

#include "core/config/schema_element.hpp"
#include "core/scenario/scenario.hpp"

namespace tandem::core::schema {

struct Bridge {
  static constexpr ElementInfo kElement{
      "bridge", "Makes the robot stand for a real one on this link. Further attributes are those of its kind.", "link",
      kAnything};
  std::string link, rearm = "proved", missing = "refuse";
  double timeout_s = 0.5, settle_s = 0.3, ramp_m_s2 = 0.25, connect_s = 15.0, stop_s = 1.0;
  void describe(ParamVisitor& v) {
    v.text("link", link, "Where the real robot is, e.g. serial:/dev/ttyUSB0@115200.");
    v.number("timeout", timeout_s, unit::s, {0.05, 60.0},
             "Age of the last answer from which the robot counts as lost and is stopped.");
    v.text("rearm", rearm,
           "What lets the robot drive again after a stop: proved (a short outage ends by itself, all else waits for a "
           "person), operator (every stop waits for a person), after a time in which all was well, never. Whatever it "
           "says: a robot that is not proved to be the one that was armed waits for a person, who names it.");
    v.number("settle_after", settle_s, unit::s, {0.0, 60.0},
             "Before it drives, all must have been well for this long.");
    v.number("rearm_ramp", ramp_m_s2, unit::m_s2, {0.001, 100.0}, "Its largest speed then grows from 0 by this.");
    static constexpr std::array<std::string_view, 3> kMissing = {"refuse", "simulate", "wait"};
    v.choice("missing", missing, kMissing,
             "When it is not there at the start: refuse to run, run with a simulated robot instead, or wait for it.");
    v.number("connect_timeout", connect_s, unit::s, {0.1, 3600.0}, "How long it is waited for before it is missing.");
    v.number("stop_timeout", stop_s, unit::s, {0.1, 60.0}, "How long it has to confirm its stop at the end.");
  }
};

struct Peer {
  static constexpr ElementInfo kElement{
      "peer", "The robot's controller steps elsewhere, in lock-step: on a board, in another program, behind a wire."};
  std::string link;
  void describe(ParamVisitor& v) {
    v.text("link", link,
           "Left out: the peer connects to the port of <peers listen>. Else where it is, serial:/dev/ttyUSB0@115200 or "
           "tcp:HOST:PORT; or emulated:FIRMWARE, a bridge and the emulated firmware in this program.");
  }
};

struct Tracker {
  static constexpr ElementInfo kElement{"tracker", "Where a real robot's pose comes from."};
  std::string source = "auto", id;
  double turn_rad = 0.0, lost_m = 0.1, height_m = -1.0;
  Vec3 offset{};
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 4> kSources = {"auto", "odometry", "positioning", "fused"};
    v.choice("source", source, kSources,
             "odometry: its wheels alone; positioning: what it says itself; fused: wheels, gyroscope and <trackers>; "
             "auto: fused where the file has trackers and the robot wheels, else one of the others.");
    v.text("id", id, "Names or tags by which trackers know it, separated by spaces; left out: its id.");
    v.number("turn", turn_rad, unit::deg, kAny, "By which the tag on it is turned against its forward axis.");
    v.vector("offset", offset, unit::m, "Where the tag's centre is on it: forward, to the left; the third is 0.");
    v.number("height", height_m, unit::m, {-1.0, 10.0},
             "Of the tag above the floor, for cameras; negative: that of the robot's body.");
    v.number("lost_above", lost_m, unit::m, {0.001, 100.0},
             "It stands while its fused pose is known no better: standard deviation.");
  }
};

struct Trackers : Bare {
  static constexpr ElementInfo kElement{"trackers", "What sees real robots from outside.", "", kTrackerKind};
};

/// What trackers of every kind have; the rest of the attributes are the kind's own.
struct TrackerElement {
  static constexpr ElementInfo kElement{
      "tracker_kind", "A tracker, written with the name of its kind, e.g. <udp>; further attributes are the kind's.",
      "", kAnything};
  std::string id, clock = "own";
  double latency_s = 0.0, sd_m = 0.003, sd_rad = 0.02, turn_rad = 0.0;
  Vec3 origin{};
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kClocks = {"own", "unix", "monotonic"};
    v.text("id", id, "Name; left out: that of its kind.");
    v.choice("clock", clock, kClocks,
             "Of its stamps: own, whose offset is found out; unix, the date; monotonic, CLOCK_MONOTONIC of this "
             "computer.");
    v.number("latency", latency_s, unit::s, {0.0, 2.0},
             "From exposure to arrival, at least: for a clock of its own, or where there are no stamps.");
    v.number("sd", sd_m, unit::m, {1e-6, 10.0}, "Standard deviation of x and y, where sightings do not say.");
    v.number("sd_heading", sd_rad, unit::rad, {1e-6, 3.0}, "Standard deviation of headings, likewise.");
    v.vector("origin", origin, unit::m, "Where the origin of its frame lies in the arena.");
    v.number("turn", turn_rad, unit::deg, kAny, "By which its frame is turned, counter-clockwise.");
  }
};

struct Safety {
  static constexpr ElementInfo kElement{
      "safety", "Where real robots may go, how fast, and whom they keep from. Simulated robots are not held.", "",
      "fence keep_out zone"};
  std::string avoid = "real";
  double apart_m = 0.01, latency_s = 0.05;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kAvoid = {"none", "real", "all"};
    v.choice("avoid", avoid, kAvoid,
             "Whom commands may not run a real robot into: nobody; other real robots; these and all that is virtual.");
    v.number("apart", apart_m, unit::m, {0.0, 10.0}, "Left between bodies, and between a body and an area's edge.");
    v.number("latency", latency_s, unit::s, {0.0, 10.0},
             "Until a command moves the robot, at least; a link's measured round trip counts where it is longer.");
  }
};

inline constexpr double kHighest_m = 1000.0;  ///< of an area that has no upper end

struct FenceElement {
  static constexpr ElementInfo kElement{"fence", "Real robots stay in it with their whole bodies.", "points"};
  std::string id, points;
  double height_m = kHighest_m;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name, for people.");
    v.text("points", points, "Its corners in order, \"x,y x,y …\"; bare numbers are in m. It may be concave.");
    v.number("height", height_m, unit::m, {kSmallest_m, kHighest_m}, "Nothing that flies rises above it.");
  }
};

struct KeepOut {
  static constexpr ElementInfo kElement{"keep_out", "Real robots stay out of it with their whole bodies.", "points"};
  std::string id, points;
  double from_m = 0.0, to_m = kHighest_m;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name, for people.");
    v.text("points", points, "Its corners in order, \"x,y x,y …\"; bare numbers are in m. It may be concave.");
    v.number("from", from_m, unit::m, {0.0, kHighest_m}, "Its lower end: what is below passes under it.");
    v.number("to", to_m, unit::m, {0.0, kHighest_m}, "Its upper end: what flies higher passes over it.");
  }
};

struct Zone {
  static constexpr ElementInfo kElement{"zone", "Real robots are no faster in it.", "points max_speed"};
  std::string id, points;
  double from_m = 0.0, to_m = kHighest_m, max_speed_m_s = 0.0;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name, for people.");
    v.text("points", points, "Its corners in order, \"x,y x,y …\"; bare numbers are in m. It may be concave.");
    v.number("max_speed", max_speed_m_s, unit::m_s, {1e-3, 1000.0}, "Of a body any part of which is in it.");
    v.number("from", from_m, unit::m, {0.0, kHighest_m}, "Its lower end.");
    v.number("to", to_m, unit::m, {0.0, kHighest_m}, "Its upper end.");
  }
};

struct Desk {
  static constexpr ElementInfo kElement{
      "desk", "Who commands real robots besides the terminal and the window, and robots that stand by.", "", "spare"};
  std::string lcm, channel = "tandem/desk";
  bool hold = false;
  void describe(ParamVisitor& v) {
    v.text("lcm", lcm, "Where commands come over LCM: udpm://GROUP:PORT?ttl=N; left out: nowhere.");
    v.text("channel", channel, "Their channel; answers go to CHANNEL/reply.");
    v.flag("hold", hold, "The robots are connected, stand, and wait for somebody to start the run.");
  }
};

struct Spare {
  static constexpr ElementInfo kElement{"spare", "A real robot that may take another one's place in a run.", "id link"};
  std::string id, link, seen_as;
  void describe(ParamVisitor& v) {
    v.text("id", id, "How it is called.");
    v.text("link", link, "Where it is, as in <bridge>.");
    v.text("seen_as", seen_as, "Names or tags by which trackers know it, separated by spaces; left out: its id.");
  }
};

}  // namespace tandem::core::schema
