#include "hal/port.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::hal {
namespace {

template <class T>
T load(const std::byte* at) noexcept {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <class T>
void store(std::byte* at, double value) noexcept {
  const T typed = static_cast<T>(value);
  std::memcpy(at, &typed, sizeof typed);
}

bool is_float(Scalar scalar) noexcept {
  return scalar == Scalar::F32 || scalar == Scalar::F64;
}
bool is_stamp(const Field& field) noexcept {
  return field.name == "taken_ns" || field.name == "validity";
}

}  // namespace

namespace detail {

std::uint64_t layout_fingerprint(const RowType& type) noexcept {
  std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
  const auto mix = [&hash](std::uint64_t value) {
    for (int i = 0; i < 8; ++i) hash = (hash ^ ((value >> (8 * i)) & 0xFF)) * 1099511628211ULL;
  };
  const auto mix_text = [&mix](std::string_view text) {
    for (const char c : text) mix(static_cast<unsigned char>(c));
    mix(0x100);
  };
  mix_text(type.name);
  mix(type.size);
  mix(type.align);
  for (const Field& f : type.fields) {
    mix_text(f.name);
    mix(f.offset);
    mix(static_cast<std::uint64_t>(f.scalar));
    mix(f.count);
  }
  return hash;
}

}  // namespace detail

const Field* RowType::field(std::string_view field_name) const noexcept {
  for (const Field& f : fields) {
    if (f.name == field_name) return &f;
  }
  return nullptr;
}

std::string port_entry(std::string_view name, Role role) {
  return (role == Role::Sensor ? "sensor " : "actuator ") + std::string(name);
}

double get_value(const void* row, const Field& field, std::size_t index) noexcept {
  const std::byte* at = static_cast<const std::byte*>(row) + field.offset + index * size_of(field.scalar);
  switch (field.scalar) {
    case Scalar::F32:
      return static_cast<double>(load<float>(at));
    case Scalar::F64:
      return load<double>(at);
    case Scalar::U8:
    case Scalar::Bool:
      return load<std::uint8_t>(at);
    case Scalar::U16:
      return load<std::uint16_t>(at);
    case Scalar::U32:
      return load<std::uint32_t>(at);
    case Scalar::I32:
      return load<std::int32_t>(at);
    case Scalar::I64:
      return static_cast<double>(load<std::int64_t>(at));
  }
  return 0.0;
}

void set_value(void* row, const Field& field, std::size_t index, double value) noexcept {
  std::byte* at = static_cast<std::byte*>(row) + field.offset + index * size_of(field.scalar);
  switch (field.scalar) {
    case Scalar::F32:
      store<float>(at, value);
      break;
    case Scalar::F64:
      store<double>(at, value);
      break;
    case Scalar::U8:
      store<std::uint8_t>(at, value);
      break;
    case Scalar::Bool:
      store<std::uint8_t>(at, value != 0.0 ? 1.0 : 0.0);
      break;
    case Scalar::U16:
      store<std::uint16_t>(at, value);
      break;
    case Scalar::U32:
      store<std::uint32_t>(at, value);
      break;
    case Scalar::I32:
      store<std::int32_t>(at, value);
      break;
    case Scalar::I64:
      store<std::int64_t>(at, value);
      break;
  }
}

UsedBy used_by(const RowType& type, const Field& field) noexcept {
  if (field.used_by.empty()) return {};
  const Field* used = type.field(field.used_by);
  if (used == nullptr) return {};
  // A field may hold several scalars an entry; its first field of that length tells how many entries there can be.
  std::size_t capacity = field.count;
  for (const Field& f : type.fields) {
    if (f.used_by == field.used_by) capacity = std::min(capacity, f.count);
  }
  return {used, std::max<std::size_t>(1, field.count / capacity)};
}

std::size_t used_count(const UsedBy& used, const void* row, const Field& field) noexcept {
  if (used.field == nullptr) return field.count;
  const auto entries = static_cast<std::size_t>(std::max(0.0, get_value(row, *used.field, 0)));
  return std::min(field.count, entries * used.per_entry);
}

std::size_t used_count(const RowType& type, const void* row, const Field& field) noexcept {
  return used_count(used_by(type, field), row, field);
}

std::string to_text(const PortType& type, const void* port) {
  std::string text = std::string(type.name) + ":";
  for (const Field& f : type.fields) {
    const std::size_t n = used_count(type, port, f);
    text += " " + std::string(f.name) + "=";
    if (f.count > 1) text += "[";
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) text += " ";
      const double value = get_value(port, f, i);
      text += f.scalar == Scalar::F32 ? format_number(std::round(value * 1e6) / 1e6) : format_number(value);
    }
    if (f.count > 1) text += "]";
    if (!f.unit.symbol.empty()) text += " " + std::string(f.unit.symbol);
  }
  return text;
}

double max_difference(const PortType& type, const void* a, const void* b) noexcept {
  double largest = 0.0;
  for (const Field& f : type.fields) {
    if (is_stamp(f)) continue;
    const std::size_t n = used_count(type, a, f);
    if (n != used_count(type, b, f)) return std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double difference = std::fabs(get_value(a, f, i) - get_value(b, f, i));
      if (std::isnan(difference)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, difference);
    }
  }
  return largest;
}

bool all_finite(const PortType& type, const void* port) noexcept {
  for (const Field& f : type.fields) {
    if (!is_float(f.scalar)) continue;
    for (std::size_t i = 0; i < f.count; ++i) {
      if (!std::isfinite(get_value(port, f, i))) return false;
    }
  }
  return true;
}

void fuse(const PortType& type, void* real, const void* virtual_) noexcept {
  if (type.role != Role::Sensor) return;
  auto* real_stamp = static_cast<Reading*>(real);
  const auto* virtual_stamp = static_cast<const Reading*>(virtual_);
  if (virtual_stamp->validity == Validity::Absent) return;
  if (real_stamp->validity == Validity::Absent) {
    // Only fields that may come from the virtual side alone do; a device that is not there stays absent otherwise.
    bool any_virtual = false;
    for (const Field& f : type.fields)
      any_virtual = any_virtual || f.fusion == Fusion::Virtual || f.fusion == Fusion::Union;
    if (any_virtual) std::memcpy(real, virtual_, type.size);
    return;
  }
  for (const Field& f : type.fields) {
    if (is_stamp(f)) continue;
    if (f.fusion == Fusion::Real || f.fusion == Fusion::Union || f.fusion == Fusion::ByAngle) continue;
    const std::size_t count =
        f.fusion == Fusion::Virtual ? f.count : std::min(used_count(type, real, f), used_count(type, virtual_, f));
    for (std::size_t i = 0; i < count; ++i) {
      const double a = get_value(real, f, i);
      const double b = get_value(virtual_, f, i);
      const double fused = f.fusion == Fusion::Virtual  ? b
                           : f.fusion == Fusion::Nearer ? std::min(a, b)
                                                        : std::max(a, b);
      set_value(real, f, i, fused);
    }
  }
  if (type.merge != nullptr) type.merge(real, virtual_);
}

}  // namespace tandem::hal
