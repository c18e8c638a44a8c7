// Texts from and into JSON. Numbers and unusual texts are nlohmann's to spell, and all texts its to parse.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "hal/json/json.hpp"

namespace tandem::hal {

/// What writing reads and parsing fills beyond the interface.
struct JsonAccess {
  using Type = Json::Type;
  static Type type(const Json& json) { return json.type_; }
  static const Json::Value& value(const Json& json) { return json.value_; }
  /// The member of that name, made where there is none; says whether there was one.
  static std::pair<Json*, bool> member(Json& json, std::string&& name) {
    Json::Members& m = *json.value_.members;
    const auto found = std::find(m.names.begin(), m.names.end(), name);
    if (found != m.names.end()) return {&m.values[static_cast<std::size_t>(found - m.names.begin())], true};
    m.names.push_back(std::move(name));
    return {&m.values.emplace_back(), false};
  }
};

namespace {

using Type = JsonAccess::Type;

class Writer {
 public:
  Writer(std::string& out, int indent) : out_(out), indent_(indent) {}

  void write(const Json& json) {
    const auto& value = JsonAccess::value(json);
    switch (JsonAccess::type(json)) {
      case Type::Null:
        out_ += "null";
        return;
      case Type::Boolean:
        out_ += value.boolean ? "true" : "false";
        return;
      case Type::Integer:
        write_integer(value.integer);
        return;
      case Type::Unsigned:
        write_integer(value.whole);
        return;
      case Type::Number:
        write_number(value.number);
        return;
      case Type::Text:
        write_text(*value.text);
        return;
      case Type::Array:
        write_array(json);
        return;
      case Type::Object:
        write_object(json);
        return;
    }
  }

 private:
  void write_array(const Json& json) {
    if (json.empty()) {
      out_ += "[]";
      return;
    }
    char before = '[';
    ++level_;
    for (const Json& element : json) {
      begin_entry(std::exchange(before, ','));
      write(element);
    }
    --level_;
    begin_line();
    out_ += ']';
  }

  void write_object(const Json& json) {
    if (json.empty()) {
      out_ += "{}";
      return;
    }
    char before = '{';
    ++level_;
    for (const auto& [name, value] : json.items()) {
      begin_entry(std::exchange(before, ','));
      write_text(name);
      out_ += indent_ < 0 ? ":" : ": ";
      write(value);
    }
    --level_;
    begin_line();
    out_ += '}';
  }

  void begin_entry(char before) {
    out_ += before;
    begin_line();
  }
  void begin_line() {
    if (indent_ < 0) return;
    out_ += '\n';
    out_.append(static_cast<std::size_t>(indent_ * level_), ' ');
  }

  template <class Integer>
  void write_integer(Integer value) {
    std::array<char, 24> digits;
    out_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
  }

  void write_number(double value) {
    if (!std::isfinite(value)) {
      out_ += "null";
      return;
    }
    std::array<char, 64> digits;
    out_.append(digits.data(), nlohmann::detail::to_chars(digits.data(), digits.data() + digits.size(), value));
  }

  void write_text(const std::string& text) {
    const auto plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
    if (!std::all_of(text.begin(), text.end(), plain)) {
      out_ += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
      return;
    }
    out_ += '"';
    out_ += text;
    out_ += '"';
  }

  std::string& out_;
  int indent_;
  int level_ = 0;
};

/// Takes what the parser finds.
class Reader final : public nlohmann::json::json_sax_t {
 public:
  bool null() override { return add({}); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(std::int64_t value) override { return add(value); }
  bool number_unsigned(std::uint64_t value) override { return add(value); }
  bool number_float(double value, const std::string& /*as_written*/) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(nlohmann::json::binary_t& /*value*/) override { return false; }  // of other formats than text
  bool start_object(std::size_t /*size*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    const auto [member, there] = JsonAccess::member(*open_.back(), std::string(name));
    if (there) twice = name;
    member_ = member;
    return true;
  }
  bool parse_error(std::size_t /*position*/, const std::string& /*last*/,
                   const nlohmann::json::exception& problem) override {
    const std::string_view why = problem.what();  // "[json.exception.parse_error.101] parse error at …"
    const std::size_t bracket = why.find("] ");
    error = bracket == std::string_view::npos ? why : why.substr(bracket + 2);
    return false;
  }

  Json root;
  std::string error;
  std::string twice;  ///< a name that stands twice in one object

 private:
  /// The element that is being read last in an open container stays where it is: nothing is added beside it.
  Json* place(Json&& value) {
    if (open_.empty()) return &(root = std::move(value));
    if (open_.back()->is_array()) return &open_.back()->emplace_back(std::move(value));
    return &(*member_ = std::move(value));
  }
  bool add(Json&& value) {
    place(std::move(value));
    return true;
  }
  bool open(Json&& value) {
    open_.push_back(place(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::vector<Json*> open_;
  Json* member_ = nullptr;  ///< of the innermost object, whose value comes next
};

}  // namespace

std::string to_text(const Json& json, int indent) {
  std::string text;
  Writer(text, indent).write(json);
  return text;
}

std::ostream& operator<<(std::ostream& out, const Json& json) {
  return out << to_text(json);
}

bool is_utf8(std::string_view text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

Result<Json> parse_json(std::string_view text) {
  Reader reader;
  if (!nlohmann::json::sax_parse(text, &reader)) return Error{"it is no JSON: " + reader.error};
  return std::move(reader.root);
}

Result<Json> parse_json_object(std::string_view text) {
  Reader reader;
  if (!nlohmann::json::sax_parse(text, &reader)) return Error{"it is no JSON object: " + reader.error};
  if (!reader.twice.empty()) return Error{"it is no JSON object: the name \"" + reader.twice + "\" stands twice"};
  if (!reader.root.is_object()) return Error{"it is no JSON object, but a " + std::string(reader.root.type_name())};
  return std::move(reader.root);
}

}  // namespace tandem::hal
