#include "core/record/record_streams.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "core/record/block_file.hpp"
#include "core/record/pattern.hpp"
#include "core/record/pose_numbers.hpp"
#include "core/record/record.hpp"
#include "core/record/scene_json.hpp"
#include "core/space/attitude.hpp"
#include "core/space/looks.hpp"
#include "core/space/stores.hpp"
#include "hal/scalar_name.hpp"

namespace tandem::core {
namespace {

using hal::Json;

template <class T>
void put(std::string& out, const T& value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

Json field_json(std::string_view name, std::string_view type, std::size_t count, double scale, std::string_view unit,
                std::string_view doc) {
  return {{"name", name}, {"type", type}, {"count", count}, {"scale", scale}, {"unit", unit}, {"doc", doc}};
}

Json pose_fields() {
  return Json::array({field_json("x", "i32", 1, kMicrometre, "m", "in W"),
                      field_json("y", "i32", 1, kMicrometre, "m", "in W"),
                      field_json("z", "i32", 1, kMicrometre, "m", "of the base above the ground"),
                      field_json("heading", "i32", 1, kBinaryAngle, "rad", "counter-clockwise from x of W")});
}

/// Whether two port classes, perhaps from two plug-ins, are the same.
bool same_port(const hal::PortType& a, const hal::PortType& b) noexcept {
  return a.layout == b.layout && a.role == b.role;
}

std::string_view set_of(const hal::PortType& type) noexcept {
  return type.role == hal::Role::Sensor ? "sensor" : "actuator";
}

std::size_t real_robots(const SpaceStores& s) noexcept {
  if (!s.twins) return 0;
  std::size_t real = 0;
  for (std::size_t row = 0; row < s.bodies.size(); ++row) real += (s.bodies.flags[row] & kExternal) != 0 ? 1U : 0U;
  return real;
}

}  // namespace

/// Rows of bodies that were chosen, in the order in which they are written, and whether each row of bodies is.
struct RecordStreams::Chosen {
  std::vector<std::uint32_t> rows;
  std::vector<std::uint8_t> is;
};

// --- what there is ---

bool RecordStreams::stale(const Space& space) const noexcept {
  const SpaceStores& s = space.stores();
  return s.generations != generations_ || s.living.size() != living_ || s.objects.size() != objects_ ||
         real_robots(s) != real_ || (inputs_ != nullptr && inputs_->version != inputs_version_);
}

void RecordStreams::declare_stream(Stream stream, Json declaration, const Json& members, hal::Tick now,
                                   std::string& out, std::vector<Stream>& to) {
  if (stream.rows == 0) return;
  if (stream.when == When::Changed) declaration["on_change"] = true;
  const auto number = [&](std::map<std::string, std::uint32_t>& numbers, Json json, const char* key, RecordBlock type) {
    const auto [entry, fresh] = numbers.emplace(hal::to_text(json), static_cast<std::uint32_t>(numbers.size() + 1));
    if (fresh) {
      json[key] = entry->second;
      append_block(out, static_cast<std::uint16_t>(type), now, hal::to_text(json));
    }
    return entry->second;
  };
  stream.number = number(stream_numbers_, std::move(declaration), "stream", RecordBlock::Stream);
  stream.members = number(members_numbers_, members, "members", RecordBlock::Members);
  to.push_back(std::move(stream));
}

void RecordStreams::declare(const Space& space, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  generations_ = s.generations;
  living_ = s.living.size();
  objects_ = s.objects.size();
  real_ = real_robots(s);
  streams_.clear();
  bodies_.clear();

  const auto fits = [&](std::uint32_t row) {
    const std::uint32_t entity = s.bodies.entity[row];
    const std::string name = space.robot_name({entity, s.robots[entity].generation});
    return std::any_of(config_.entities.begin(), config_.entities.end(),
                       [&name](const std::string& pattern) { return fits_pattern(name, pattern); });
  };
  const bool everybody = config_.entities.size() == 1 && config_.entities[0] == "*";
  Chosen chosen;
  chosen.is.resize(s.bodies.size(), 0);
  for (const std::uint32_t row : living_rows(s)) {
    if (!everybody && !fits(row)) continue;
    chosen.is[row] = 1;
    chosen.rows.push_back(row);
  }
  if (order_ == RowOrder::Ids) {
    std::sort(chosen.rows.begin(), chosen.rows.end(),
              [&s](std::uint32_t a, std::uint32_t b) { return came_earlier(s, a, b); });
  }
  declare_poses(space, chosen, now, out);
  declare_ports(space, chosen, now, out);
  if (config_.state) declare_state(space, chosen, now, out);
  if (config_.look) declare_look(space, chosen, now, out);
  if (inputs_ != nullptr) declare_inputs(space, now, out);
  declare_tables(space, now, out);
  if (config_.objects) declare_objects(space, now, out);
}

void RecordStreams::declare_poses(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  Stream poses;
  poses.indices = chosen.rows;
  poses.rows = chosen.rows.size();
  poses.in_order = chosen.rows.size() == s.bodies.size() && std::is_sorted(chosen.rows.begin(), chosen.rows.end());
  const Json everyone = members_json(space, chosen.rows, bodies_);
  declare_stream(std::move(poses), {{"of", "robot"}, {"set", "pose"}, {"name", "pose"}, {"fields", pose_fields()}},
                 everyone, now, out);
  if (!s.bodies.has_motion || !config_.attitudes) return;
  Stream attitudes;
  attitudes.sort = Sort::Attitudes;
  attitudes.indices = chosen.rows;
  attitudes.rows = chosen.rows.size();
  declare_attitudes(std::move(attitudes), "robot", everyone, now, out);
}

void RecordStreams::declare_attitudes(Stream attitudes, const char* of, const Json& members, hal::Tick now,
                                      std::string& out) {
  attitudes.row_bytes = 4 * sizeof(float);
  attitudes.layouts = {{0, sizeof(float), 4, nullptr, 1}};
  declare_stream(
      std::move(attitudes),
      {{"of", of},
       {"set", "pose"},
       {"name", "attitude"},
       {"fields",
        Json::array({field_json("q_WB", "f32", 4, 1.0, "", "w, x, y, z; in engines of the plane: 1, 0, 0, 0")})}},
      members, now, out);
}

namespace {

/// The fields of a row type, those that others are counted by first.
std::vector<const hal::Field*> in_order(const hal::RowType& type) {
  std::vector<const hal::Field*> ordered;
  for (const hal::Field& field : type.fields) ordered.push_back(&field);
  std::stable_partition(ordered.begin(), ordered.end(), [&type](const hal::Field* field) {
    return std::any_of(type.fields.begin(), type.fields.end(),
                       [field](const hal::Field& other) { return other.used_by == field->name; });
  });
  return ordered;
}

Json row_fields(const hal::RowType& type) {
  Json fields = Json::array();
  for (const hal::Field* f : in_order(type)) {
    Json field = field_json(f->name, hal::name_of(f->scalar), f->count, 1.0, f->unit.symbol, f->doc);
    const hal::UsedBy used = f->used_by.empty() ? hal::UsedBy{} : hal::used_by(type, *f);
    if (used.field != nullptr) {
      field["used_by"] = f->used_by;
      field["per_entry"] = used.per_entry;
    }
    fields.push_back(std::move(field));
  }
  return fields;
}

/// Who holds a robot, as RobotBlock::halted has it.
struct Halts {
  static constexpr std::string_view kName = "halted";
  static constexpr std::string_view kDoc = "Who is halted.";
  std::uint8_t by = 0;
  void describe(hal::FieldList& f) const {
    f.add("by", by, hal::unit::none,
          "0: its controller steps; else bits of who holds it: 1 hook, 2 controller, 4 safety table, 8 operator");
  }
};

}  // namespace

hal::Json RecordStreams::declaration_of(const char* of, Title title, const hal::RowType& type) {
  return {{"of", of}, {"set", title.set}, {"name", title.name}, {"doc", type.doc}, {"fields", row_fields(type)}};
}

void RecordStreams::add_layouts(const hal::RowType& type, std::vector<Layout>& layouts) {
  for (const hal::Field* f : in_order(type)) {
    const hal::UsedBy used = f->used_by.empty() ? hal::UsedBy{} : hal::used_by(type, *f);
    layouts.push_back(
        {f->offset, hal::size_of(f->scalar), f->count, used.field, used.field != nullptr ? used.per_entry : 1});
  }
}

/// Rows of the blocks in which `first_of` finds some: it gives the first one of a block by its number, or null.
void RecordStreams::declare_rows(const Space& space, const Chosen& chosen, const hal::RowType& type, Title title,
                                 const std::function<const std::byte*(std::size_t)>& first_of, hal::Tick now,
                                 std::string& out) {
  const SpaceStores& s = space.stores();
  Stream stream;
  stream.sort = Sort::Rows;
  stream.when = title.set == "look" ? When::Changed : When::Due;
  stream.row_bytes = type.size;
  std::vector<std::uint32_t> who;
  for (std::size_t b = 0; b < s.blocks.size(); ++b) {
    const RobotBlock& block = s.blocks[b];
    const std::byte* const first = first_of(b);
    bool open = false;
    for (std::size_t slot = 0; first != nullptr && slot < block.used; ++slot) {
      const std::size_t row = block.first_row + slot;
      if (chosen.is[row] == 0) {
        open = false;
        continue;
      }
      if (!std::exchange(open, true)) stream.runs.push_back({first + slot * type.size, 0, type.size});
      ++stream.runs.back().rows;
      who.push_back(static_cast<std::uint32_t>(row));
    }
  }
  stream.rows = who.size();
  add_layouts(type, stream.layouts);
  declare_stream(std::move(stream), declaration_of("robot", title, type), members_json(space, who, bodies_), now, out);
}

// Ports are those of all groups that have one, together; published state is by group.
void RecordStreams::declare_ports(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  std::vector<const hal::PortType*> types;
  for (const RobotGroup& group : s.groups) {
    for (const hal::PortType* type : group.ports) {
      const bool wanted = std::any_of(config_.ports.begin(), config_.ports.end(),
                                      [type](const std::string& name) { return name == "*" || name == type->name; });
      const bool known = std::any_of(types.begin(), types.end(),
                                     [type](const hal::PortType* other) { return same_port(*type, *other); });
      if (wanted && !known) types.push_back(type);
    }
  }
  for (const hal::PortType* type : types) {
    const auto first_of = [&s, type](std::size_t b) -> const std::byte* {
      const std::vector<const hal::PortType*>& ports = s.groups[s.blocks[b].group].ports;
      const auto port =
          std::find_if(ports.begin(), ports.end(), [type](const auto* p) { return same_port(*p, *type); });
      return port == ports.end() ? nullptr : s.blocks[b].ports[static_cast<std::size_t>(port - ports.begin())];
    };
    declare_rows(space, chosen, *type, {set_of(*type), type->name}, first_of, now, out);
  }
}

void RecordStreams::declare_state(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    const RobotGroup& group = s.groups[g];
    if (group.published.empty()) continue;
    Stream stream;
    stream.sort = Sort::State;
    stream.group = g;
    std::vector<std::uint32_t> who;
    for (const std::size_t b : group.blocks) {
      const RobotBlock& block = s.blocks[b];
      for (std::size_t slot = 0; slot < block.used; ++slot) {
        const std::size_t row = block.first_row + slot;
        if (chosen.is[row] == 0 || block.constructed[slot] == 0) continue;
        stream.runs.push_back({block.controller(slot), 1, block.controller_stride});
        who.push_back(static_cast<std::uint32_t>(row));
      }
    }
    stream.rows = who.size();
    Json fields = Json::array();
    for (const hal::PublishedField& f : group.published) {
      Json field = field_json(f.name, hal::name_of(f.scalar), f.count, 1.0, f.unit.symbol, f.doc);
      if (!f.texts.empty()) field["texts"] = f.texts;
      fields.push_back(std::move(field));
      stream.layouts.push_back({stream.row_bytes, hal::size_of(f.scalar), f.count, nullptr, 1});
      stream.row_bytes += hal::size_of(f);
    }
    Json declaration = {{"of", "robot"},
                        {"set", "state"},
                        {"name", group.controller != nullptr ? std::string(group.controller->name) : std::string()},
                        {"fields", std::move(fields)}};
    declare_stream(std::move(stream), std::move(declaration), members_json(space, who, bodies_), now, out);
  }
}

/// What pictures show besides poses: the rows that move and light robots, and who is halted.
void RecordStreams::declare_look(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  std::vector<const hal::RobotKind*> kinds;
  for (const RobotGroup& group : s.groups) kinds.push_back(group.kind);
  const std::vector<std::string> rows = driven_rows(kinds);
  for (const std::string& row : rows) {
    const hal::RowType* type = nullptr;  // of the first group that has such
    std::vector<Looks::Place> places;
    for (const RobotGroup& group : s.groups) {
      Looks::Place& place = places.emplace_back(Looks::place_of(group, row));
      if (type == nullptr) type = place.type;
      if (place.type != nullptr && place.type->layout != type->layout) place.type = nullptr;
    }
    if (type == nullptr) continue;
    const auto first_of = [&](std::size_t b) { return places[s.blocks[b].group].row(s.blocks[b], b, 0); };
    declare_rows(space, chosen, *type, {"look", row_name(rows, row)}, first_of, now, out);
  }
  const auto halted = [&s](std::size_t b) { return reinterpret_cast<const std::byte*>(s.blocks[b].halted.data()); };
  declare_rows(space, chosen, hal::row_type<Halts>(), {"look", Halts::kName}, halted, now, out);
}

/// All that reached the space from outside: what real robots did to their twins, and what they measured.
void RecordStreams::declare_inputs(const Space& space, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  inputs_version_ = inputs_->version;
  input_streams_.clear();
  input_encoder_.forget();
  const auto alike = [](const InputRow& a, const InputRow& b) {
    return a.set == b.set && a.robot.valid() == b.robot.valid() && a.type->layout == b.type->layout &&
           a.type->name == b.type->name;
  };
  std::vector<const InputRow*> first;  // of each form
  for (const InputRow& row : inputs_->rows) {
    if (std::none_of(first.begin(), first.end(), [&](const InputRow* other) { return alike(row, *other); }))
      first.push_back(&row);
  }
  for (const InputRow* const form : first) {
    const hal::RowType* const type = form->type;
    Stream stream;
    stream.sort = Sort::Rows;
    stream.row_bytes = type->size;
    const bool of_run = !form->robot.valid();
    std::vector<std::uint32_t> who;
    for (const InputRow& row : inputs_->rows) {
      if (!alike(row, *form) || !(of_run || space.contains(row.robot))) continue;
      stream.runs.push_back({static_cast<const std::byte*>(row.row), 1, type->size});
      if (!of_run) who.push_back(static_cast<std::uint32_t>(s.row_of(row.robot)));
    }
    stream.rows = stream.runs.size();
    add_layouts(*type, stream.layouts);
    declare_stream(std::move(stream), declaration_of(of_run ? "run" : "robot", {form->set, type->name}, *type),
                   of_run ? Json{{"ids", {"run"}}} : members_json(space, who, bodies_), now, out, input_streams_);
  }
}

void RecordStreams::declare_tables(const Space& space, hal::Tick now, std::string& out) {
  for (const RecordTable& table : tables_) {
    Stream stream;
    stream.sort = Sort::Rows;
    stream.when = When::Changed;
    stream.row_bytes = table.type->size;
    std::vector<std::uint32_t> who;
    for (std::size_t i = 0; i < table.robots.size(); ++i) {
      if (!space.contains(table.robots[i])) continue;
      stream.runs.push_back({static_cast<const std::byte*>(table.first) + i * table.type->size, 1, table.type->size});
      who.push_back(static_cast<std::uint32_t>(space.stores().row_of(table.robots[i])));
    }
    stream.rows = who.size();
    add_layouts(*table.type, stream.layouts);
    declare_stream(std::move(stream), declaration_of("robot", {table.set, table.type->name}, *table.type),
                   members_json(space, who, bodies_), now, out);
  }
}

void RecordStreams::declare_objects(const Space& space, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  Stream things;
  things.sort = Sort::ObjectPoses;
  Json ids = Json::array();
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    if (!s.objects[i].alive || !s.objects[i].movable) continue;
    things.indices.push_back(static_cast<std::uint32_t>(i));
    ids.push_back(s.objects[i].id);
  }
  things.rows = things.indices.size();
  const Json members = {{"ids", std::move(ids)}};
  Stream attitudes;
  attitudes.sort = Sort::ObjectAttitudes;
  attitudes.indices = things.indices;
  attitudes.rows = things.rows;
  declare_stream(std::move(things), {{"of", "object"}, {"set", "pose"}, {"name", "pose"}, {"fields", pose_fields()}},
                 members, now, out);
  if (config_.attitudes && anything_may_lean(s)) declare_attitudes(std::move(attitudes), "object", members, now, out);
}

// --- copying, on the thread that steps ---

void RecordStreams::copy_robot_poses(const Space& space, Stream& stream) const {
  const SpaceStores& s = space.stores();
  const Bodies& b = s.bodies;
  const auto gather = [&](const LargeVector<double>& from, std::vector<double>& to) {
    to.resize(stream.rows);
    if (stream.in_order) {
      std::memcpy(to.data(), from.data(), stream.rows * sizeof(double));
    } else {
      for (std::size_t i = 0; i < stream.rows; ++i) to[i] = from[stream.indices[i]];
    }
  };
  gather(b.x_m, stream.x);
  gather(b.y_m, stream.y);
  gather(b.cos_h, stream.c);
  gather(b.sin_h, stream.s);
  stream.flat = b.motion.empty();
  if (stream.flat) return;
  stream.z.resize(stream.rows);
  for (std::size_t i = 0; i < stream.rows; ++i) stream.z[i] = b.motion[stream.indices[i]].z_m;
}

void RecordStreams::copy_rows(const Space& space, Stream& stream) const {
  const SpaceStores& s = space.stores();
  const Bodies& b = s.bodies;
  stream.raw.resize(stream.rows * stream.row_bytes);
  std::byte* out = stream.raw.data();
  const auto copy_turns = [&](const auto& motion) {
    for (std::size_t i = 0; i < stream.rows; ++i, out += stream.row_bytes) {
      std::array<float, 4> q = {1.0F, 0.0F, 0.0F, 0.0F};
      for (std::size_t k = 0; k < 4 && !motion.empty(); ++k)
        q[k] = static_cast<float>(motion[stream.indices[i]].q_WB[k]);
      std::memcpy(out, q.data(), sizeof q);
    }
  };
  switch (stream.sort) {
    case Sort::Attitudes:
      return copy_turns(b.motion);
    case Sort::ObjectAttitudes:
      return copy_turns(s.object_motion);
    case Sort::State:
      for (const Run& run : stream.runs) {
        for (const hal::PublishedField& field : s.groups[stream.group].published) {
          const std::size_t bytes = hal::size_of(field);
          std::memcpy(out, run.first + field.offset, bytes);
          out += bytes;
        }
      }
      return;
    default:
      for (const Run& run : stream.runs) {
        std::memcpy(out, run.first, run.rows * run.stride);
        out += run.rows * run.stride;
      }
  }
}

void RecordStreams::copy(const Space& space, bool due) {
  const SpaceStores& s = space.stores();
  for (Stream& stream : streams_) {
    stream.copied = due;
    if (!stream.copied) continue;
    if (stream.sort == Sort::RobotPoses) {
      copy_robot_poses(space, stream);
    } else if (stream.sort == Sort::ObjectPoses) {
      stream.flat = false;
      for (std::vector<double>* axis : {&stream.x, &stream.y, &stream.z, &stream.c, &stream.s})
        axis->resize(stream.rows);
      for (std::size_t i = 0; i < stream.rows; ++i) {
        const Object& o = s.objects[stream.indices[i]];
        stream.x[i] = o.x_m;
        stream.y[i] = o.y_m;
        stream.z[i] = o.z_low_m;
        stream.c[i] = o.cos_h;
        stream.s[i] = o.sin_h;
      }
    } else {
      copy_rows(space, stream);
    }
  }
  for (Stream& stream : input_streams_) {
    copy_rows(space, stream);
    stream.copied = true;
  }
}

// --- encoding, on any thread ---

void RecordStreams::encode_poses(const Stream& stream, std::string& out) {
  numbers_.resize(stream.rows);
  const auto put_numbers = [&] {
    out.append(reinterpret_cast<const char*>(numbers_.data()), stream.rows * sizeof(std::int32_t));
  };
  for (const std::vector<double>* axis : {&stream.x, &stream.y, &stream.z}) {
    if (axis == &stream.z && stream.flat) {
      out.append(stream.rows * sizeof(std::int32_t), '\0');
      continue;
    }
    to_micrometres(*axis, numbers_);
    put_numbers();
  }
  to_binary_angles(stream.c, stream.s, numbers_);
  put_numbers();
}

void RecordStreams::encode_rows(const Stream& stream, std::string& out) {
  for (const Layout& field : stream.layouts) {
    const std::size_t all = field.count * field.size;
    for (std::size_t row = 0; row < stream.rows; ++row) {
      const std::byte* const data = stream.raw.data() + row * stream.row_bytes;
      std::size_t bytes = all;
      if (field.used_by != nullptr) {
        const double used = hal::get_value(data, *field.used_by, 0);
        bytes = std::min(all, static_cast<std::size_t>(std::max(0.0, used)) * field.per_entry * field.size);
      }
      out.append(reinterpret_cast<const char*>(data + field.offset), bytes);
    }
  }
}

void RecordStreams::encode(hal::Tick tick, std::string& out) {
  for (Stream& stream : streams_) {
    if (!std::exchange(stream.copied, false)) continue;
    if (stream.when == When::Changed) {
      if (stream.raw == stream.last) continue;
      stream.last.swap(stream.raw);
      stream.raw = stream.last;
    }
    const std::size_t begin = begin_block(out);
    put(out, stream.number);
    put(out, stream.members);
    put(out, static_cast<std::uint32_t>(stream.rows));
    put(out, std::uint32_t{0});
    if (stream.sort == Sort::RobotPoses || stream.sort == Sort::ObjectPoses)
      encode_poses(stream, out);
    else
      encode_rows(stream, out);
    end_block(out, begin, static_cast<std::uint16_t>(RecordBlock::Rows), tick);
  }
  encode_inputs(tick, out);
}

void RecordStreams::encode_inputs(hal::Tick tick, std::string& out) {
  input_tables_.resize(input_streams_.size());
  bool copied = false;
  for (std::size_t i = 0; i < input_streams_.size(); ++i) {
    Stream& stream = input_streams_[i];
    copied = std::exchange(stream.copied, false) || copied;
    input_tables_[i].stream = stream.number;
    input_tables_[i].members = stream.members;
    input_tables_[i].rows.clear();
    encode_rows(stream, input_tables_[i].rows);
  }
  if (!copied) return;
  const std::size_t begin = begin_block(out);
  input_encoder_.encode(input_tables_, out);
  end_block(out, begin, static_cast<std::uint16_t>(RecordBlock::Inputs), tick);
}

}  // namespace tandem::core
