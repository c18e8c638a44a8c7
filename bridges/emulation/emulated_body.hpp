// Bodies of emulated robots: their interface, and the one that lives in another robot's ports.
#pragma once
#include <array>
#include <cstddef>

#include "bridges/port_bank.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

template <std::size_t n>
constexpr std::array<double, n> filled(double value) {
  std::array<double, n> a{};
  a.fill(value);
  return a;
}

/// A body for a firmware to live in. Times never decrease. All calls come from the thread that runs the firmware.
template <class SensesOfBody, class CommandOfBody>
class EmulatedBodyOf {
 public:
  using Senses = SensesOfBody;
  using Command = CommandOfBody;

  virtual ~EmulatedBodyOf() = default;
  virtual Senses sense(hal::TimeNs now) = 0;
  /// `command` holds from `now` until the next call.
  virtual void actuate(hal::TimeNs now, const Command& command) = 0;
};

/// A body that lives elsewhere: its senses are another robot's readings, its commands become that robot's. What that
/// does not measure is as the defaults of Senses say.
template <class Body, void (*read)(const PortBank&, typename Body::Senses&),
          void (*write)(PortBank&, const typename Body::Command&)>
class PortBodyOf : public Body {
 public:
  /// `ports` must outlive this.
  explicit PortBodyOf(SharedPorts& ports) : ports_(ports) {}

  typename Body::Senses sense(hal::TimeNs /*now*/) final {
    typename Body::Senses senses;
    ports_.with([&](const PortBank& bank) { read(bank, senses); });
    return senses;
  }
  void actuate(hal::TimeNs /*now*/, const typename Body::Command& command) final {
    ports_.with([&](PortBank& bank) { write(bank, command); });
  }

 protected:
  SharedPorts& ports_;
};

}  // namespace tandem::bridges
