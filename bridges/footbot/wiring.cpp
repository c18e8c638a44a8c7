#include "bridges/footbot/wiring.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <utility>

namespace tandem::bridges::footbot {
namespace {

constexpr std::uint64_t kMostLoads = 3;  // of a program that does not begin: then the robot drives without
constexpr hal::TimeNs kReadMail = 100 * hal::kNsPerMs;
constexpr hal::TimeNs kOneRestart = hal::kNsPerSecond;  // within which memory and program may show it

constexpr double kJumpSlack_s = 0.05;  // between what the stamps say and when a module counted

std::string one_of(const std::vector<std::string>& names) {
  std::string text = "'" + names.front() + "'";
  for (std::size_t i = 1; i < names.size(); ++i) text += (i == 1 ? " (or '" : ", '") + names[i] + "'";
  return names.size() > 1 ? text + ")" : text;
}

template <class Rows>
std::size_t behind_last(const Rows& fields) noexcept {
  std::size_t behind = 0;
  for (const FieldMap& f : fields) behind = std::max(behind, static_cast<std::size_t>(words_of(f).behind));
  return behind;
}

/// Elements of the field that are in use once this row is filled.
std::size_t used_elements(const FieldMap& map) noexcept {
  const auto last = static_cast<std::ptrdiff_t>(map.element) +
                    std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(map.count - 1) * map.element_step);
  return static_cast<std::size_t>(last) + 1;
}

std::size_t element(const FieldMap& map, std::size_t i) noexcept {
  return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(map.element) +
                                  static_cast<std::ptrdiff_t>(i) * map.element_step);
}

}  // namespace

Wiring::Wiring(const FootbotMap& map, aseba::Network& network, FootbotRobot& robot, bool observe)
    : NodeWiring(network, observe), map_(map), robot_(robot) {
  for (const NodeMap& node : map_.nodes) {
    NodeRow row;
    row.map = &node;
    for (const VariableMap& variable : node.variables) {
      VariableRow v;
      v.map = &variable;
      v.target.assign(variable.words, 0);
      v.sent = v.target;
      for (const FieldMap& field : variable.reads)
        v.reads.push_back({&field, 0, std::vector<Counter>(field.count), {}});
      row.variables.push_back(std::move(v));
    }
    rows_.push_back(std::move(row));
    if (node.id != 0) network_.expect(node.id);
  }
  note_demand();
}

// --- who is there, and what for ---

void Wiring::note_demand() noexcept {
  const auto used = [this](const FieldMap& f) { return robot_.uses(*f.port); };
  for (NodeRow& row : rows_) {
    row.used = !row.map->packets.empty() && robot_.uses(hal::port_type<hal::RangeAndBearing>());
    for (VariableRow& v : row.variables) {
      const bool commanded = std::ranges::any_of(v.map->writes, used);
      const bool controlled = !observe_ && !v.map->writes.empty() && (commanded || row.map->need == Need::Always);
      if (controlled != v.controlled) ++rest_version_;
      v.controlled = controlled;
      row.used = row.used || commanded || std::ranges::any_of(v.map->reads, used);
      v.read_first = v.map->words;
      v.read_behind = 0;
      for (const FieldMap& f : v.map->reads) {
        const bool watched = !observe_ && f.accumulate && row.map->need == Need::Always;  // for restarts
        if (!used(f) && !watched) continue;
        const WordRange range = words_of(f);
        v.read_first = std::min(v.read_first, static_cast<std::size_t>(range.first));
        v.read_behind = std::max(v.read_behind, static_cast<std::size_t>(range.behind));
      }
      if (v.controlled && v.map->verify) {
        v.read_first = 0;
        v.read_behind = std::max(v.read_behind, behind_last(v.map->writes));
      }
    }
  }
}

/// A node that was just found drives once its program runs, or has turned out not to.
bool Wiring::awaits_dead_man(const NodeRow& row) const noexcept {
  return row.has_dead_man && !observe_ && !row.dead_man.running() && row.dead_man.loads() < kMostLoads;
}

bool Wiring::look() noexcept {
  if (!others_are_there()) return false;
  for (NodeRow& row : rows_) {
    if (ready(row)) continue;
    const aseba::Node* node = network_.find(row.map->names);
    if (node != nullptr) bind(row, node);
  }
  return true;
}

std::string Wiring::look_for_restarts() noexcept {
  std::string what;
  for (NodeRow& row : rows_) {
    if (row.map->need != Need::Always || !ready(row)) continue;
    bool restarted = false;
    for (VariableRow& v : row.variables) restarted = forgot(row, v) || restarted;
    const std::string itself = std::exchange(row.stopped_itself, {});
    const bool known = row.restart_told_ns != 0 && served_ns_ - row.restart_told_ns < kOneRestart;
    if ((!restarted && itself.empty()) || known) continue;
    row.restart_told_ns = served_ns_;
    statistics_.restarts += restarted ? 1 : 0;
    what = "its node '" + row.node->description.name + "' " + (restarted ? "restarted" : itself);
  }
  return what;
}

bool Wiring::forgot(const NodeRow& row, VariableRow& v) const noexcept {
  if (!v.bound) return false;
  bool forgot = false;
  const auto variable = std::span<const std::int16_t>(row.node->image.values).subspan(v.address, v.map->words);
  if (v.controlled && v.map->verify) forgot = v.told.forgotten(variable, row.node->taken_ns(v.address, v.map->words));
  for (FieldRow& f : v.reads) {
    if (!f.map->accumulate) continue;
    const WordRange range = words_of(*f.map);
    const auto first = static_cast<std::size_t>(range.first), behind = static_cast<std::size_t>(range.behind);
    const hal::TimeNs taken_ns = row.node->taken_ns(v.address + first, behind - first);
    forgot = f.module_counter.began_anew(raw_number(*f.map, variable, 0), taken_ns) || forgot;
  }
  return forgot;
}

void Wiring::bind(NodeRow& row, const aseba::Node* node) {
  row.node = node;
  row.generation = node->generation;
  row.trouble.clear();
  ++row.times_wired;
  for (VariableRow& v : row.variables) bind(row, v);
  bind_dead_man(row);
}

void Wiring::bind_dead_man(NodeRow& row) {
  const DeadManMap& map = row.map->dead_man;
  row.has_dead_man = false;
  row.alive = -1;
  row.alive_ns = row.mail_asked_ns = 0;
  if (map.event.empty() || !row.trouble.empty()) return;
  std::vector<aseba::RestWord> words;
  for (const VariableRow& v : row.variables) {
    if (!v.bound || v.map->writes.empty()) continue;
    std::vector<std::int16_t> rest(v.map->words, 0);
    make_target(*v.map, false, rest);
    for (std::size_t i = 0; i < rest.size(); ++i) words.push_back({static_cast<std::uint16_t>(v.address + i), rest[i]});
  }
  auto program = aseba::make_dead_man(row.node->description, map.event, words);
  row.has_dead_man = program.ok();
  row.dead_man_trouble = program.ok() ? "" : program.error().message;
  if (program.ok()) row.dead_man.begin(std::move(program).value(), {.beat_ns = map.period_ns});
}

void Wiring::bind(NodeRow& row, VariableRow& v) {
  v.bound = false;
  v.sent_known = false;
  v.asked_ns = 0;
  for (FieldRow& f : v.reads) {
    for (Counter& c : f.counters) {
      statistics_.counter_jumps += c.known ? 1 : 0;
      c.known = false;
    }
  }
  const aseba::Variable* found = nullptr;
  for (const std::string& name : v.map->names) {
    found = row.node->description.variable(name);
    if (found != nullptr) break;
  }
  const std::string where = "node '" + row.node->description.name + "': ";
  if (found == nullptr) {
    if (!v.map->optional && row.trouble.empty()) row.trouble = where + "has no variable " + one_of(v.map->names);
    return;
  }
  if (found->words != v.map->words) {
    row.trouble = where + "variable '" + found->name + "' has " + std::to_string(found->words) +
                  " words, in the map (line " + std::to_string(v.map->line) + ") it has " +
                  std::to_string(v.map->words);
    return;
  }
  v.bound = true;
  v.address = found->address;
}

bool Wiring::complete() const noexcept {
  return std::ranges::all_of(rows_, [this](const NodeRow& row) { return !needed(row) || complete(row); });
}

bool Wiring::lost_needed() const noexcept {
  return std::ranges::any_of(rows_, [](const NodeRow& row) {
    return needed(row) && row.node != nullptr && row.node->state == aseba::NodeState::Lost;
  });
}

std::string Wiring::trouble_of(const NodeRow& row) const {
  if (row.node == nullptr) {
    for (const std::uint8_t id : network_.known()) {
      const aseba::Node& node = network_.node(id);
      if (node.state == aseba::NodeState::Refused && id == row.map->id) return node.trouble;
    }
    return "node " + one_of(row.map->names) + " is not there";
  }
  if (ready(row) && !row.trouble.empty()) return row.trouble;
  if (ready(row)) {
    return awaits_dead_man(row) ? "node '" + row.node->description.name + "': its program does not run yet" : "";
  }
  return "node '" + row.node->description.name + "' is " + aseba::node_state_name(row.node->state);
}

std::string Wiring::trouble() const {
  for (const NodeRow& row : rows_) {
    if ((needed(row) || row.used) && !complete(row)) return trouble_of(row);
  }
  return "";
}

std::string Wiring::needed_trouble() const {
  for (const NodeRow& row : rows_) {
    if (needed(row) && !complete(row)) return trouble_of(row);
  }
  return "";
}

std::vector<NodeStatus> Wiring::nodes() const {
  std::vector<NodeStatus> all;
  for (const NodeRow& row : rows_) {
    std::string trouble = trouble_of(row);
    if (trouble.empty() && !row.dead_man_trouble.empty())
      trouble = "does not stop by itself when it hears nothing: " + row.dead_man_trouble;
    all.push_back(status_of(row.node, row.map->names.front(), needed(row), std::move(trouble), row.times_wired));
  }
  return all;
}

/// Of those modules without which it does not drive: others come and go. Their addresses, names and descriptions are
/// what they can be told by: they have no serial numbers.
void Wiring::identify(RobotIdentity& identity) const {
  std::string names, ids;
  std::uint32_t print = 2166136261U;  // FNV-1a
  const auto add = [&print](std::string_view text) {
    for (const char c : text) print = (print ^ static_cast<unsigned char>(c)) * 16777619U;
    print = (print ^ 0xFFU) * 16777619U;
  };
  for (const NodeRow& row : rows_) {
    if (row.map->need != Need::Always || !ready(row)) continue;
    const aseba::NodeDescription& description = row.node->description;
    names += (names.empty() ? "" : ", ") + description.name;
    ids += (ids.empty() ? "node " : ", ") + std::to_string(row.node->id);
    add(description.name);
    add(std::to_string(description.bytecode_words) + " " + std::to_string(description.variable_words));
    for (const aseba::Variable& v : description.variables) add(v.name + " " + std::to_string(v.words));
  }
  if (names.empty()) return;
  identity.name = std::move(names);
  identity.address = std::move(ids);
  std::array<char, 9> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), print, 16);
  if (error == std::errc{}) identity.firmware = "variables " + std::string(digits.data(), end);
}

void WiringStatistics::describe(StatusVisitor& visitor) const {
  visitor.count("counter_jumps", counter_jumps);
  visitor.count("not_obeyed", not_obeyed);
  visitor.count("dead_man_programs", dead_men);
  visitor.count("stopped_without_word", lapses);
  visitor.count("programs_gone", programs_gone);
}

hal::TimeNs Wiring::oldest_ns() const noexcept {
  hal::TimeNs oldest = std::numeric_limits<hal::TimeNs>::max();
  for (const NodeRow& row : rows_) {
    if (!needed(row) || !ready(row)) continue;
    for (const VariableRow& v : row.variables) {
      if (!v.bound || v.map->period_ns != 0 || v.read_first >= v.read_behind) continue;
      oldest = std::min(oldest, row.node->taken_ns(v.address + v.read_first, v.read_behind - v.read_first));
    }
  }
  return oldest;
}

// --- readings ---

bool Wiring::serve(hal::TimeNs now) noexcept {
  served_ns_ = now;
  serve_packets();
  bool due = false;
  statistics_.dead_men = 0;
  for (NodeRow& row : rows_) {
    if (ready(row) && row.has_dead_man && !observe_) due = serve_dead_man(row, now) || due;
    statistics_.dead_men += ready(row) && row.has_dead_man && row.dead_man.running() ? 1 : 0;
  }
  return due;
}

bool Wiring::serve_dead_man(NodeRow& row, hal::TimeNs now) noexcept {
  const aseba::ResidentProgram::Heard heard = row.dead_man.hear(*row.node);
  statistics_.lapses += heard.lapsed ? 1 : 0;
  // One that began before we drove was the end of what was told before, such as before an outage.
  if (heard.lapsed && row.alive > 0 && heard.taken_ns - row.driven_since_ns >= row.map->dead_man.after_ns) {
    row.stopped_itself =
        "heard nothing for " + std::to_string(row.map->dead_man.after_ns / hal::kNsPerMs) + " ms and stopped by itself";
  }
  if (heard.gone) {
    ++statistics_.programs_gone;
    row.stopped_itself = "lost its program: it restarted, or somebody else has loaded another";
  }
  if (heard.began) row.alive = -1;
  if (!row.dead_man.running() && row.dead_man.loads() >= kMostLoads) {
    row.dead_man_trouble = "its program does not run";
    return false;
  }
  if (heard.absent) row.dead_man.load(network_, *row.node, now);
  return row.dead_man.pursue(network_, *row.node, now) || heard.absent;
}

/// Whoever drives says so well before the time is over, and says once when it rests.
void Wiring::tell_alive(NodeRow& row, bool drive, hal::TimeNs now) noexcept {
  if (!row.has_dead_man || !row.dead_man.running()) return;
  const DeadManMap& map = row.map->dead_man;
  const auto alive = static_cast<std::int16_t>(drive ? (map.after_ns + map.period_ns - 1) / map.period_ns : 0);
  if (alive == row.alive && (!drive || now - row.alive_ns < map.after_ns / 5)) return;
  const std::array<std::int16_t, 1> words = {alive};
  const std::size_t address = row.dead_man.program().mailbox + std::size_t{aseba::dead_man_mail::kAlive};
  if (!network_.write(row.node->id, address, words)) return;
  if (row.alive <= 0) row.driven_since_ns = now;
  row.alive = alive;
  row.alive_ns = now;
}

void Wiring::serve_packets() noexcept {
  while (network_.take_event(event_)) {
    for (const NodeRow& row : rows_) {
      if (!ready(row) || row.node->id != event_.source) continue;
      for (const PacketMap& packet : row.map->packets) {
        if (packet.number != event_.number) continue;
        if (packet.words != event_.count) {
          ++statistics_.packets_unfit;
          continue;
        }
        const auto words = std::span<const std::int16_t>(event_.arguments).first(event_.count);
        const auto value = [&](const FieldMap& f) {
          return f.count == 0 ? 0.0F : static_cast<float>(to_value(f, raw_number(f, words, 0)));
        };
        std::array<std::uint8_t, hal::kRabPayloadMax> payload{};
        const std::size_t size = std::min(packet.payload.count, payload.size());
        for (std::size_t i = 0; i < size; ++i) {
          payload[i] = static_cast<std::uint8_t>(raw_number(packet.payload, words, i));
        }
        heard_.insert(value(packet.range), value(packet.bearing), value(packet.elevation), payload.data(),
                      static_cast<std::uint8_t>(size));
        ++statistics_.packets;
      }
    }
  }
}

void Wiring::fill_packets(hal::TimeNs now) noexcept {
  auto& port = robot_.port<hal::RangeAndBearing>();
  const hal::Reading before = port;
  const auto hears = [](const NodeRow& row) { return !row.map->packets.empty() && ready(row); };
  port = heard_;
  heard_ = {};
  static_cast<hal::Reading&>(port) = before;
  if (std::ranges::any_of(rows_, hears)) {
    robot_.stamp(port, now, 0, now);
  } else if (port.validity == hal::Validity::Fresh) {
    port.validity = hal::Validity::Stale;
  }
}

void Wiring::fill(hal::TimeNs now) noexcept {
  for (const hal::PortType* type : port_types()) {
    if (type->role != hal::Role::Sensor || !robot_.uses(*type)) continue;
    if (type == &hal::port_type<hal::RangeAndBearing>()) {
      fill_packets(now);
    } else {
      fill_port(*type, now);
    }
  }
}

void Wiring::fill_port(const hal::PortType& type, hal::TimeNs now) noexcept {
  hal::TimeNs oldest = std::numeric_limits<hal::TimeNs>::max();
  hal::TimeNs period = 0;
  for (NodeRow& row : rows_) {
    for (VariableRow& v : row.variables) {
      for (FieldRow& f : v.reads) {
        if (f.map->port != &type) continue;
        if (ready(row) && v.bound) {
          const WordRange range = words_of(*f.map);
          const hal::TimeNs taken = row.node->taken_ns(v.address + static_cast<std::size_t>(range.first),
                                                       static_cast<std::size_t>(range.behind - range.first));
          if (taken != 0 && taken != f.taken_ns) fill_field(*row.node, v, f, taken);
        }
        if (v.map->optional && f.taken_ns == 0) continue;
        oldest = std::min(oldest, f.taken_ns);
        period = std::max(period, v.map->period_ns);
      }
    }
  }
  if (oldest == std::numeric_limits<hal::TimeNs>::max()) return;  // nothing feeds it
  robot_.stamp(*static_cast<hal::Reading*>(robot_.memory(type)), oldest, period, now);
}

/// What a counter has summed up, or its change per second.
double Wiring::counted(FieldRow& field, std::size_t i, std::int32_t raw, double since_s) noexcept {
  const FieldMap& map = *field.map;
  Counter& counter = field.counters[i];
  const std::int64_t difference = counter.known ? counter_difference(map.form, raw, counter.raw) : 0;
  const double change = static_cast<double>(difference) * map.scale;
  const bool possible = std::abs(change) <= map.fastest * (since_s + kJumpSlack_s);
  if (!possible) ++statistics_.counter_jumps;
  const bool moved = counter.known && possible;
  counter = {true, raw, counter.total + (possible ? difference : 0)};
  return moved && since_s > 0.0 ? change / since_s : 0.0;
}

void Wiring::fill_field(const aseba::Node& node, const VariableRow& v, FieldRow& f, hal::TimeNs taken) noexcept {
  const FieldMap& map = *f.map;
  void* port = robot_.memory(*map.port);
  const auto words = std::span<const std::int16_t>(node.image.values).subspan(v.address, v.map->words);
  const double since_s = f.taken_ns == 0 ? 0.0 : hal::to_seconds(taken - f.taken_ns);
  for (std::size_t i = 0; i < map.count; ++i) {
    const std::int32_t raw = raw_number(map, words, i);
    double value = to_value(map, raw);
    if (map.accumulate || map.rate != nullptr) {
      const double rate = counted(f, i, raw, since_s);
      if (map.rate != nullptr) hal::set_value(port, *map.rate, element(map, i), rate);
      if (map.accumulate) value = static_cast<double>(f.counters[i].total) * map.scale;
    }
    hal::set_value(port, *map.field, element(map, i), value);
  }
  f.taken_ns = taken;
  if (map.field->used_by.empty()) return;
  const hal::Field* used = map.port->field(map.field->used_by);
  const auto count = static_cast<double>(used_elements(map));
  if (hal::get_value(port, *used, 0) < count) hal::set_value(port, *used, 0, count);
}

void Wiring::ask(hal::TimeNs now) noexcept {
  const hal::TimeNs slack = robot_.settings().tick_ns / 2;
  for (NodeRow& row : rows_) {
    if (!ready(row)) continue;
    for (VariableRow& v : row.variables) {
      if (!v.bound || v.read_first >= v.read_behind) continue;
      if (v.asked_ns != 0 && now - v.asked_ns + slack < v.map->period_ns) continue;
      if (network_.want(row.node->id, v.address + v.read_first, v.read_behind - v.read_first)) v.asked_ns = now;
    }
    if (!row.has_dead_man || !row.dead_man.running() || now - row.mail_asked_ns + slack < kReadMail) continue;
    if (network_.want(row.node->id, row.dead_man.program().mailbox, 3)) row.mail_asked_ns = now;
  }
}

// --- commands ---

void Wiring::make_target(const VariableMap& map, bool drive, std::span<std::int16_t> target) const noexcept {
  for (const FieldMap& f : map.writes) {
    const void* port = robot_.memory(*f.port);
    const bool meant = drive && robot_.uses(*f.port) && (f.when == nullptr || hal::get_value(port, *f.when, 0) != 0.0);
    const std::size_t used = meant ? hal::used_count(*f.port, port, *f.field) : 0;
    for (std::size_t i = 0; i < f.count; ++i) {
      const bool valued = meant && element(f, i) < used;
      set_raw_number(f, target, i, valued ? to_raw(f, hal::get_value(port, *f.field, element(f, i))) : f.rest);
    }
  }
}

void Wiring::write(NodeRow& row, VariableRow& v, bool drive, hal::TimeNs now) noexcept {
  make_target(*v.map, drive, v.target);
  const aseba::Node& node = *row.node;
  const bool changed = !v.sent_known || v.target != v.sent;
  bool lost = false;
  if (!changed && v.map->verify && node.taken_ns(v.address, v.target.size()) > v.sent_ns) {
    const auto read = std::span<const std::int16_t>(node.image.values).subspan(v.address, v.target.size());
    lost = !std::ranges::equal(read, v.target);
    statistics_.not_obeyed += lost ? 1 : 0;
  }
  if (!changed && !lost && now - v.sent_ns < map_.refresh_ns) return;
  v.told.sent(v.target, now);
  v.sent_known = network_.write(node.id, v.address, v.target);
  v.sent = v.target;
  v.sent_ns = now;
}

std::vector<RestMessage> Wiring::rest_messages() const {
  std::vector<RestMessage> all;
  for (const NodeRow& row : rows_) {
    for (const VariableRow& v : row.variables) {
      if (row.node == nullptr || !v.bound || !v.controlled) continue;
      std::vector<std::int16_t> target(v.map->words, 0);
      make_target(*v.map, false, target);
      const bool confirm = v.map->verify && row.map->need == Need::Always;
      if (auto message = rest_message(*row.node, v.address, target, confirm)) all.push_back(std::move(*message));
    }
  }
  return all;
}

void Wiring::command(bool drive, hal::TimeNs now) noexcept {
  for (NodeRow& row : rows_) {
    if (!ready(row)) continue;
    for (VariableRow& v : row.variables) {
      if (v.bound && v.controlled) write(row, v, drive, now);
    }
    if (!observe_) tell_alive(row, drive, now);
  }
}

void Wiring::rest(hal::TimeNs now) noexcept {
  for (NodeRow& row : rows_) {
    row.alive = -1;
    for (VariableRow& v : row.variables) v.sent_known = false;
  }
  command(false, now);
  for (NodeRow& row : rows_) {
    for (VariableRow& v : row.variables) {
      if (!ready(row) || !v.bound || !v.controlled || !v.map->verify) continue;
      (void)network_.want(row.node->id, v.address, v.target.size());  // an answer to an older question is no proof
    }
  }
}

bool Wiring::rests(const NodeRow& row, const VariableRow& v) const noexcept {
  if (!v.controlled || !v.map->verify) return true;
  if (!ready(row) || !v.bound || row.node->taken_ns(v.address, v.target.size()) <= rested_ns_) return false;
  const auto read = std::span<const std::int16_t>(row.node->image.values).subspan(v.address, v.target.size());
  return std::ranges::equal(read, v.target);
}

bool Wiring::rests() const noexcept {
  return std::ranges::all_of(rows_, [this](const NodeRow& row) {
    if (row.map->need != Need::Always) return true;
    return std::ranges::all_of(row.variables, [&](const VariableRow& v) { return rests(row, v); });
  });
}

}  // namespace tandem::bridges::footbot
