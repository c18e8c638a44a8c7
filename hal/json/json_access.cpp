#include "hal/json/json_access.hpp"

#include <cmath>

namespace tandem::hal {
namespace {

double number_or(const Json* json, double otherwise) {
  if (json == nullptr || !json->is_number()) return otherwise;
  const auto value = json->get<double>();
  return std::isfinite(value) ? value : otherwise;
}

}  // namespace

const Json* member_of(const Json& json, const char* key) {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(key);
  return found == json.end() ? nullptr : &*found;
}

std::string text_of(const Json& json, const char* key, std::string_view otherwise) {
  const Json* const found = member_of(json, key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string(otherwise);
}

double number_of(const Json& json, const char* key, double otherwise) {
  return number_or(member_of(json, key), otherwise);
}

std::int64_t whole_of(const Json& json, const char* key, std::int64_t otherwise) {
  const Json* const found = member_of(json, key);
  return found != nullptr && found->is_number_integer() ? found->get<std::int64_t>() : otherwise;
}

std::uint64_t count_of(const Json& json, const char* key, std::uint64_t otherwise) {
  const Json* const found = member_of(json, key);
  return found != nullptr && found->is_number_unsigned() ? found->get<std::uint64_t>() : otherwise;
}

bool flag_of(const Json& json, const char* key) {
  const Json* const found = member_of(json, key);
  return found != nullptr && found->is_boolean() && found->get<bool>();
}

const Json& list_of(const Json& json, const char* key) {
  static const Json kNone = Json::array();
  const Json* const found = member_of(json, key);
  return found != nullptr && found->is_array() ? *found : kNone;
}

const Json& object_of(const Json& json, const char* key) {
  static const Json kNone = Json::object();
  const Json* const found = member_of(json, key);
  return found != nullptr && found->is_object() ? *found : kNone;
}

std::vector<std::string> texts_of(const Json& json, const char* key) {
  std::vector<std::string> texts;
  for (const Json& text : list_of(json, key))
    texts.push_back(text.is_string() ? text.get<std::string>() : std::string());
  return texts;
}

double item_of(const Json& list, std::size_t index, double otherwise) {
  return list.is_array() && index < list.size() ? number_or(&list[index], otherwise) : otherwise;
}

}  // namespace tandem::hal
