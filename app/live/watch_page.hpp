// The table of `run --watch`: its contents, and its layout on a screen of any size.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/process/screen.hpp"
#include "app/run/real_side.hpp"
#include "core/live/live_run.hpp"
#include "core/run/roll_call.hpp"
#include "core/sim/world.hpp"
#include "hal/port.hpp"

namespace tandem::app {

/// What is asked of the run for the next page.
struct WatchWish {
  std::vector<std::string> robots;  ///< ids, or patterns with '*'; empty: all
  std::string port;                 ///< "proximity" or "actuator leds"; empty: what controllers publish
  std::size_t first = 0;            ///< of the chosen robots
  std::size_t rows = 20;            ///< robots, at most
  Screen::Size map{0, 0};           ///< room for the map; none
};

/// What a moment is made of: of a run, or of the record of one.
struct WatchSight {
  const core::Space& space;
  hal::Tick done = 0;  ///< ticks
  std::int64_t ticks_per_second = 10;
  std::optional<core::Incidents> incidents = {};  ///< nothing: not counted
};

/// One moment of a run as texts.
struct WatchMoment {
  struct Robot {
    std::string id, kind;
    double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0, speed_m_s = 0.0;
    bool halted = false, real = false;
    std::string values;
    std::optional<double> age_s;  ///< of the port's reading
    bool fresh = true;
  };
  std::vector<std::pair<std::string, std::size_t>> kinds;  ///< how many robots of each
  std::optional<core::Incidents> incidents;
  std::size_t chosen = 0;  ///< robots that the wish's patterns fit
  std::size_t first = 0;   ///< of `robots` among these
  std::vector<Robot> robots;
  std::vector<std::string> ports;  ///< that the first of them has, as wishes name them
  std::vector<RealRobots::Line> real;
  std::vector<core::RollRow> roll;  ///< of the same robots
  std::vector<std::string> map;     ///< of the arena; empty: there is no room
};

/// Finds what a wish asks for. Used by the thread that steps what is watched.
class WatchEye {
 public:
  WatchMoment look(const WatchSight& now, const WatchWish& wish);

 private:
  const std::vector<core::RobotId>& chosen(const core::Space& space, const std::vector<std::string>& patterns);

  std::vector<std::string> patterns_{"nobody has asked yet"};
  std::size_t robots_then_ = 0;
  std::vector<core::RobotId> chosen_;
};

/// The port of that name, "sensor proximity", "actuator leds" or, the sensor first, "leds"; null: the robot has none.
const hal::PortType* port_of(const core::Space& space, core::RobotId robot, const std::string& name);

/// What a page says beside the moment.
struct WatchPage {
  std::string experiment;
  std::int64_t ticks = 0;  ///< of the run; 0: it has no end of its own
  std::int64_t ticks_per_second = 10;
  bool keys = true;
  core::LiveState state;
  WatchMoment moment;
  std::string port;                  ///< that is shown
  std::string note;                  ///< an answer to the last key
  std::string prompt;                ///< what is being typed
  std::deque<std::string> messages;  ///< the newest last
};

/// The first line: "a  t = 12.3 s  tick 123  0.5 × real time asked, 0.498 reached".
std::string headline(const WatchPage& page);
/// One line of it all, for where there is no terminal.
std::string summary(const WatchPage& page);
/// As many lines as fit.
std::vector<ScreenLine> lay_out(const WatchPage& page, Screen::Size size);
/// Robots that a page of this size shows.
std::size_t rows_of(const WatchPage& page, Screen::Size size);
/// Room for the map on a page of this size.
Screen::Size map_room(const WatchPage& page, Screen::Size size);

}  // namespace tandem::app
