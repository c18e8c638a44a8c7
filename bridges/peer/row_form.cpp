#include "bridges/peer/row_form.hpp"

#include <bit>
#include <cstring>

#include "hal/scalar_name.hpp"

namespace tandem::bridges::peer {

static_assert(std::endian::native == std::endian::little, "ports are copied as they lie in memory");

RowForm::RowForm(const hal::RowType& type) {
  for (const bool all_in_use : {true, false}) {
    for (const hal::Field& field : type.fields) {
      const hal::UsedBy by = hal::used_by(type, field);
      if ((by.field == nullptr) == all_in_use)
        parts_.push_back({&field, hal::size_of(field.scalar), by.field, by.per_entry});
    }
  }
  std::uint64_t hash = 14695981039346656037ULL;
  const auto mix = [&hash](std::string_view text) {
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  };
  mix(type.name);
  mix("\n");
  for (const Part& part : parts_) {
    mix(part.field->name);
    mix(":");
    mix(name_of(part.field->scalar));
    mix(":" + std::to_string(part.field->count) + ":");
    mix(part.used == nullptr ? std::string_view() : part.used->name);
    mix("\n");
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (int shift = 60; shift >= 0; shift -= 4) digest_ += kDigits[(hash >> shift) & 15U];
}

hal::Json RowForm::fields() const {
  hal::Json all = hal::Json::array();
  for (const Part& part : parts_) {
    all.push_back({std::string(part.field->name), std::string(name_of(part.field->scalar)), part.field->count,
                   part.used == nullptr ? std::string() : std::string(part.used->name), part.per_entry});
  }
  return all;
}

/// False: the row says that more is in use than there can be.
bool RowForm::in_use(const Part& part, const void* row, std::size_t& count) noexcept {
  count = part.field->count;
  if (part.used == nullptr) return true;
  const double entries = hal::get_value(row, *part.used, 0);
  if (!(entries >= 0.0) || entries * static_cast<double>(part.per_entry) > static_cast<double>(count)) return false;
  count = static_cast<std::size_t>(entries) * part.per_entry;
  return true;
}

void RowForm::pack(const void* row, std::vector<std::uint8_t>& out) const {
  for (const Part& part : parts_) {
    std::size_t count = 0;
    if (!in_use(part, row, count)) count = part.field->count;  // a row of our own that is full
    const auto* const first = static_cast<const std::uint8_t*>(row) + part.field->offset;
    out.insert(out.end(), first, first + count * part.bytes);
  }
}

bool RowForm::unpack(std::span<const std::uint8_t>& in, void* row) const noexcept {
  for (const Part& part : parts_) {
    std::size_t count = 0;
    if (!in_use(part, row, count) || in.size() < count * part.bytes) return false;
    auto* const first = static_cast<std::uint8_t*>(row) + part.field->offset;
    if (part.field->scalar == hal::Scalar::Bool) {
      for (std::size_t i = 0; i < count; ++i) first[i] = in[i] != 0 ? 1 : 0;
    } else {
      std::memcpy(first, in.data(), count * part.bytes);
    }
    in = in.subspan(count * part.bytes);
  }
  return true;
}

}  // namespace tandem::bridges::peer
