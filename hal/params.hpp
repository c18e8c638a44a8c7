// Parameters: described once, read, checked, printed and documented by visitors of that one description.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "hal/unit.hpp"

namespace tandem::hal {

/// Closed interval in SI (for numbers) or of the integer itself.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// Interval of an error, in SI: in a file "-0.1:0.2", or one number x for -x:x.
struct Interval {
  double least = 0.0, most = 0.0;
  /// -x:x
  static constexpr Interval around(double x) noexcept { return {-x, x}; }
  constexpr bool empty() const noexcept { return least == 0.0 && most == 0.0; }
  /// At `part` of its half from its middle, which is in [-1, 1).
  constexpr double at(double part) const noexcept { return 0.5 * (least + most) + 0.5 * (most - least) * part; }
};

inline constexpr Range kAny{};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity()};

class ParamVisitor;

/// A struct whose `describe(ParamVisitor&)` spells its parameters.
template <class T>
concept Described = requires(T t, ParamVisitor& v) {
  t.describe(v);
};

/// A struct of which one element of a file may stand for several: `T::add_to(list, v)` describes such an element to `v`
/// and appends what it stands for. Others are described one by one.
template <class T>
concept AddedInGroups = requires(std::vector<T>& list, ParamVisitor& v) {
  T::add_to(list, v);
};

/// A list of described structs, for visitors that do not know their type.
class ParamList {
 public:
  virtual ~ParamList() = default;
  virtual std::size_t size() const = 0;
  virtual void describe(std::size_t index, ParamVisitor& visitor) = 0;
  virtual void clear() = 0;
  /// Appends what an element stands for, which is one unless the class says otherwise, and describes it to `visitor`.
  virtual void add(ParamVisitor& visitor) = 0;
  /// Describes one with its defaults that is in no list.
  virtual void describe_default(ParamVisitor& visitor) const = 0;
};

/// One described value: what it is called, where it is, what it may be, what it means.
struct Param {
  struct Choice {
    std::string* value;
    std::span<const std::string_view> options;
  };
  struct Group {
    void* value;
    void (*describe)(void* value, ParamVisitor& visitor);  ///< the inner struct, to any visitor
  };
  std::string_view name;
  std::variant<double*, std::int64_t*, bool*, std::string*, Choice, std::array<double, 3>*, Group, ParamList*,
               Interval*>
      value;
  std::string_view doc;
  const Unit* bare = &unit::none;  ///< of a number, a vector and an interval
  Range range = kAny;              ///< of a number, an integer and an interval's ends

  /// Null: it is something else.
  template <class T>
  T* as() const noexcept {
    const auto* const found = std::get_if<T*>(&value);
    return found == nullptr ? nullptr : *found;
  }
  /// The value of a text, or of a choice.
  std::string* text() const noexcept {
    const auto* const choice = std::get_if<Choice>(&value);
    return choice != nullptr ? choice->value : as<std::string>();
  }
  const Group* group() const noexcept { return std::get_if<Group>(&value); }
  ParamList* list() const noexcept { return as<ParamList>(); }
};

/// One visitor, many uses: the reader of experiment files fills the values in, the manual prints them, the report saves
/// them. A value that is absent keeps what it has: the in-class initialiser is the default.
class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;
  virtual void visit(const Param& param) = 0;
  /// Of what visitors are handed, for the surfaces of plug-ins.
  static constexpr std::uint64_t digest() noexcept { return sizeof(Param); }

  /// A real number. `value_si` in SI; `bare` is the unit of a number written without suffix.
  void number(std::string_view name, double& value_si, const Unit& bare, Range range_si, std::string_view doc) {
    visit({name, &value_si, doc, &bare, range_si});
  }
  void integer(std::string_view name, std::int64_t& value, Range range, std::string_view doc) {
    visit({name, &value, doc, &unit::none, range});
  }
  void flag(std::string_view name, bool& value, std::string_view doc) { visit({name, &value, doc}); }
  void text(std::string_view name, std::string& value, std::string_view doc) { visit({name, &value, doc}); }
  /// `value` is one of `options`.
  void choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
              std::string_view doc) {
    visit({name, Param::Choice{&value, options}, doc});
  }
  /// "x,y,z", each in `bare`.
  void vector(std::string_view name, std::array<double, 3>& value_si, const Unit& bare, std::string_view doc) {
    visit({name, &value_si, doc, &bare});
  }
  /// An error that lies between two values.
  void interval(std::string_view name, Interval& value_si, const Unit& bare, std::string_view doc,
                Range range_si = kAny) {
    visit({name, &value_si, doc, &bare, range_si});
  }
  /// A struct within the struct: in a file, the attributes of a child element `name`, of which there is one at most.
  template <Described T>
  void group(std::string_view name, T& value, std::string_view doc) {
    visit({name,
           Param::Group{&value, [](void* described, ParamVisitor& v) { static_cast<T*>(described)->describe(v); }},
           doc});
  }
  /// Any number of structs: in a file, one child element `name` each, in their order. A file that has any replaces the
  /// whole list.
  template <Described T>
  void list(std::string_view name, std::vector<T>& values, std::string_view doc) {
    struct Typed final : ParamList {
      std::vector<T>& all;
      explicit Typed(std::vector<T>& v) : all(v) {}
      std::size_t size() const override { return all.size(); }
      void describe(std::size_t index, ParamVisitor& visitor) override { all[index].describe(visitor); }
      void clear() override { all.clear(); }
      void add(ParamVisitor& visitor) override {
        if constexpr (AddedInGroups<T>)
          T::add_to(all, visitor);
        else
          all.emplace_back().describe(visitor);
      }
      void describe_default(ParamVisitor& visitor) const override {
        std::vector<T> none;
        Typed(none).add(visitor);
      }
    } typed(values);
    visit({name, static_cast<ParamList*>(&typed), doc});
  }
};

}  // namespace tandem::hal
