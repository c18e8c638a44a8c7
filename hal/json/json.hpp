// JSON: values in the order in which they were added, to text and back.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iosfwd>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/result.hpp"

namespace tandem::hal {

/// A member that is missing, or a value of another type than was asked for.
class JsonError final : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a text can be made of.
template <class T>
concept TextLike = std::convertible_to<const T&, std::string_view> && !std::same_as<T, std::nullptr_t>;

/// One JSON value. Members of objects keep their order; looking one up compares names one by one. The functions that
/// read a value as a type throw JsonError where it is none of it.
class Json {
 public:
  template <class Of>
  class Iterator;
  template <class Of>
  struct Member;
  template <class Of>
  class Items;

  // NOLINTBEGIN(google-explicit-constructor): `json["speed"] = 0.1`
  Json() noexcept = default;
  Json(std::nullptr_t) noexcept {}
  template <std::same_as<bool> T>
  Json(T value) noexcept : type_(Type::Boolean), value_{.boolean = value} {}
  template <std::signed_integral T>
  Json(T value) noexcept : type_(Type::Integer), value_{.integer = value} {}
  template <std::unsigned_integral T>
  requires(!std::same_as<T, bool>) Json(T value)
  noexcept : type_(Type::Unsigned), value_{.whole = value} {}
  template <std::floating_point T>
  Json(T value) noexcept : type_(Type::Number), value_{.number = static_cast<double>(value)} {}
  template <TextLike T>
  Json(const T& text) : type_(Type::Text), value_{.text = new_text(std::string_view(text))} {}
  template <std::same_as<std::string> T>
  Json(T&& text) : type_(Type::Text), value_{.text = new_text(std::move(text))} {}
  /// An array of a container's values, or an object of a map's.
  template <class T>
  requires(!std::same_as<T, Json> && !TextLike<T> && requires(const T& all) { all.begin() != all.end(); })
      Json(const T& all)
      : Json(array()) {
    if constexpr (requires { typename T::mapped_type; }) {
      *this = object();
      for (const auto& [name, value] : all) (*this)[name] = value;
    } else {
      for (const auto& value : all) emplace_back(value);
    }
  }
  /// An object, if each of the values is an array of two, a text first; else an array.
  Json(std::initializer_list<Json> values);
  // NOLINTEND(google-explicit-constructor)

  Json(const Json& other);
  Json(Json&& other) noexcept : type_(other.type_), value_(other.value_) { other.type_ = Type::Null; }
  Json& operator=(Json other) noexcept {
    std::swap(type_, other.type_);
    std::swap(value_, other.value_);
    return *this;
  }
  ~Json() {
    if (type_ >= Type::Text) destroy();
  }

  static Json array();
  static Json array(std::initializer_list<Json> values);
  static Json object();

  bool is_null() const noexcept { return type_ == Type::Null; }
  bool is_boolean() const noexcept { return type_ == Type::Boolean; }
  bool is_number() const noexcept { return type_ >= Type::Integer && type_ <= Type::Number; }
  bool is_number_integer() const noexcept { return type_ == Type::Integer || type_ == Type::Unsigned; }
  bool is_number_unsigned() const noexcept { return type_ == Type::Unsigned; }
  bool is_string() const noexcept { return type_ == Type::Text; }
  bool is_array() const noexcept { return type_ == Type::Array; }
  bool is_object() const noexcept { return type_ == Type::Object; }
  /// "null", "boolean", "number", "string", "array", "object".
  const char* type_name() const noexcept;

  /// Of arrays and objects; 0 of null, 1 of anything else.
  std::size_t size() const noexcept;
  bool empty() const noexcept { return size() == 0; }

  /// Texts, numbers (of each other's types, too), booleans, and of these std::vector, std::array and maps by name.
  template <class T>
  T get() const;
  /// The text itself.
  const std::string& text() const;

  /// The member; an object gets it where it has none, as null is made an object.
  Json& operator[](std::string_view name);
  /// It must be there.
  const Json& operator[](std::string_view name) const;
  /// The element; null is made an array, and an array is filled up with null.
  template <std::integral T>
  Json& operator[](T index) {
    return element(static_cast<std::size_t>(index));
  }
  /// It must be there.
  template <std::integral T>
  const Json& operator[](T index) const {
    return element(static_cast<std::size_t>(index));
  }
  const Json& at(std::string_view name) const;  ///< @throws JsonError: there is none
  Json& at(std::string_view name) { return const_cast<Json&>(std::as_const(*this).at(name)); }
  template <std::integral T>
  const Json& at(T index) const {  ///< @throws JsonError: there is none
    return element_at(static_cast<std::size_t>(index));
  }
  bool contains(std::string_view name) const noexcept { return find_member(name) != nullptr; }
  /// The member's value, or `otherwise` where there is none.
  template <class T>
  T value(std::string_view name, const T& otherwise) const {
    const Json* found = member(name);
    return found != nullptr ? found->template get<T>() : otherwise;
  }
  std::string value(std::string_view name, const char* otherwise) const;

  void push_back(Json value);
  /// To an object: the member {name, value}.
  void push_back(std::initializer_list<Json> value);
  template <class... T>
  Json& emplace_back(T&&... value) {
    push_back(Json(std::forward<T>(value)...));
    return back();
  }
  void update(const Json& other);  ///< all members of another object, over those of the same name
  void erase(std::string_view name);
  Json& back();
  const Json& back() const;
  const Json& front() const;

  /// The elements of an array, the values of an object; of null none, of anything else itself.
  Iterator<Json> begin() noexcept;
  Iterator<Json> end() noexcept;
  Iterator<const Json> begin() const noexcept;
  Iterator<const Json> end() const noexcept;
  /// end(): there is no such member, or this is no object.
  Iterator<Json> find(std::string_view name) noexcept;
  Iterator<const Json> find(std::string_view name) const noexcept;
  /// The members of an object, of anything else none: `for (const auto& [name, value] : json.items())`.
  Items<Json> items() & noexcept;
  Items<const Json> items() const& noexcept;
  void items() const&& = delete;  // a loop would outlive it

  /// Numbers are compared as such: 1 is 1.0.
  friend bool operator==(const Json& a, const Json& b) noexcept;
  template <TextLike T>
  friend bool operator==(const Json& a, const T& text) noexcept {
    return a.is_text(text);
  }

 private:
  friend struct JsonAccess;
  enum class Type : std::uint8_t { Null, Boolean, Integer, Unsigned, Number, Text, Array, Object };
  struct Members;
  union Value {
    bool boolean;
    std::int64_t integer;
    std::uint64_t whole;
    double number;
    std::string* text;
    std::vector<Json>* elements;
    Members* members;
  };

  static std::string* new_text(std::string_view text);
  static std::string* new_text(std::string&& text);
  void destroy() noexcept;
  [[noreturn]] void fail_type(const char* wanted) const;
  Json taken() const noexcept;
  bool is_text(std::string_view text) const noexcept;
  const std::vector<Json>* values() const noexcept;
  const Json* find_member(std::string_view name) const noexcept;
  const Json* member(std::string_view name) const;
  Json& element(std::size_t index);
  const Json& element(std::size_t index) const;
  const Json& element_at(std::size_t index) const;
  bool as_boolean() const;
  double as_number() const;
  std::int64_t as_integer() const;
  std::uint64_t as_whole() const;
  std::size_t length() const;

  // Mutable, for the elements of a list are constant, and are moved out of it.
  mutable Type type_ = Type::Null;
  Value value_{};
};

struct Json::Members {
  std::vector<Json> values;
  std::vector<std::string> names;
};

template <class Of>
struct Json::Member {
  const std::string& name;
  Of& value;
};

template <class Of>
class Json::Iterator {
 public:
  using iterator_category = std::forward_iterator_tag;
  using value_type = Json;
  using difference_type = std::ptrdiff_t;
  using pointer = Of*;
  using reference = Of&;

  Iterator() = default;
  explicit Iterator(Of* at) : at_(at) {}
  reference operator*() const noexcept { return *at_; }
  pointer operator->() const noexcept { return at_; }
  Iterator& operator++() noexcept {
    ++at_;
    return *this;
  }
  Iterator operator++(int) noexcept { return Iterator(at_++); }
  bool operator==(const Iterator&) const = default;

 private:
  Of* at_ = nullptr;
};

template <class Of>
class Json::Items {
 public:
  struct Place {
    const std::string* name;
    Of* value;
    Member<Of> operator*() const noexcept { return {*name, *value}; }
    Place& operator++() noexcept {
      ++name;
      ++value;
      return *this;
    }
    bool operator==(const Place&) const = default;
  };

  Items(const std::string* names, Of* values, std::size_t count) : names_(names), values_(values), count_(count) {}
  Place begin() const noexcept { return {names_, values_}; }
  Place end() const noexcept { return {names_ + count_, values_ + count_}; }

 private:
  const std::string* names_;
  Of* values_;
  std::size_t count_;
};

template <class T>
T Json::get() const {
  if constexpr (std::same_as<T, Json>) {
    return *this;
  } else if constexpr (std::same_as<T, std::string>) {
    return text();
  } else if constexpr (std::same_as<T, bool>) {
    return as_boolean();
  } else if constexpr (std::floating_point<T>) {
    return static_cast<T>(as_number());
  } else if constexpr (std::signed_integral<T>) {
    return static_cast<T>(as_integer());
  } else if constexpr (std::unsigned_integral<T>) {
    return static_cast<T>(as_whole());
  } else {
    T all{};
    if constexpr (requires { typename T::mapped_type; }) {
      if (!is_object()) fail_type("object");
      for (const auto& [name, value] : items()) all.emplace(name, value.template get<typename T::mapped_type>());
    } else if constexpr (requires { all.emplace_back(); }) {
      for (std::size_t i = 0, count = length(); i < count; ++i)
        all.push_back(element_at(i).template get<typename T::value_type>());
    } else {
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = element_at(i).template get<typename T::value_type>();
    }
    return all;
  }
}

/// One line without a line end; with `indent`, a line for each value, indented by so many blanks a level. Bytes that
/// are no UTF-8 become U+FFFD, numbers that JSON cannot hold (NaN, infinity) null.
std::string to_text(const Json& json, int indent = -1);
std::ostream& operator<<(std::ostream& out, const Json& json);

/// That to_text keeps each byte of it.
bool is_utf8(std::string_view text);

/// One value. Errors: no JSON, with the place.
Result<Json> parse_json(std::string_view text);

/// One object. Errors: no JSON, with the place; no object; a name that stands twice.
Result<Json> parse_json_object(std::string_view text);

}  // namespace tandem::hal
