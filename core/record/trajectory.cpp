#include "core/record/trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "core/record/csv.hpp"
#include "core/scenario/element.hpp"
#include "core/space/stores.hpp"
#include "hal/output_file.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
constexpr std::size_t kNamesShown = 8;

/// A field of a port, and how many columns it has.
struct CsvColumns {
  const hal::PortType* port;
  const hal::Field* field;
  std::size_t values;
};

std::string first_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kNamesShown); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kNamesShown) text += ", … (" + std::to_string(names.size()) + " in all)";
  return text;
}

std::string hint(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = closest(word, known);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

bool is_stamp(const hal::Field& field) {
  return field.name == "taken_ns" || field.name == "validity";
}

/// Whether two port classes, perhaps from two plug-ins, are the same.
bool same_port(const hal::PortType& a, const hal::PortType& b) {
  return a.layout == b.layout && a.role == b.role;
}

}  // namespace

bool fits_pattern(std::string_view text, std::string_view pattern) noexcept {
  std::size_t t = 0, p = 0;
  std::size_t star = std::string_view::npos, from = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++t;
      ++p;
    } else if (star != std::string_view::npos) {
      p = star + 1;  // let the last star take one more
      t = ++from;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

struct TrajectoryRecorder::Impl {
  std::string path;
  std::int64_t every = 1;
  std::int64_t ticks_per_second = 10;
  std::optional<hal::OutputFile> file;
  std::vector<RobotId> robots;
  std::vector<std::string> names;
  std::vector<std::string> patterns;
  std::set<std::pair<std::uint32_t, std::uint32_t>> newcomers;  // of `robots`: index and generation
  std::uint32_t generations = 0;                                // of the space when they were looked for last
  std::vector<const hal::PortType*> ports;
  std::vector<CsvColumns> columns;
  bool header_written = false;
  hal::Tick flushed_until = 0;  // the first tick that `buffer` holds lines of
  std::string buffer;           // whole lines, but while a record is made
  UnwrittenRecords unwritten;
  std::string failure;

  hal::Status choose_robots(const Space& space);
  void choose_newcomers(const Space& space);
  hal::Status choose_ports(const std::vector<std::string>& names, const Space& space);
  void write_header(const Space& space);
  void write_line(const Space& space, std::size_t i, hal::Tick tick);
  void write_fields(const Space& space, RobotId robot);
  hal::Status flush();
  void show_buffer() noexcept {
    unwritten.data.store(buffer.data(), std::memory_order_relaxed);
    unwritten.size.store(buffer.size(), std::memory_order_release);
  }

  template <class Real, class... Format>
  void number(Real value, Format... format) {
    char digits[400];  // the longest double with 6 decimals has 316 characters
    const auto end = std::to_chars(digits, digits + sizeof digits, value, format...).ptr;
    buffer.append(digits, end);
  }
  void integer(std::int64_t value) {
    char digits[24];
    buffer.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  }
};

hal::Status TrajectoryRecorder::Impl::choose_robots(const Space& space) {
  generations = space.stores().generations;
  std::vector<std::string> all(space.robot_count());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = space.robot_name(space.robot(i));
  std::vector<std::uint8_t> chosen(all.size(), patterns.empty() ? 1 : 0);
  for (const std::string& pattern : patterns) {
    bool any = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!fits_pattern(all[i], pattern)) continue;
      chosen[i] = 1;
      any = true;
    }
    if (any || all.empty()) continue;  // a hook may bring the first robot
    std::string message = "trajectory '" + path + "': no robot fits '" + pattern + "'" + hint(pattern, all);
    return hal::Error{message + "; there are: " + first_of(all)};
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (chosen[i] == 0) continue;
    robots.push_back(space.robot(i));
    names.push_back(csv_cell(all[i]));
  }
  return {};
}

void TrajectoryRecorder::Impl::choose_newcomers(const Space& space) {
  generations = space.stores().generations;
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const RobotId robot = space.robot(i);
    if (robot.generation == 0) continue;  // of the file
    const std::string name = space.robot_name(robot);
    const auto fits = [&name](const std::string& pattern) { return fits_pattern(name, pattern); };
    if (!patterns.empty() && std::none_of(patterns.begin(), patterns.end(), fits)) continue;
    if (!newcomers.emplace(robot.index, robot.generation).second) continue;
    robots.push_back(robot);
    names.push_back(csv_cell(name));
  }
}

hal::Status TrajectoryRecorder::Impl::choose_ports(const std::vector<std::string>& wanted, const Space& space) {
  std::vector<const hal::PortType*> there;
  for (const RobotId robot : robots) {
    for (const hal::PortType* type : space.ports(robot)) {
      const auto same = [type](const hal::PortType* other) { return same_port(*type, *other); };
      if (std::none_of(there.begin(), there.end(), same)) there.push_back(type);
    }
  }
  for (const std::string& name : wanted) {
    const std::size_t before = ports.size();
    for (const hal::PortType* type : there) {
      if (type->name == name) ports.push_back(type);
    }
    if (ports.size() > before) continue;
    std::vector<std::string> known;
    for (const hal::PortType* type : there) known.emplace_back(type->name);
    return hal::Error{"trajectory '" + path + "': the controllers of the chosen robots use no port '" + name + "'" +
                      hint(name, known) + (known.empty() ? "; they use none" : "; they use: " + first_of(known))};
  }
  return {};
}

void TrajectoryRecorder::Impl::write_header(const Space& space) {
  header_written = true;
  buffer += "tick,time_s,id,x_m,y_m,heading_rad";
  for (const hal::PortType* port : ports) {
    for (const hal::Field& field : port->fields) {
      if (is_stamp(field)) continue;
      std::size_t values = field.fusion == hal::Fusion::Union ? field.count : 0;
      for (const RobotId robot : robots) {
        const void* data = space.port(robot, *port);
        if (data != nullptr) values = std::max(values, hal::used_count(*port, data, field));
      }
      columns.push_back({port, &field, values});
      // A sensor and an actuator may share a name.
      const bool shared = std::count_if(ports.begin(), ports.end(),
                                        [port](const hal::PortType* p) { return p->name == port->name; }) > 1;
      const std::string name = std::string(port->name) + (shared && port->role == hal::Role::Actuator ? "_out." : ".") +
                               std::string(field.name);
      for (std::size_t i = 0; i < values; ++i) {
        buffer += "," + name;
        if (field.count > 1) buffer += "[" + std::to_string(i) + "]";
      }
    }
  }
  buffer += '\n';
}

void TrajectoryRecorder::Impl::write_line(const Space& space, std::size_t i, hal::Tick tick) {
  const Pose pose = space.pose(robots[i]);
  integer(tick);
  buffer += ',';
  number(hal::to_seconds(hal::time_of_tick(tick, ticks_per_second)));
  buffer += ',';
  buffer += names[i];
  for (const double value : {pose.x_m, pose.y_m, pose.heading_rad()}) {
    buffer += ',';
    number(value, std::chars_format::fixed, 6);
  }
  write_fields(space, robots[i]);
  buffer += '\n';
}

void TrajectoryRecorder::Impl::write_fields(const Space& space, RobotId robot) {
  const hal::PortType* port = nullptr;
  const void* data = nullptr;
  for (const CsvColumns& column : columns) {
    if (column.port != port) data = space.port(robot, *(port = column.port));
    const std::size_t used = data == nullptr ? 0 : hal::used_count(*port, data, *column.field);
    for (std::size_t i = 0; i < column.values; ++i) {
      buffer += ',';
      if (i >= used) continue;
      const double value = hal::get_value(data, *column.field, i);
      if (column.field->scalar == hal::Scalar::F32) {
        number(static_cast<float>(value));
      } else {
        number(value);
      }
    }
  }
}

hal::Status TrajectoryRecorder::Impl::flush() {
  if (!failure.empty()) return hal::Error{failure};
  unwritten.size.store(0, std::memory_order_release);  // what is written here is not to be written by another
  const hal::Status written = file->write(buffer);
  buffer.clear();
  if (written.ok()) return {};
  failure = written.error().message + "; it is lost from tick " + std::to_string(flushed_until) + " on" +
            (file->part().empty() ? "" : ", what came before is in '" + file->part() + "'");
  return hal::Error{failure};
}

hal::Result<std::unique_ptr<TrajectoryRecorder>> TrajectoryRecorder::open(const TrajectoryConfig& config,
                                                                          const Space& space,
                                                                          std::int64_t ticks_per_second,
                                                                          const std::vector<std::string>& ports) {
  auto impl = std::make_unique<Impl>();
  impl->path = config.path;
  impl->every = std::max<std::int64_t>(1, config.every);
  impl->ticks_per_second = ticks_per_second;
  impl->patterns = config.entities;
  if (const hal::Status chosen = impl->choose_robots(space); !chosen.ok()) return chosen.error();
  if (const hal::Status chosen = impl->choose_ports(ports, space); !chosen.ok()) return chosen.error();
  auto file = hal::OutputFile::open(config.path, "trajectory");
  if (!file.ok()) return file.error();
  impl->file = std::move(file).value();
  impl->buffer.reserve(2 * kBufferBytes);
  impl->unwritten.descriptor = impl->file->descriptor();
  return std::unique_ptr<TrajectoryRecorder>(new TrajectoryRecorder(std::move(impl)));
}

TrajectoryRecorder::TrajectoryRecorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

TrajectoryRecorder::~TrajectoryRecorder() {
  if (impl_->file && impl_->header_written) (void)close();
}

hal::Status TrajectoryRecorder::record(const Space& space, hal::Tick tick) {
  Impl& r = *impl_;
  if (!r.failure.empty()) return hal::Error{r.failure};
  if (tick % r.every != 0) return {};
  r.unwritten.size.store(0, std::memory_order_release);  // the buffer may move
  if (r.generations != space.stores().generations) r.choose_newcomers(space);
  if (!r.header_written) r.write_header(space);
  if (r.buffer.empty()) r.flushed_until = tick;
  hal::Status flushed;
  for (std::size_t i = 0; flushed.ok() && i < r.robots.size(); ++i) {
    if (!space.contains(r.robots[i])) continue;  // removed
    r.write_line(space, i, tick);
    if (r.buffer.size() >= kBufferBytes) {
      flushed = r.flush();
      r.flushed_until = tick;
    }
  }
  r.show_buffer();
  return flushed;
}

hal::Status TrajectoryRecorder::flush() {
  return impl_->flush();
}

hal::Status TrajectoryRecorder::close() {
  Impl& r = *impl_;
  if (!r.file) return r.failure.empty() ? hal::Status{} : hal::Status(hal::Error{r.failure});
  if (!r.header_written && r.failure.empty()) r.buffer += "tick,time_s,id,x_m,y_m,heading_rad\n";
  hal::Status closed = r.flush();
  if (closed.ok()) {
    closed = r.file->commit();
  } else {
    r.file->keep_part();
  }
  r.file.reset();
  if (!closed.ok()) r.failure = closed.error().message;
  return closed;
}

const UnwrittenRecords& TrajectoryRecorder::unwritten() const noexcept {
  return impl_->unwritten;
}

const hal::OutputFile& TrajectoryRecorder::file() const noexcept {
  return *impl_->file;
}

}  // namespace tandem::core
