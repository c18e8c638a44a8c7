#include "hal/published.hpp"

#include <cmath>

namespace tandem::hal {
namespace {

Field field_of(const PublishedField& field) {
  Field f;
  f.offset = field.offset;
  f.scalar = field.scalar;
  f.count = field.count;
  return f;
}

std::string element_text(const PublishedField& field, double value) {
  if (field.texts.empty()) return format_number(value);
  const auto number = static_cast<std::size_t>(value);
  return value >= 0.0 && number < field.texts.size() ? field.texts[number] : format_number(value);
}

}  // namespace

bool PublishedField::operator==(const PublishedField& other) const noexcept {
  return name == other.name && offset == other.offset && scalar == other.scalar && count == other.count &&
         unit.symbol == other.unit.symbol && texts == other.texts;
}

double value_of(const PublishedField& field, const void* controller, std::size_t index) noexcept {
  return get_value(controller, field_of(field), index);
}

std::string text_of(const PublishedField& field, const void* controller) {
  std::string text;
  for (std::size_t i = 0; i < field.count; ++i)
    text += (i == 0 ? "" : " ") + element_text(field, value_of(field, controller, i));
  if (field.count != 1) text = "[" + text + "]";
  if (!field.unit.symbol.empty()) text += " " + std::string(field.unit.symbol);
  return text;
}

std::size_t size_of(const PublishedField& field) noexcept {
  return size_of(field.scalar) * field.count;
}

}  // namespace tandem::hal
