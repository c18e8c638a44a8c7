// JSON out: objects and arrays written in order, correctly quoted.
#pragma once
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/unit.hpp"

namespace tandem::app {

/// Builds one JSON value. Numbers that JSON cannot hold (NaN, infinity) become null.
class Json {
 public:
  Json& begin_object() { return open('{'); }
  Json& end_object() { return close('}'); }
  Json& begin_array() { return open('['); }
  Json& end_array() { return close(']'); }
  Json& key(std::string_view name) {
    comma();
    quote(name);
    text_ += ": ";
    after_key_ = true;
    return *this;
  }
  Json& value(std::string_view v) {
    comma();
    quote(v);
    return *this;
  }
  Json& value(const char* v) { return value(std::string_view(v)); }
  Json& value(const std::string& v) { return value(std::string_view(v)); }
  Json& value(double v) {
    comma();
    text_ += std::isfinite(v) ? hal::format_number(v) : "null";
    return *this;
  }
  Json& value(bool v) {
    comma();
    text_ += v ? "true" : "false";
    return *this;
  }
  Json& value(std::int64_t v) {
    comma();
    text_ += std::to_string(v);
    return *this;
  }
  Json& value(std::uint64_t v) {
    comma();
    text_ += std::to_string(v);
    return *this;
  }
  template <class T>
  Json& field(std::string_view name, const T& v) {
    return key(name).value(v);
  }
  const std::string& text() const noexcept { return text_; }

 private:
  Json& open(char c) {
    comma();
    text_ += c;
    first_ = true;
    return *this;
  }
  Json& close(char c) {
    text_ += c;
    first_ = false;
    return *this;
  }
  void comma() {
    if (!first_ && !after_key_) text_ += ", ";
    first_ = false;
    after_key_ = false;
  }
  void quote(std::string_view v) {
    static constexpr char kHex[] = "0123456789abcdef";
    text_ += '"';
    for (const char c : v) {
      const auto u = static_cast<unsigned char>(c);
      if (c == '"' || c == '\\') {
        text_ += '\\';
        text_ += c;
      } else if (u < 0x20) {
        text_ += "\\u00";
        text_ += kHex[u >> 4];
        text_ += kHex[u & 15];
      } else {
        text_ += c;
      }
    }
    text_ += '"';
  }

  std::string text_;
  bool first_ = true;
  bool after_key_ = false;
};

}  // namespace tandem::app
