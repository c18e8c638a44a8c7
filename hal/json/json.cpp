#include "hal/json/json.hpp"

#include <algorithm>

#include "hal/check.hpp"

namespace tandem::hal {
namespace {

[[noreturn]] void fail(const std::string& why) {
  throw JsonError(why);
}

}  // namespace

Json::Json(std::initializer_list<Json> values) {
  const bool members = std::all_of(values.begin(), values.end(), [](const Json& one) {
    return one.is_array() && one.size() == 2 && one.front().is_string();
  });
  if (!members) {
    *this = array(values);
    return;
  }
  *this = object();
  for (const Json& one : values) {
    std::vector<Json>& pair = *one.value_.elements;
    if (find_member(*pair[0].value_.text) != nullptr) continue;  // the first one stays
    value_.members->names.push_back(std::move(*pair[0].value_.text));
    value_.members->values.push_back(std::move(pair[1]));
  }
}

Json::Json(const Json& other) : type_(other.type_), value_(other.value_) {
  if (type_ == Type::Text) value_.text = new std::string(*other.value_.text);
  if (type_ == Type::Array) value_.elements = new std::vector<Json>(*other.value_.elements);
  if (type_ == Type::Object) value_.members = new Members(*other.value_.members);
}

// Values in values are taken out first: texts of others may be a hundred thousand arrays deep.
void Json::destroy() noexcept {
  std::vector<Json> inner;
  const auto empty = [&inner](const Json& json) {
    if (json.type_ < Type::Array) return;
    for (Json& one : json.type_ == Type::Array ? *json.value_.elements : json.value_.members->values)
      if (one.type_ >= Type::Array && one.size() > 0) inner.push_back(std::move(one));
  };
  empty(*this);
  while (!inner.empty()) {
    const Json one = std::move(inner.back());
    inner.pop_back();
    empty(one);
  }
  if (type_ == Type::Text) delete value_.text;
  if (type_ == Type::Array) delete value_.elements;
  if (type_ == Type::Object) delete value_.members;
}

Json Json::array() {
  Json json;
  json.value_.elements = new std::vector<Json>;
  json.type_ = Type::Array;
  return json;
}

Json Json::array(std::initializer_list<Json> values) {
  Json json = array();
  json.value_.elements->reserve(values.size());
  for (const Json& one : values) json.value_.elements->push_back(one.taken());
  return json;
}

Json Json::object() {
  Json json;
  json.value_.members = new Members;
  json.type_ = Type::Object;
  return json;
}

const char* Json::type_name() const noexcept {
  switch (type_) {
    case Type::Null:
      return "null";
    case Type::Boolean:
      return "boolean";
    case Type::Text:
      return "string";
    case Type::Array:
      return "array";
    case Type::Object:
      return "object";
    default:
      return "number";
  }
}

std::size_t Json::size() const noexcept {
  const std::vector<Json>* all = values();
  return all != nullptr ? all->size() : type_ == Type::Null ? 0 : 1;
}

const std::string& Json::text() const {
  if (!is_string()) fail_type("string");
  return *value_.text;
}

Json& Json::operator[](std::string_view name) {
  if (is_null()) *this = object();
  if (!is_object()) fail(std::string("a ") + type_name() + " has no members");
  if (const Json* found = find_member(name)) return const_cast<Json&>(*found);
  value_.members->names.emplace_back(name);
  return value_.members->values.emplace_back();
}

const Json& Json::operator[](std::string_view name) const {
  const Json* found = member(name);
  TANDEM_CHECK(found != nullptr, "a member that is read must be there");
  return *found;
}

const Json& Json::at(std::string_view name) const {
  const Json* found = member(name);
  if (found == nullptr) fail("key '" + std::string(name) + "' not found");
  return *found;
}

std::string Json::value(std::string_view name, const char* otherwise) const {
  const Json* found = member(name);
  return found != nullptr ? found->text() : std::string(otherwise);
}

void Json::push_back(Json value) {
  if (is_null()) *this = array();
  if (!is_array()) fail(std::string("nothing can be added to a ") + type_name());
  value_.elements->push_back(std::move(value));
}

void Json::push_back(std::initializer_list<Json> value) {
  if (is_object() && value.size() == 2 && value.begin()->is_string())
    (*this)[value.begin()->text()] = value.begin()[1].taken();
  else
    push_back(Json(value));
}

void Json::update(const Json& other) {
  if (!other.is_object()) other.fail_type("object");
  if (is_null()) *this = object();
  for (const auto& [name, value] : other.items()) (*this)[name] = value;
}

void Json::erase(std::string_view name) {
  if (!is_object()) fail_type("object");
  const Json* found = find_member(name);
  if (found == nullptr) return;
  const auto index = found - value_.members->values.data();
  value_.members->values.erase(value_.members->values.begin() + index);
  value_.members->names.erase(value_.members->names.begin() + index);
}

Json& Json::back() {
  return const_cast<Json&>(std::as_const(*this).back());
}
const Json& Json::back() const {
  TANDEM_CHECK(!empty(), "there must be a last value");
  return values() != nullptr ? values()->back() : *this;
}
const Json& Json::front() const {
  TANDEM_CHECK(!empty(), "there must be a first value");
  return values() != nullptr ? values()->front() : *this;
}

Json::Iterator<const Json> Json::begin() const noexcept {
  return Iterator<const Json>(values() != nullptr ? values()->data() : this);
}
Json::Iterator<const Json> Json::end() const noexcept {
  return Iterator<const Json>((values() != nullptr ? values()->data() : this) + size());
}
Json::Iterator<Json> Json::begin() noexcept {
  return Iterator<Json>(const_cast<Json*>(std::as_const(*this).begin().operator->()));
}
Json::Iterator<Json> Json::end() noexcept {
  return Iterator<Json>(const_cast<Json*>(std::as_const(*this).end().operator->()));
}
Json::Iterator<const Json> Json::find(std::string_view name) const noexcept {
  const Json* found = find_member(name);
  return found != nullptr ? Iterator<const Json>(found) : end();
}
Json::Iterator<Json> Json::find(std::string_view name) noexcept {
  return Iterator<Json>(const_cast<Json*>(std::as_const(*this).find(name).operator->()));
}

Json::Items<Json> Json::items() & noexcept {
  if (!is_object()) return {nullptr, nullptr, 0};
  return {value_.members->names.data(), value_.members->values.data(), value_.members->values.size()};
}
Json::Items<const Json> Json::items() const& noexcept {
  if (!is_object()) return {nullptr, nullptr, 0};
  return {value_.members->names.data(), value_.members->values.data(), value_.members->values.size()};
}

bool operator==(const Json& a, const Json& b) noexcept {
  using Type = Json::Type;
  if (a.is_number() && b.is_number()) {
    if (a.type_ == Type::Number || b.type_ == Type::Number) return a.as_number() == b.as_number();
    return a.as_whole() == b.as_whole();
  }
  if (a.type_ != b.type_) return false;
  switch (a.type_) {
    case Type::Boolean:
      return a.value_.boolean == b.value_.boolean;
    case Type::Text:
      return *a.value_.text == *b.value_.text;
    case Type::Array:
      return *a.value_.elements == *b.value_.elements;
    case Type::Object:
      return a.value_.members->names == b.value_.members->names && a.value_.members->values == b.value_.members->values;
    default:
      return true;
  }
}

std::string* Json::new_text(std::string_view text) {
  return new std::string(text);
}
std::string* Json::new_text(std::string&& text) {
  return new std::string(std::move(text));
}

void Json::fail_type(const char* wanted) const {
  fail(std::string("type must be ") + wanted + ", but is " + type_name());
}

Json Json::taken() const noexcept {
  Json json;
  json.type_ = std::exchange(type_, Type::Null);
  json.value_ = value_;
  return json;
}

bool Json::is_text(std::string_view text) const noexcept {
  return is_string() && *value_.text == text;
}

const std::vector<Json>* Json::values() const noexcept {
  if (is_array()) return value_.elements;
  return is_object() ? &value_.members->values : nullptr;
}

const Json* Json::find_member(std::string_view name) const noexcept {
  if (!is_object()) return nullptr;
  const std::vector<std::string>& names = value_.members->names;
  const auto found = std::find(names.begin(), names.end(), name);
  return found != names.end() ? &value_.members->values[static_cast<std::size_t>(found - names.begin())] : nullptr;
}

const Json* Json::member(std::string_view name) const {
  if (!is_object()) fail_type("object");
  return find_member(name);
}

Json& Json::element(std::size_t index) {
  if (is_null()) *this = array();
  if (!is_array()) fail_type("array");
  if (index >= value_.elements->size()) value_.elements->resize(index + 1);
  return (*value_.elements)[index];
}
const Json& Json::element(std::size_t index) const {
  if (!is_array()) fail_type("array");
  TANDEM_CHECK(index < value_.elements->size(), "an element that is read must be there");
  return (*value_.elements)[index];
}
const Json& Json::element_at(std::size_t index) const {
  if (!is_array()) fail_type("array");
  if (index >= value_.elements->size()) fail("array index " + std::to_string(index) + " is out of range");
  return (*value_.elements)[index];
}

bool Json::as_boolean() const {
  if (!is_boolean()) fail_type("boolean");
  return value_.boolean;
}
double Json::as_number() const {
  if (type_ == Type::Number) return value_.number;
  return type_ == Type::Unsigned ? static_cast<double>(value_.whole) : static_cast<double>(as_integer());
}
std::int64_t Json::as_integer() const {
  if (!is_number()) fail_type("number");
  return type_ == Type::Number ? static_cast<std::int64_t>(value_.number) : value_.integer;
}
std::uint64_t Json::as_whole() const {
  if (!is_number()) fail_type("number");
  return type_ == Type::Number ? static_cast<std::uint64_t>(value_.number) : value_.whole;
}
std::size_t Json::length() const {
  if (!is_array()) fail_type("array");
  return value_.elements->size();
}

}  // namespace tandem::hal
