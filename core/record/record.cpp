#include "core/record/record.hpp"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <thread>
#include <utility>

#include "core/record/block_file.hpp"
#include "core/record/trajectory.hpp"
#include "core/scenario/element.hpp"
#include "core/space/stores.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"

namespace tandem::core {
namespace {

using hal::Json;

constexpr double kMicrometre = 1e-6;
constexpr double kBinaryAngle = std::numbers::pi / 2147483648.0;  // of 2^32 a turn
constexpr std::int32_t kNoNumber = std::numeric_limits<std::int32_t>::min();

const char* type_name(hal::Scalar scalar) noexcept {
  switch (scalar) {
    case hal::Scalar::F32:
      return "f32";
    case hal::Scalar::F64:
      return "f64";
    case hal::Scalar::U8:
      return "u8";
    case hal::Scalar::U16:
      return "u16";
    case hal::Scalar::U32:
      return "u32";
    case hal::Scalar::I32:
      return "i32";
    case hal::Scalar::I64:
      return "i64";
    case hal::Scalar::Bool:
      return "bool";
  }
  return "";
}

std::int32_t scaled(double value, double scale) noexcept {
  const double number = std::round(value / scale);
  return std::abs(number) <= 2147483647.0 ? static_cast<std::int32_t>(number) : kNoNumber;
}

/// Where one field of a row lies, and how many of its values count.
struct Layout {
  std::size_t offset = 0, size = 0, count = 1;  // of one value; of values
  const hal::Field* used_by = nullptr;
  std::size_t per_entry = 1;
};

/// Rows that lie in memory one after the other.
struct Run {
  const std::byte* first = nullptr;
  std::size_t rows = 0, stride = 0;
};

enum class Sort : std::uint8_t { RobotPoses, ObjectPoses, Attitudes, Port, State };

/// Rows of one form, of the members that have such.
struct Stream {
  Sort sort = Sort::RobotPoses;
  std::uint32_t number = 0, members = 0;
  std::size_t rows = 0;
  std::vector<std::uint32_t> indices;  // of RobotPoses, Attitudes: rows of bodies; of ObjectPoses: numbers of objects
  bool in_order = false;               // the indices are 0, 1, 2, …
  const hal::PortType* port = nullptr;
  std::size_t group = 0;  // of State
  std::vector<Layout> layouts;
  std::size_t row_bytes = 0;  // of a copied row
  std::vector<Run> runs;      // of Port: where the rows lie

  std::vector<double> x, y, z, c, s;  // copied, of poses
  std::vector<std::byte> raw;         // copied, of others
};

class Encoder {
 public:
  explicit Encoder(std::string& out) : out_(out) {}
  template <class T>
  void put(const T& value) {
    out_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void put(const void* data, std::size_t bytes) { out_.append(static_cast<const char*>(data), bytes); }

 private:
  std::string& out_;
};

void encode_poses(const Stream& stream, Encoder& out) {
  for (const std::vector<double>* axis : {&stream.x, &stream.y, &stream.z}) {
    for (const double value : *axis) out.put(scaled(value, kMicrometre));
  }
  for (std::size_t i = 0; i < stream.c.size(); ++i) out.put(scaled(std::atan2(stream.s[i], stream.c[i]), kBinaryAngle));
}

void encode_rows(const Stream& stream, Encoder& out) {
  for (const Layout& field : stream.layouts) {
    const std::size_t all = field.count * field.size;
    for (std::size_t row = 0; row < stream.rows; ++row) {
      const std::byte* const data = stream.raw.data() + row * stream.row_bytes;
      std::size_t bytes = all;
      if (field.used_by != nullptr) {
        const double used = hal::get_value(data, *field.used_by, 0);
        bytes = std::min(all, static_cast<std::size_t>(std::max(0.0, used)) * field.per_entry * field.size);
      }
      out.put(data + field.offset, bytes);
    }
  }
}

void encode(const Stream& stream, hal::Tick tick, std::string& scratch, std::string& file) {
  scratch.clear();
  Encoder out(scratch);
  out.put(stream.number);
  out.put(stream.members);
  out.put(static_cast<std::uint32_t>(stream.rows));
  out.put(std::uint32_t{0});
  if (stream.sort == Sort::RobotPoses || stream.sort == Sort::ObjectPoses)
    encode_poses(stream, out);
  else
    encode_rows(stream, out);
  append_block(file, static_cast<std::uint16_t>(RecordBlock::Rows), tick, scratch);
}

Json field_json(std::string_view name, const char* type, std::size_t count, double scale, std::string_view unit,
                std::string_view doc) {
  return {{"name", name}, {"type", type}, {"count", count}, {"scale", scale}, {"unit", unit}, {"doc", doc}};
}

Json pose_fields() {
  return Json::array({field_json("x", "i32", 1, kMicrometre, "m", "in W"),
                      field_json("y", "i32", 1, kMicrometre, "m", "in W"),
                      field_json("z", "i32", 1, kMicrometre, "m", "of the base above the ground"),
                      field_json("heading", "i32", 1, kBinaryAngle, "rad", "counter-clockwise from x of W")});
}

/// The fields of a row type, those that others are counted by first, and where they lie.
Json row_fields(const hal::RowType& type, std::vector<Layout>& layouts) {
  std::vector<hal::Field> ordered = type.fields;
  std::stable_partition(ordered.begin(), ordered.end(), [&type](const hal::Field& field) {
    return std::any_of(type.fields.begin(), type.fields.end(),
                       [&field](const hal::Field& other) { return other.used_by == field.name; });
  });
  Json fields = Json::array();
  for (const hal::Field& f : ordered) {
    Json field = field_json(f.name, type_name(f.scalar), f.count, 1.0, f.unit.symbol, f.doc);
    Layout layout{f.offset, hal::size_of(f.scalar), f.count, nullptr, 1};
    if (!f.used_by.empty()) {
      const hal::UsedBy used = hal::used_by(type, f);
      layout.used_by = used.field;
      layout.per_entry = used.per_entry;
      if (used.field != nullptr) {
        field["used_by"] = f.used_by;
        field["per_entry"] = used.per_entry;
      }
    }
    layouts.push_back(layout);
    fields.push_back(std::move(field));
  }
  return fields;
}

/// What there is to draw of a kind.
Json body_json(const hal::RobotKind& kind) {
  Json body = {{"radius", kind.body.radius_m}, {"height", kind.body.height_m}};
  if (const auto* const rotors = std::get_if<hal::Quadrotor>(&kind.locomotion)) body["rotor_arm"] = rotors->rotor_arm_m;
  if (const auto* const gripper = kind.part<hal::GripperPart>(); gripper != nullptr)
    body["gripper_reach"] = gripper->reach_m;
  if (const auto* const leds = kind.part<hal::LedsPart>(); leds != nullptr) {
    body["leds_on_turret"] = leds->on_turret;
    for (const hal::Mount& led : leds->mounts) body["leds"].push_back({led.x_m, led.y_m, led.z_m});
  }
  return body;
}

Json object_json(const Object& o) {
  Json json = {{"id", o.id},           {"shape", o.kind == Object::Kind::Box ? "box" : "cylinder"},
               {"movable", o.movable}, {"x", o.x_m},
               {"y", o.y_m},           {"heading", std::atan2(o.sin_h, o.cos_h)},
               {"z", o.z_low_m},       {"height", o.z_high_m - o.z_low_m}};
  if (o.kind == Object::Kind::Box) {
    json["size_x"] = 2.0 * o.half_x_m;
    json["size_y"] = 2.0 * o.half_y_m;
  } else {
    json["radius"] = o.radius_m;
  }
  for (const ObjectLed& led : o.leds)
    json["leds"].push_back({led.x_m, led.y_m, led.z_m, led.color.r, led.color.g, led.color.b});
  return json;
}

Json scene_json(const SpaceStores& s) {
  Json scene = {{"arena", {{"min_x", s.min_x_m}, {"min_y", s.min_y_m}, {"max_x", s.max_x_m}, {"max_y", s.max_y_m}}},
                {"objects", Json::array()},
                {"lights", Json::array()}};
  for (const Object& o : s.objects) {
    if (o.alive) scene["objects"].push_back(object_json(o));
  }
  for (const Region& region : s.regions) {
    for (std::size_t i = 0; i < region.sides.size(); ++i) {
      const RegionSide& a = region.sides[i];
      const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
      scene["borders"].push_back({a.x_m, a.y_m, b.x_m, b.y_m, a.wall});
    }
  }
  for (const LightSource& light : s.lights) {
    if (!light.alive) continue;
    scene["lights"].push_back({{"id", light.id},
                               {"x", light.x_m},
                               {"y", light.y_m},
                               {"z", light.z_m},
                               {"intensity", light.intensity},
                               {"color", {light.color.r, light.color.g, light.color.b}}});
  }
  return scene;
}

/// Rises with everything that `scene_json` shows of what engines do not move.
struct SceneVersion {
  std::uint64_t immovables = 0, leds = 0;
  std::size_t objects = 0;
  std::string lights;
  bool operator==(const SceneVersion&) const = default;
};

SceneVersion scene_version(const SpaceStores& s) {
  SceneVersion version{s.immovables_version, s.object_leds_version, s.objects.size(), {}};
  Encoder out(version.lights);
  for (const LightSource& light : s.lights) {
    for (const double value : {light.x_m, light.y_m, light.z_m, light.intensity}) out.put(value);
    for (const std::uint8_t value : {light.color.r, light.color.g, light.color.b}) out.put(value);
    out.put(light.alive);
  }
  return version;
}

}  // namespace

struct Recorder::Impl {
  RecordConfig config;
  std::optional<hal::OutputFile> file;
  std::vector<Stream> streams;
  std::map<std::string, std::uint32_t> stream_numbers;   // by their declaration without the number
  std::map<std::string, std::uint32_t> members_numbers;  // by theirs
  std::uint32_t generations = 0;
  std::size_t living = 0, objects = 0;
  SceneVersion scene;

  // Between the thread that steps and the one that writes.
  std::mutex mutex;
  std::condition_variable changed;
  std::string ready, after;  // whole blocks, in front of the rows and behind them
  bool rows_ready = false;   // the streams hold rows of `tick` that are to be encoded
  bool over = false;
  bool busy = false;  // the writer uses `streams`
  hal::Tick tick = 0;
  std::string failure;
  std::uint64_t written = 0;
  std::thread writer;

  void declare(const Space& space, hal::Tick now, std::string& out);
  void declare_stream(Stream stream, Json declaration, Json members, hal::Tick now, std::string& out);
  void copy(const Space& space);
  void copy_state(const Space& space, Stream& stream);
  hal::Status hand_over(std::string blocks, bool with_rows, hal::Tick now);
  void wait_until_idle(std::unique_lock<std::mutex>& lock) {
    changed.wait(lock, [this] { return !busy && !rows_ready; });
  }
  hal::Status status() const { return failure.empty() ? hal::Status{} : hal::Status(hal::Error{failure}); }
  void write();
};

void Recorder::Impl::write() {
  std::string blocks, behind, scratch;
  std::unique_lock lock(mutex);
  for (;;) {
    changed.wait(lock, [this] { return over || rows_ready || !ready.empty(); });
    if (!rows_ready && ready.empty()) return;
    blocks.swap(ready);
    behind.swap(after);
    const bool with_rows = std::exchange(rows_ready, false);
    const hal::Tick now = tick;
    busy = true;
    const bool lost = !failure.empty();
    lock.unlock();
    hal::Status status;
    if (!lost) {
      if (with_rows) {
        for (const Stream& stream : streams) encode(stream, now, scratch, blocks);
      }
      blocks += behind;
      status = file->write(blocks);
    }
    lock.lock();
    busy = false;
    if (status.ok() && !lost) written += blocks.size();
    if (!status.ok()) {
      failure = status.error().message + "; it is lost from tick " + std::to_string(now) + " on" +
                (file->part().empty() ? "" : ", what came before is in '" + file->part() + "'");
    }
    blocks.clear();
    behind.clear();
    changed.notify_all();
  }
}

hal::Status Recorder::Impl::hand_over(std::string blocks, bool with_rows, hal::Tick now) {
  const std::lock_guard lock(mutex);
  (rows_ready ? after : ready) += blocks;
  rows_ready = rows_ready || with_rows;
  if (with_rows || !rows_ready) tick = now;  // rows that still wait keep theirs
  changed.notify_all();
  return status();
}

void Recorder::Impl::declare_stream(Stream stream, Json declaration, Json members, hal::Tick now, std::string& out) {
  if (stream.rows == 0) return;
  const auto number = [&](std::map<std::string, std::uint32_t>& numbers, Json json, const char* key, RecordBlock type) {
    const auto [entry, fresh] = numbers.emplace(hal::to_text(json), static_cast<std::uint32_t>(numbers.size() + 1));
    if (fresh) {
      json[key] = entry->second;
      append_block(out, static_cast<std::uint16_t>(type), now, hal::to_text(json));
    }
    return entry->second;
  };
  stream.number = number(stream_numbers, std::move(declaration), "stream", RecordBlock::Stream);
  stream.members = number(members_numbers, std::move(members), "members", RecordBlock::Members);
  streams.push_back(std::move(stream));
}

void Recorder::Impl::declare(const Space& space, hal::Tick now, std::string& out) {
  const SpaceStores& s = space.stores();
  generations = s.generations;
  living = s.living.size();
  objects = s.objects.size();
  streams.clear();

  const auto chosen = [&](std::uint32_t entity) {
    const RobotEntity& e = s.robots[entity];
    const std::string name = space.robot_name({entity, e.generation});
    return std::any_of(config.entities.begin(), config.entities.end(),
                       [&name](const std::string& pattern) { return fits_pattern(name, pattern); });
  };
  const bool everybody = config.entities.size() == 1 && config.entities[0] == "*";

  // Rows in the order in which they lie in memory.
  std::vector<std::uint32_t> rows;
  std::vector<std::uint8_t> is_chosen(s.bodies.size(), 0);
  for (std::size_t row = 0; row < s.bodies.size(); ++row) {
    if ((s.bodies.flags[row] & kAlive) == 0 || !(everybody || chosen(s.bodies.entity[row]))) continue;
    is_chosen[row] = 1;
    rows.push_back(static_cast<std::uint32_t>(row));
  }
  const auto members_of = [&](const std::vector<std::uint32_t>& who) {
    Json ids = Json::array(), kinds = Json::array(), kind = Json::array(), real = Json::array(), bodies = Json::array();
    std::map<std::string_view, std::size_t> known;
    for (std::size_t i = 0; i < who.size(); ++i) {
      const std::uint32_t entity = s.bodies.entity[who[i]];
      ids.push_back(space.robot_name({entity, s.robots[entity].generation}));
      const std::string_view name = s.kind_of_row(who[i]).name;
      const auto [entry, fresh] = known.emplace(name, known.size());
      if (fresh) {
        kinds.push_back(name);
        bodies.push_back(body_json(s.kind_of_row(who[i])));
      }
      kind.push_back(entry->second);
      if ((s.bodies.flags[who[i]] & kExternal) != 0) real.push_back(i);
    }
    return Json{{"ids", std::move(ids)},
                {"kinds", std::move(kinds)},
                {"kind", std::move(kind)},
                {"real", std::move(real)},
                {"bodies", std::move(bodies)}};
  };

  Stream poses;
  poses.indices = rows;
  poses.rows = rows.size();
  poses.in_order = rows.size() == s.bodies.size();
  const Json everyone = members_of(rows);
  declare_stream(std::move(poses), {{"of", "robot"}, {"set", "pose"}, {"name", "pose"}, {"fields", pose_fields()}},
                 everyone, now, out);
  if (s.bodies.has_motion) {
    Stream attitudes_stream;
    attitudes_stream.sort = Sort::Attitudes;
    attitudes_stream.indices = rows;
    attitudes_stream.rows = rows.size();
    attitudes_stream.row_bytes = 4 * sizeof(float);
    attitudes_stream.layouts = {{0, sizeof(float), 4, nullptr, 1}};
    declare_stream(
        std::move(attitudes_stream),
        {{"of", "robot"},
         {"set", "pose"},
         {"name", "attitude"},
         {"fields",
          Json::array({field_json("q_WB", "f32", 4, 1.0, "", "w, x, y, z; in engines of the plane: 1, 0, 0, 0")})}},
        everyone, now, out);
  }

  // Ports, those of all groups that have one together; published state by group.
  std::vector<const hal::PortType*> types;
  for (const RobotGroup& group : s.groups) {
    for (const hal::PortType* type : group.ports) {
      const bool wanted = std::any_of(config.ports.begin(), config.ports.end(),
                                      [type](const std::string& name) { return name == "*" || name == type->name; });
      const bool known = std::any_of(types.begin(), types.end(), [type](const hal::PortType* other) {
        return other->layout == type->layout && other->role == type->role;
      });
      if (wanted && !known) types.push_back(type);
    }
  }
  for (const hal::PortType* type : types) {
    Stream stream;
    stream.sort = Sort::Port;
    stream.port = type;
    stream.row_bytes = type->size;
    std::vector<std::uint32_t> who;
    for (const RobotGroup& group : s.groups) {
      for (std::size_t p = 0; p < group.ports.size(); ++p) {
        if (group.ports[p]->layout != type->layout || group.ports[p]->role != type->role) continue;
        for (const std::size_t b : group.blocks) {
          const RobotBlock& block = s.blocks[b];
          bool open = false;
          for (std::size_t slot = 0; slot < block.used; ++slot) {
            const std::size_t row = block.first_row + slot;
            if (is_chosen[row] == 0) {
              open = false;
              continue;
            }
            if (!open) stream.runs.push_back({block.ports[p] + slot * type->size, 0, type->size});
            open = true;
            ++stream.runs.back().rows;
            who.push_back(static_cast<std::uint32_t>(row));
          }
        }
      }
    }
    stream.rows = who.size();
    Json fields = row_fields(*type, stream.layouts);
    Json declaration = {{"of", "robot"},
                        {"set", type->role == hal::Role::Sensor ? "sensor" : "actuator"},
                        {"name", type->name},
                        {"doc", type->doc},
                        {"fields", std::move(fields)}};
    declare_stream(std::move(stream), std::move(declaration), members_of(who), now, out);
  }
  for (std::size_t g = 0; config.state && g < s.groups.size(); ++g) {
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
        if (is_chosen[row] == 0 || block.constructed[slot] == 0) continue;
        stream.runs.push_back({block.controller(slot), 1, block.controller_stride});
        who.push_back(static_cast<std::uint32_t>(row));
      }
    }
    stream.rows = who.size();
    Json fields = Json::array();
    for (const hal::PublishedField& f : group.published) {
      Json field = field_json(f.name, type_name(f.scalar), f.count, 1.0, f.unit.symbol, f.doc);
      if (!f.texts.empty()) field["texts"] = f.texts;
      fields.push_back(std::move(field));
      stream.layouts.push_back({stream.row_bytes, hal::size_of(f.scalar), f.count, nullptr, 1});
      stream.row_bytes += hal::size_of(f);
    }
    Json declaration = {{"of", "robot"},
                        {"set", "state"},
                        {"name", group.controller != nullptr ? std::string(group.controller->name) : std::string()},
                        {"fields", std::move(fields)}};
    declare_stream(std::move(stream), std::move(declaration), members_of(who), now, out);
  }

  Stream things;
  things.sort = Sort::ObjectPoses;
  Json ids = Json::array();
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    if (!s.objects[i].alive || !s.objects[i].movable) continue;
    things.indices.push_back(static_cast<std::uint32_t>(i));
    ids.push_back(s.objects[i].id);
  }
  things.rows = things.indices.size();
  declare_stream(std::move(things), {{"of", "object"}, {"set", "pose"}, {"name", "pose"}, {"fields", pose_fields()}},
                 {{"ids", std::move(ids)}}, now, out);
}

void Recorder::Impl::copy_state(const Space& space, Stream& stream) {
  const std::vector<hal::PublishedField>& published = space.stores().groups[stream.group].published;
  stream.raw.resize(stream.rows * stream.row_bytes);
  std::byte* out = stream.raw.data();
  for (const Run& run : stream.runs) {
    for (const hal::PublishedField& field : published) {
      const std::size_t bytes = hal::size_of(field);
      std::memcpy(out, run.first + field.offset, bytes);
      out += bytes;
    }
  }
}

void Recorder::Impl::copy(const Space& space) {
  const SpaceStores& s = space.stores();
  const Bodies& b = s.bodies;
  for (Stream& stream : streams) {
    switch (stream.sort) {
      case Sort::RobotPoses: {
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
        stream.z.resize(stream.rows, 0.0);
        for (std::size_t i = 0; b.has_motion && i < stream.rows; ++i) stream.z[i] = s.base_m(stream.indices[i]);
        break;
      }
      case Sort::ObjectPoses:
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
        break;
      case Sort::Attitudes:
        stream.raw.resize(stream.rows * stream.row_bytes);
        for (std::size_t i = 0; i < stream.rows; ++i) {
          std::array<float, 4> q = {1.0F, 0.0F, 0.0F, 0.0F};
          if (!b.motion.empty()) {
            for (std::size_t k = 0; k < 4; ++k) q[k] = static_cast<float>(b.motion[stream.indices[i]].q_WB[k]);
          }
          std::memcpy(stream.raw.data() + i * stream.row_bytes, q.data(), sizeof q);
        }
        break;
      case Sort::Port: {
        stream.raw.resize(stream.rows * stream.row_bytes);
        std::byte* out = stream.raw.data();
        for (const Run& run : stream.runs) {
          std::memcpy(out, run.first, run.rows * run.stride);
          out += run.rows * run.stride;
        }
        break;
      }
      case Sort::State:
        copy_state(space, stream);
        break;
    }
  }
}

hal::Result<std::unique_ptr<Recorder>> Recorder::open(const RecordConfig& config, const Space& space,
                                                      const hal::Json& start) {
  const auto failed = [&](const std::string& why) { return hal::Error{"record '" + config.path + "': " + why}; };
  std::vector<std::string> names, ports;
  for (std::size_t i = 0; i < space.robot_count(); ++i) names.push_back(space.robot_name(space.robot(i)));
  for (const RobotGroup& group : space.stores().groups) {
    for (const hal::PortType* port : group.ports) ports.emplace_back(port->name);
  }
  for (const std::string& pattern : config.entities) {
    const auto fits = [&pattern](const std::string& name) { return fits_pattern(name, pattern); };
    if (names.empty() || std::any_of(names.begin(), names.end(), fits)) continue;  // none: a hook may bring them
    const std::string near = closest(pattern, names);
    return failed("no robot fits '" + pattern + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  for (const std::string& port : config.ports) {
    if (port == "*" || std::find(ports.begin(), ports.end(), port) != ports.end()) continue;
    const std::string near = closest(port, ports);
    return failed("no robot's controller uses a port '" + port + "'" +
                  (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  auto file = hal::OutputFile::open(config.path, "record");
  if (!file.ok()) return file.error();
  auto impl = std::make_unique<Impl>();
  impl->config = config;
  impl->config.every = std::max<std::int64_t>(1, config.every);
  impl->file = std::move(file).value();
  impl->file->keep_part();
  std::string blocks(kBlockFileStart);
  append_block(blocks, static_cast<std::uint16_t>(RecordBlock::Start), -1, hal::to_text(start));
  impl->scene = scene_version(space.stores());
  append_block(blocks, static_cast<std::uint16_t>(RecordBlock::Scene), -1, hal::to_text(scene_json(space.stores())));
  impl->declare(space, -1, blocks);
  impl->copy(space);
  (void)impl->hand_over(std::move(blocks), true, -1);
  impl->writer = std::thread([&impl = *impl] { impl.write(); });
  return std::unique_ptr<Recorder>(new Recorder(std::move(impl)));
}

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->over = true;
    impl_->changed.notify_all();
  }
  if (impl_->writer.joinable()) impl_->writer.join();
}

hal::Status Recorder::tick_done(const Space& space, hal::Tick tick) {
  Impl& r = *impl_;
  if (tick % r.config.every != 0) return {};
  {
    std::unique_lock lock(r.mutex);
    r.wait_until_idle(lock);
    if (!r.failure.empty()) return r.status();
  }
  const SpaceStores& s = space.stores();
  std::string blocks;
  if (SceneVersion now = scene_version(s); !(now == r.scene)) {
    r.scene = std::move(now);
    append_block(blocks, static_cast<std::uint16_t>(RecordBlock::Scene), tick, hal::to_text(scene_json(s)));
  }
  if (s.generations != r.generations || s.living.size() != r.living || s.objects.size() != r.objects || !blocks.empty())
    r.declare(space, tick, blocks);
  r.copy(space);
  return r.hand_over(std::move(blocks), true, tick);
}

bool Recorder::wants_fingerprint(hal::Tick tick) const noexcept {
  return impl_->config.fingerprint_every > 0 && tick % impl_->config.fingerprint_every == 0;
}

hal::Status Recorder::fingerprint(hal::Tick tick, std::uint64_t fingerprint) {
  std::string block;
  append_block(block, static_cast<std::uint16_t>(RecordBlock::Fingerprint), tick,
               {reinterpret_cast<const char*>(&fingerprint), sizeof fingerprint});
  return impl_->hand_over(std::move(block), false, tick);
}

hal::Status Recorder::event(hal::Tick tick, const hal::Json& event) {
  std::string block;
  append_block(block, static_cast<std::uint16_t>(RecordBlock::Event), tick, hal::to_text(event));
  return impl_->hand_over(std::move(block), false, tick);
}

hal::Status Recorder::close(hal::Tick tick, const hal::Json& end) {
  Impl& r = *impl_;
  if (!r.file) return r.status();
  std::string block;
  append_block(block, static_cast<std::uint16_t>(RecordBlock::End), tick, hal::to_text(end));
  (void)r.hand_over(std::move(block), false, tick);
  {
    const std::lock_guard lock(r.mutex);
    r.over = true;
    r.changed.notify_all();
  }
  if (r.writer.joinable()) r.writer.join();
  hal::Status closed = r.status();
  if (closed.ok()) closed = r.file->commit();
  r.file.reset();
  if (!closed.ok()) r.failure = closed.error().message;
  return closed;
}

const hal::OutputFile& Recorder::file() const noexcept {
  return *impl_->file;
}

std::uint64_t Recorder::bytes() const noexcept {
  const std::lock_guard lock(impl_->mutex);
  return impl_->written;
}

}  // namespace tandem::core
