// Controls: values that people change while a run goes on, and buttons that they press, as a controller or a hook
// declares them.
//
//   void controls(hal::Controls& c) override {
//     c.number("cruise", cruise_m_s_, unit::cm_s, {0.0, 0.5}, "Speed on free ground.");
//     if (c.button("turn round", "Goes back the way it came.")) turn_round();
//   }
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "hal/params.hpp"

namespace tandem::hal {

/// Shows controls, or changes one of them: one function declares them for both. Names are unique within an owner.
/// Every function returns whether this call has changed the value, or pressed the button: whoever keeps something that
/// follows from a value brings it up to date then.
class Controls {
 public:
  virtual ~Controls() = default;

  /// A slider. `shown` is the unit in which people see it; both ends of the range are finite.
  virtual bool number(std::string_view name, double& value_si, const Unit& shown, Range range_si,
                      std::string_view doc) = 0;
  virtual bool integer(std::string_view name, std::int64_t& value, Range range, std::string_view doc) = 0;
  virtual bool flag(std::string_view name, bool& value, std::string_view doc) = 0;
  /// `value` is one of `options`.
  virtual bool choice(std::string_view name, std::string& value, std::span<const std::string_view> options,
                      std::string_view doc) = 0;
  virtual bool text(std::string_view name, std::string& value, std::string_view doc) = 0;
  virtual bool button(std::string_view name, std::string_view doc) = 0;
};

}  // namespace tandem::hal
