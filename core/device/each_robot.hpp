// Bases of devices that treat the robots of a block one by one, and errors that are one number.
#pragma once
#include <cstddef>
#include <string_view>

#include "core/device/describe.hpp"

namespace tandem::core {

/// What files call an error, and how large that of a noisy device is, in SI.
struct ErrorText {
  std::string_view name;
  double noisy;
  const hal::Unit& unit;
  hal::Range range;
  std::string_view doc;
};

/// The errors of a device that has one.
template <const ErrorText& kText>
struct OneError {
  double amount = 0.0;
  static OneError noisy() { return {kText.noisy}; }
  void describe(hal::ParamVisitor& v) { v.number(kText.name, amount, kText.unit, kText.range, kText.doc); }
};

/// The same of one that lies in an interval.
template <const ErrorText& kText>
struct OneInterval {
  hal::Interval amount = {};
  static OneInterval noisy() { return {hal::Interval::around(kText.noisy)}; }
  void describe(hal::ParamVisitor& v) { v.interval(kText.name, amount, kText.unit, kText.doc, kText.range); }
};

/// A robot of the block that a device works for.
struct RobotAt {
  const DeviceContext& context;
  std::size_t i;  ///< in the block

  std::size_t row() const noexcept { return context.block.first_row + i; }
  const Bodies& bodies() const noexcept { return context.stores.bodies; }
  std::array<std::uint32_t, 4> draw(Stream stream) const noexcept {
    return core::draw(context.seed, bodies().entity[row()], stream, context.tick);
  }
};

/// What a device is made with: its errors, and the block's rows of the column that it keeps, if it keeps one.
template <class OfErrors, class OfKept>
class DeviceState {
 public:
  using Errors = OfErrors;
  using Kept = OfKept;
  DeviceState(const DeviceSetup&, const Errors& errors, const BlockColumns& columns)
      : errors_(errors), kept_(columns.find<Kept>()) {}

 protected:
  Errors errors_;
  Kept* kept_;
};
template <class OfErrors>
class DeviceState<OfErrors, void> {
 public:
  using Errors = OfErrors;
  DeviceState(const DeviceSetup&, const Errors& errors, const BlockColumns&) : errors_(errors) {}

 protected:
  Errors errors_;
};

/// Sensor of the class `Self`, which has `read(robot, port)`: fills a port that is stamped.
template <class Self, class OfPort, class OfErrors, class OfKept = void>
class EachSensor : public Sensor, public DeviceState<OfErrors, OfKept> {
 public:
  using Port = OfPort;
  using DeviceState<OfErrors, OfKept>::DeviceState;

  void sense(const DeviceContext& context, void* ports) noexcept final {
    for (std::size_t i = 0; i < context.block.used; ++i) {
      Port& port = static_cast<Port*>(ports)[i];
      stamp(context, port);
      static_cast<Self&>(*this).read(RobotAt{context, i}, port);
    }
  }
};

/// Actuator of the class `Self`, which has `obey(robot, port)`.
template <class Self, class OfPort, class OfErrors, class OfKept>
class EachActuator : public Actuator, public DeviceState<OfErrors, OfKept> {
 public:
  using Port = OfPort;
  using DeviceState<OfErrors, OfKept>::DeviceState;

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept final {
    for (std::size_t i = 0; i < context.block.used; ++i)
      static_cast<Self&>(*this).obey(RobotAt{context, i}, static_cast<const Port*>(ports)[i]);
  }
};

}  // namespace tandem::core
