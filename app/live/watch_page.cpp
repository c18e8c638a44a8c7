#include "app/live/watch_page.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numbers>

#include "app/live/watch_map.hpp"
#include "app/outputs/roll_lines.hpp"
#include "app/process/terminal.hpp"
#include "core/record/trajectory.hpp"
#include "hal/unit.hpp"

namespace tandem::app {
namespace {

constexpr std::size_t kLinesWithMessages = 14;  // of a screen: smaller ones have the newest message alone
constexpr std::size_t kMostMessages = 6;
constexpr std::size_t kMostNumbers = 32;  // of one field
constexpr std::size_t kLinesOfMap = 20;   // at most, with its frame

std::string values_of(const hal::PortType& type, const void* port) {
  std::string all;
  for (const hal::Field& field : type.fields) {
    if (field.name == "taken_ns" || field.name == "validity" || field.name == "count") continue;
    const std::size_t used = hal::used_count(type, port, field);
    all += (all.empty() ? "" : "  ") + std::string(field.name) + " ";
    if (field.count > 1) all += "[";
    for (std::size_t i = 0; i < std::min(used, kMostNumbers); ++i)
      all += fmt::format("{}{:.3g}", i == 0 ? "" : " ", hal::get_value(port, field, i));
    if (used > kMostNumbers) all += " …";
    if (field.count > 1) all += "]";
    if (!field.unit.symbol.empty()) all += " " + std::string(field.unit.symbol);
  }
  return all;
}

std::string published_of(const core::Space& space, core::RobotId robot) {
  std::string all;
  for (const hal::PublishedField& field : space.published(robot)) {
    const auto text = space.published_text(robot, field.name);
    if (text.ok()) all += (all.empty() ? "" : "  ") + field.name + " " + text.value();
  }
  return all;
}

double degrees(double rad) {
  return rad * 180.0 / std::numbers::pi;
}

std::uint64_t incidents_of(const core::Incidents& i) {
  return i.commands_clamped + i.commands_not_finite + i.controllers_thrown + i.bodies_escaped;
}

std::string robots_text(const WatchMoment& moment) {
  std::string all;
  for (const auto& [kind, count] : moment.kinds) all += fmt::format("{}{} {}", all.empty() ? "" : ", ", count, kind);
  return all.empty() ? "no robots" : all;
}

/// "; no incidents"
std::string incidents_text(const std::optional<core::Incidents>& counted) {
  if (!counted) return {};
  const core::Incidents& i = *counted;
  if (incidents_of(i) == 0) return "; no incidents";
  std::string all;
  const auto add = [&all](std::uint64_t n, const char* what) {
    if (n > 0) all += fmt::format("{}{} {}", all.empty() ? "" : ", ", n, what);
  };
  add(i.controllers_thrown, "controllers stopped");
  add(i.bodies_escaped, "escaped");
  add(i.commands_not_finite, "commands not finite");
  add(i.commands_clamped, "commands clamped");
  return "; incidents: " + all;
}

std::size_t id_width(const WatchMoment& moment) {
  std::size_t width = 5;
  for (const WatchMoment::Robot& robot : moment.robots) width = std::max(width, width_of(printable(robot.id)));
  return std::min<std::size_t>(width, 16);
}

/// `text` in so many columns, cut or filled.
std::string column(const std::string& text, std::size_t columns) {
  std::string cut = cut_to(text, columns);
  cut.append(columns - width_of(cut), ' ');
  return cut;
}

ScreenLine line_of(const WatchMoment::Robot& robot, std::size_t id_columns, bool port) {
  std::string text = fmt::format("{} {} {:8.3f} {:8.3f} {:6.2f} {:6.0f} {:7.3f}  ",
                                 column(printable(robot.id), id_columns), column(printable(robot.kind), 8), robot.x_m,
                                 robot.y_m, robot.z_m, degrees(robot.heading_rad), robot.speed_m_s);
  if (robot.halted) text += "stopped  ";
  if (port && robot.age_s) text += fmt::format("{:.2f} s old  ", *robot.age_s);
  text += printable(robot.values);
  const bool bad = robot.halted || !robot.fresh;
  return {text, bad ? LineLook::Bad : robot.real ? LineLook::Bold : LineLook::Plain};
}

struct Layout {
  std::size_t real = 0, robots = 0, messages = 0;
  std::size_t map_room = 0, map = 0;  // lines that it may have, and has
  std::vector<ScreenLine> roll;       // real robots in groups: all of them, before anything else gets a line
};

std::vector<ScreenLine> lines_of_roll(const WatchPage& page, Screen::Size size) {
  std::vector<ScreenLine> lines;
  for (const core::RollGroup& group : grouped(page.moment.roll)) {
    std::vector<core::RollRow> rows;
    for (const std::string& id : group.ids) rows.push_back({id, group.presence, group.why});
    for (const std::string& line : roll_lines(rows, size.columns))
      lines.push_back({printable(line), is_urgent(group.presence) ? LineLook::Bad : LineLook::Plain});
  }
  return lines;
}

/// How many lines each part gets. Four are always there: headline, counts, head of the table, keys.
Layout layout_of(const WatchPage& page, Screen::Size size) {
  Layout layout;
  layout.roll = lines_of_roll(page, size);
  const std::size_t fixed = 4 + layout.roll.size();
  std::size_t left = size.lines > fixed ? size.lines - fixed : 0;
  layout.messages =
      std::min({page.messages.size(), left, size.lines < kLinesWithMessages ? std::size_t{1} : kMostMessages});
  left -= layout.messages;
  layout.real = std::min(page.moment.real.size(), left / 2);
  left -= layout.real;
  layout.map_room =
      std::min(left - std::min(std::max<std::size_t>(1, page.moment.chosen), (left + 1) / 2), kLinesOfMap);
  layout.map = page.moment.map.size() <= layout.map_room ? page.moment.map.size() : 0;
  layout.robots = left - layout.map;
  return layout;
}

}  // namespace

const hal::PortType* port_of(const core::Space& space, core::RobotId robot, const std::string& name) {
  const hal::PortType* found = nullptr;
  for (const hal::PortType* type : space.ports(robot)) {
    if (type->catalog_name() == name) return type;
    if (type->name == name && (found == nullptr || type->role == hal::Role::Sensor)) found = type;
  }
  return found;
}

const std::vector<core::RobotId>& WatchEye::chosen(const core::Space& space, const std::vector<std::string>& patterns) {
  const auto there = [&space](core::RobotId robot) { return space.contains(robot); };
  if (patterns == patterns_ && space.robot_count() == robots_then_ &&
      std::all_of(chosen_.begin(), chosen_.end(), there))
    return chosen_;
  chosen_.clear();
  patterns_ = patterns;
  robots_then_ = space.robot_count();
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::RobotId robot = space.robot(i);
    const auto fits = [&](const std::string& pattern) { return core::fits_pattern(space.robot_name(robot), pattern); };
    if (patterns.empty() || std::any_of(patterns.begin(), patterns.end(), fits)) chosen_.push_back(robot);
  }
  return chosen_;
}

WatchMoment WatchEye::look(const WatchSight& now, const WatchWish& wish) {
  const core::Space& space = now.space;
  WatchMoment moment;
  const hal::TimeNs now_ns = hal::time_of_tick(now.done, now.ticks_per_second);
  moment.incidents = now.incidents;
  std::map<const hal::RobotKind*, std::size_t> kinds;
  for (std::size_t i = 0; i < space.robot_count(); ++i) ++kinds[&space.kind(space.robot(i))];
  std::map<std::string, std::size_t> by_name;  // robots with parts of their own have kinds of their own
  for (const auto& [kind, count] : kinds) by_name[kind->name] += count;
  moment.kinds.assign(by_name.begin(), by_name.end());
  const std::vector<core::RobotId>& all = chosen(space, wish.robots);
  moment.chosen = all.size();
  moment.map = arena_map(space, wish.map);
  moment.first = std::min(wish.first, all.size() > wish.rows ? all.size() - wish.rows : 0);
  for (std::size_t i = moment.first; i < std::min(all.size(), moment.first + wish.rows); ++i) {
    const core::RobotId id = all[i];
    const core::Pose pose = space.pose(id);
    const core::Velocity velocity = space.velocity(id);
    WatchMoment::Robot robot{space.robot_name(id),
                             space.kind(id).name,
                             pose.x_m,
                             pose.y_m,
                             pose.z_m,
                             pose.heading_rad(),
                             std::hypot(velocity.v_m_s[0], velocity.v_m_s[1], velocity.v_m_s[2]),
                             space.halted(id),
                             space.external(id),
                             {},
                             {},
                             true};
    if (wish.port.empty()) {
      robot.values = published_of(space, id);
    } else if (const hal::PortType* const type = port_of(space, id, wish.port); type != nullptr) {
      const void* const port = space.port(id, *type);
      robot.values = values_of(*type, port);
      if (type->role == hal::Role::Sensor) {
        const auto& reading = *static_cast<const hal::Reading*>(port);
        robot.fresh = reading.validity == hal::Validity::Fresh;
        if (reading.validity == hal::Validity::Absent)
          robot.values = "no reading";
        else if (!robot.fresh)
          robot.age_s = hal::to_seconds(now_ns - reading.taken_ns);
      }
    }
    moment.robots.push_back(std::move(robot));
  }
  if (!moment.robots.empty()) {
    for (const hal::PortType* type : space.ports(all[moment.first])) moment.ports.push_back(type->catalog_name());
  }
  return moment;
}

std::string headline(const WatchPage& page) {
  const core::LiveState& state = page.state;
  const auto seconds = [&](std::int64_t ticks) {
    return static_cast<double>(ticks) / static_cast<double>(page.ticks_per_second);
  };
  std::string text = fmt::format("{}  t = {:.1f} s", printable(page.experiment), seconds(state.tick));
  if (page.ticks > 0) text += fmt::format(" of {:g} s", seconds(page.ticks));
  text += fmt::format("  tick {}", state.tick);
  if (!state.ended.empty()) return text + "  over: " + printable(state.ended);
  if (state.paused)
    return text + "  paused" + (state.stopped_by.empty() ? std::string() : ": " + printable(state.stopped_by));
  const std::string reached = fmt::format(fmt::runtime(state.reached < 100.0 ? "{:.3g}" : "{:.0f}"), state.reached);
  return text + (state.speed ? fmt::format("  {:g} × real time asked, {} reached", *state.speed, reached)
                             : fmt::format("  unpaced, {} × real time", reached));
}

std::string summary(const WatchPage& page) {
  std::string text = headline(page) + "; " + robots_text(page.moment) + incidents_text(page.moment.incidents);
  for (const std::string& line : roll_lines(page.moment.roll, 0)) text += "; " + printable(line);
  return text;
}

std::size_t rows_of(const WatchPage& page, Screen::Size size) {
  return layout_of(page, size).robots;
}

Screen::Size map_room(const WatchPage& page, Screen::Size size) {
  return {size.columns, layout_of(page, size).map_room};
}

std::vector<ScreenLine> lay_out(const WatchPage& page, Screen::Size size) {
  const WatchMoment& m = page.moment;
  const Layout layout = layout_of(page, size);
  std::vector<ScreenLine> lines;
  lines.push_back({headline(page), LineLook::Title});
  const bool bad = m.incidents && incidents_of(*m.incidents) > 0;
  lines.push_back({robots_text(m) + incidents_text(m.incidents), bad ? LineLook::Bad : LineLook::Plain});
  lines.insert(lines.end(), layout.roll.begin(), layout.roll.end());
  for (std::size_t i = 0; i < layout.real; ++i)
    lines.push_back({m.real[i].text, m.real[i].drives ? LineLook::Plain : LineLook::Bad});
  for (std::size_t i = 0; i < layout.map; ++i) lines.push_back({m.map[i]});
  const std::size_t columns = id_width(m);
  std::string head = fmt::format("{} {} {:>8} {:>8} {:>6} {:>6} {:>7}  {}", column("robot", columns), column("kind", 8),
                                 "x m", "y m", "z m", "deg", "m/s", page.port.empty() ? "published" : page.port);
  if (m.chosen > m.robots.size())
    head += fmt::format("  ({} to {} of {})", m.first + 1, m.first + m.robots.size(), m.chosen);
  lines.push_back({head, LineLook::Bold});
  for (std::size_t i = 0; i < layout.robots; ++i) {
    if (i < m.robots.size())
      lines.push_back(line_of(m.robots[i], columns, !page.port.empty()));
    else
      lines.push_back({i == 0 ? "no robot fits" : "", LineLook::Faint});
  }
  for (std::size_t i = page.messages.size() - layout.messages; i < page.messages.size(); ++i)
    lines.push_back({printable(page.messages[i]), LineLook::Faint});
  if (!page.prompt.empty())
    lines.push_back({page.prompt, LineLook::Bold});
  else if (!page.note.empty())
    lines.push_back({printable(page.note), LineLook::Bold});
  else
    lines.push_back(
        {page.keys ? "space pause  . one tick  + - speed  / robots  up down  tab port  q end" : "Ctrl-C ends the run",
         LineLook::Faint});
  while (lines.size() > size.lines) lines.erase(lines.end() - 2);
  return lines;
}

}  // namespace tandem::app
