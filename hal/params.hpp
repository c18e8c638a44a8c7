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
#include <vector>

#include "hal/unit.hpp"

namespace tandem::hal {

/// Closed interval in SI (for numbers) or of the integer itself.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
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

/// One visitor, many uses: the reader of experiment files fills the values in, the manual prints them, the report saves
/// them. A value that is absent keeps what it has: the in-class initialiser is the default.
class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;

  /// A real number. `value_si` in SI; `bare` is the unit of a number written without suffix.
  virtual void number(std::string_view name, double& value_si, const Unit& bare, Range range_si,
                      std::string_view doc) = 0;
  virtual void integer(std::string_view name, std::int64_t& value, Range range, std::string_view doc) = 0;
  virtual void flag(std::string_view name, bool& value, std::string_view doc) = 0;
  virtual void text(std::string_view name, std::string& value, std::string_view doc) = 0;
  /// `value` is one of `options`.
  virtual void choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
                      std::string_view doc) = 0;
  /// "x,y,z", each in `bare`.
  virtual void vector(std::string_view name, std::array<double, 3>& value_si, const Unit& bare,
                      std::string_view doc) = 0;

  /// A struct within the struct: in a file, the attributes of a child element `name`, of which there is one at most.
  template <Described T>
  void group(std::string_view name, T& value, std::string_view doc) {
    visit_group(
        name, &value, [](void* described, ParamVisitor& v) { static_cast<T*>(described)->describe(v); }, doc);
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
    visit_list(name, typed, doc);
  }

 protected:
  using Describe = void (*)(void* value, ParamVisitor& visitor);
  /// `describe(value, v)` describes the inner struct to any visitor.
  virtual void visit_group(std::string_view name, void* value, Describe describe, std::string_view doc) = 0;
  virtual void visit_list(std::string_view name, ParamList& list, std::string_view doc) = 0;
};

}  // namespace tandem::hal
