#include "core/space/state_values.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <unordered_map>

namespace tandem::core {
namespace {

using hal::Scalar;
using Numbers = std::array<std::uint32_t, kBlockRows>;

template <class T>
const std::byte* bytes_of(const T* values) noexcept {
  return reinterpret_cast<const std::byte*>(values);
}

/// The fields of one class of rows, for up to kBlockRows rows at a time.
class Rows {
 public:
  Rows(StateVisitor& visitor, ValueOwner owner, std::span<const std::uint32_t> numbers)
      : visitor_(visitor), numbers_(numbers) {
    visitor.begin({owner, numbers});
  }

  /// One value a row.
  template <class T>
  void value(std::string_view name, std::string_view field, const T* first, std::size_t stride = sizeof(T)) {
    FieldRows rows{ValueSet::Own, name, field, hal::detail::scalar_of<T>()};
    rows.first = bytes_of(first);
    rows.stride = stride;
    visitor_.visit(rows);
  }

  void fields(ValueSet set, const hal::RowType& type, const std::byte* first) {
    std::array<std::uint32_t, kBlockRows> used;
    for (const hal::Field& field : type.fields) {
      FieldRows rows{set, type.name, field.name, field.scalar, field.count};
      rows.first = first + field.offset;
      rows.stride = type.size;
      if (type.initial != nullptr) rows.initial = static_cast<const std::byte*>(type.initial) + field.offset;
      if (const hal::UsedBy by = hal::used_by(type, field); by.field != nullptr) {
        for (std::size_t i = 0; i < numbers_.size(); ++i)
          used[i] = static_cast<std::uint32_t>(hal::used_count(by, first + i * type.size, field));
        rows.used = used.data();
      }
      visitor_.visit(rows);
    }
  }

  template <class T>
  void state(const std::vector<T>& rows, std::size_t first_row) {
    if (!rows.empty()) fields(ValueSet::Own, hal::row_type<T>(), bytes_of(rows.data() + first_row));
  }

 private:
  StateVisitor& visitor_;
  std::span<const std::uint32_t> numbers_;
};

void visit_bodies(const Bodies& b, std::size_t row, Rows& rows) {
  constexpr std::string_view kBody = "body";
  rows.value(kBody, "x", &b.x_m[row]);
  rows.value(kBody, "y", &b.y_m[row]);
  rows.value(kBody, "cos_heading", &b.cos_h[row]);
  rows.value(kBody, "sin_heading", &b.sin_h[row]);
  rows.value(kBody, "left", &b.left_m[row]);
  rows.value(kBody, "right", &b.right_m[row]);
  rows.value(kBody, "left_speed", &b.left_m_s[row]);
  rows.value(kBody, "right_speed", &b.right_m_s[row]);
  rows.value(kBody, "flags", &b.flags[row]);
  // An engine of places alone moves a body alike in every region.
  if (b.has_motion) rows.value(kBody, "region", &b.region[row]);
  rows.state(b.motion, row);
}

/// Of those whose poses are set from outside.
void visit_real_senses(const SpaceStores& s, const RobotBlock& block, const Numbers& numbers, Rows& rows) {
  std::array<std::uint8_t, kBlockRows> senses{};
  bool any = false;
  for (std::size_t i = 0; i < block.used; ++i) {
    if ((s.bodies.flags[block.first_row + i] & kExternal) == 0) continue;
    senses[i] = s.robots[numbers[i]].real_senses;
    any = any || senses[i] != 0;
  }
  if (any) rows.value("body", "real_senses", senses.data());
}

void visit_block(const StateView& state, std::size_t index, StateVisitor& visitor) {
  const SpaceStores& s = state.stores;
  const RobotBlock& block = s.blocks[index];
  const RobotGroup& group = s.groups[block.group];
  Numbers numbers;
  for (std::size_t i = 0; i < block.used; ++i) {
    const std::size_t row = block.first_row + i;
    numbers[i] = (s.bodies.flags[row] & kAlive) != 0 ? s.bodies.entity[row] : ValueOwners::kNobody;
  }
  if (block.used == 0) return;
  const std::span<const std::uint32_t> used(numbers.data(), block.used);
  Rows rows(visitor, ValueOwner::Robot, used);
  visit_bodies(s.bodies, block.first_row, rows);
  rows.value("body", "halted", block.halted.data());
  visit_real_senses(s, block, numbers, rows);
  for (std::size_t p = 0; p < block.ports.size(); ++p) {
    const hal::PortType& type = *group.ports[p];
    rows.fields(type.role == hal::Role::Sensor ? ValueSet::Sensor : ValueSet::Actuator, type, block.ports[p]);
  }
  for (const hal::PublishedField& field : group.published) {
    FieldRows shown{ValueSet::Published, group.controller->name, field.name, field.scalar, field.count};
    shown.first = block.controllers + field.offset;
    shown.stride = block.controller_stride;
    visitor.visit(shown);
  }
  for (const KeptColumn& column : group.columns) rows.fields(ValueSet::Own, *column.type, column.arrays->array(index));
}

/// Calls `visit(first, rows, numbers)` for up to kBlockRows of the living at a time.
template <class T, class Visit>
void in_parts(const std::vector<T>& all, Visit&& visit) {
  Numbers numbers;
  for (std::size_t begin = 0; begin < all.size(); begin += kBlockRows) {
    const std::size_t count = std::min(kBlockRows, all.size() - begin);
    for (std::size_t i = 0; i < count; ++i)
      numbers[i] = all[begin + i].alive ? static_cast<std::uint32_t>(begin + i) : ValueOwners::kNobody;
    visit(begin, std::span<const std::uint32_t>(numbers.data(), count));
  }
}

void visit_leds(const Object& object, std::uint32_t number, StateVisitor& visitor) {
  for (std::size_t i = 0; i < object.leds.size(); ++i) {
    const ObjectLed& led = object.leds[i];
    // LEDs are told apart by their fields' indices.
    const std::array<double, 3> place = {led.x_m, led.y_m, led.z_m};
    const std::array<std::uint32_t, 2> light = {
        static_cast<std::uint32_t>(led.color.r | led.color.g << 8 | led.color.b << 16), led.medium};
    std::string name = "led";
    name += std::to_string(i);
    Rows rows(visitor, ValueOwner::Object, {&number, 1});
    rows.value(name, "x", &place[0]);
    rows.value(name, "y", &place[1]);
    rows.value(name, "z", &place[2]);
    rows.value(name, "color", &light[0]);
    rows.value(name, "medium", &light[1]);
  }
}

void visit_objects(const SpaceStores& s, StateVisitor& visitor) {
  constexpr std::string_view kBody = "body";
  in_parts(s.objects, [&](std::size_t begin, std::span<const std::uint32_t> numbers) {
    Rows rows(visitor, ValueOwner::Object, numbers);
    const Object& o = s.objects[begin];
    const auto value = [&](std::string_view field, const auto* first) { rows.value(kBody, field, first, sizeof o); };
    value("movable", &o.movable);
    value("kind", &o.kind);
    value("x", &o.x_m);
    value("y", &o.y_m);
    value("cos_heading", &o.cos_h);
    value("sin_heading", &o.sin_h);
    value("half_x", &o.half_x_m);
    value("half_y", &o.half_y_m);
    value("radius", &o.radius_m);
    value("z_low", &o.z_low_m);
    value("z_high", &o.z_high_m);
    value("mass", &o.mass_kg);
    rows.value(kBody, "region", &s.object_region[begin]);
    rows.state(s.object_motion, begin);
    for (const std::uint32_t number : numbers) {
      if (number != ValueOwners::kNobody) visit_leds(s.objects[number], number, visitor);
    }
  });
}

/// A body by a number that does not depend on where it is stored.
std::uint32_t number_of(const SpaceStores& s, BodyKey body) noexcept {
  return body.is_object() ? body.value : s.bodies.entity[body.index()];
}

void visit_joints(const SpaceStores& s, StateVisitor& visitor) {
  constexpr std::string_view kJoint = "joint";
  in_parts(s.joints, [&](std::size_t begin, std::span<const std::uint32_t> numbers) {
    Numbers a, b;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] == ValueOwners::kNobody) continue;
      a[i] = number_of(s, s.joints[begin + i].a);
      b[i] = number_of(s, s.joints[begin + i].b);
    }
    Rows rows(visitor, ValueOwner::Joint, numbers);
    rows.value(kJoint, "a", a.data());
    rows.value(kJoint, "b", b.data());
    const Joint& j = s.joints[begin];
    const auto value = [&](std::string_view field, const auto* first) { rows.value(kJoint, field, first, sizeof j); };
    value("alive", &j.alive);
    value("ax", &j.ax_m);
    value("ay", &j.ay_m);
    value("az", &j.az_m);
    value("bx", &j.bx_m);
    value("by", &j.by_m);
    value("bz", &j.bz_m);
    value("turns", &j.form.kind);
    value("heading", &j.heading_rad);
    value("axis_x", &j.form.axis[0]);
    value("axis_y", &j.form.axis[1]);
    value("axis_z", &j.form.axis[2]);
    value("limited", &j.form.limited);
    value("low", &j.form.low);
    value("high", &j.form.high);
    value("motor_torque", &j.form.motor_most);
    value("motor_speed", &j.form.motor_speed);
  });
}

void visit_sources(const SpaceStores& s, StateVisitor& visitor) {
  in_parts(s.lights, [&](std::size_t begin, std::span<const std::uint32_t> numbers) {
    Rows rows(visitor, ValueOwner::Light, numbers);
    const LightSource& l = s.lights[begin];
    const auto value = [&](std::string_view field, const auto* first) { rows.value("light", field, first, sizeof l); };
    value("x", &l.x_m);
    value("y", &l.y_m);
    value("z", &l.z_m);
    value("intensity", &l.intensity);
    value("red", &l.color.r);
    value("green", &l.color.g);
    value("blue", &l.color.b);
    value("medium", &l.medium);
  });
  in_parts(s.sounds, [&](std::size_t begin, std::span<const std::uint32_t> numbers) {
    Rows rows(visitor, ValueOwner::Sound, numbers);
    const SoundSource& p = s.sounds[begin];
    const auto value = [&](std::string_view field, const auto* first) { rows.value("sound", field, first, sizeof p); };
    value("x", &p.x_m);
    value("y", &p.y_m);
    value("z", &p.z_m);
    value("level", &p.level);
  });
}

void visit_world(const StateView& state, StateVisitor& visitor) {
  const SpaceStores& s = state.stores;
  const std::uint32_t number = 0;
  Rows rows(visitor, ValueOwner::World, {&number, 1});
  const auto value = [&](std::string_view field, std::uint64_t at) {
    const auto bits = static_cast<std::int64_t>(at);
    rows.value("world", field, &bits);
  };
  value("seed", state.seed);
  value("tick", static_cast<std::uint64_t>(state.tick));
  value("robots", s.robots.size());  // decides what numbers the next one draws
  value("objects", s.objects.size());
  value("lights", s.lights.size());
  value("sounds", s.sounds.size());
  for (const Fields::Entry& entry : s.fields.all()) {
    value(entry.name, entry.field->mark());
    value("repaint_" + entry.name, entry.field->unpainted() ? 1 : 0);
  }
}

}  // namespace

void visit_state(const StateView& state, StateVisitor& visitor) {
  visit_world(state, visitor);
  for (std::size_t block = 0; block < state.stores.blocks.size(); ++block) visit_block(state, block, visitor);
  visit_objects(state.stores, visitor);
  visit_joints(state.stores, visitor);
  visit_sources(state.stores, visitor);
}

// --- in words ---

namespace {

template <class T>
std::string text_of(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  char digits[40];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

std::string text_of(Scalar scalar, const std::byte* at) {
  switch (scalar) {
    case Scalar::F32:
      return text_of<float>(at);
    case Scalar::F64:
      return text_of<double>(at);
    case Scalar::U8:
    case Scalar::Bool:
      return text_of<std::uint8_t>(at);
    case Scalar::U16:
      return text_of<std::uint16_t>(at);
    case Scalar::U32:
      return text_of<std::uint32_t>(at);
    case Scalar::I32:
      return text_of<std::int32_t>(at);
    case Scalar::I64:
      return text_of<std::int64_t>(at);
  }
  return {};
}

std::string name_of(const SpaceStores& s, ValueOwner owner, std::uint32_t number) {
  switch (owner) {
    case ValueOwner::World:
      return "world";
    case ValueOwner::Robot: {
      const RobotEntity& e = s.robots[number];
      return "robot " + s.names[e.item].prefix + (e.number < 0 ? "" : std::to_string(e.number));
    }
    case ValueOwner::Object:
      return "object " + s.objects[number].id;
    case ValueOwner::Joint:
      return "joint " + std::to_string(number);
    case ValueOwner::Light:
      return "light " + s.lights[number].id;
    case ValueOwner::Sound:
      return "sound " + s.sounds[number].id;
  }
  return {};
}

class InWords final : public StateVisitor {
 public:
  explicit InWords(const SpaceStores& stores) : stores_(stores) {}

  void begin(const ValueOwners& owners) override { owners_ = owners; }
  void visit(const FieldRows& rows) override {
    static constexpr std::array<std::byte, 8> kZeros{};
    const std::size_t size = hal::size_of(rows.scalar);
    const std::string what = (rows.set == ValueSet::Sensor      ? "sensor "
                              : rows.set == ValueSet::Actuator  ? "actuator "
                              : rows.set == ValueSet::Published ? "controller "
                                                                : "") +
                             std::string(rows.name);
    for (std::size_t i = 0; i < owners_.numbers.size(); ++i) {
      if (owners_.numbers[i] == ValueOwners::kNobody) continue;
      const std::size_t used = rows.used == nullptr ? rows.count : rows.used[i];
      for (std::size_t k = 0; k < used; ++k) {
        const std::byte* at = rows.first + i * rows.stride + k * size;
        const std::byte* initial = rows.initial == nullptr ? kZeros.data() : rows.initial + k * size;
        if (std::memcmp(at, initial, size) == 0) continue;
        std::string field(rows.field);
        if (rows.count > 1) field += "[" + std::to_string(k) + "]";
        found_.push_back(
            {owners_.kind,
             owners_.numbers[i],
             {name_of(stores_, owners_.kind, owners_.numbers[i]), what, std::move(field), text_of(rows.scalar, at)}});
      }
    }
  }

  std::vector<StateValue> take() {
    std::stable_sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) {
      return std::pair(a.owner, a.number) < std::pair(b.owner, b.number);
    });
    std::vector<StateValue> values;
    values.reserve(found_.size());
    for (Found& one : found_) values.push_back(std::move(one.value));
    return values;
  }

 private:
  struct Found {
    ValueOwner owner;
    std::uint32_t number;
    StateValue value;
  };
  const SpaceStores& stores_;
  ValueOwners owners_;
  std::vector<Found> found_;
};

std::string key_of(const StateValue& v) {
  return v.who + '\n' + v.what + '\n' + v.field;
}

}  // namespace

std::vector<StateValue> state_values(const StateView& state) {
  InWords in_words(state.stores);
  visit_state(state, in_words);
  return in_words.take();
}

std::vector<StateDifference> differences(const std::vector<StateValue>& a, const std::vector<StateValue>& b) {
  std::unordered_map<std::string, const StateValue*> others;
  others.reserve(b.size());
  for (const StateValue& value : b) others.emplace(key_of(value), &value);
  std::vector<StateDifference> found;
  for (const StateValue& value : a) {
    const auto other = others.find(key_of(value));
    const std::string there = other == others.end() ? "" : other->second->value;
    if (other != others.end()) others.erase(other);
    if (there != value.value) found.push_back({value.who, value.what, value.field, value.value, there});
  }
  for (const StateValue& value : b) {
    if (others.contains(key_of(value))) found.push_back({value.who, value.what, value.field, "", value.value});
  }
  return found;
}

}  // namespace tandem::core
