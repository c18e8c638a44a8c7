#include "core/record/record_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/record/floor_image.hpp"
#include "core/record/scene_json.hpp"
#include "core/space/looks.hpp"
#include "core/space/shown.hpp"
#include "core/space/stores.hpp"
#include "hal/controller.hpp"
#include "hal/finite.hpp"
#include "hal/json/json_access.hpp"
#include "hal/time.hpp"

namespace tandem::core {
namespace {

using hal::Json;

/// A row in memory that has the fields of a stream, and refers to its texts.
hal::PortType form_of(const RecordStream& stream) {
  hal::PortType form;
  form.name = stream.name;
  form.role = stream.set == "actuator" ? hal::Role::Actuator : hal::Role::Sensor;
  form.align = alignof(std::max_align_t);
  for (const RecordField& f : stream.fields) {
    const std::size_t size = hal::size_of(f.scalar);
    hal::Field field;
    field.name = f.name;
    field.offset = (form.size + size - 1) / size * size;
    field.scalar = f.scalar;
    field.count = f.count;
    field.unit = {hal::Dim::None, f.unit, 1.0};
    field.doc = f.doc;
    if (f.used_by) field.used_by = stream.fields[*f.used_by].name;
    form.size = field.offset + size * f.count;
    form.fields.push_back(field);
  }
  form.size = (form.size + form.align - 1) / form.align * form.align;
  return form;
}

/// Whether rows of that type hold all that a stream has.
bool holds(const hal::RowType& type, const RecordStream& stream) {
  return std::all_of(stream.fields.begin(), stream.fields.end(), [&type](const RecordField& f) {
    const hal::Field* const field = type.field(f.name);
    return field != nullptr && field->scalar == f.scalar && field->count == f.count;
  });
}

std::unordered_map<std::string_view, std::size_t> places_of(const std::vector<std::string>& ids) {
  std::unordered_map<std::string_view, std::size_t> places;
  for (std::size_t i = 0; i < ids.size(); ++i) places.emplace(ids[i], i);
  return places;
}

/// A field of every row.
class Values {
 public:
  Values(const RecordRows& rows, std::string_view field) : rows_(rows), field_(field_of(rows, field)) {}
  double at(std::size_t row, std::size_t index = 0) const {
    return field_ && index < rows_.used(*field_, row) ? hal::finite_or(rows_.value(*field_, row, index), 0.0) : 0.0;
  }

 private:
  const RecordRows& rows_;
  std::optional<std::size_t> field_;
};

/// Poses of a tick.
class Poses {
 public:
  explicit Poses(const RecordRows& rows) : x_(rows, "x"), y_(rows, "y"), z_(rows, "z"), heading_(rows, "heading") {}
  SeenPose at(std::size_t row, hal::Tick tick = SeenPose::kNever) const {
    return {x_.at(row), y_.at(row), z_.at(row), heading_.at(row), tick};
  }

 private:
  Values x_, y_, z_, heading_;
};

}  // namespace

/// The space, and where in it the values of a record go.
class RecordSource::Shown {
 public:
  explicit Shown(const hal::Catalog* catalog) : catalog_(catalog) {}
  const Space& space(const RecordMoments& moments);

  Measures measures;

 private:
  enum class Sort : std::uint8_t { Port, Column, Published, Halted };
  /// One field of a stream, and where its values lie in a row in memory.
  struct Copy {
    std::size_t from = 0;
    hal::Field to;
  };
  /// Rows of a stream, and where those of its members go.
  struct Table {
    std::string title;
    Sort sort = Sort::Port;
    const hal::PortType* port = nullptr;
    const hal::RowType* type = nullptr;  // of the rows in memory
    const RecordStream* stream = nullptr;
    std::size_t group = 0;                                          // among streams of this title
    std::unordered_map<std::string_view, std::size_t> row_of = {};  // by id
    std::vector<Copy> copies = {};
    std::vector<std::pair<hal::Field, std::size_t>> counters = {};  // and the most that they may say
    std::vector<std::byte*> to = {};                                // by row of the stream; null: nowhere
  };
  using Tables = std::vector<std::pair<const void*, const void*>>;  // stream and members of each

  static Tables tables_in(const RecordMoments& moments);
  void rebuild(const RecordMoments& moments);
  void plan(const RecordMoments& moments);
  void plan_looks(const RecordMoments& moments);
  void plan(const std::string& title, const RecordRows& rows, Sort sort, const hal::RowType* type,
            std::size_t group = 0);
  const hal::RowType* column_of(const std::string& name, const RecordStream& stream);
  const hal::PortType& port_of(const std::string& title, const RecordStream& stream);
  std::vector<std::size_t> kinds_of(const RecordMembers& members);
  std::uint32_t number_of(const std::string& id);
  void make_group(const RecordMembers& members, const hal::RobotKind& kind, const std::vector<std::size_t>& tables,
                  const std::vector<std::size_t>& who);
  void make_block(const RecordMembers& members, const std::vector<std::size_t>& tables, const std::size_t* who,
                  std::size_t count);
  std::byte* place(Table& table, RobotBlock& block, std::size_t number);
  void take_scene(const RecordMoments& moments);
  void take_poses(const RecordMoments& moments);
  void take_rows(const RecordMoments& moments);
  void take_objects(const RecordMoments& moments);

  const hal::Catalog* catalog_;
  std::deque<hal::PortType> forms_;                                            // of streams that nobody here knows
  std::vector<std::string> looks_;                                             // rows that kinds' looks name
  std::deque<hal::ControllerType> controllers_;                                // names alone
  std::vector<std::pair<Json, std::unique_ptr<const hal::RobotKind>>> kinds_;  // and what there is to draw
  std::unordered_map<std::string, std::uint32_t> numbers_;                     // of robots that were seen
  std::vector<SeenPose> was_;                                                  // by number
  std::unique_ptr<Space> space_;
  Tables known_;
  std::vector<Table> tables_;
  std::vector<std::size_t> body_of_;  // rows of bodies by rows of poses
  hal::Tick shown_ = SeenPose::kNever;
  std::uint32_t spaces_ = 0;
  std::uint64_t scene_ = 0, floor_ = 0, sketch_ = 0;  // their numbers in the record
  std::shared_ptr<const FloorImage> image_;
};

const Space& RecordSource::Shown::space(const RecordMoments& moments) {
  if (space_ != nullptr && shown_ == moments.tick()) return *space_;
  if (Tables now = tables_in(moments); space_ == nullptr || now != known_) {
    known_ = std::move(now);
    rebuild(moments);
  }
  take_scene(moments);
  take_poses(moments);
  take_rows(moments);
  take_objects(moments);
  shown_ = moments.tick();
  return *space_;
}

RecordSource::Shown::Tables RecordSource::Shown::tables_in(const RecordMoments& moments) {
  Tables all;
  moments.each(
      [&all](const std::string&, const RecordRows& rows) { all.emplace_back(&rows.stream(), &rows.members()); });
  return all;
}

// --- a space for these robots, and what each has ---

void RecordSource::Shown::plan(const std::string& title, const RecordRows& rows, Sort sort, const hal::RowType* type,
                               std::size_t group) {
  Table table{title, sort, nullptr, type, &rows.stream(), group, places_of(rows.members().ids)};
  for (std::size_t f = 0; f < rows.stream().fields.size(); ++f) {
    if (const hal::Field* const field = type->field(rows.stream().fields[f].name); field != nullptr)
      table.copies.push_back({f, *field});
  }
  for (const hal::Field& field : type->fields) {
    const hal::UsedBy used = hal::used_by(*type, field);
    if (used.field != nullptr) table.counters.emplace_back(*used.field, field.count / used.per_entry);
  }
  table.to.assign(rows.size(), nullptr);
  if (sort == Sort::Port) table.port = static_cast<const hal::PortType*>(type);
  tables_.push_back(std::move(table));
}

const hal::PortType& RecordSource::Shown::port_of(const std::string& title, const RecordStream& stream) {
  const hal::PortType* const known = catalog_ != nullptr ? catalog_->find<hal::PortType>(title) : nullptr;
  if (known != nullptr && holds(*known, stream)) return *known;
  hal::PortType& form = forms_.emplace_back(form_of(stream));
  form.role = title.starts_with("actuator") ? hal::Role::Actuator : hal::Role::Sensor;
  if (const std::size_t role = form.name.find(' '); role != std::string_view::npos) form.name.remove_prefix(role + 1);
  return form;
}

/// Null: the space keeps other rows under that name.
const hal::RowType* RecordSource::Shown::column_of(const std::string& name, const RecordStream& stream) {
  hal::PortType& form = forms_.emplace_back(form_of(stream));
  form.name = name;
  for (const auto& column : space_->stores().columns.all()) {
    if (column->type->name == name) return holds(*column->type, stream) ? column->type : nullptr;
  }
  return &form;
}

void RecordSource::Shown::plan(const RecordMoments& moments) {
  tables_.clear();
  forms_.clear();
  controllers_.clear();
  moments.each([&](const std::string& title, const RecordRows& rows) {
    const RecordStream& stream = rows.stream();
    if (stream.of != "robot") return;
    const auto group = static_cast<std::size_t>(std::ranges::count(tables_, title, &Table::title));
    if (stream.set == "sensor" || stream.set == "actuator")
      plan(title, rows, Sort::Port, &port_of(title, stream), group);
    else if (stream.set == "state")
      plan(title, rows, Sort::Published, &forms_.emplace_back(form_of(stream)), group);
  });
  plan_looks(moments);
  if (const RecordRows* const halts = moments.rows("look halted"))
    plan("look halted", *halts, Sort::Halted, &forms_.emplace_back(form_of(halts->stream())));
}

/// The rows that the appearances of the kinds name. Old records have ports alone: of what is kept, those that read it.
void RecordSource::Shown::plan_looks(const RecordMoments& moments) {
  std::vector<const hal::RobotKind*> kinds;
  for (const auto& [body, kind] : kinds_) kinds.push_back(kind.get());
  looks_ = driven_rows(kinds);
  for (const std::string& row : looks_) {
    const std::string look = "look " + std::string(row_name(looks_, row));
    const bool port = row.find(' ') != std::string::npos;
    if (port && moments.rows(row) != nullptr) continue;  // it is there as a port
    for (const std::string& title : {look, "sensor " + row + "_encoder"}) {
      const RecordRows* const rows = moments.rows(title);
      if (rows == nullptr) continue;
      const hal::RowType* const type = port ? &port_of(row, rows->stream()) : column_of(row, rows->stream());
      if (type != nullptr) plan(title, *rows, port ? Sort::Port : Sort::Column, type);
      break;
    }
  }
}

/// By member: its kind's number in `kinds_`.
std::vector<std::size_t> RecordSource::Shown::kinds_of(const RecordMembers& members) {
  std::map<std::pair<std::size_t, std::string_view>, std::size_t> known;
  std::vector<std::size_t> all;
  for (std::size_t member = 0; member < members.ids.size(); ++member) {
    const auto [place, fresh] = known.emplace(std::pair(members.kind[member], members.kinds[member]), 0);
    if (fresh) {
      const std::string& name = members.kinds[member];
      const std::size_t number = members.kind[member];
      const bool said = members.bodies.is_array() && number < members.bodies.size();
      const Json body = said ? members.bodies[number] : Json::object();
      std::size_t& k = place->second;
      while (k < kinds_.size() && !(kinds_[k].second->name == name && kinds_[k].first == body)) ++k;
      if (k == kinds_.size()) {
        auto kind = std::make_unique<hal::RobotKind>(kind_of_body(name, body));
        const auto* const here = catalog_ != nullptr ? catalog_->find<hal::RobotKind>(name) : nullptr;
        if (here != nullptr && looks_alike(*here, *kind)) *kind = *here;
        kinds_.emplace_back(body, std::move(kind));
      }
    }
    all.push_back(place->second);
  }
  return all;
}

std::uint32_t RecordSource::Shown::number_of(const std::string& id) {
  return numbers_.emplace(id, static_cast<std::uint32_t>(numbers_.size())).first->second;
}

void RecordSource::Shown::rebuild(const RecordMoments& moments) {
  const RecordMembers& members = moments.poses().members();
  space_ = std::make_unique<Space>();
  scene_ = floor_ = sketch_ = 0;
  const std::vector<std::size_t> kinds = kinds_of(members);
  plan(moments);
  SpaceStores& s = space_->stores();
  s.generations = ++spaces_;
  s.bodies.has_motion = true;
  s.bodies.resize(members.ids.size());
  body_of_.assign(members.ids.size(), 0);
  for (const std::size_t member : members.order) (void)number_of(members.ids[member]);
  s.robots.resize(numbers_.size());
  s.names.resize(numbers_.size());
  for (const auto& [id, number] : numbers_) s.names[number] = {id, -1, number, 1};
  s.added_robots = numbers_;
  was_.resize(numbers_.size());

  std::map<std::pair<std::size_t, std::vector<std::size_t>>, std::vector<std::size_t>> groups;
  for (const std::size_t member : members.order) {
    std::vector<std::size_t> has;
    for (std::size_t t = 0; t < tables_.size(); ++t) {
      if (tables_[t].row_of.contains(members.ids[member])) has.push_back(t);
    }
    groups[{kinds[member], std::move(has)}].push_back(member);
  }
  std::size_t blocks = 0;
  for (const auto& [form, who] : groups) blocks += (who.size() + kBlockRows - 1) / kBlockRows;
  s.blocks.reserve(blocks);  // rows of tables point into them
  for (const auto& [form, who] : groups) make_group(members, *kinds_[form.first].second, form.second, who);
  for (std::uint32_t number = 0; number < s.robots.size(); ++number) {
    if (s.robots[number].alive) s.living.push_back(number);
  }
}

void RecordSource::Shown::make_group(const RecordMembers& members, const hal::RobotKind& kind,
                                     const std::vector<std::size_t>& tables, const std::vector<std::size_t>& who) {
  SpaceStores& s = space_->stores();
  RobotGroup& group = s.groups.emplace_back();
  group.kind = &kind;
  for (const std::size_t t : tables) {
    const Table& table = tables_[t];
    if (table.sort == Sort::Port) group.ports.push_back(table.port);
    if (table.sort == Sort::Column) {
      std::vector<std::byte> first(table.type->size);
      if (table.type->initial != nullptr) std::memcpy(first.data(), table.type->initial, first.size());
      group.columns.push_back({table.type, std::move(first), s.columns.of(*table.type).value()});
    }
    if (table.sort != Sort::Published) continue;
    hal::ControllerType& controller = controllers_.emplace_back();
    controller.name = table.stream->name;
    group.controller = &controller;
    for (const Copy& copy : table.copies) {
      const RecordField& f = table.stream->fields[copy.from];
      group.published.push_back({f.name, copy.to.offset, f.scalar, f.count, copy.to.unit, f.doc, f.texts});
    }
  }
  for (std::size_t first = 0; first < who.size(); first += kBlockRows)
    make_block(members, tables, who.data() + first, std::min(kBlockRows, who.size() - first));
}

/// Where the rows of a table are in a block, whose number is given.
std::byte* RecordSource::Shown::place(Table& table, RobotBlock& block, std::size_t number) {
  if (table.sort == Sort::Halted) return reinterpret_cast<std::byte*>(block.halted.data());
  const std::size_t size = table.type->size;
  auto* const array = new std::byte[std::max<std::size_t>(1, size * block.capacity)]();
  block.own_arrays.emplace_back(array, [](const std::byte* p) { delete[] p; });
  if (table.type->reset != nullptr) {
    for (std::size_t slot = 0; slot < block.capacity; ++slot) table.type->reset(array + slot * size);
  }
  if (table.sort == Sort::Port) block.ports.push_back(array);
  if (table.sort == Sort::Column) {
    std::vector<std::byte*>& of_block = space_->stores().columns.of(*table.type).value()->of_block;
    of_block.resize(number + 1);
    of_block[number] = array;
  }
  if (table.sort == Sort::Published) {
    block.controllers = array;
    block.controller_stride = size;
    std::fill_n(block.constructed.begin(), block.used, std::uint8_t{1});
  }
  return array;
}

void RecordSource::Shown::make_block(const RecordMembers& members, const std::vector<std::size_t>& tables,
                                     const std::size_t* who, std::size_t count) {
  SpaceStores& s = space_->stores();
  const std::size_t number = s.blocks.size();
  RobotBlock& block = s.blocks.emplace_back();
  block.group = s.groups.size() - 1;
  s.groups.back().blocks.push_back(number);
  block.first_row = number == 0 ? 0 : s.blocks[number - 1].first_row + s.blocks[number - 1].used;
  block.capacity = block.used = count;
  for (const std::size_t t : tables) {
    Table& table = tables_[t];
    std::byte* const rows = place(table, block, number);
    const std::size_t stride = table.sort == Sort::Halted ? 1 : table.type->size;
    for (std::size_t slot = 0; slot < count; ++slot)
      table.to[table.row_of.at(members.ids[who[slot]])] = rows + slot * stride;
  }
  for (std::size_t slot = 0; slot < count; ++slot) {
    const std::size_t member = who[slot];
    body_of_[member] = block.first_row + slot;
    show_robot(s, number_of(members.ids[member]),
               {static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(slot)}, members.real[member]);
  }
}

// --- what is in it at a tick ---

void RecordSource::Shown::take_scene(const RecordMoments& moments) {
  SpaceStores& s = space_->stores();
  if (scene_ != moments.scene_number() || s.regions.empty()) {
    scene_ = moments.scene_number();
    s.objects.clear();
    s.object_motion.clear();
    s.object_region.clear();
    s.object_numbers.clear();
    s.lights.clear();
    read_scene(moments.scene(), s);
    s.immovables_version = scene_ + 1;
  }
  if (floor_ != moments.floor_number()) {
    floor_ = moments.floor_number();
    image_.reset();
    if (auto read = floor_of_png(moments.floor_png()); read.ok())
      image_ = std::make_shared<const FloorImage>(std::move(read).value());
    s.fields = Fields();
    if (image_ != nullptr) s.fields.add("floor", floor_of_image(image_, floor_));
  }
  if (sketch_ != moments.sketch_number()) {
    sketch_ = moments.sketch_number();
    s.sketch = sketch_of_json(moments.sketch());
  }
}

void RecordSource::Shown::take_poses(const RecordMoments& moments) {
  SpaceStores& s = space_->stores();
  Bodies& b = s.bodies;
  ++s.poses_version;
  const Poses poses(moments.poses());
  for (std::size_t i = 0; i < body_of_.size(); ++i) {
    const std::size_t row = body_of_[i];
    show_body(s, row, poses.at(i, moments.tick()), moments.ticks_per_second(), was_[b.entity[row]]);
  }
  const RecordRows* const attitudes = moments.rows("attitude");
  if (attitudes == nullptr) return;
  const Values q(*attitudes, "q_WB");
  for (std::size_t i = 0; i < attitudes->size(); ++i) {
    const RobotId robot = space_->find_robot(attitudes->members().ids[i]);
    if (!robot.valid()) continue;
    for (std::size_t k = 0; k < 4; ++k) b.motion[s.row_of(robot)].q_WB[k] = q.at(i, k);
  }
}

void RecordSource::Shown::take_rows(const RecordMoments& moments) {
  for (const Table& table : tables_) {
    const RecordRows& rows = *moments.rows(table.title, table.group);
    for (const Copy& copy : table.copies) {
      const RecordField& from = table.stream->fields[copy.from];
      const bool same = from.scalar == copy.to.scalar && from.scale == 1.0;
      for (std::size_t row = 0; row < table.to.size(); ++row) {
        if (table.to[row] == nullptr) continue;
        const std::size_t count = std::min(copy.to.count, rows.used(copy.from, row));
        if (same) {
          std::memcpy(table.to[row] + copy.to.offset, rows.bytes(copy.from, row).data(),
                      count * hal::size_of(from.scalar));
          continue;
        }
        for (std::size_t i = 0; i < count; ++i)
          hal::set_value(table.to[row], copy.to, i, hal::finite_or(rows.value(copy.from, row, i), 0.0));
      }
    }
    for (const auto& [field, most] : table.counters) {  // a damaged record may say anything
      for (std::byte* const row : table.to) {
        if (row != nullptr && hal::get_value(row, field, 0) > static_cast<double>(most))
          hal::set_value(row, field, 0, static_cast<double>(most));
      }
    }
  }
}

void RecordSource::Shown::take_objects(const RecordMoments& moments) {
  SpaceStores& s = space_->stores();
  const auto each = [&](const char* title, auto&& put) {
    const RecordRows* const rows = moments.rows(title);
    for (std::size_t row = 0; rows != nullptr && row < rows->size(); ++row) {
      const auto number = s.object_numbers.find(rows->members().ids[row]);
      if (number != s.object_numbers.end() && s.objects[number->second].movable) put(*rows, row, number->second);
    }
  };
  each("object pose", [&](const RecordRows& rows, std::size_t row, std::uint32_t number) {
    const SeenPose at = Poses(rows).at(row);
    Object& o = s.objects[number];
    o.z_high_m += at.z_m - o.z_low_m;
    o.x_m = at.x_m;
    o.y_m = at.y_m;
    o.z_low_m = at.z_m;
    o.cos_h = std::cos(at.heading_rad);
    o.sin_h = std::sin(at.heading_rad);
  });
  each("object attitude", [&](const RecordRows& rows, std::size_t row, std::uint32_t number) {
    const Values q(rows, "q_WB");
    for (std::size_t k = 0; k < 4; ++k) s.object_motion[number].q_WB[k] = q.at(row, k);
  });
}

RecordSource::RecordSource(RecordMoments moments, const hal::Catalog* catalog)
    : moments_(std::move(moments)), shown_(std::make_unique<Shown>(catalog)) {}
RecordSource::RecordSource(RecordSource&&) noexcept = default;
RecordSource& RecordSource::operator=(RecordSource&&) noexcept = default;
RecordSource::~RecordSource() = default;

hal::Result<RecordSource> RecordSource::open(const std::string& path, const hal::Catalog* catalog) {
  auto moments = RecordMoments::open(path);
  if (!moments.ok()) return moments.error();
  return RecordSource(std::move(moments).value(), catalog);
}

std::string RecordSource::experiment() const {
  return hal::text_of(moments_.start(), "experiment", "?");
}

std::uint64_t RecordSource::seed() const {
  return hal::count_of(moments_.start(), "seed");
}

const Space& RecordSource::space() {
  return shown_->space(moments_);
}

Observation RecordSource::observation() {
  return {space(), shown_->measures, std::max<hal::Tick>(0, moments_.tick()), ticks_per_second(), seed()};
}

}  // namespace tandem::core
